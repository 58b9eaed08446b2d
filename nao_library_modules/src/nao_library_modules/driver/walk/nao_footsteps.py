"""The node nao_footsteps: single footsteps and sequences of them, with the names of nao_robot.

A step that is too long is shortened, one that treads on the other foot turned back. Source: limits and boxes of the
feet that ALMotion itself uses for its footsteps, as the robot's documentation of the walk prints them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import rospy

from almath import Pose2D, Position2D, avoidFootCollision, clipFootWithEllipse
from nao_library_actions.msg import ExecFootstepsAction, ExecFootstepsFeedback, ExecFootstepsGoal, ExecFootstepsResult
from nao_library_msgs.msg import StepTarget
from nao_library_msgs.srv import ClipFootstep, ClipFootstepResponse, StepTargetService
from naoqi.errors import NaoError
from naoqi.limits import ANSWER_LIMIT, STOP_LIMIT

from ...core.errors import BadGoal, Preempted
from ...core.fields import limit, require_length, require_within
from ...core.geometry import Place
from ...core.health import Report
from ...core.nao_facts import MOTION, ask_for_stiff_legs
from ...core.waiting import CancellationToken
from ...ros.action_server import ConcurrentActionServer, GoalOutcome
from ...ros.node_interface import NodeInterface
from ...ros.time_and_frames import RosClock
from ..base.driver_node import interrupt_when_lost, whenever
from ..joints.joint_controller import InitialStiffness, JointController
from .walk_commands import LEFT, LEGS, RIGHT, FootStep, read_step

STEP_TIME = 0.5
"""s from step to step."""
TOO_EARLY = 0.6
"""Share of the time of all steps: a walk that ends before was stopped."""
MIN_X, MAX_X = -0.04, 0.08
MIN_Y, MAX_Y = 0.088, 0.16
"""m: from the middle of the standing foot to that of the other one, to its own side."""
MAX_TURN = 0.5
"""rad."""
LEFT_BOX = [Position2D(*corner) for corner in ((0.11, 0.05), (0.11, -0.038), (-0.047, -0.038), (-0.047, 0.05))]
RIGHT_BOX = [Position2D(corner.x, -corner.y) for corner in reversed(LEFT_BOX)]


def clip(step: Place, leg: str) -> Place:
    """The nearest step of its kind that the robot can make: place of the moving foot `leg` in the frame of the other.

    Raises NaoError if a number of the step is none, or the leg is unknown.
    """
    if leg not in (LEFT, RIGHT):
        raise NaoError(f"no leg {leg!r}: {LEFT} or {RIGHT}")
    for name, value in zip(("x", "y", "theta"), step):
        if not math.isfinite(value):
            raise BadGoal(f"pose.{name}", value, "a finite number")
    outwards = 1.0 if leg == LEFT else -1.0
    x = min(max(step.x, MIN_X), MAX_X)
    aside = min(max(step.y * outwards, MIN_Y), MAX_Y)
    turn = min(max(step.yaw, -MAX_TURN), MAX_TURN)
    # Of the ellipse, the middle is the place beside the standing foot: far ahead and far aside at once is too far.
    clipped = Pose2D(x, aside - MIN_Y, turn)
    clipFootWithEllipse(MAX_X if x >= 0.0 else MIN_X, MAX_Y - MIN_Y, clipped)
    clipped.y = (clipped.y + MIN_Y) * outwards
    avoidFootCollision(LEFT_BOX, RIGHT_BOX, leg == RIGHT, clipped)
    return Place(clipped.x, clipped.y, clipped.theta)


def check_legs(legs: Sequence[str]) -> None:
    """Check that each step is made by the other foot than the one before; raises BadGoal."""
    for index, (before, leg) in enumerate(zip(legs, legs[1:]), start=1):
        if leg == before:
            raise BadGoal(f"footsteps[{index}].leg", leg, f"left and right in turn, and {before} made the step before")


@dataclass(frozen=True)
class Walked:
    """The steps that were made, in order, as the robot can make them."""

    steps: tuple[FootStep, ...]
    preempted: bool = False  # stopped before the last step


class FootstepWalk:
    """Has one robot make footsteps. Any thread may ask; callers see to it that only one walks at a time."""

    def __init__(self, robot: Any, clock: Any) -> None:
        self._robot = robot
        self._clock = clock

    @staticmethod
    def clipped(step: FootStep) -> FootStep:
        return FootStep(step.leg, *clip(step.place, step.leg))

    def prepared(self, steps: Sequence[FootStep]) -> tuple[FootStep, ...]:
        """Steps as the robot can make them, one after the other.

        Raises NaoError if there are none, or they are not made by one leg after the other.
        """
        if not steps:
            raise BadGoal("footsteps", [], "one step at least")
        check_legs([step.leg for step in steps])
        return tuple(self.clipped(step) for step in steps)

    def add(self, step: FootStep) -> None:
        """Have a step made after those that were added before; returns at once.

        Raises NaoError if it is no step, or the robot refuses it or has soft legs.
        """
        clipped = self.clipped(step)
        ask_for_stiff_legs(self._robot)
        self._send((clipped,), clear=False)

    def make(self, step: FootStep) -> None:
        """Make a step, and return when the robot stands.

        Raises NaoError if it is no step, or the robot does not make it.
        """
        self.add(step)
        self._motion("waitUntilMoveIsFinished").result(timeout=STOP_LIMIT)

    def walk(
        self,
        steps: Sequence[FootStep],
        period: float,
        interrupt: CancellationToken,
        report: Callable[[tuple[FootStep, ...]], None],
    ) -> Walked:
        """Make steps that `prepared` gave, to the end or to the interrupt; the robot stands then.

        Every `period` s `report` gets the steps that are made.

        Raises NaoError if the robot refuses them or has soft legs, is lost or stops by itself.
        """
        steps = tuple(steps)
        ask_for_stiff_legs(self._robot)
        began = self._clock.now()
        self._send(steps, clear=True)
        ended = self._motion("waitUntilMoveIsFinished")
        wake = CancellationToken()
        ended.add_done_callback(lambda _: wake.trigger())
        made = None  # until the robot has planned them
        with interrupt.waking(wake.trigger):
            while not wake.is_set():
                self._clock.wait(period, wake)
                if not ended.done():
                    made = self._made(len(steps), made)
                    report(steps[: made or 0])
        if not ended.done():
            return self._stopped(steps, made, interrupt)
        ended.result(timeout=0)
        if self._clock.now() - began < TOO_EARLY * STEP_TIME * len(steps):
            count = f"{made or 0} of {len(steps)} steps"
            raise NaoError(f"the walk ended after {count}: another client or a protection of the robot did that")
        report(steps)
        return Walked(steps)

    def _stopped(self, steps: tuple[FootStep, ...], made: int | None, interrupt: CancellationToken) -> Walked:
        """Stop the robot; steps that can no longer be taken back are made."""
        try:
            made = self._made(len(steps), made, taken_back=True)
            self._motion("stopMove").result(timeout=STOP_LIMIT)
            self._motion("waitUntilMoveIsFinished").result(timeout=STOP_LIMIT)
        except NaoError:
            interrupt.check()  # why it was to stop says more than that it cannot be reached
        with suppress(Preempted):
            interrupt.check()
        return Walked(steps[: made or 0], preempted=True)

    def _send(self, steps: tuple[FootStep, ...], clear: bool) -> None:
        legs = [step.leg for step in steps]
        places = [list(step.place) for step in steps]
        times = [STEP_TIME * (index + 1) for index in range(len(steps))]
        self._motion("setFootSteps", legs, places, times, clear).result(timeout=ANSWER_LIMIT)

    def _made(self, count: int, before: int | None, taken_back: bool = False) -> int | None:
        """How many of `count` steps are made, by those that are left.

        None while the robot has not planned them: it takes the pose for walking first, with no step left. `before` is
        the last answer. With `taken_back`, only the steps that can still be taken back will not be made.
        """
        _, fixed, changeable = self._motion("getFootSteps").result(timeout=ANSWER_LIMIT)
        if before is None and not fixed and not changeable:
            return None
        ahead = len(changeable) + (0 if taken_back else len(fixed))
        return max(before or 0, min(count, count - ahead))

    def _motion(self, method: str, *arguments: Any) -> Any:
        return self._robot.proxy(MOTION).call_async(method, *arguments)


FEEDBACK, FOOTSTEPS = limit("feedback rate"), limit("footsteps")
COMPLAINT_PERIOD = 5.0
SHUTDOWN_LIMIT = 4.0
CODES = {leg: code for code, leg in LEGS.items()}


class NaoFootsteps:
    """Makes footsteps, half a second each. A step that is too far is shortened as by `clip_footstep_srv`.

    ROS API (relative names):
        Subscribes `footstep` (nao_library_msgs/StepTarget): one more step.
        Services `footstep_srv` (nao_library_msgs/StepTargetService: answers when the step is made),
        `clip_footstep_srv` (nao_library_msgs/ClipFootstep).
        Action `footsteps_execution` (nao_library_actions/ExecFootsteps): steps of left and right foot in turn; the
        executed steps, in feedback and result, are as the robot makes them. A new goal ends the one before.
        Parameter `~init_stiffness` (0): stiffness that the body gets when the robot is reached, if above 0.
    """

    def __init__(self, robot: Any, node: NodeInterface) -> None:
        self._node = node
        init_stiffness = InitialStiffness(JointController(robot), node.param)
        self._walk = FootstepWalk(robot, RosClock())
        self._server = ConcurrentActionServer(self._claims, self._execute, with_feedback=True, robot=robot)
        self._node.action("footsteps_execution", ExecFootstepsAction, self._server)
        self._node.offer("footstep_srv", StepTargetService, lambda request: self._walk.make(read_step(request.step)))
        self._node.offer("clip_footstep_srv", ClipFootstep, self._on_clip)
        # After the services: a part that cannot offer them sets nothing on the robot.
        self._stop_watching = interrupt_when_lost(robot, node, self._server)
        self._stop_stiffening = whenever(robot, node, "connected", init_stiffness.apply)
        self._node.subscriber("footstep", StepTarget, self._on_step, queue_size=50)

    def reports(self) -> dict[str, Callable[[], Report]]:
        return {"goals footsteps_execution": self._server.counter.report}

    def close(self) -> None:
        """End the goal that runs; the robot stands then."""
        self._stop_stiffening()
        self._stop_watching()
        self._server.close(SHUTDOWN_LIMIT)

    # --- the action -----------------------------------------------------------------------------------------------

    def _claims(self, goal: ExecFootstepsGoal) -> frozenset[str]:
        """Check the goal before it ends another one."""
        require_within("feedback_frequency", goal.feedback_frequency, FEEDBACK)
        self._walk.prepared(read_steps(goal.footsteps))
        return frozenset({"the legs"})

    def _execute(
        self, goal: ExecFootstepsGoal, interrupt: CancellationToken, publish: Callable[[Any], None]
    ) -> GoalOutcome:
        steps = self._walk.prepared(read_steps(goal.footsteps))

        def report(made: tuple[FootStep, ...]) -> None:
            publish(ExecFootstepsFeedback([step_target(step) for step in made]))

        walked = self._walk.walk(steps, 1.0 / goal.feedback_frequency, interrupt, report)
        return GoalOutcome(ExecFootstepsResult([step_target(step) for step in walked.steps]), walked.preempted)

    # --- topic and services ---------------------------------------------------------------------------------------

    def _on_step(self, target: StepTarget) -> None:
        try:
            self._walk.add(read_step(target))
        except NaoError as error:
            rospy.logerr_throttle(COMPLAINT_PERIOD, f"footstep: {error}")

    def _on_clip(self, request: Any) -> ClipFootstepResponse:
        return ClipFootstepResponse(step_target(self._walk.clipped(read_step(request.step))))


def read_steps(targets: list[StepTarget]) -> list[FootStep]:
    """Steps from their messages. Raises BadGoal if one will not do, or they are too many."""
    require_length("footsteps", len(targets), FOOTSTEPS)
    return [read_step(target, f"footsteps[{index}].") for index, target in enumerate(targets)]


def step_target(step: FootStep) -> StepTarget:
    target = StepTarget(leg=CODES[step.leg])
    target.pose.x, target.pose.y, target.pose.theta = step.place
    return target
