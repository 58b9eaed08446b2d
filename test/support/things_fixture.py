"""What scenarios with things to see share: placing them, and where they really are, seen from the robot."""

from __future__ import annotations

import json
import math

import numpy as np
from camera_fixture import matrix

TORSO, ROBOT = 0, 2
"""NAOqi's frames."""
FACING = math.pi
"""Heading of a card or a person ahead of the robot that looks back at it, rad."""


class Things:
    """Things in the world of the simulated robot.

    Args:
        robot: The SimulatedRobot.
    """

    def __init__(self, robot) -> None:
        self._robot = robot
        self._simulation = robot.module("NaoSimulation")
        self._motion = robot.module("ALMotion")

    def place(self, name: str, position, heading: float = 0.0, **entry) -> np.ndarray:
        """Add a thing at a place of the world, m, rad; what it is as in a world file. Answers the place."""
        entry.update(name=name, position=[float(value) for value in position], rpy=[0.0, 0.0, float(heading)])
        self._simulation.placeObject(json.dumps(entry))
        return np.asarray(position, dtype=float)

    def in_base(self, place) -> np.ndarray:
        """A place of the world in NAOqi's FRAME_ROBOT, m, as it really is."""
        base = self._torso_in_world() @ np.linalg.inv(self._transform("Torso", ROBOT))
        return (np.linalg.inv(base) @ [*place, 1.0])[:3]

    def in_camera(self, place, camera: str = "CameraTop") -> np.ndarray:
        """A place of the world in the frame of a camera, m: X along its axis, Y left, Z up, as it really is."""
        pose = self._torso_in_world() @ self._transform(camera, TORSO)
        return (np.linalg.inv(pose) @ [*place, 1.0])[:3]

    def _torso_in_world(self) -> np.ndarray:
        pose = self._robot.true_pose()
        return matrix(pose.position, pose.orientation)

    def _transform(self, name: str, frame: int) -> np.ndarray:
        return np.array(self._motion.getTransform(name, frame, True)).reshape(4, 4)
