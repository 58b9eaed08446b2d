#!/usr/bin/env python3
"""A simulator that is started with a world, friction, payload and imperfect sensors by its launch file."""

import unittest

import rostest
from PIL import Image

from nao_sim_bridge.testing import SimulatedRobot

ENCODER_STEP = 0.0015339808
PAYLOAD, WEIGHT = 0.5, 5.36
ANGLE = "Device/SubDeviceList/HeadYaw/Position/Sensor/Value"


class FurnishedWorld(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()

    def setUp(self):
        self.robot.reset()

    def test_the_things_of_the_world_are_there(self):
        poses = self.robot.module("NaoSimulation").objectPoses()
        self.assertEqual(set(poses), {"ball", "blue_cube", "green_can", "chair_left", "chair_right"})
        self.assertAlmostEqual(poses["ball"][2], 0.05, delta=0.005)

    def test_the_room_can_be_drawn(self):
        with Image.open(self.robot.picture("room", "room.png")) as picture:
            pixels = list(picture.convert("RGB").getdata())
        # The ball is the only thing of a saturated red.
        red = sum(r > 150 and g < 60 and b < 60 for r, g, b in pixels)
        self.assertGreater(red, 20)

    def test_the_feet_carry_the_payload_and_their_sensors_err(self):
        seen = []
        for _ in range(40):
            self.robot.advance(0.05)
            seen.append(sum(self.robot.value(f"{side}FootTotalWeight") for side in ("left", "right")))
        self.assertGreater(max(seen) - min(seen), 0.02)
        self.assertAlmostEqual(sum(seen) / len(seen), WEIGHT + PAYLOAD, delta=0.3)

    def test_encoders_have_steps_and_flicker(self):
        angles = set()
        for _ in range(20):
            self.robot.advance(0.02)
            angles.add(self.robot.value(ANGLE))
        self.assertGreater(len(angles), 1)
        for angle in angles:
            steps = angle / ENCODER_STEP
            self.assertAlmostEqual(steps, round(steps), delta=1e-3)


if __name__ == "__main__":
    rostest.rosrun("nao_library_tests", "furnished_world", FurnishedWorld)
