"""Motions made of several steps, as one task that can be killed at any point. Simulation thread only."""

from __future__ import annotations

from typing import Any, Callable, Iterable, Iterator, Optional, Sequence

from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.control.balance.posture_recognition import CROUCHING, STANDING, recognise
from nao_sim_bridge.control.joints.curves import Ramp, SmoothCurve
from nao_sim_bridge.core.robot import SimulatedRobot
from nao_sim_bridge.model.postures import posture

Step = Callable[[], Optional[Task]]

AWAKE_POSTURE = "Stand"
# Time to stiffen or release the body, s, and to move between standing and crouching.
STIFFEN_TIME = 0.2
POSTURE_TIME = 2.0


def run_steps(
    robot: SimulatedRobot, name: str, steps: Iterable[Step], outcome: Callable[[], Any] = lambda: None
) -> Task:
    """Run steps one after the other; each returns the task to wait for, or None.

    Args:
        steps: Called in order, each when the one before has ended; a killed step ends the whole.
        outcome: Called at the end, also at one before time; what it returns is the result of the whole.
    """
    remaining: Iterator[Step] = iter(steps)
    running: list[Task] = []

    def stop(_: Task) -> None:
        for task in running:
            task.kill()
        whole.finish(outcome())

    whole = robot.task_ids.make(name, on_kill=stop)

    def proceed(done: Task | None = None) -> None:
        if whole.finished or whole.killed:
            return
        if done is not None and done.killed:
            whole.kill()
            return
        for step in remaining:
            task = step()
            if task is not None:
                running[:] = [task]
                task.add_done_callback(proceed)
                return
        whole.finish(outcome())

    proceed()
    return whole


def stop_walk(robot: SimulatedRobot) -> Task | None:
    """Bring a walk to its end on two feet, before legs do something else; None when there is none."""
    return robot.locomotion.stop() if robot.walking else None


def is_on_feet(robot: SimulatedRobot, snapshot: Snapshot) -> bool:
    """Whether the robot stands or crouches: from anywhere else, standing up is more than one motion."""
    return recognise(robot.model, snapshot).family in (STANDING, CROUCHING)


def wake_up(robot: SimulatedRobot, snapshot: Callable[[], Snapshot], on_end: Callable[[], None]) -> Task:
    """Stiffen the body where it is and, when on its feet, stand up; `on_end` is called after the last step."""

    def stand() -> Task | None:
        return posture_task(robot, "wakeUp", AWAKE_POSTURE) if is_on_feet(robot, snapshot()) else None

    steps = [lambda: stop_walk(robot), lambda: stiffen(robot, "wakeUp", snapshot()), stand, on_end]
    return run_steps(robot, "wakeUp", steps)


def body_is_stiff(robot: SimulatedRobot) -> bool:
    """Whether nothing but hands is limp: these often are, and bear nothing."""
    return all(stiff for stiff, joint in zip(robot.joints.stiffnesses, robot.model.joints) if not joint.is_hand)


def posture_task(
    robot: SimulatedRobot,
    name: str,
    target: str,
    duration: float = POSTURE_TIME,
    indices: Sequence[int] | None = None,
) -> Task:
    """Move the whole body, or some joints, to a posture in `duration` s."""
    goal = posture(robot.model, target)
    moved = range(len(goal)) if indices is None else indices

    def curves(commands: Sequence[float]) -> dict[int, SmoothCurve]:
        return {i: SmoothCurve((0.0, duration), (commands[i], goal[i])) for i in moved}

    return robot.motion.follow(name, moved, curves)


def stiffen(robot: SimulatedRobot, name: str, now: Snapshot) -> Task:
    """Stiffen the body where it is."""
    body = range(len(robot.model.joints))
    robot.joints.hold(now.positions, [i for i in body if robot.joints.stiffnesses[i] == 0.0])
    return stiffness_task(robot, name, body, 1.0, STIFFEN_TIME)


def stiffness_task(robot: SimulatedRobot, name: str, indices: Iterable[int], target: float, duration: float) -> Task:
    """Change stiffness of joints to `target` in `duration` s."""
    indices = list(indices)

    def ramps(now: Sequence[float]) -> dict[int, Ramp]:
        return {i: Ramp(now[i], target, max(abs(target - now[i]), 1e-6) / duration) for i in indices}

    return robot.motion.stiffen(name, indices, ramps)
