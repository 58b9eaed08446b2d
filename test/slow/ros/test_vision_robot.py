"""Pictures, videos and settings of the robot's own cameras, through the whole stack."""

import os
import signal
import subprocess
import unittest
from pathlib import Path

import av
import cv2
import numpy as np
import rosnode
import rospkg
import rospy
from actionlib_msgs.msg import GoalStatus
from goal_functions import vision as f
from sensor_msgs.msg import CameraInfo, Image

from nao_library_actions.msg import NaoVisionAction, NaoVisionGoal
from nao_sim_bridge.testing import SimulatedRobot, send, wait_until

LIMIT = 60.0
CAMERAS = ("top", "bottom")


def likeness(one, other):
    """How much two pictures are alike, -1..1."""
    return float(np.corrcoef(one.astype(float).ravel(), other.astype(float).ravel())[0, 1])


class VisionRobot(unittest.TestCase):
    world = "lab"

    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.client = cls.robot.action_client("NaoVision", NaoVisionAction)
        cls.device = cls.robot.module("ALVideoDevice")
        rospy.wait_for_message("nao_robot/camera/top/image_raw", Image, LIMIT)  # nao_camera and the renderer are there

    def setUp(self):
        self.robot.reset()

    def tearDown(self):
        for thread in self.play(f("listThreads")).threads:
            self.play(f("deleteThread", id=thread.id))
        self.play(*(f("setAllParametersToDefault", camera=camera) for camera in CAMERAS))
        # Nobody looks any more.
        wait_until(lambda: not self.device.getSubscribers(), 60.0, "the end of the cameras' subscriptions")

    def play(self, *functions, state=GoalStatus.SUCCEEDED):
        run = send(self.client, NaoVisionGoal(list(functions))).wait(LIMIT)
        self.assertEqual(run.state, state, run.text)
        return run.result if state == GoalStatus.SUCCEEDED else run

    def play_in_step(self, *functions):
        """Play them when the server's clock is that of the simulation: it is late, on a busy computer by much.

        What a picture or the end of a recording shows depends on it.
        """
        self.robot.pause()
        try:
            now = self.robot.advance(0.0)
            knows = lambda: send(self.client, NaoVisionGoal([f("ping")])).wait(LIMIT).server_time >= now  # noqa: E731
            wait_until(knows, LIMIT, f"the server at {now} s")
            run = send(self.client, NaoVisionGoal(list(functions)))
        finally:
            self.robot.resume()
        self.assertEqual(run.wait(LIMIT).state, GoalStatus.SUCCEEDED, run.text)
        return run.result

    def picture(self, camera="top", *before):
        """A picture of now or later."""
        take = f("takePicture", camera=camera, str_param="look.png", overwrite=True)
        (message,) = self.play_in_step(*before, take).pictures
        return cv2.imread(message.path), message

    def turn_head(self, yaw):
        motion = self.robot.module("ALMotion")
        motion.setStiffnesses("Head", 1.0)
        motion.angleInterpolationWithSpeed("HeadYaw", yaw, 0.5)

    def test_pictures_are_what_the_cameras_see(self):
        asked = self.robot.advance(0.0)
        ahead, message = self.picture()
        self.assertEqual(ahead.shape, (240, 320, 3))
        self.assertGreater(ahead.std(), 5.0)  # there is something to see in the lab
        self.assertEqual(message.header.frame_id, "CameraTop_optical_frame")
        taken, now = message.header.stamp.to_sec(), self.robot.advance(0.0)
        self.assertTrue(asked <= taken <= now, (asked, taken, now))
        again, _ = self.picture()
        below, message = self.picture("bottom")
        self.assertEqual(message.header.frame_id, "CameraBottom_optical_frame")
        self.turn_head(0.8)
        left, _ = self.picture()
        self.turn_head(0.0)
        back, _ = self.picture()
        alike = [likeness(ahead, other) for other in (again, back, below, left)]
        print(f"like the first picture: {np.round(alike, 2)}")
        self.assertGreater(min(alike[:2]), 0.85)
        self.assertLess(max(alike[2:]), 0.7)

    def frames(self, ident, count):
        wait_until(
            lambda: self.play(f("listThreads", id=ident)).threads[0].frames >= count,
            LIMIT,
            f"{count} frames of {ident}",
        )

    def test_a_stream_is_a_camera_of_its_own(self):
        pictures, infos = [], []
        listeners = [
            rospy.Subscriber("NaoVision/small/image_raw", Image, pictures.append),
            rospy.Subscriber("NaoVision/small/camera_info", CameraInfo, infos.append),
        ]
        self.play(f("subscribe", id="small", width=160, rate=5.0))
        wait_until(lambda: len(pictures) >= 8 and len(infos) >= 8, LIMIT, "a stream with camera_info")
        whole = rospy.wait_for_message("nao_robot/camera/top/camera_info", CameraInfo, LIMIT)
        for listener in reversed(listeners):
            listener.unregister()
        self.assertEqual({(m.width, m.height, m.encoding) for m in pictures}, {(160, 120, "bgr8")})
        stamps = [message.header.stamp.to_sec() for message in pictures]
        self.assertAlmostEqual(float(np.median(np.diff(stamps))), 0.2, delta=0.01)
        known = [info.header.stamp.to_sec() for info in infos]
        both = [stamp for stamp in known if stamps[0] <= stamp <= stamps[-1]]
        self.assertGreaterEqual(len(both), 6)
        self.assertLessEqual(set(both), set(stamps))
        self.assertEqual((infos[-1].width, infos[-1].header.frame_id), (160, "CameraTop_optical_frame"))
        np.testing.assert_allclose(np.array(infos[-1].K)[:6], np.array(whole.K)[:6] / 2.0)

    def test_a_server_can_start_its_cameras_itself(self):
        folder = Path(rospkg.get_ros_home()) / "own_files"
        server = subprocess.Popen(
            ["rosrun", "nao_library_modules", "nao_vision_server", "--pport", os.environ["NAO_PORT"], "__ns:=own",
             "_autostart:=true", "_launchpath:=nao_library cameras.launch", f"_record_dir:={folder}"],
        )  # fmt: skip
        try:
            client = self.robot.action_client("own/NaoVision", NaoVisionAction, limit=90.0)
            run = send(client, NaoVisionGoal([f("takePicture", timeout=120.0)])).wait(LIMIT)
            self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
            (picture,) = run.result.pictures
            self.assertEqual((picture.topic, picture.width), ("/own/nao_robot/camera/top/image_raw", 320))
            self.assertEqual(cv2.imread(picture.path).shape, (240, 320, 3))
        finally:
            server.send_signal(signal.SIGINT)
            server.wait(LIMIT)
        # The launch file has ended with the server.
        wait_until(lambda: not rosnode.rosnode_ping("/own/nao_camera", max_count=1), 60.0, "the end of the cameras")

    def test_what_is_recorded_moves_with_the_head(self):
        self.play(f("startRecording", id="look"))
        self.frames("look", 3)
        self.turn_head(0.7)
        self.turn_head(-0.7)
        (video,) = self.play_in_step(f("stopRecording", id="look")).recordings
        with av.open(video.path) as container:
            pictures = [frame.to_ndarray(format="bgr24") for frame in container.decode(video=0)]
        alike = [likeness(pictures[0], picture) for picture in pictures]
        self.assertLess(alike[-1], 0.9)  # also the end of the motion is there
        self.assertGreater(alike[1], 0.95)
        self.assertLess(min(alike), 0.8)
        # On the way from left to right it looks ahead again.
        lowest = int(np.argmin(alike[: len(alike) // 2]))
        self.assertGreater(max(alike[lowest:]), min(alike) + 0.1)
