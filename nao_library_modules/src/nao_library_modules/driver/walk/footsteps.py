"""The node nao_footsteps: single footsteps and sequences of them, with the names of nao_robot."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import rospy

from nao_library_actions.msg import ExecFootstepsAction, ExecFootstepsFeedback, ExecFootstepsGoal, ExecFootstepsResult
from nao_library_msgs.msg import StepTarget
from nao_library_msgs.srv import ClipFootstep, ClipFootstepResponse, StepTargetService
from naoqi.errors import NaoError

from ...base.cancellation import CancellationToken
from ...base.field_checks import require_length, require_within
from ...base.limits import limit
from ...ros.concurrent_action_server import ConcurrentActionServer, GoalOutcome
from ...ros.health import Report
from ...ros.node_interface import NodeInterface
from ...ros.ros_clock import RosClock
from ..base.node import interrupt_when_lost, whenever
from ..joints.joint_controller import InitialStiffness, JointController
from .footsteps_walk import FootstepWalk
from .walk_commands import LEGS, FootStep, read_step

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
