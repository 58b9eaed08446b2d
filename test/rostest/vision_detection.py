#!/usr/bin/env python3
"""Goals of NaoVision that recognise things in what the simulated cameras see, and follow them with the head."""

import math
import sys
import unittest
from pathlib import Path

import numpy as np
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoMotionAction, NaoMotionGoal, NaoVisionAction, NaoVisionGoal
from nao_library_msgs.msg import MotionFunction, VisionFunction
from nao_sim_bridge.testing import SimulatedRobot, send, wait_until

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))  # not beside its relay
from cases import case  # noqa: E402
from things_fixture import FACING, Things, angle_between, point  # noqa: E402

EXTRACTORS = (
    "ALRedBallDetection",
    "ALFaceDetection",
    "ALLandMarkDetection",
    "ALBarcodeReader",
    "ALMovementDetection",
)
BEARING = math.radians(2.0)
HEAD = ["HeadYaw", "HeadPitch"]


def f(function, **fields):
    return VisionFunction(function=function, **fields)


class VisionDetection(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.vision = cls.robot.action_client("NaoVision", NaoVisionAction)
        cls.motion = cls.robot.action_client("NaoMotion", NaoMotionAction)
        cls.things = Things(cls.robot)

    def setUp(self):
        self.robot.reset()
        self.do(MotionFunction(function="goToPosture", str_param="Stand"))

    def tearDown(self):
        for module in EXTRACTORS:
            self.assertEqual(self.robot.module(module).getSubscribersInfo(), [], module)

    def do(self, *functions):
        run = send(self.motion, NaoMotionGoal(list(functions))).wait(60.0)
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)

    def look(self, yaw=0.0, pitch=0.0):
        self.do(
            MotionFunction(
                function="angleInterpolationWithSpeed", names=HEAD, angles=[yaw, pitch], speed=0.3, stiffness=1.0
            )
        )

    def start(self, *functions):
        return send(self.vision, NaoVisionGoal(list(functions)))

    def see(self, *functions):
        run = self.start(*functions).wait(90.0)
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
        return run.result

    def check(self, seen, place, distance_error):
        """What was seen is at a place of the world, as far as its direction and its distance go."""
        camera = {"top": "CameraTop", "bottom": "CameraBottom"}[seen.camera]
        true = self.things.in_camera(place, camera)
        x, y, z = point(seen.camera_position)
        off = angle_between((z, -x, -y), true)
        base_off = np.linalg.norm(point(seen.position) - self.things.in_base(place))
        length = np.linalg.norm(true)
        text = f"{seen.kind} {seen.name}: {length:.2f} m away, {math.degrees(off):.2f} degrees off, seen at"
        text += f" {seen.distance:.3f} m, {base_off:.3f} m off in the frame of the robot"
        rospy.loginfo("%s", text)
        self.assertLess(off, BEARING, text)
        self.assertTrue(seen.located, text)
        self.assertLess(abs(seen.distance / length - 1.0), distance_error, text)
        self.assertLess(base_off, distance_error * length + BEARING * length + 0.01, text)
        self.assertEqual(seen.header.frame_id, f"{camera}_optical_frame")
        self.assertEqual(seen.base_frame, "base_footprint")
        self.assertLess(abs((rospy.Time.now() - seen.header.stamp).to_sec()), 5.0)

    def test_a_ball_from_near_to_far(self):
        for number, (distance, left, camera, pitch) in enumerate(
            (
                (0.3, 0.0, "bottom", 0.4),
                (0.5, 0.1, "bottom", 0.0),
                (1.0, -0.25, "top", 0.2),
                (1.5, 0.4, "top", 0.0),
                (2.0, 0.0, "top", 0.0),
            )
        ):
            with case(distance=distance):
                self.look(pitch=pitch)
                place = self.things.place(f"ball{number}", (distance, left, 0.03), ball=0.03)
                (ball,) = self.see(f("detectBall", camera=camera, count=3)).objects
                self.check(ball, place, 0.12)
                self.things.remove(f"ball{number}")

    def test_landmarks_with_their_numbers(self):
        places = {
            "64": self.things.from_camera(0.5, 0.1),
            "114": self.things.from_camera(1.0, -0.3, 0.1),
            "85": self.things.from_camera(1.4, 0.45, 0.2),
        }
        for number, place in places.items():
            self.things.place(f"mark{number}", place, FACING, landmark=number)
        result = self.see(f("detectLandmarks", count=3, timeout=5.0), f("detectLandmarks", str_param="85", count=2))
        self.assertEqual(sorted(result.results[0].values), ["114", "64", "85"])
        self.assertEqual(result.results[1].values, ["85"])
        for seen in result.objects:
            self.check(seen, places[seen.name], 0.12)

    def test_codes_with_what_they_say(self):
        place = self.things.place("code", self.things.from_camera(0.5, 0.05), FACING, qr="nao_library", size=0.15)
        result = self.see(f("readBarcodes", timeout=5.0))
        self.assertEqual(result.memList, ["nao_library"])
        (code,) = result.objects
        self.assertFalse(code.located)
        x, y, z = point(code.camera_position)
        self.assertLess(angle_between((z, -x, -y), self.things.in_camera(place)), BEARING)

    def test_a_face_is_learnt_known_and_forgotten(self):
        self.see(f("forgetAllFaces"))
        place = self.things.place("card", self.things.from_camera(0.8), FACING, face="anna")
        result = self.see(f("detectFaces"), f("learnFace", str_param="Anna"), f("listFaces"), f("detectFaces", count=5))
        unknown, learn, known, again = (list(each.values) for each in result.results)
        self.assertEqual((unknown, learn, known, again), (["face"], ["True"], ["Anna"], ["Anna"]))
        face = result.objects[-1]
        self.assertEqual((face.kind, face.name), ("face", "Anna"))
        self.assertGreaterEqual(face.confidence, 0.4)
        x, y, z = point(face.camera_position)
        self.assertLess(angle_between((z, -x, -y), self.things.in_camera(place)), 2.0 * BEARING)
        self.things.remove("card")
        self.things.place("other", self.things.from_camera(0.8), FACING, face="farid")
        self.assertEqual(self.see(f("detectFaces", count=5)).memList, ["face"])
        self.assertEqual(self.see(f("forgetFace", str_param="Anna"), f("listFaces")).memList, [])

    def test_somebody_who_walks_by_moves(self):
        self.things.place("ben", (2.0, 1.0, 0.0), FACING, person="ben")
        run = self.start(f("detectMovement", timeout=20.0, count=3))
        run.wait_for_function(0)
        self.things.move("ben", (2.0, -1.0, 0.0), FACING, 6.0)
        run.wait(60.0)
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
        self.assertTrue(run.result.objects)
        largest = max(run.result.objects, key=lambda seen: seen.width * seen.height)
        self.assertLess(abs(largest.alpha), math.radians(32.0))

    def test_nothing_is_seen_in_an_empty_room(self):
        result = self.see(
            *(f(function, timeout=2.0) for function in ("detectBall", "detectLandmarks", "detectFaces")),
            *(f(function, timeout=2.0) for function in ("readBarcodes", "detectMovement")),
        )
        self.assertEqual((result.memList, result.objects), ([], []))

    def test_the_head_follows_a_ball(self):
        self.look(pitch=0.25)
        self.things.place("ball", (1.2, 0.0, 0.03), ball=0.03)
        run = self.start(f("trackBall", duration=9.0, size=0.03))
        run.wait_for_function(0)
        self.things.move("ball", (0.9, 0.8, 0.03), 0.0, 5.0)
        run.wait(90.0)
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
        self.assertGreater(float(run.result.memList[0]), 6.5)
        true = self.things.in_camera((0.9, 0.8, 0.03))
        self.assertLess(angle_between((1.0, 0.0, 0.0), true), math.radians(4.0))
        (ball,) = run.result.objects
        self.check(ball, (0.9, 0.8, 0.03), 0.12)

    def test_the_head_follows_one_face_of_two(self):
        self.look()
        start, end = self.things.from_camera(0.9, 0.15), self.things.from_camera(0.8, 0.6)
        self.things.place("anna", start, FACING, face="anna")
        self.see(f("forgetAllFaces"), f("learnFace", str_param="Anna"))
        self.things.place("ben", self.things.from_camera(0.9, -0.2), FACING, face="ben")
        run = self.start(f("trackFace", str_param="Anna", duration=9.0))
        run.wait_for_function(0)
        self.things.move("anna", end, FACING + math.radians(35.0), 4.0)
        run.wait(90.0)
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
        self.assertEqual([seen.name for seen in run.result.objects], ["Anna"])
        self.assertGreater(float(run.result.memList[0]), 6.0)
        self.assertLess(angle_between((1.0, 0.0, 0.0), self.things.in_camera(end)), math.radians(4.0))

    def test_a_ball_behind_the_shoulder_is_found(self):
        place = self.things.place("ball", (-0.3, 0.9, 0.03), ball=0.03)
        (ball,) = self.see(f("lookFor", str_param="ball", count=3)).objects
        self.check(ball, place, 0.12)
        yaw, _ = self.robot.module("ALMotion").getAngles("Head", True)
        self.assertGreater(yaw, 1.2)

    def test_a_preempted_track_ends_and_the_head_goes_back(self):
        self.look(pitch=0.25)
        self.things.place("ball", (1.0, 0.3, 0.03), ball=0.03)
        before = self.robot.module("ALMotion").getAngles("Head", False)
        run = self.start(f("trackBall", revert=True))
        run.wait_for_function(0)
        balls = self.robot.module("ALRedBallDetection")
        wait_until(lambda: len(balls.getSubscribersInfo()) == 1, 20.0, "the subscription")
        motion = self.robot.module("ALMotion")
        wait_until(lambda: motion.getAngles("HeadYaw", True)[0] > 0.15, 20.0, "the head's turn")
        run.cancel()
        run.wait(10.0)
        self.assertEqual(run.state, GoalStatus.PREEMPTED)
        self.assertEqual(balls.getSubscribersInfo(), [])
        for now, then in zip(motion.getAngles("Head", True), before):
            self.assertAlmostEqual(now, then, delta=0.03)
        self.assertEqual([seen.kind for seen in run.result.objects], ["ball"])

    def test_extractors_of_others_are_left_alone(self):
        self.things.place("mark", self.things.from_camera(0.6), FACING, landmark="64")
        marks = self.robot.module("ALLandMarkDetection")
        marks.subscribe("somebody")
        try:
            self.assertEqual(self.see(f("detectLandmarks")).memList, ["64"])
            self.assertEqual([name for name, *_ in marks.getSubscribersInfo()], ["somebody"])
            run = self.start(f("detectLandmarks", camera="bottom")).wait(20.0)
            self.assertEqual(run.state, GoalStatus.ABORTED)
            self.assertIn("somebody", run.text)
        finally:
            marks.unsubscribe("somebody")

    def test_the_other_camera_sees_and_is_given_back(self):
        self.things.place("mark", self.things.from_camera(0.4, camera="CameraBottom"), FACING, landmark="64")
        (seen,) = self.see(f("detectLandmarks", camera="bottom", timeout=5.0)).objects or [None]
        self.assertIsNotNone(seen, "nothing in the bottom camera")
        self.assertEqual((seen.camera, seen.header.frame_id), ("bottom", "CameraBottom_optical_frame"))
        self.assertEqual(self.robot.module("ALLandMarkDetection").getActiveCamera(), 0)

    def test_wrong_fields_are_refused_before_anything_is_done(self):
        run = self.start(f("detectBall", timeout=30.0), f("detectLandmarks", str_param="seven")).wait(20.0)
        self.assertEqual(run.state, GoalStatus.ABORTED)
        self.assertIn("function 2 (detectLandmarks)", run.text)
        self.assertIn("seven", run.text)


if __name__ == "__main__":
    rospy.init_node("vision_detection_test")
    rostest.rosrun("nao_library_tests", "vision_detection", VisionDetection)
