"""Sweeps of behaviours and plans: `nao_sim_bridge.sweep` over seeds, pushes and errors, on whole stacks."""

from __future__ import annotations

import inspect
from collections.abc import Mapping, Sequence
from pathlib import Path

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.limits import kind
from nao_sim_bridge.core.scene import Scene
from nao_sim_bridge.sweep import Table, sweep

from .stack_runs import StackRuns
from .subjects import Subject
from .watch import Push

LIMIT = 300.0
"""s of a computer that a run may take."""
COLUMNS = "fell outcome duration lean moved pushed_at heading told seconds error".split()
"""Of a table, besides the seed and what is swept."""


def sweep_stack(
    subject: Subject,
    seeds: int | Sequence[int],
    push: Sequence[float] = (),
    noise: Sequence[float] = (),
    payload: Sequence[float] = (),
    delay: Sequence[float] = (),
    parameters: Mapping[str, Sequence[str]] | None = None,
    posture: str = "",
    limit: float = LIMIT,
    launch: Mapping[str, str] | None = None,
    output: str | Path | None = None,
    workers: int | None = None,
    address: str | None = None,
    progress: bool = True,
) -> Table:
    """Run a behaviour or a plan with all seeds and all combinations of the rest; each worker has a stack of its own.

    Args:
        subject: `BehaviorGoal` or `PlanProgram`.
        seeds: As `sweep` takes them.
        push: N s on the torso within a tenth of a second, at a moment and into a direction that the seed says. What is
            empty is 0 in all runs and no column of the table, here and with the next three.
        noise: Errors of the sensors: 0 none, 1 as those of a real robot.
        payload: kg that the torso carries besides its own.
        delay: How late sensors arrive, s.
        parameters: Of a behaviour: values by name.
        posture: That the robot takes before, a name of NAOqi; empty: it crouches, motors off, as after its start.
        limit: s of a computer that a run may take; one that takes longer is ended and is a row that says so.
        launch: Further arguments of nao_sim.launch, as `world`.
        output: As `sweep` takes it, as those that follow.
        workers: 0: in this process, which must not be a ROS node yet and can do so once.
        address: Of a Ray cluster.
        progress: Show how far it is.

    Raises:
        BadValue: A number is not in its range, or a parameter has a name that is taken.
        ImportError: There is no Ray.
    """
    _check_ranges(push, noise, payload, delay)
    taken = {*inspect.signature(sweep).parameters, *inspect.signature(StackRuns.__call__).parameters, *COLUMNS}
    for name in parameters or {}:
        if name in taken:
            raise BadValue("parameter", name, "a name that sweeps have no other use for: leave it at its default")
    varied = {"push": push, "noise": noise, "payload": payload, "delay": delay}
    return sweep(
        StackRuns(subject, limit, posture, launch or {}),
        seeds,
        output=output,
        workers=workers,
        address=address,
        progress=progress,
        memory=subject.memory,
        **(parameters or {}),
        **{name: list(map(float, values)) for name, values in varied.items() if len(values)},
    )


def _check_ranges(
    push: Sequence[float], noise: Sequence[float], payload: Sequence[float], delay: Sequence[float]
) -> None:
    """Refuse what the simulator would refuse in each run."""
    for name, values in (("sensor_noise", noise), ("payload", payload), ("sensor_delay", delay)):
        for value in values:
            Scene(**{name: value})
    most = kind("force").highest * Push.DURATION
    for value in push:
        if not 0.0 <= value <= most:
            raise BadValue("push", value, f"0 to {most:g} N s")
