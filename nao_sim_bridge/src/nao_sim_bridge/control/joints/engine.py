"""The motion engine: every task that moves or stiffens joints, advanced once a tick.

Two kinds of motion share the joints, as in ALMotion:

- a *task* (angleInterpolation and kin) owns its joints from start to end. A second task that wants one of them waits
  in line until it is free;
- a *target* (setAngles and kin) is no task: a newer one replaces it at any time. It gives way to a task that starts on
  its joint, and one set while a task holds the joint is taken up when that task ends.

Joints that neither moves are idle, and somebody may move them for as long as they are.

Only the simulation thread calls anything here.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, AbstractSet, Callable, Container, Iterable, Mapping, Protocol, Sequence, Union

from nao_sim_bridge.base.errors import check_finite
from nao_sim_bridge.base.tasks import Task, TaskIds
from nao_sim_bridge.body.joint_commands import JointCommands
from nao_sim_bridge.control.joints.curves import ROUNDING, Ramp, SmoothCurve
from nao_sim_bridge.control.joints.wishes import Notices

if TYPE_CHECKING:
    from nao_sim_bridge.control.joints.bezier import BezierCurve

Curve = Union[Ramp, SmoothCurve, "BezierCurve"]
CurveBuilder = Callable[[Sequence[float]], Mapping[int, Curve]]

# A command is "there" when it is this close; float rounding only, commands are exact.
REACHED = 1e-9


class Corrector(Protocol):
    """Changes what tasks and targets want before the joints are told, as whole body control does."""

    def correct(self, wanted: dict[int, float], dt: float) -> dict[int, float]:
        """What the joints are told instead of `wanted` (rad by index) at a tick of `dt` s; called at every tick."""

    def stop(self, indices: Iterable[int]) -> None:
        """Leave these joints where they are: somebody has killed what moves them."""


class IdleMotion(Protocol):
    """Moves joints that nobody else moves, as breathing does."""

    def wishes(self, busy: AbstractSet[int], dt: float) -> Mapping[int, float]:
        """Where idle joints go at a tick of `dt` s, rad by index; none of `busy`, which somebody else moves."""


@dataclass(eq=False)
class _Job:
    """A task, the curves it follows once started, and what it holds."""

    task: Task
    indices: frozenset[int]
    build: CurveBuilder
    stiffness: bool
    noticed: bool
    started: float | None = None
    curves: Mapping[int, Curve] = field(default_factory=dict)

    def conflicts(self, other: _Job) -> bool:
        return self.stiffness == other.stiffness and bool(self.indices & other.indices)


class MotionEngine:
    """Advances all joint motion.

    Attributes:
        corrector: Who changes what tasks and targets want; None when nobody does.
        idle: Who moves idle joints; None when nobody does.
        notices: Tells in the log what cannot be done as it was asked.
    """

    def __init__(self, joints: JointCommands, task_ids: TaskIds) -> None:
        self._joints = joints
        self._ids = task_ids
        self._jobs: list[_Job] = []
        self._targets: dict[int, tuple[float, float]] = {}
        self._ramps: dict[int, tuple[Ramp, float]] = {}
        self._now = 0.0
        self.corrector: Corrector | None = None
        self.idle: IdleMotion | None = None
        self.notices = Notices(joints)

    # --- what callers ask for -------------------------------------------------------------------------------------

    def follow(self, name: str, indices: Iterable[int], build: CurveBuilder, noticed: bool = True) -> Task:
        """Start a task that moves `indices` along the curves that `build(commands)` makes when its turn comes.

        With `noticed` the log tells what joints cannot do of it; without, for curves that are known to ask for more
        than there is, and go as far as joints go.
        """
        return self._add(name, indices, build, stiffness=False, noticed=noticed)

    def stiffen(self, name: str, indices: Iterable[int], build: CurveBuilder) -> Task:
        """Start a task that changes stiffnesses (0..1) along the curves of `build(stiffnesses)`."""
        return self._add(name, indices, build, stiffness=True)

    def set_targets(self, targets: Mapping[int, float], speeds: Mapping[int, float]) -> None:
        """Move joints to `targets` (rad) at `speeds` (rad/s) from now on; replaces older targets.

        Raises:
            NotFinite: One of the numbers is not.
        """
        check_finite("targets", (*targets.values(), *speeds.values()))
        self.notices.check_targets("setAngles", targets)
        for index, target in targets.items():
            self._targets[index] = (self._joints.clamp_alone(index, target), speeds[index])
            self._ramps.pop(index, None)

    def target_of(self, index: int) -> float:
        """Where a joint is heading by `set_targets`, else its command, in rad."""
        target = self._targets.get(index)
        return self._joints.commands[index] if target is None else target[0]

    def set_stiffness_now(self, values: Mapping[int, float]) -> None:
        """Set stiffnesses at once; ends stiffness tasks on these joints."""
        for job in [j for j in self._jobs if j.stiffness and j.indices & values.keys()]:
            job.task.kill()
        self._joints.set_stiffness(dict(values))

    # --- looking and killing --------------------------------------------------------------------------------------

    def tasks(self) -> list[Task]:
        """Tasks that run or wait, oldest first."""
        return [job.task for job in self._jobs]

    def busy(self, indices: Iterable[int]) -> bool:
        """True when a task runs or waits on one of the joints."""
        wanted = set(indices)
        return any(not job.stiffness and wanted & job.indices for job in self._jobs)

    def kill_using(self, indices: Iterable[int]) -> None:
        """Kill every motion task on these joints and drop their targets: they stay where they are."""
        wanted = set(indices)
        for job in [j for j in self._jobs if not j.stiffness and j.indices & wanted]:
            job.task.kill()
        for index in wanted:
            self._targets.pop(index, None)
            self._ramps.pop(index, None)
        if self.corrector is not None:
            self.corrector.stop(wanted)

    def kill_all(self) -> None:
        for job in list(self._jobs):
            job.task.kill()
        self._targets.clear()
        self._ramps.clear()
        if self.corrector is not None:
            self.corrector.stop(range(len(self._joints.commands)))

    def fail(self, task: Task, error: Exception) -> None:
        """End a task that has raised: whoever waits for it gets the error."""
        self._ids.guard.caught(f"task {task.name}", error)
        self._drop(task)
        task.finish(error=error)

    # --- the tick -------------------------------------------------------------------------------------------------

    def tick(self, now: float, dt: float) -> None:
        """Advance everything to time `now` (s), `dt` seconds after the last tick."""
        self._now = now
        if not (self._jobs or self._targets):
            self._command({} if self.idle is None else dict(self.idle.wishes(frozenset(), dt)), dt)
            return
        self._start_jobs(now - dt)
        wanted: dict[int, float] = {}
        if self.idle is not None:
            wanted.update(self.idle.wishes(self._moved(), dt))
        if self._targets:
            self._advance_targets(wanted, now, dt)
        for job in self._jobs:  # replaced, never changed
            if job.started is None:
                continue
            elapsed = now - job.started
            try:
                values = {index: curve.value(elapsed) for index, curve in job.curves.items()}
                check_finite(job.task.name, values.values())
            except Exception as error:
                self.fail(job.task, error)
                continue
            if job.stiffness:
                self._joints.set_stiffness(values)
            else:
                wanted.update(values)
        self._command(wanted, dt)
        self._finish_jobs(now)

    def _moved(self) -> AbstractSet[int]:
        return {*self._targets, *(i for job in self._jobs if not job.stiffness for i in job.indices)}

    def _command(self, wanted: dict[int, float], dt: float) -> None:
        if self.corrector is not None:
            wanted = self.corrector.correct(wanted, dt)
        self._joints.step(wanted, dt)

    def _add(
        self, name: str, indices: Iterable[int], build: CurveBuilder, stiffness: bool, noticed: bool = False
    ) -> Task:
        task = self._ids.make(name, on_kill=self._drop)
        self._jobs.append(_Job(task, frozenset(indices), build, stiffness, noticed))
        return task

    def _drop(self, task: Task) -> None:
        self._jobs = [job for job in self._jobs if job.task is not task]

    def _start_jobs(self, now: float) -> None:
        jobs = self._jobs
        for position, job in enumerate(jobs):
            if job.started is not None or any(job.conflicts(older) for older in jobs[:position]):
                continue
            job.started = now
            try:
                job.curves = job.build(self._joints.stiffnesses if job.stiffness else self._joints.commands)
                if job.noticed and not job.stiffness:
                    self.notices.check_curves(job.task.name, job.curves)
            except Exception as error:
                self.fail(job.task, error)
                continue
            if not job.stiffness:
                for index in job.indices:
                    self._targets.pop(index, None)
                    self._ramps.pop(index, None)

    def _advance_targets(self, wanted: dict[int, float], now: float, dt: float) -> None:
        held = {i for job in self._jobs if job.started is not None and not job.stiffness for i in job.indices}
        for index, (target, speed) in list(self._targets.items()):
            if index in held:
                continue
            if index not in self._ramps:
                self._ramps[index] = (Ramp(self._joints.commands[index], target, speed), now - dt)
            ramp, started = self._ramps[index]
            wanted[index] = ramp.value(now - started)
            if now - started >= ramp.duration and self._arrived(index, target, self._targets):
                del self._targets[index], self._ramps[index]

    def _finish_jobs(self, now: float) -> None:
        for job in [j for j in self._jobs if j.started is not None]:
            try:
                over = self._is_over(job, now)
            except Exception as error:
                self.fail(job.task, error)
                continue
            if over:
                self._drop(job.task)
                job.task.finish()

    def _is_over(self, job: _Job, now: float) -> bool:
        """Whether all curves have ended, and no motor's speed limit still keeps a command from the end of its curve.

        A command that something else keeps from there, an arm before a collision for example, is as far as it gets.
        """
        if any(now - job.started < curve.duration - ROUNDING for curve in job.curves.values()):
            return False
        ends = ((i, curve.value(curve.duration)) for i, curve in job.curves.items())
        return job.stiffness or all(self._arrived(i, end, job.curves) for i, end in ends)

    def _arrived(self, index: int, goal: float, moved: Container[int]) -> bool:
        """Whether a joint, moved together with `moved`, has got as near to its goal (rad) as it gets."""
        joints = self._joints
        return (
            self.corrector is not None  # it may have kept the command somewhere else
            or abs(joints.commands[index] - joints.clamp(index, goal)) <= REACHED
            or index in joints.blocked
            or joints.overruled(index, moved)
        )
