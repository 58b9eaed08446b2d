"""The node nao_path_follower: walks to targets and along paths, with the names of nao_robot."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import rospy
from geometry_msgs.msg import PoseStamped
from move_base_msgs.msg import MoveBaseAction, MoveBaseActionGoal, MoveBaseFeedback, MoveBaseGoal, MoveBaseResult
from nav_msgs.msg import Path
from std_msgs.msg import Bool

from nao_library_actions.msg import (
    FollowPathAction,
    FollowPathActionGoal,
    FollowPathFeedback,
    FollowPathGoal,
    FollowPathResult,
)
from naoqi.errors import NaoError

from ...core.errors import RobotLost
from ...core.geometry import FOOTPRINT, ODOM, Place
from ...core.health import Report
from ...core.waiting import CancellationToken
from ...ros.action_server import ConcurrentActionServer, GoalOutcome, Replaced
from ...ros.node_interface import NodeInterface
from ...ros.time_and_frames import RosClock
from ..base.driver_node import frame_parameter, interrupt_when_lost
from ..joints.planar_frames import PlanarFrames, pose_stamped, read_path, read_place
from .path_courses import Aim, FollowerSettings, PathCourse, TargetCourse, WalkPath
from .path_walk import WalkTopics, lead

SHUTDOWN_LIMIT = 4.0
LEGS = frozenset({"the legs"})
FOOT_CONTACT = "lost foot contact"
NODE_KILLED = "node killed"


class NaoPathFollower:
    """Walks to targets and along paths. One goal at a time: a new one takes over from the one before, walking.

    A goal that ends for any reason but a newer one leaves the robot standing on both feet. While one runs, nobody
    else walks: `inhibit_walk` is called for it.

    Targets and paths may be in any frame of /tf. In frames that hang below that of odometry (those of the robot too)
    they stay where they are at the beginning; others, such as a map, are looked up all the time.

    ROS API (relative names):
        Actions `walk_target` (move_base_msgs/MoveBase), `walk_path` (nao_library_actions/FollowPath: the last pose has
        a heading, before it the robot looks along the path).
        Subscribes `walk_target_simple/goal` (geometry_msgs/PoseStamped), `walk_path_simple/goal` (nav_msgs/Path):
        goals of the actions without an answer. `foot_contact` (std_msgs/Bool): the loss ends a goal.
        Publishes `cmd_pose` (geometry_msgs/Pose2D), or `cmd_vel` (geometry_msgs/Twist) with `~use_vel_ctrl`;
        `~target_pose` (geometry_msgs/PoseStamped, latched): where it aims. `~path` (nav_msgs/Path, latched): the path
        it follows.
        Calls `stop_walk_srv`, `inhibit_walk`, `uninhibit_walk` (std_srvs/Empty), where they are offered.
        Parameters `~base_frame_id` (base_footprint), `~odom_frame_id` (odom), `tf_prefix` (searched upwards), and
        those of `FollowerSettings`.
    """

    def __init__(self, robot: Any, node: NodeInterface) -> None:
        self._node = node
        self._settings = FollowerSettings.read(node.param)
        self._base = frame_parameter(node, "~base_frame_id", FOOTPRINT)
        self._odom = frame_parameter(node, "~odom_frame_id", ODOM)
        self._frames = PlanarFrames(answering_time=robot.connection.answering_time)
        self._legs = WalkTopics(robot, node, self._settings.use_vel_ctrl)
        self._clock = RosClock()
        self._touching = True
        self._aims = self._node.publisher("~target_pose", PoseStamped, queue_size=1, latch=True)
        self._paths = self._node.publisher("~path", Path, queue_size=1, latch=True)
        self._server = ConcurrentActionServer(self._claims, self._execute, with_feedback=True, robot=robot)
        for name, action in (("walk_target", MoveBaseAction), ("walk_path", FollowPathAction)):
            self._node.action(name, action, self._server)
        self._target_goals = self._node.publisher("walk_target/goal", MoveBaseActionGoal, queue_size=1)
        self._path_goals = self._node.publisher("walk_path/goal", FollowPathActionGoal, queue_size=1)
        self._stop_watching = interrupt_when_lost(robot, node, self._server)
        self._node.subscriber("walk_target_simple/goal", PoseStamped, self._on_target, queue_size=1)
        self._node.subscriber("walk_path_simple/goal", Path, self._on_path, queue_size=1)
        self._node.subscriber("foot_contact", Bool, self._on_foot_contact, queue_size=1)

    def reports(self) -> dict[str, Callable[[], Report]]:
        return {"goals": self._server.counter.report}

    def close(self) -> None:
        """End the goal that runs; the robot stands then."""
        self._stop_watching()
        self._server.interrupt_all(NaoError(NODE_KILLED))
        self._server.close(SHUTDOWN_LIMIT)

    # --- goals ----------------------------------------------------------------------------------------------------

    def _claims(self, goal: MoveBaseGoal | FollowPathGoal) -> frozenset[str]:
        """Check the goal before it ends another one."""
        if isinstance(goal, FollowPathGoal):
            WalkPath(read_path(goal.path)[0])
        else:
            read_place("target_pose", goal.target_pose)
        return LEGS

    def _execute(
        self, goal: MoveBaseGoal | FollowPathGoal, interrupt: CancellationToken, publish: Callable[[Any], None]
    ) -> GoalOutcome:
        self._legs.reserve()
        try:
            return self._walk(goal, interrupt, publish)
        except (Replaced, RobotLost):
            raise  # the new goal continues from here; a robot that is gone cannot be stopped
        except BaseException:
            self._stop()
            raise
        finally:
            self._legs.release()

    def _walk(
        self, goal: MoveBaseGoal | FollowPathGoal, interrupt: CancellationToken, publish: Callable[[Any], None]
    ) -> GoalOutcome:
        if self._settings.use_foot_contact_protection and not self._touching:
            raise NaoError(f"{FOOT_CONTACT}: put the robot on its feet")
        follows_path = isinstance(goal, FollowPathGoal)
        frame, course = self._path_course(goal.path) if follows_path else self._target_course(goal.target_pose)
        last: list[Place] = []

        def report(robot: Place, aim: Aim) -> None:
            if follows_path:
                publish(FollowPathFeedback(aim.index))
            else:
                publish(MoveBaseFeedback(pose_stamped(robot, frame, rospy.Time.now())))
            if last != [aim.place]:
                last[:] = [aim.place]
                self._aims.publish(pose_stamped(aim.place, frame, rospy.Time.now()))

        def locate() -> Place:
            return self._frames.locate(self._base, frame)

        lead(course, self._legs, locate, self._clock, self._settings, interrupt, report)
        return GoalOutcome(FollowPathResult() if follows_path else MoveBaseResult())

    def _target_course(self, target: PoseStamped) -> tuple[str, TargetCourse]:
        place, frame = read_place("target_pose", target)
        if self._stays(frame):
            place, frame = self._frames.place_in(self._odom, target), self._odom
        return frame, TargetCourse(lambda: place)

    def _path_course(self, path: Path) -> tuple[str, PathCourse]:
        places, frame = read_path(path)
        if self._stays(frame):
            origin = self._frames.locate(frame, self._odom)
            places, frame = [origin.then(place) for place in places], self._odom
        message = Path(poses=[pose_stamped(place, frame, rospy.Time.now()) for place in places])
        message.header.frame_id = frame
        self._paths.publish(message)
        return frame, PathCourse(WalkPath(places), self._settings)

    def _stays(self, frame: str) -> bool:
        """Whether a goal in this frame is fixed in that of odometry at the beginning."""
        # Waits until it is known; tf2 takes any frame for known that is looked for in itself.
        self._frames.locate(self._base, self._odom if frame == self._base else frame)
        return self._frames.inside(frame, self._odom)

    def _stop(self) -> None:
        try:
            self._legs.stop()
        except NaoError as error:
            rospy.logwarn("the walk cannot be stopped: %s", error)

    # --- topics, connection ---------------------------------------------------------------------------------------

    def _on_target(self, target: PoseStamped) -> None:
        goal = MoveBaseActionGoal(goal=MoveBaseGoal(target))
        goal.header.stamp = rospy.Time.now()
        self._target_goals.publish(goal)

    def _on_path(self, path: Path) -> None:
        goal = FollowPathActionGoal(goal=FollowPathGoal(path))
        goal.header.stamp = rospy.Time.now()
        self._path_goals.publish(goal)

    def _on_foot_contact(self, contact: Bool) -> None:
        self._touching = contact.data
        if not contact.data and self._settings.use_foot_contact_protection:
            self._server.interrupt_all(NaoError(FOOT_CONTACT))
