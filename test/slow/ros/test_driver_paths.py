"""Walking to targets and along paths, by odometry and by what is true: to the end, replaced, cancelled, stuck."""

import math

import rospy
import tf2_ros
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseStamped, TransformStamped
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from nav_msgs.msg import Odometry
from rospy import Duration
from services import action_client, measured_now, publisher
from std_msgs.msg import Bool, Empty
from std_srvs.srv import Empty as EmptyService
from walking_fixture import WalkingTest, of_pose, seen_from_above

from nao_library_actions.msg import FollowPathAction, FollowPathGoal
from nao_library_modules.core.geometry import Place
from nao_library_modules.driver.joints.planar_frames import pose_stamped
from nao_library_modules.driver.path_follower.path_courses import WalkPath
from nao_library_msgs.srv import SetTransform
from nao_sim_bridge.testing import send, wait_until

NEAR, TURNED = 0.05, math.radians(5.0)
"""The thresholds of the node."""
TRUE_NEAR = 0.08
"""m: with what odometry is off after a metre."""


def target(x, y, yaw=0.0, frame="odom"):
    return MoveBaseGoal(pose_stamped(Place(x, y, yaw), frame, rospy.Time()))


def path(places, frame="odom"):
    goal = FollowPathGoal()
    goal.path.header.frame_id = frame
    goal.path.poses = [pose_stamped(place, frame, rospy.Time()) for place in places]
    return goal


class DriverPaths(WalkingTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.targets = action_client("walk_target", MoveBaseAction)
        cls.paths = action_client("walk_path", FollowPathAction)
        cls.frames = tf2_ros.Buffer(Duration(600))
        cls.listener = tf2_ros.TransformListener(cls.frames)
        for service in ("wakeup", "stop_walk_srv", "set_odometry_pose"):
            rospy.wait_for_service(service, 60.0)
        rospy.wait_for_message("odom", Odometry, 60.0)

    def here(self, frame="odom"):
        """The robot between its feet, by a transform of after now."""
        return self.at(rospy.Time.now(), frame)

    def at(self, time, frame="odom"):
        """The robot between its feet at a time."""
        transform = self.frames.lookup_transform(frame, "base_footprint", time, Duration(120)).transform
        return seen_from_above(transform.translation, transform.rotation)

    def play(self, client, goal, end=GoalStatus.SUCCEEDED):
        run = send(client, goal).wait(180.0)
        self.assertEqual(run.state, end, run.text)
        return run

    def there(self, place, wanted):
        way = wanted.seen_from(place)
        self.assertLess(way.distance, NEAR, (place, wanted))
        self.assertLess(abs(way.yaw), TURNED, (place, wanted))

    def walked(self, before, way):
        """Whether the robot has truly gone a way."""
        off = before.then(way).seen_from(self.truth())
        print(f"truly {1000 * off.distance:.0f} mm and {math.degrees(off.yaw):.1f} degrees off")
        self.assertLess(off.distance, TRUE_NEAR)
        self.assertLess(abs(off.yaw), math.radians(8.0))

    # --- targets ---------------------------------------------------------------------------------------------------

    def test_a_target_is_reached_and_feedback_tells_the_way(self):
        before, start = self.truth(), self.here()
        way = Place(0.5, 0.2, 0.6)
        run = self.play(self.targets, target(*start.then(way)))
        self.there(self.here(), start.then(way))
        self.walked(before, way)
        told = [of_pose(feedback.base_position.pose) for _, feedback in run.feedback]
        self.assertGreater(len(told), 5)
        self.assertLess(told[0].distance_to(start), 0.05)
        self.assertEqual(run.feedback[0][1].base_position.header.frame_id, "odom")
        aim = rospy.wait_for_message("nao_path_follower/target_pose", PoseStamped, 60.0)
        self.there(of_pose(aim.pose), start.then(way))

    def test_a_target_in_the_frame_of_the_robot_is_where_it_was_at_the_beginning(self):
        before, start = self.truth(), self.here()
        way = Place(0.3, 0.0, -0.5)
        self.play(self.targets, target(*way, frame="base_footprint"))
        self.there(self.here(), start.then(way))
        self.walked(before, way)

    def test_a_target_on_a_map_follows_the_map(self):
        broadcaster = tf2_ros.StaticTransformBroadcaster()
        transform = TransformStamped(child_frame_id="odom")
        transform.header.frame_id, transform.header.stamp = "map", rospy.Time.now()
        transform.transform.translation.x, transform.transform.rotation.w = 5.0, 1.0
        broadcaster.sendTransform(transform)
        start = self.here("map")
        way = Place(0.4, 0.0, 0.0)
        run = send(self.targets, target(*start.then(way), frame="map"))
        wait_until(lambda: self.here("map").distance_to(start) > 0.1, 90.0, "the walk")
        transform.transform.translation.x = 4.9  # the robot learns that it is not so far yet
        broadcaster.sendTransform(transform)
        self.assertEqual(run.wait(180.0).state, GoalStatus.SUCCEEDED, run.text)
        self.there(self.here("map"), start.then(way))
        self.assertEqual(run.feedback[0][1].base_position.header.frame_id, "map")

    def test_a_goal_of_the_simple_topic_is_one_of_the_action(self):
        goals = publisher(self, "walk_target_simple/goal", PoseStamped)
        start = self.here()
        goals.publish(target(*start.then(Place(0.2, 0.0, 0.0))).target_pose)
        wait_until(lambda: self.here().distance_to(start) > 0.17, 90.0, "the walk")
        wait_until(lambda: not self.motion.moveIsActive(), 90.0, "the end of the walk")
        self.there(self.here(), start.then(Place(0.2, 0.0, 0.0)))

    def test_a_new_goal_takes_over_without_a_stop(self):
        start = self.here()
        old = send(self.targets, target(*start.then(Place(1.0, 0.0, 0.0))))
        wait_until(lambda: self.here().distance_to(start) > 0.1, 90.0, "the walk")
        new = send(self.targets, target(*start.then(Place(0.4, 0.1, 0.0))))
        self.assertEqual(old.wait().state, GoalStatus.PREEMPTED)
        self.assertEqual(old.text, "a newer goal needs the legs")
        self.assertTrue(self.motion.moveIsActive())
        self.assertEqual(new.wait(180.0).state, GoalStatus.SUCCEEDED, new.text)
        self.there(self.here(), start.then(Place(0.4, 0.1, 0.0)))

    def test_a_cancelled_goal_leaves_the_robot_standing(self):
        start = self.here()
        run = send(self.targets, target(*start.then(Place(1.0, 0.0, 0.0))))
        wait_until(lambda: self.here().distance_to(start) > 0.1, 90.0, "the walk")
        run.cancel()
        self.assertEqual(run.wait().state, GoalStatus.PREEMPTED)
        self.assertFalse(self.motion.moveIsActive())
        stands = self.truth()
        self.robot.advance(2.0)
        self.assertLess(self.truth().distance_to(stands), 0.005)
        self.assertGreater(self.robot.true_pose().position.z, 0.3)

    # --- paths -----------------------------------------------------------------------------------------------------

    def follow(self, places, most_off, **limits):
        start, before = self.here(), self.truth()
        wanted = [start.then(place) for place in places]
        track = []
        # The torso sways from foot to foot; what is to be on the path is the middle between them.
        subscriber = rospy.Subscriber("odom", Odometry, lambda message: track.append(self.at(message.header.stamp)))
        with self.robot.at_speed(1.0):  # what the machine delays a command by counts as so much less of the way
            run = self.play(self.paths, path(wanted))
        subscriber.unregister()
        line = WalkPath(wanted)
        offs = [line.nearest(place, 0.0, line.length).off for place in track]
        took = run.ended - run.sent
        print(f"{line.length:.2f} m in {took:.1f} s, at most {1000 * max(offs):.0f} mm off the path")
        self.assertLess(max(offs), most_off)
        self.there(self.here(), wanted[-1])
        self.walked(before, places[-1])
        indices = [feedback.index for _, feedback in run.feedback]
        self.assertEqual(indices, sorted(indices))
        self.assertEqual(indices[-1], len(places) - 1)
        self.assertGreater(len(set(indices)), 0.7 * len(places) - 1)

    def test_a_square(self):
        corners = [Place(0, 0, 0), Place(0.3, 0, 0), Place(0.3, 0.3, 0), Place(0, 0.3, 0), Place(0, 0, -math.pi / 2)]
        self.follow(corners, 0.07)

    def test_the_simple_topic_of_paths(self):
        goals = publisher(self, "walk_path_simple/goal", type(path([]).path))
        start = self.here()
        goals.publish(path([Place(0, 0, 0), Place(0.2, 0, 0)], "base_footprint").path)
        wait_until(lambda: self.here().distance_to(start) > 0.17, 90.0, "the walk")
        wait_until(lambda: not self.motion.moveIsActive(), 90.0, "the end of the walk")

    # --- what will not do ------------------------------------------------------------------------------------------

    def test_bad_goals_are_aborted_with_a_text_and_move_nothing(self):
        before = self.truth()
        for client, goal, words in (
            (self.targets, target(0.3, 0.0, frame=""), "target_pose.header.frame_id"),
            (self.targets, target(0.3, 0.0, frame="kitchen"), "kitchen"),
            (self.paths, path([]), "0 pose"),
            (self.paths, path([Place(0.3, 0, 0)]), "walk_target goes to a single pose"),
        ):
            self.assertIn(words, self.play(client, goal, GoalStatus.ABORTED).text)
        self.assertLess(self.truth().distance_to(before), 0.005)

    def test_lost_foot_contact_ends_the_goal(self):
        feet = publisher(self, "foot_contact", Bool, latch=True)
        start, here = self.here(), target(0.0, 0.0, frame="base_footprint")
        run = send(self.targets, target(*start.then(Place(1.0, 0.0, 0.0))))
        wait_until(lambda: self.here().distance_to(start) > 0.05, 90.0, "the walk")
        feet.publish(Bool(False))
        self.assertEqual(run.wait().state, GoalStatus.ABORTED)
        self.assertEqual(run.text, "lost foot contact")
        self.assertIn("put the robot on its feet", self.play(self.targets, here, GoalStatus.ABORTED).text)
        feet.publish(Bool(True))
        wait_until(lambda: send(self.targets, here).wait().state == GoalStatus.SUCCEEDED, 60.0, "foot contact")

    # --- goals of RViz, odometry -----------------------------------------------------------------------------------

    def test_goals_of_rviz_and_their_cancel(self):
        goals = publisher(self, "move_base_simple/goal", PoseStamped)
        cancels = publisher(self, "move_base_simple/cancel", Empty)
        start, before = self.here(), self.truth()
        goals.publish(target(*start.then(Place(1.0, 0.0, 0.0))).target_pose)
        wait_until(lambda: self.here().distance_to(start) > 0.08, 90.0, "the walk")
        goals.publish(target(*start.then(Place(0.3, -0.1, -0.4))).target_pose)  # takes over
        wait_until(lambda: not self.motion.moveIsActive(), 90.0, "the end of the walk")
        self.there(self.here(), start.then(Place(0.3, -0.1, -0.4)))
        self.walked(before, Place(0.3, -0.1, -0.4))
        here = self.here()
        goals.publish(target(1.0, 0.0, frame="base_footprint").target_pose)
        wait_until(lambda: self.here().distance_to(here) > 0.05, 90.0, "the walk")
        cancels.publish(Empty())
        wait_until(lambda: not self.motion.moveIsActive(), 90.0, "the end of the walk")
        self.assertLess(self.here().distance_to(here), 0.4)

    def test_odometry_is_paused_set_and_moved(self):
        def call(name, kind, *arguments):
            rospy.ServiceProxy(name, kind)(*arguments)
            self.robot.advance(0.2)

        def torso():
            return of_pose(measured_now("odom", Odometry).pose.pose)

        def offset(x, y, yaw):
            transform = TransformStamped().transform
            transform.translation.x, transform.translation.y = x, y
            transform.rotation.z, transform.rotation.w = math.sin(yaw / 2), math.cos(yaw / 2)
            return transform

        self.addCleanup(call, "set_odometry_pose", SetTransform, offset(0.0, 0.0, 0.0))
        self.addCleanup(self.robot.reset)
        call("set_odometry_pose", SetTransform, offset(2.0, 1.0, math.pi / 2))
        self.there(torso(), Place(2.0, 1.0, math.pi / 2))
        call("odometry_offset", SetTransform, offset(0.5, 0.0, 0.0))
        self.there(torso(), Place(2.0, 1.5, math.pi / 2))
        call("pause_odometry", EmptyService)
        self.addCleanup(call, "resume_odometry", EmptyService)
        before = self.truth()
        self.motion.moveTo(0.2, 0.0, 0.0)
        self.walked(before, Place(0.2, 0.0, 0.0))
        self.assertLess(torso().distance_to(Place(2.0, 1.5, 0.0)), 0.02)
        call("resume_odometry", EmptyService)
        # Goals are told in the odometry as it is published.
        start = self.here()
        self.play(self.targets, target(*start.then(Place(0.2, 0.0, 0.0))))
        self.there(self.here(), start.then(Place(0.2, 0.0, 0.0)))
