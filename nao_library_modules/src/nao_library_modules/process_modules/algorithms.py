"""The words of the thesis' algorithms 5.5 to 5.13, so that these run as they are printed: examples/thesis has them.

What they make and send is what the process modules make and send. Any of them may be called in plans, and outside of
them; all take the robot of this node's namespace, unless `low_level.use_robot` names another one.
"""

# ruff: noqa: N802, N803

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from std_msgs.msg import String

from nao_library_actions.msg import JointTrajectoryAction, JointTrajectoryGoal

from ..core.errors import of_those
from .action_rules import a_place, a_point, a_position
from .designators.designator import Designator
from .designators.objects_and_locations import Point3
from .designators.rules import Command, taken
from .failures import LowLevelFailure, PlanError
from .low_level import this_robot
from .nao_modules import LISTENER_LIMIT, Manipulation, Navigation
from .plan_action_client import PlanActionClient
from .plans import def_top_level_plan
from .process_module import ProcessModule, perform, start_process_modules

ACTIONS = {"JointTrajectoryAction": JointTrajectoryAction, "MoveBaseAction": MoveBaseAction}
"""Names of types that `makeActionClient` knows; others are given as classes."""


def runThread(module: type[ProcessModule]) -> ProcessModule:
    """Run a process module of this robot in a thread of its own, until `stop_process_modules`."""
    made = module(this_robot())
    start_process_modules(made)
    return made


def resolve(ActionDesignator: Designator) -> Command:
    """What a process module is to do, in numbers. Raises DesignatorError if no rule fits."""
    return ActionDesignator.reference()


@def_top_level_plan
def callAction(ResolvedDesignator: Command) -> Any:
    """Have the process module do it; returns its answer. Raises PlanFailure if it fails."""
    return perform(ResolvedDesignator)


def makeActionClient(name: str, action: str | type) -> PlanActionClient:
    """The client of an action: of its name, and of its type or the name of that. Each is made once."""
    if isinstance(action, str) and action not in ACTIONS:
        raise PlanError(f"no action {action!r}{of_those(action, ACTIONS)}; others are given as classes")
    return this_robot().action(name, ACTIONS[action] if isinstance(action, str) else action)


@def_top_level_plan
def waitingForServer(client: PlanActionClient) -> None:
    """Wait until there is a server; ActionlibActionTimedOut after 20 s without one."""
    client.wait_for_server()


@def_top_level_plan
def callGoal(client: PlanActionClient, goal: Any) -> Any:
    """Send a goal and wait for its end; returns its result. Raises LowLevelFailure if it does not succeed."""
    end = client.call(goal)
    if not end.succeeded:
        raise LowLevelFailure(f"{client.name}: {end}", status=end.status)
    return end.result


@def_top_level_plan
def createOpenLeftGripperMsg() -> JointTrajectoryGoal:
    return Manipulation(this_robot()).gripper_goal("left", "open")


@def_top_level_plan
def createOpenRightGripperMsg() -> JointTrajectoryGoal:
    return Manipulation(this_robot()).gripper_goal("right", "open")


@def_top_level_plan
def createCloseLeftGripperMsg() -> JointTrajectoryGoal:
    return Manipulation(this_robot()).gripper_goal("left", "closed")


@def_top_level_plan
def createCloseRightGripperMsg() -> JointTrajectoryGoal:
    return Manipulation(this_robot()).gripper_goal("right", "closed")


@def_top_level_plan
def createMoveHeadMsg(X: float, Y: float) -> JointTrajectoryGoal:
    """Look at a point X m ahead and Y m to the left of the torso, at the height of the eyes."""
    return Manipulation(this_robot()).head_goal(taken(a_position(), [X, Y]))


@def_top_level_plan
def createMoveLeftArmMsg(Target: Point3 | Sequence[float]) -> JointTrajectoryGoal:
    """Bring the left hand to (x, y, z), m in the torso frame."""
    return Manipulation(this_robot()).arm_goal(taken(a_point(), Target), "left")


@def_top_level_plan
def createMoveRightArmMsg(Target: Point3 | Sequence[float]) -> JointTrajectoryGoal:
    """Bring the right hand to (x, y, z), m in the torso frame."""
    return Manipulation(this_robot()).arm_goal(taken(a_point(), Target), "right")


@def_top_level_plan
def createStablePositionMsg() -> JointTrajectoryGoal:
    """Take the pose from which everything else can begin."""
    return Manipulation(this_robot()).stable_goal()


@def_top_level_plan
def createWalkingMsg(Position: Any) -> MoveBaseGoal:
    """Walk to a place, as `low_level.walk_to` takes it."""
    return Navigation(this_robot()).walk_goal(*taken(a_place(), Position))


class NaoROSnode:
    """What `createROSnode` makes: it publishes in the name of the plan's node."""

    @staticmethod
    @def_top_level_plan
    def publish(Sentence: str, Topic: str) -> None:
        """Publish a sentence when there is a subscriber; LowLevelFailure after 10 s without one."""
        if not this_robot().topic(Topic, String).tell(String(Sentence), LISTENER_LIMIT):
            raise LowLevelFailure(f"{Topic} has no subscriber: is nao_speech running?")


def createROSnode() -> NaoROSnode:
    return NaoROSnode()
