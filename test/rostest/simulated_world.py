#!/usr/bin/env python3
"""What the simulator offers to ROS: ground truth, clock, pushes, touch, pictures; and that the robot stands."""

import unittest

import rospy
import rostest
from nav_msgs.msg import Odometry

from nao_sim_bridge.testing import SimulatedRobot


class SimulatedWorld(unittest.TestCase):
    def setUp(self):
        self.robot = SimulatedRobot()
        self.robot.reset()

    def height(self):
        return self.robot.true_pose().position.z

    def test_it_stands_up_by_its_own_motors_and_stays(self):
        self.assertLess(self.height(), 0.25)
        self.robot.module("ALMotion").wakeUp()
        self.assertGreater(self.height(), 0.32)
        before = self.robot.true_pose().position
        self.robot.advance(20.0)
        after = self.robot.true_pose().position
        self.assertLess(abs(after.x - before.x) + abs(after.y - before.y), 0.001)
        weight = sum(self.robot.value(f"{side}FootTotalWeight") for side in ("left", "right"))
        self.assertAlmostEqual(weight, 5.36, delta=0.1)

    def test_a_hard_push_throws_it_over(self):
        self.robot.module("ALMotion").wakeUp()
        self.robot.push((150.0, 0.0, 0.0), 0.1)
        self.robot.advance(3.0)
        self.assertLess(self.height(), 0.2)

    def test_topic_and_service_of_the_true_pose_agree(self):
        message = rospy.wait_for_message("ground_truth/odom", Odometry, timeout=30.0)
        self.assertEqual((message.header.frame_id, message.child_frame_id), ("world", "torso"))
        topic, service = message.pose.pose, self.robot.true_pose()
        for axis in "xyz":
            self.assertAlmostEqual(getattr(topic.position, axis), getattr(service.position, axis), delta=0.002)
        for axis in "xyzw":
            self.assertAlmostEqual(getattr(topic.orientation, axis), getattr(service.orientation, axis), delta=0.01)

    def test_time_moves_only_as_told_while_paused(self):
        self.robot.pause()
        self.addCleanup(self.robot.resume)
        before = self.robot.advance(0.0)
        self.assertAlmostEqual(self.robot.advance(1.0) - before, 1.0, delta=0.01)
        self.assertAlmostEqual(self.robot.module("NaoSimulation").time(), before + 1.0, delta=0.01)

    def test_fingers_press_sensors(self):
        key = "Device/SubDeviceList/Head/Touch/Front/Sensor/Value"
        self.robot.press(["Head/Touch/Front"])
        self.robot.advance(0.05)
        self.assertEqual(self.robot.value(key), 1.0)
        self.robot.press([])
        self.robot.advance(0.05)
        self.assertEqual(self.robot.value(key), 0.0)
        with self.assertRaisesRegex(ValueError, "Head/Touch/Fron"):
            self.robot.press(["Head/Touch/Fron"])

    def test_pictures_stay_in_their_folder(self):
        self.assertTrue(self.robot.picture("face", "folder/face.png").is_file())
        with self.assertRaisesRegex(ValueError, "relative"):
            self.robot.picture("face", "../face.png")
        with self.assertRaisesRegex(ValueError, "front"):
            self.robot.picture("frnt", "face.png")


if __name__ == "__main__":
    rospy.init_node("simulated_world_test")
    rostest.rosrun("nao_library_tests", "simulated_world", SimulatedWorld)
