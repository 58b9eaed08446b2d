"""What nao_vision finds in the pictures of the robot: landmarks, faces by name, and movement; switched on and off."""

import math
import unittest
from contextlib import contextmanager

import numpy as np
import rospy
import yaml
from camera_fixture import LIMIT, Geometry, matrix
from services import answer, service
from std_srvs.srv import Empty

from nao_library_msgs.msg import FaceDetected, LandmarkDetected, MovementDetected
from nao_library_msgs.srv import LearnFace
from nao_sim_bridge.testing import SimulatedRobot, wait_until

MODULES = {"face": "ALFaceDetection", "motion": "ALMovementDetection", "landmark": "ALLandMarkDetection"}
TOP = "CameraTop_optical_frame"
AHEAD = math.pi
"""Heading of a thing that looks at the robot."""


class DriverVision(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.simulation = cls.robot.module("NaoSimulation")
        cls.geometry = Geometry(cls.robot)
        names = [f"nao_vision/{kind}_detection/{change}" for kind in MODULES for change in ("enable", "disable")]
        cls.switches = {name.split("/", 1)[1]: service(name, Empty) for name in names}
        cls.learn = service("nao_vision/face_detection/learn_face", LearnFace)
        cls.forget = service("nao_vision/face_detection/forget_person", LearnFace)
        enable = cls.switches["landmark_detection/enable"]
        wait_until(lambda: answer(enable) == "", LIMIT, "nao_vision and the robot")

    def setUp(self):
        self.robot.reset()
        for kind in MODULES:
            self.switches[f"{kind}_detection/disable"]()

    # --- things to see --------------------------------------------------------------------------------------------

    def ahead(self, distance, left=0.0, up=0.0):
        """(3,) place in world: in front of the top camera, m along its axis, to the left and up."""
        pose = self.geometry.optical_in_world(TOP, rospy.Time())
        return (pose @ (-left, -up, distance, 1.0))[:3]

    def put(self, **entry):
        """Place a thing at `position`; it is taken away at the end of the test."""
        entry["position"] = [float(each) for each in entry["position"]]
        self.simulation.placeObject(yaml.safe_dump(entry, default_flow_style=True))
        self.addCleanup(self.simulation.removeObject, entry["name"])

    @contextmanager
    def looking(self, kind, topic, message_type):
        """Messages of a topic while a detection is switched on."""
        messages = []
        subscriber = rospy.Subscriber(f"nao_vision/{topic}", message_type, messages.append, queue_size=100)
        self.switches[f"{kind}_detection/enable"]()
        try:
            yield messages
        finally:
            self.switches[f"{kind}_detection/disable"]()
            subscriber.unregister()

    def angles(self, message, point):
        """(alpha, beta) of a point in world, seen by the camera of a message, rad."""
        pose = self.geometry.optical_in_world(message.header.frame_id, message.header.stamp)
        x, y, z = (np.linalg.inv(pose) @ np.append(point, 1.0))[:3]
        return -math.atan2(x, z), math.atan2(y, z)

    def check_pose(self, message, pose):
        """Whether a message tells where its camera was in the torso frame, by /tf."""
        torso = self.robot.true_pose()
        optical = self.geometry.optical_in_world(message.header.frame_id, message.header.stamp)
        in_torso = np.linalg.inv(matrix(torso.position, torso.orientation)) @ optical
        found = matrix(pose.position, pose.orientation)
        np.testing.assert_allclose(found[:3, 3], in_torso[:3, 3], atol=0.005)
        # NAOqi's X is the optical axis, which is Z of the optical frame.
        np.testing.assert_allclose(found[:3, 0], in_torso[:3, 2], atol=0.01)

    # --- what is found --------------------------------------------------------------------------------------------

    def test_landmarks_are_found_with_number_and_place(self):
        place = self.ahead(0.8, left=0.1, up=0.05)
        self.put(name="mark", landmark=84, position=place, heading=AHEAD)
        with self.looking("landmark", "landmark_detected", LandmarkDetected) as messages:
            wait_until(lambda: any(message.mark_ids for message in messages), LIMIT, "a landmark")
        message = next(message for message in messages if message.mark_ids)
        self.assertEqual([number.data for number in message.mark_ids], [84])
        self.assertEqual((message.header.frame_id, message.camera_name.data), (TOP, "CameraTop"))
        alpha, beta = self.angles(message, place)
        self.assertAlmostEqual(message.shape_alpha[0].data, alpha, delta=math.radians(2.0))
        self.assertAlmostEqual(message.shape_beta[0].data, beta, delta=math.radians(2.0))
        self.assertGreater(message.shape_sizex[0].data, 0.05)
        self.assertLess(abs(message.header.stamp.to_sec() - rospy.get_time()), LIMIT)
        self.check_pose(message, message.camera_local_pose)

    def test_a_face_is_found_learned_known_by_name_and_forgotten(self):
        faces = self.robot.module("ALFaceDetection")
        faces.clearDatabase()
        place = self.ahead(0.8, left=-0.08)
        self.put(name="portrait", face="anna", position=place, heading=AHEAD)
        with self.looking("face", "faces_detected", FaceDetected) as messages:
            wait_until(lambda: messages, LIMIT, "a face")
            message = messages[-1]
            self.assertEqual((message.face_label.data, message.camera_id.data), ("", 0))
            alpha, beta = self.angles(message, place)
            self.assertAlmostEqual(message.shape_alpha.data, alpha, delta=math.radians(3.0))
            self.assertAlmostEqual(message.shape_beta.data, beta, delta=math.radians(5.0))
            self.assertGreater(message.shape_sizeX.data, 0.08)
            # NAOqi's angles grow to the left: the left eye of who looks at the robot is on the robot's right.
            self.assertNotEqual(message.left_eye_eyeCenter_x.data, message.right_eye_eyeCenter_x.data)
            self.check_pose(message, message.camera_0_pose)
            self.assertTrue(self.learn(name_of("anna")).result.data)
            wait_until(lambda: messages[-1].face_label.data == "anna", LIMIT, "the name")
            self.assertGreater(messages[-1].score_reco.data, 0.0)
            self.assertEqual(faces.getLearnedFacesList(), ["anna"])
            self.assertTrue(self.forget(name_of("anna")).result.data)
            wait_until(lambda: messages[-1].face_label.data == "", LIMIT, "the face without a name")
        self.assertEqual(faces.getLearnedFacesList(), [])

    def test_movement_is_found_where_something_moves(self):
        begin, end = self.ahead(0.9, left=0.25), self.ahead(0.9, left=-0.25)
        self.put(name="thing", box=[0.12, 0.12, 0.12], position=begin, color=[0.8, 0.1, 0.1])
        self.robot.advance(0.5)
        with self.looking("motion", "movement_detected", MovementDetected) as messages:
            self.robot.advance(1.0)
            self.assertEqual(messages, [], "something moves while all is still")
            turn = [0.0, 0.0, 0.0]
            for place in (end, begin):
                self.simulation.moveObject("thing", [float(each) for each in place], turn, 1.5)
            wait_until(lambda: len(messages) > 2, LIMIT, "movement")
        message = messages[-1]
        self.assertEqual(message.header.frame_id, TOP)
        self.assertLess(abs(message.gravity_center.x), math.atan2(0.35, 0.9))
        self.assertLess(abs(message.gravity_center.y), math.radians(12.0))
        self.assertEqual(len(message.points_poses), len(message.points_speeds))
        fastest = max(abs(message.mean_velocity.x) for message in messages)
        self.assertGreater(fastest, 0.05)


def name_of(text):
    """A name as the service takes it."""
    request = LearnFace._request_class()
    request.name.data = text
    return request
