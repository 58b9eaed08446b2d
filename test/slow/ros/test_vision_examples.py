"""The examples that see, started as users start them."""

import math
import re
from pathlib import Path

import av
import cv2
import numpy as np
from cases import case
from examples_fixture import ExampleTest
from things_fixture import FACING, Things

from nao_library_actions.msg import NaoVisionAction

BALL = "ball"
"""Of the world lab."""
NEAR = 0.30


class VisionExamples(ExampleTest):
    world = "lab"

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.robot.action_client("NaoVision", NaoVisionAction)
        cls.things = Things(cls.robot)

    def file_in(self, output, pattern):
        """The file that the example says it wrote."""
        match = re.search(rf"^(/.*{pattern}): ", output, re.MULTILINE)
        self.assertIsNotNone(match, output)
        return Path(match.group(1))

    def test_a_picture(self):
        for camera in ("top", "bottom"):
            with case(camera=camera):
                output = self.run_example("take_picture.py", f"example_{camera}.png", "--camera", camera, "--overwrite")
                picture = cv2.imread(str(self.file_in(output, r"\.png")))
                self.assertIn(f"{picture.shape[1]} x {picture.shape[0]} pixels", output)
                self.assertGreater(picture.std(), 10.0)  # a room, not a wall of one colour

    def test_two_videos_of_a_walk(self):
        self.robot.module("ALMotion").wakeUp()
        before = self.robot.true_pose().position
        output = self.run_example("record_while_walking.py", "--distance", "0.3")
        after = self.robot.true_pose().position
        self.assertAlmostEqual(after.x - before.x, 0.3, delta=0.06)
        files = [Path(line.split(": ")[0]) for line in output.splitlines() if ".mp4: " in line]
        self.assertEqual(len(files), 2, output)
        for file in files:
            with av.open(str(file)) as video:
                frames = [frame.to_ndarray(format="rgb24") for frame in video.decode(video=0)]
            self.assertGreater(len(frames), 10)
            moved = np.abs(frames[-1].astype(int) - frames[0].astype(int)).mean()
            self.assertGreater(moved, 3.0, f"{file}: the last picture is the first one")
        durations = [float(found) for found in re.findall(r"mp4: ([0-9.]+) s", output)]
        self.assertGreater(min(durations), 2.0, output)

    def test_the_ball_is_found_and_walked_to(self):
        output = self.run_example("find_ball.py", "--radius", "0.05")
        self.assertIn("in the picture of the bottom camera", output)
        place = self.robot.module("NaoSimulation").objectPoses()[BALL][:3]
        x, y, _ = self.things.in_base(place)
        self.assertLess(math.hypot(x, y), NEAR + 0.03, output)
        ahead, left, up = self.things.in_camera(place, "CameraBottom")
        self.assertGreater(ahead, 0.0)
        self.assertLess(abs(math.atan2(left, ahead)), math.radians(28.0), output)
        self.assertLess(abs(math.atan2(up, ahead)), math.radians(22.0), output)

    def test_a_face_is_greeted_once_it_is_known(self):
        self.robot.module("ALFaceDetection").clearDatabase()
        self.robot.module("ALMotion").wakeUp()
        # Before the table, to the left: the head has to turn.
        self.things.place("card", (0.25, 0.7, 0.47), FACING + math.atan2(0.7, 0.25), face="anna")
        self.assertIn("I do not know you yet", self.run_example("greet_face.py", status=1))
        self.assertIn("Nice to meet you, Anna!", self.run_example("greet_face.py", "--learn", "Anna"))
        self.assertIn("Hello, Anna!", self.run_example("greet_face.py"))

    def test_nobody_is_greeted_by_no_name(self):
        self.robot.module("ALMotion").wakeUp()
        self.assertIn("Is anybody there?", self.run_example("greet_face.py", "--timeout", "8", status=1))
