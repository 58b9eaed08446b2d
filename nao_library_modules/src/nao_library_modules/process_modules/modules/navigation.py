"""Navigation: walking to places, by the action `walk_target` of nao_path_follower."""

from __future__ import annotations

import math
from typing import Any

from actionlib_msgs.msg import GoalStatus
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal

from ...base.places import ODOM, Place, wrapped, yaw_of_quaternion
from ..language.failures import NavigationGoalNotReached, NavigationPoseUnreachable
from ..language.fluents import Fluent
from ..robot.robot_link import RobotLink
from .robot_module import RobotModule

WALK_ACTION = "walk_target"
WALK_MARGIN = 20.0
"""s that a walk may take longer than the slowest one."""


class Navigation(RobotModule):
    """Walks to places; `position` is a fluent with the (Place, frame) of the last feedback of a walk."""

    name = "navigation"
    methods = ("walk_to",)

    def __init__(self, robot: RobotLink, name: str = "") -> None:
        super().__init__(robot, name)
        self.position = Fluent("position on the way", None)

    def walk_to(self, target: Place, frame: str = ODOM) -> Place:
        """Walk to a place; returns where the robot is then, in odom. A heading of nan stands for that of the way there.

        Raises:
            NavigationPoseUnreachable: The goal was refused.
            NavigationGoalNotReached: The robot did not get there; `reached` is where it is, `wanted` where it was to
                be, in odom.
        """
        settings = self.robot.settings
        here, target = self.robot.place(frame), self._with_heading(target, frame)
        # The robot's own frames move along: what counts at the end is where the target was at the beginning.
        wanted = self.robot.place(ODOM).then(target.seen_from(here))
        way = target.seen_from(here)
        slowest = way.distance / settings.walk_speed[0] + math.pi / settings.walk_speed[1]
        goal = self.walk_goal(target, frame)
        end = self.robot.action(WALK_ACTION, MoveBaseAction).call(goal, slowest + WALK_MARGIN, self._on_feedback)
        reached = self.robot.place(ODOM)
        if end.status == GoalStatus.REJECTED:
            raise NavigationPoseUnreachable(f"{_shown(target, frame)}: {end}", target=target, frame=frame)
        off, turn = reached.distance_to(wanted), abs(wrapped(reached.yaw - wanted.yaw))
        if not end.succeeded or off > 2.0 * settings.walk_tolerance[0] or turn > 2.0 * settings.walk_tolerance[1]:
            why = str(end) if not end.succeeded else f"it is {off:.3f} m and {turn:.2f} rad off"
            text = f"the robot did not get to {_shown(target, frame)}: {why}"
            raise NavigationGoalNotReached(text, target=target, frame=frame, reached=reached, wanted=wanted)
        return reached

    def walk_goal(self, target: Place, frame: str = ODOM) -> MoveBaseGoal:
        """What the path follower gets to walk to a place, as `walk_to` takes it."""
        target, goal = self._with_heading(target, frame), MoveBaseGoal()
        goal.target_pose.header.frame_id = frame
        goal.target_pose.pose.position.x, goal.target_pose.pose.position.y = target.x, target.y
        goal.target_pose.pose.orientation.z = math.sin(target.yaw / 2.0)
        goal.target_pose.pose.orientation.w = math.cos(target.yaw / 2.0)
        return goal

    def _with_heading(self, target: Place, frame: str) -> Place:
        if not math.isnan(target.yaw):
            return target
        here = self.robot.place(frame)
        far = here.distance_to(target) > self.robot.settings.walk_tolerance[0]  # a robot that is there need not turn
        return target._replace(yaw=math.atan2(target.y - here.y, target.x - here.x) if far else here.yaw)

    def _on_feedback(self, feedback: Any) -> None:
        stamped = feedback.base_position
        turn = stamped.pose.orientation
        yaw = yaw_of_quaternion(turn.x, turn.y, turn.z, turn.w) or 0.0
        place = Place(stamped.pose.position.x, stamped.pose.position.y, yaw)
        self.position.value = (place, stamped.header.frame_id)


def _shown(place: Place, frame: str) -> str:
    return f"x {place.x:.2f} m, y {place.y:.2f} m, {place.yaw:.2f} rad in {frame}"
