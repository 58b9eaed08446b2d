"""Cameras that are no NAO's: a launch file is all that NaoVision needs of them, and threads need no robot at all."""

import os
import signal
import subprocess
import tempfile
import unittest
from pathlib import Path

import av
import rospy
from actionlib_msgs.msg import GoalStatus
from examples_fixture import start
from goal_functions import vision as f

from nao_library_actions.msg import NaoVisionAction, NaoVisionGoal
from nao_sim_bridge.testing import SimulatedRobot, send

LIMIT = 60.0


def ended(program):
    program.send_signal(signal.SIGINT)
    program.communicate(timeout=LIMIT)


class OtherCameras(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)

    def test_the_camera_of_a_launch_file_is_the_source_and_may_be_changed(self):
        server = start(
            "../nodes/nao_vision_server", "--pport", os.environ["NAO_PORT"], "__ns:=/other", "_autostart:=true",
            "_launchpath:=nao_library_tests other_camera.launch", f"_record_dir:={self.folder.name}",
        )  # fmt: skip
        self.addCleanup(ended, server)
        client = self.robot.action_client("other/NaoVision", NaoVisionAction, limit=LIMIT)
        run = send(client, NaoVisionGoal([f("takePicture", timeout=60.0)])).wait(LIMIT)
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
        (picture,) = run.result.pictures
        self.assertEqual((picture.topic, picture.width, picture.height), ("/other/usb_cam/image_raw", 64, 48))
        missing = send(client, NaoVisionGoal([f("takePicture", camera="bottom")])).wait(LIMIT)
        self.assertEqual(missing.state, GoalStatus.ABORTED)
        self.assertRegex(
            missing.text, "other_camera.launch brings no camera 'bottom': its nodes publish /other/usb_cam/image_raw"
        )

    def test_threads_stream_and_record_without_a_robot(self):
        camera = subprocess.Popen(["rosrun", "nao_library_tests", "pattern_camera.py", "__ns:=/lab"])
        self.addCleanup(camera.communicate)
        self.addCleanup(camera.terminate)
        rospy.wait_for_message("/lab/usb_cam/image_raw", rospy.AnyMsg, LIMIT)
        example = start(
            "webcam.py", "/lab/usb_cam/image_raw", "grey.avi", "--seconds", "10", "--width", "32",
            "--folder", self.folder.name,
        )  # fmt: skip
        output, _ = example.communicate(timeout=LIMIT)
        self.assertEqual(example.returncode, 0, output)
        self.assertRegex(output, r"[1-9]\d* small pictures on /lab/usb_cam_small/image_raw")
        with av.open(str(Path(self.folder.name) / "grey.avi")) as video:
            pictures = [frame.to_ndarray(format="gray") for frame in video.decode(video=0)]
        self.assertGreater(len(pictures), 5)
        self.assertEqual(pictures[0].shape, (48, 64))
        self.assertGreater(len({int(picture.mean()) for picture in pictures}), 3)
