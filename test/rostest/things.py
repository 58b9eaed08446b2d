#!/usr/bin/env python3
"""Things that ROS nodes place in the simulated world, move and remove."""

import math
import sys
import threading
import unittest
from pathlib import Path

import rospy
import rostest
from geometry_msgs.msg import Point, Pose, Quaternion
from PIL import Image

from nao_library_msgs.srv import MoveObject, PlaceObject, RemoveObject
from nao_sim_bridge.testing import SimulatedRobot

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))  # not beside its relay
from services import service  # noqa: E402

HALF_TURN = Quaternion(0.0, 0.0, 1.0, 0.0)
PATIENCE = 20.0


def at(x, y, z, orientation=None):
    return Pose(Point(x, y, z), orientation or Quaternion())


class Things(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.simulation = cls.robot.module("NaoSimulation")
        cls.place, cls.move, cls.remove = (
            service(f"nao_sim/{name}_object", kind, PATIENCE)
            for name, kind in (("place", PlaceObject), ("move", MoveObject), ("remove", RemoveObject))
        )

    def setUp(self):
        self.robot.pause()
        self.robot.reset()

    def good(self, answer):
        self.assertEqual((answer.success, answer.message), (True, ""))

    def bad(self, answer, text):
        self.assertFalse(answer.success)
        self.assertIn(text, answer.message)

    def where(self, name):
        return self.simulation.objects()[name]

    def test_a_ball_is_placed_and_falls(self):
        self.good(self.place(name="b", kind="ball", size=[0.03], pose=at(0.4, 0.4, 0.3)))
        self.robot.advance(1.0)
        self.assertAlmostEqual(self.where("b")[2], 0.03, delta=0.003)

    def test_a_box_has_its_size_colour_pose_and_mass(self):
        blue = dict(color=[0.0, 0.0, 1.0], mass=0.2)
        self.good(self.place(name="x", kind="box", size=[0.2, 0.3, 0.6], pose=at(0.3, -0.9, 0.3, HALF_TURN), **blue))
        self.assertAlmostEqual(abs(self.where("x")[5]), math.pi, places=4)
        self.robot.advance(0.5)
        self.assertAlmostEqual(self.where("x")[2], 0.3, delta=0.003)
        with Image.open(self.robot.picture("room", "blue.png")) as picture:
            seen = sum(b > r + 80 and b > g + 60 for r, g, b in picture.convert("RGB").getdata())
        self.assertGreater(seen, 200)

    def test_a_mark_and_a_person_are_placed(self):
        self.good(self.place(name="m", kind="landmark", content="64", pose=at(0.4, 0.5, 0.45, HALF_TURN), stand=True))
        self.good(self.place(name="p", kind="person", content="ben", size=[1.5], pose=at(2.0, 1.5, 0.0)))
        self.assertAlmostEqual(self.where("m")[2], 0.45, places=4)
        self.assertEqual([round(value, 4) for value in self.where("p")], [2.0, 1.5, 0.0, 0.0, 0.0, 0.0])

    def test_a_description_is_as_good(self):
        self.good(self.place(description="{name: q, qr: hello, position: [0.8, 0.6, 0.5], heading: 1.0}"))
        self.assertAlmostEqual(self.where("q")[5], 1.0, places=4)
        self.bad(self.place(description="{}", kind="ball"), "description is '{}', allowed is empty when")

    def test_a_person_walks_while_time_passes(self):
        self.good(self.place(name="p", kind="person", content="anna", pose=at(2.0, 1.5, 0.0)))
        self.good(self.move(name="p", pose=at(2.0, 0.5, 0.0), time=rospy.Duration(2.0)))
        self.robot.advance(1.0)
        self.assertAlmostEqual(self.where("p")[1], 1.0, delta=0.02)
        answers = []
        waiting = threading.Thread(
            target=lambda: answers.append(
                service("nao_sim/move_object", MoveObject)(
                    name="p", pose=at(2.0, 1.5, 0.0, HALF_TURN), time=rospy.Duration(1.0), wait=True
                )
            )
        )
        waiting.start()
        self.robot.resume()
        waiting.join(PATIENCE)
        self.good(answers[0])
        self.assertAlmostEqual(self.where("p")[1], 1.5, places=3)
        self.assertAlmostEqual(abs(self.where("p")[5]), math.pi, places=3)

    def test_things_of_the_world_are_moved_and_removed_until_a_reset(self):
        self.good(self.move(name="chair_left", pose=at(0.0, 1.5, 0.0)))
        self.assertAlmostEqual(self.where("chair_left")[5], -1.65, places=3)
        self.good(self.remove(name="table"))
        self.assertNotIn("table", self.simulation.objects())
        self.robot.reset()
        self.assertIn("table", self.simulation.objects())
        self.assertAlmostEqual(self.where("chair_left")[0], 0.95, places=3)

    def test_errors_say_what_is_there_and_what_is_allowed(self):
        self.bad(self.place(name="table", kind="ball", size=[0.03], pose=at(0.4, 0.4, 0.3)), "name is 'table', allowed")
        self.bad(self.place(name="x", kind="landmark", content="1", pose=at(0.4, 0.4, 0.3)), "allowed is one of 64")
        self.bad(self.place(name="x", kind="bal", pose=at(0.4, 0.4, 0.3)), "did you mean 'ball'")
        self.bad(self.place(name="x", kind="box", size=[0.1], pose=at(0.4, 0.4, 0.3)), "not 3 finite numbers")
        self.bad(
            self.place(name="x", kind="face", content="anna", size=[1, 2], pose=at(1, 1, 1)), "one number for a face"
        )
        self.bad(self.move(name="tabel", pose=at(0.4, 0.4, 0.3)), "did you mean 'table'")
        self.bad(self.remove(name="tabel"), "there are: ball, blue_cube")


if __name__ == "__main__":
    rostest.rosrun("nao_library_tests", "things", Things)
