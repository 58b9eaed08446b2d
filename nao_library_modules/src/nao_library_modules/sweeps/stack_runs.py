"""Runs of a sweep on the stack of a worker: reset, run, push, and tell what came of it."""

from __future__ import annotations

import math
import random
from collections.abc import Mapping
from typing import Any

from nao_sim_bridge.base.readings import Pose

from ..processes.own_stack import StackFailed
from .subjects import LATE, Outcome, Subject
from .watch import Push, TorsoWatch
from .worker_stack import WorkerStack

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
