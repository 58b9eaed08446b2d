"""Sweeps of behaviours and plans: `nao_sim_bridge.sweep` over seeds, pushes and errors, on whole stacks.

Each worker has a stack of its own. A run resets the robot, watches the true pose of its torso, pushes it when the
moment has come, and tells what came of it.
"""

from __future__ import annotations

import inspect
import math
import os
import random
import shutil
import tempfile
import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.limits import kind
from nao_sim_bridge.base.readings import FALLEN, Pose
from nao_sim_bridge.core.scene import Scene
from nao_sim_bridge.sweep import Table, sweep

from ..ros.own_stack import START_LIMIT, OwnMaster, OwnStack, StackFailed
from .subjects import LATE, Outcome, Subject

NODE = "nao_sweep"
AS_FAST_AS_POSSIBLE = "0"


class WorkerStack:
    """A ROS master, a stack on it, and this process as a node of it: a process has at most one in its life.

    Attributes:
        robot: The `SimulatedRobot`; None while the stack does not run.

    Args:
        launch: Arguments of nao_sim.launch.

    Raises:
        RuntimeError: This process is a ROS node already.
        MasterFailed: The master does not come up.
    """

    def __init__(self, launch: Mapping[str, str]) -> None:
        import rospy

        if rospy.core.is_initialized():
            raise RuntimeError("this process is a ROS node already: sweep with 1 worker or more, or in another process")
        self._folder = Path(tempfile.mkdtemp(prefix="nao_sweep_"))
        self.robot: Any = None
        self._launch = {"speed": AS_FAST_AS_POSSIBLE, "record_dir": str(self._folder), **launch}
        self._stack: OwnStack | None = None
        self._master = OwnMaster(self._folder / "master.log")
        os.environ["ROS_MASTER_URI"] = self._master.uri

    def start(self) -> bool:
        """Start the stack, unless it runs; whether it had to be started. Raises StackFailed if it does not come up."""
        import rospy

        from nao_sim_bridge.testing import SimulatedRobot

        if self.robot is not None:
            return False
        self._stack = OwnStack(self._folder / "stack.log", self._launch, master_uri=self._master.uri)
        self._stack.wait_for_robot()
        if not rospy.core.is_initialized():  # not before the stack has said whose time counts
            rospy.init_node(NODE, argv=[NODE], anonymous=True, disable_rosout=True, disable_signals=True)
        self.robot = SimulatedRobot(limit=START_LIMIT)
        return True

    def drop(self) -> None:
        """End the stack."""
        self.robot = None
        if self._stack is not None:
            self._stack.stop()
            self._stack = None

    def close(self) -> None:
        """End it, and its master; leave nothing on the disk."""
        import rospy

        rospy.signal_shutdown("the sweep is over")
        self.drop()
        self._master.stop()
        shutil.rmtree(self._folder, ignore_errors=True)


# --- what is seen of a run --------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Push:
    """A push on the torso.

    Attributes:
        momentum: N s.
        heading: Where to, rad in world from the x axis to the left.
        moment: s of simulated time after the begin of what runs.
    """

    DURATION = 0.1

    momentum: float
    heading: float
    moment: float

    @property
    def force(self) -> tuple[float, float, float]:
        """N in world, for `DURATION` s."""
        size = self.momentum / self.DURATION
        return size * math.cos(self.heading), size * math.sin(self.heading), 0.0


class TorsoWatch:
    """One run, told the poses of the torso as they come, from any thread; the lock guards what is noted.

    Attributes:
        lean: The most the torso has leant, rad.
        pushed_at: s after the begin of what runs; None: not pushed.

    Args:
        after: Poses count from this simulated time on, s.
        push: What is to come, None for nothing.
        do_push: Carries it out.
    """

    def __init__(self, after: float, push: Push | None, do_push: Callable[[Push], None]) -> None:
        self.lean = 0.0
        self.pushed_at: float | None = None
        self._after = self._began = self._now = after
        self._push, self._do_push = push, do_push
        self._running = False
        self._first: tuple[float, float] | None = None
        self._last = (0.0, 0.0)
        self._lock = threading.Lock()

    @property
    def fell(self) -> bool:
        return self.lean > FALLEN

    @property
    def moved(self) -> float:
        """Distance on the floor between the first and the last place, m."""
        return math.dist(self._first or self._last, self._last)

    def begin(self, now: float) -> None:
        """What runs begins, at a simulated time in s; only the first call counts."""
        with self._lock:
            if not self._running:
                self._running, self._began = True, now

    def look(self, time: float, torso: Pose) -> None:
        """The true pose of the torso at a simulated time, s; pushes when the moment has come."""
        if time <= self._after:
            return  # of the run before
        with self._lock:
            self._now = time
            self.lean = max(self.lean, torso.lean)
            self._last = torso.position[:2]
            self._first = self._first or self._last
            due = self._running and self._push is not None and time >= self._began + self._push.moment
            push = self._take() if due else None
        if push is not None:
            self._do_push(push)

    def end(self) -> None:
        """What runs is over: a push whose moment has not come, for this run was shorter, comes now."""
        with self._lock:
            push = self._take()
        if push is not None:
            self._do_push(push)

    def _take(self) -> Push | None:
        """The push, once; the lock is held."""
        push, self._push = self._push, None
        if push is not None:
            self.pushed_at = max(0.0, self._now - self._began)
        return push


# --- a run ------------------------------------------------------------------------------------------------------------

TRUTH = "ground_truth/odom"
AFTERWARDS = 3.0
"""s of simulated time after the end of what runs: who was pushed at the end has fallen by then."""
TRIES = 2
"""How often a run is begun whose stack is lost meanwhile."""
NEVER = ""
"""In the columns of a push: there was none."""


class StackLost(RuntimeError):
    """The stack of a run is gone."""


class StackRuns:
    """A function for `sweep`: each copy begins a stack with its first run and keeps it.

    Args:
        subject: What runs.
        limit: s of this computer that a run may take.
        posture: That the robot takes before, a name of NAOqi; empty: it crouches, motors off, as after its start.
        launch: Further arguments of nao_sim.launch.
    """

    def __init__(self, subject: Subject, limit: float, posture: str, launch: Mapping[str, str]) -> None:
        self._subject = subject
        self._posture = posture
        self._limit = limit
        self._launch = {**subject.launch, **launch}
        self._stack: WorkerStack | None = None
        self._link: Any = None
        self._durations: dict[tuple[Any, ...], float] = {}

    def __call__(
        self,
        seed: int,
        push: float = 0.0,
        noise: float = 0.0,
        payload: float = 0.0,
        delay: float = 0.0,
        **parameters: Any,
    ) -> dict[str, Any]:
        """One run, as a row of the table; begun again where the stack was lost."""
        chance = random.Random(seed)
        share, heading = chance.random(), chance.uniform(-math.pi, math.pi)
        planned = Push(push, heading, share * self._undisturbed(parameters)) if push else None
        varied = {"seed": seed, "noise": noise, "payload": payload, "delay": delay}
        outcome, watch = self._insist(varied, planned, parameters)
        pushed = watch.pushed_at is not None
        return {
            "fell": watch.fell,
            "outcome": outcome.state,
            "duration": round(outcome.duration, 3),
            "lean": round(watch.lean, 4),
            "moved": round(watch.moved, 4),
            "pushed_at": round(watch.pushed_at, 3) if pushed else NEVER,
            "heading": round(heading, 4) if pushed else NEVER,
            "told": outcome.text,
        }

    def close(self) -> None:
        """End the stack."""
        if self._stack is not None:
            self._stack.close()

    def _undisturbed(self, parameters: Mapping[str, Any]) -> float:
        """How long it takes without errors and pushes, s of simulated time: run once for all that is pushed."""
        key = tuple(parameters.items())
        if key not in self._durations:
            outcome, _ = self._insist({}, None, parameters)
            self._durations[key] = outcome.duration
        return self._durations[key]

    def _insist(
        self, varied: Mapping[str, Any], push: Push | None, parameters: Mapping[str, Any]
    ) -> tuple[Outcome, TorsoWatch]:
        import rospy

        from nao_sim_bridge.testing import StackNotReady

        if self._stack is None:
            self._stack = WorkerStack(self._launch)
        for _ in range(TRIES):
            try:
                return self._run(self._stack, varied, push, parameters)
            except (StackLost, StackNotReady, StackFailed, rospy.ROSException, rospy.ServiceException) as error:
                self._stack.drop()
                lost = error
        raise StackLost(f"the stack was lost {TRIES} times, at last: {lost}") from lost

    def _run(
        self, stack: WorkerStack, varied: Mapping[str, Any], push: Push | None, parameters: Mapping[str, Any]
    ) -> tuple[Outcome, TorsoWatch]:
        if stack.start():
            self._link = self._subject.connect(stack.robot)
            # Nodes that still start hold the first one up for seconds of simulated time: it does not count.
            first = self._watched(stack, varied, None, parameters)
            if first[0].state == LATE:
                return first
        return self._watched(stack, varied, push, parameters)

    def _watched(
        self, stack: WorkerStack, varied: Mapping[str, Any], push: Push | None, parameters: Mapping[str, Any]
    ) -> tuple[Outcome, TorsoWatch]:
        import rospy
        from nav_msgs.msg import Odometry

        robot = stack.robot
        robot.vary(**varied)
        robot.reset()
        if self._posture and not robot.module("ALRobotPosture").goToPosture(self._posture, 1.0):
            raise RuntimeError(f"the robot does not reach the posture {self._posture!r}")
        began = robot.advance(0.0)
        watch = TorsoWatch(began, push, lambda push: robot.push(push.force, push.DURATION))

        seen = rospy.Subscriber(
            TRUTH, Odometry, lambda told: watch.look(told.header.stamp.to_sec(), _pose(told.pose.pose))
        )
        try:
            outcome = self._subject.run(self._link, parameters, self._limit, lambda: watch.begin(rospy.get_time()))
            if outcome.state == LATE:
                stack.drop()  # with whatever goes on in it
                return outcome, watch
            watch.end()
            ended = robot.advance(AFTERWARDS)
            if ended < began:
                raise StackLost("the simulator has begun anew during a run")
            watch.look(ended, _pose(robot.true_pose()))
            return outcome, watch
        finally:
            seen.unregister()


def _pose(told: Any) -> Pose:
    """A pose as messages have it."""
    place, turn = told.position, told.orientation
    return Pose((place.x, place.y, place.z), (turn.x, turn.y, turn.z, turn.w))


# --- a sweep ----------------------------------------------------------------------------------------------------------

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
