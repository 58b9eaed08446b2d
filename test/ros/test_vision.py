#!/usr/bin/env python3
"""NaoVision through actionlib, on the pictures of the simulated robot's own cameras."""

from pathlib import Path

import cv2
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from sensor_msgs.msg import Image

from nao_library_actions.msg import NaoVisionAction
from nao_library_msgs.msg import VisionFunction
from nao_sim_bridge.testing import RobotTestCase, wait_until


def f(function, **fields):
    return VisionFunction(function=function, **fields)


class Vision(RobotTestCase):
    server = ("NaoVision", NaoVisionAction)

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        rospy.wait_for_message("nao_robot/camera/top/image_raw", Image, 60.0)

    def tearDown(self):
        threads = self.succeed(f("listThreads")).threads
        if threads:
            self.succeed(*(f("deleteThread", id=thread.id) for thread in threads))

    def test_a_picture_is_taken_after_the_goal_and_is_not_overwritten(self):
        asked = rospy.get_time()
        name = f"picture_{rospy.Time.now().to_nsec()}.png"
        (picture,) = self.succeed(f("takePicture", str_param=name)).pictures
        self.assertGreaterEqual(picture.header.stamp.to_sec(), asked)
        self.assertEqual(cv2.imread(picture.path).shape, (picture.height, picture.width, 3))
        self.assertEqual(Path(picture.path).name, name)
        self.assertRegex(self.refused(f("takePicture", str_param=name)), f"{name} is there already")

    def test_a_recording_outlives_its_goal_and_ends_when_it_is_asked_to(self):
        wait = f("startRecording", id="walk", time=rospy.Duration(1000))
        run = self.send(wait).wait_for_function(0)
        run.cancel()
        self.ends(run, GoalStatus.PREEMPTED)
        frames = lambda: {each.id: each.frames for each in self.succeed(f("listThreads")).threads}  # noqa: E731
        wait_until(lambda: frames().get("walk", 0) >= 5, 60.0, "frames of the recording")
        (video,) = self.succeed(f("stopRecording", id="walk")).recordings
        self.assertGreaterEqual(video.frames, 5)
        capture = cv2.VideoCapture(video.path)
        self.assertEqual(int(capture.get(cv2.CAP_PROP_FRAME_COUNT)), video.frames)

    def test_a_wrong_topic_is_refused(self):
        self.assertRegex(self.refused(f("takePicture", topic="rosout")), "field topic")


if __name__ == "__main__":
    rospy.init_node("vision_test")
    rostest.rosrun("nao_library_tests", "vision", Vision)
