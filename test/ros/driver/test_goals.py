"""Joints and poses under the names of nao_robot: topics, services and actions, to success, abort and preemption."""

import unittest

import rospy
from actionlib_msgs.msg import GoalStatus, GoalStatusArray
from rospy import Duration
from sensor_msgs.msg import JointState
from services import action_client, publisher, service
from std_srvs.srv import Empty
from trajectory_msgs.msg import JointTrajectoryPoint

from nao_library_actions.msg import (
    BodyPoseAction,
    BodyPoseGoal,
    BodyPoseWithSpeedAction,
    BodyPoseWithSpeedGoal,
    JointAnglesWithSpeedAction,
    JointAnglesWithSpeedGoal,
    JointTrajectoryAction,
    JointTrajectoryGoal,
)
from nao_library_msgs.msg import JointAnglesWithSpeed
from nao_sim_bridge.testing import SimulatedRobot, send, wait_until

CROUCH = (
    [0.0, 0.0, 1.0, 0.4, -1.57, -0.486, 0.0, 0.0, -0.3, 0.057, -0.744, 2.1, -1.122, -0.035]
    + [-0.3, -0.057, -0.744, 2.1, -1.122, 0.035]
    + [1.0, -0.4, 1.57, 0.486, 0.0, 0.0]
)


def trajectory(names, *points, relative=0):
    """A goal of points: time, positions, and velocities if there is a third."""
    goal = JointTrajectoryGoal(relative=relative)
    goal.trajectory.joint_names = names
    for time, positions, *velocities in points:
        point = JointTrajectoryPoint(time_from_start=Duration(time), positions=positions)
        point.velocities = velocities[0] if velocities else []
        goal.trajectory.points.append(point)
    return goal


def angles(names, values, speed, relative=0):
    message = JointAnglesWithSpeed(joint_names=names, joint_angles=values, speed=speed, relative=relative)
    return JointAnglesWithSpeedGoal(message)


class DriverGoals(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.trajectories = action_client("joint_trajectory", JointTrajectoryAction)
        cls.stiffness = action_client("joint_stiffness_trajectory", JointTrajectoryAction)
        cls.angles = action_client("joint_angles_action", JointAnglesWithSpeedAction)
        cls.poses = action_client("body_pose", BodyPoseAction)
        cls.postures = action_client("body_pose_naoqi", BodyPoseWithSpeedAction)
        # Everything that speaks to the robot has reached it.
        near = trajectory(["HeadYaw"], (0.1, [0.0]))
        crouch = BodyPoseWithSpeedGoal("Crouch", 1.0)
        for client, goal in ((cls.trajectories, near), (cls.postures, crouch)):
            wait_until(lambda c=client, g=goal: send(c, g).wait().state == GoalStatus.SUCCEEDED, 60.0, client)

    def setUp(self):
        self.robot.reset()
        self.serve("body_stiffness/enable")

    def serve(self, name):
        service(name, Empty, 10.0)()

    def play(self, client, goal, end=GoalStatus.SUCCEEDED):
        run = send(client, goal).wait()
        self.assertEqual(run.state, end, run.text)
        return run

    def sensed(self, joint):
        return self.robot.module("ALMotion").getAngles(joint, True)[0]

    def commanded(self, joint):
        return self.robot.module("ALMotion").getAngles(joint, False)[0]

    def close(self, found, wanted, tolerance=0.03):
        self.assertEqual(len(found), len(wanted))
        for i, (value, target) in enumerate(zip(found, wanted)):
            self.assertAlmostEqual(value, target, delta=tolerance, msg=f"value {i}")

    # --- what nao_robot's own test program does --------------------------------------------------------------------

    def test_one_joint_many_points(self):
        sent = self.robot.advance(0.0)
        run = self.play(self.trajectories, trajectory(["HeadYaw"], (1.0, [1.0]), (2.0, [-1.0]), (2.5, [0.0])))
        took = self.robot.advance(0.0) - sent
        self.assertEqual(run.result.goal_position.name, ["HeadYaw"])
        self.close(run.result.goal_position.position, [0.0])
        self.assertGreaterEqual(took, 2.5)

    def test_angles_with_speed(self):
        run = self.play(self.angles, angles(["HeadYaw", "HeadPitch"], [1.0, 0.0], 0.2))
        self.assertEqual(run.result.goal_position.name, ["HeadYaw", "HeadPitch"])
        self.close(run.result.goal_position.position, [1.0, 0.0])
        self.play(self.angles, angles(["HeadYaw"], [-0.25], 0.2, relative=1))
        self.assertAlmostEqual(self.sensed("HeadYaw"), 0.75, delta=0.04)

    def test_stiffness(self):
        run = self.play(self.stiffness, trajectory(["Body"], (0.5, [0.0])))
        self.assertEqual(list(run.result.goal_position.position), [0.0] * 26)
        run = self.play(self.stiffness, trajectory(["HeadYaw", "LHand"], (0.2, [1.0, 0.5])))
        self.close(run.result.goal_position.position, [1.0, 0.5], 0.001)

    # --- preemption ------------------------------------------------------------------------------------------------

    def cancel_on_the_way(self, client, goal, value):
        """Cancel when `value()` has begun to change; returns it at the end, and the run."""
        start = value()
        run = send(client, goal)
        wait_until(lambda: abs(value() - start) > 0.01, 60.0, "the motion")
        run.cancel()
        run.wait()
        self.assertEqual(run.state, GoalStatus.PREEMPTED, run.text)
        self.assertEqual(self.robot.module("ALMotion").getTaskList(), [])
        stopped = value()
        self.robot.advance(0.5)
        self.assertEqual(value(), stopped)
        return stopped, run

    def test_a_cancelled_goal_stops_the_joint_where_it_is(self):
        there = lambda: self.commanded("HeadYaw")  # noqa: E731
        stopped, run = self.cancel_on_the_way(self.trajectories, trajectory(["HeadYaw"], (200.0, [1.5])), there)
        self.assertLess(stopped, 1.4)
        self.assertAlmostEqual(run.result.goal_position.position[0], stopped, delta=0.05)
        stopped, _ = self.cancel_on_the_way(self.angles, angles(["HeadYaw"], [-1.5], 0.002), there)
        self.assertGreater(stopped, -1.4)

    def test_the_status_tells_of_a_goal_that_runs(self):
        def told():
            return {each.status for each in rospy.wait_for_message(topic, GoalStatusArray, 60.0).status_list}

        topic, run = "joint_trajectory/status", send(self.trajectories, trajectory(["HeadYaw"], (200.0, [1.5])))
        self.addCleanup(run.wait)
        self.addCleanup(run.cancel)
        wait_until(lambda: GoalStatus.ACTIVE in told(), 60.0, "an active goal")

    def test_a_newer_goal_for_the_same_joint_ends_the_older_one(self):
        old = send(self.trajectories, trajectory(["Head"], (200.0, [1.0, 0.0])))
        wait_until(lambda: self.commanded("HeadYaw") > 0.01, 60.0, "the motion")
        new = send(self.trajectories, trajectory(["HeadYaw"], (0.5, [-0.5])))
        self.assertEqual(old.wait().state, GoalStatus.PREEMPTED)
        self.assertEqual(old.text, "a newer goal needs HeadYaw")
        self.assertEqual(new.wait().state, GoalStatus.SUCCEEDED, new.text)
        self.assertAlmostEqual(self.sensed("HeadYaw"), -0.5, delta=0.03)

    # --- what will not do ------------------------------------------------------------------------------------------

    def test_bad_goals_are_aborted_with_a_text_and_move_nothing(self):
        before = self.robot.module("ALMotion").getAngles("Body", False)
        for client, goal, words in (
            (self.trajectories, trajectory(["HeadJaw"], (1, [0.0])), "did you mean 'HeadYaw'"),
            (self.trajectories, trajectory(["Head"]), "there is no point"),
            (self.stiffness, trajectory(["Head"], (1, [1.5])), "0 to 1"),
            (self.angles, angles(["Head"], [0.1], 1.5), "field speed"),
            (self.poses, BodyPoseGoal("inti"), "did you mean 'init'"),
            (self.postures, BodyPoseWithSpeedGoal("Stadn", 0.5), "did you mean 'Stand'"),
            (self.postures, BodyPoseWithSpeedGoal("Stand", 0.0), "field speed"),
        ):
            self.assertIn(words, self.play(client, goal, GoalStatus.ABORTED).text)
        self.assertEqual(self.robot.module("ALMotion").getAngles("Body", False), before)

    # --- topics and services ---------------------------------------------------------------------------------------

    def test_topics_set_angles_and_stiffness(self):
        topic = publisher(self, "joint_angles", JointAnglesWithSpeed)
        topic.publish(angles(["HeadYaw", "HeadPitch"], [0.6, 0.2], 0.5).joint_angles)
        wait_until(lambda: abs(self.sensed("HeadYaw") - 0.6) < 0.03, 60.0, "HeadYaw at 0.6")
        topic.publish(angles(["HeadYaw"], [-0.2], 0.5, relative=1).joint_angles)
        wait_until(lambda: abs(self.sensed("HeadYaw") - 0.4) < 0.03, 60.0, "HeadYaw at 0.4")
        publisher(self, "joint_stiffness", JointState).publish(JointState(name=["HeadYaw"], effort=[0.3]))
        stiffness = lambda: self.robot.module("ALMotion").getStiffnesses("HeadYaw")[0]  # noqa: E731
        wait_until(lambda: abs(stiffness() - 0.3) < 0.001, 60.0, "stiffness 0.3")

    def test_services_switch_the_motors(self):
        motion = self.robot.module("ALMotion")
        self.serve("body_stiffness/disable")
        self.assertEqual(set(motion.getStiffnesses("Body")), {0.0})
        self.serve("wakeup")
        self.assertTrue(motion.robotIsWakeUp())
        self.assertGreater(min(motion.getStiffnesses("Body")), 0.5)
        self.serve("rest")
        self.assertFalse(motion.robotIsWakeUp())

    # --- poses -----------------------------------------------------------------------------------------------------

    def test_poses_by_name(self):
        self.play(self.poses, BodyPoseGoal("init"))
        self.assertAlmostEqual(self.sensed("LShoulderPitch"), 1.4, delta=0.05)
        self.assertGreater(self.robot.true_pose().position.z, 0.3)
        self.play(self.poses, BodyPoseGoal("ArmsForward"))  # of the pose library
        self.assertAlmostEqual(self.sensed("LShoulderPitch"), 0.2, delta=0.08)
        self.play(self.poses, BodyPoseGoal("crouch"))
        self.assertLess(self.robot.true_pose().position.z, 0.26)

    def test_a_pose_that_was_loaded_meanwhile(self):
        nod = {"nod": {"joint_names": ["HeadPitch"], "positions": [0.4], "time_from_start": 0.5}}
        self.play(self.poses, BodyPoseGoal("nod"), GoalStatus.ABORTED)
        rospy.set_param("pose_manager/poses", nod)
        self.addCleanup(rospy.delete_param, "pose_manager/poses")
        self.play(self.poses, BodyPoseGoal("nod"))
        self.assertAlmostEqual(self.commanded("HeadPitch"), 0.4, delta=0.01)

    def test_postures_of_the_robot(self):
        self.serve("body_stiffness/disable")  # the goal switches the motors on itself
        self.play(self.postures, BodyPoseWithSpeedGoal("StandInit", 0.8))
        self.assertEqual(self.robot.module("ALRobotPosture").getPosture(), "StandInit")
        knees = self.commanded("LKneePitch")
        run = send(self.postures, BodyPoseWithSpeedGoal("Crouch", 0.02))
        wait_until(lambda: self.commanded("LKneePitch") > knees + 0.02, 60.0, "bent knees")
        run.cancel()
        self.assertEqual(run.wait().state, GoalStatus.PREEMPTED, run.text)
        self.assertLess(self.commanded("LKneePitch"), 2.0)
