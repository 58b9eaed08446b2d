"""What scenarios with things to see share: placing them, and where they really are, seen from the robot."""

from __future__ import annotations

import json
import math

import numpy as np
from sound_fixture import quaternion_matrix

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

    def move(self, name: str, position, heading: float = 0.0, duration: float = 0.0):
        """Move a thing; the future of its arrival."""
        return self._simulation.moveObject(
            name, [float(value) for value in position], [0.0, 0.0, float(heading)], float(duration), _async=True
        )

    def remove(self, name: str) -> None:
        """Take a thing away."""
        self._simulation.removeObject(name)

    def in_base(self, place) -> np.ndarray:
        """A place of the world in NAOqi's FRAME_ROBOT, m, as it really is."""
        base = self._torso_in_world() @ np.linalg.inv(self._transform("Torso", ROBOT))
        return (np.linalg.inv(base) @ [*place, 1.0])[:3]

    def in_camera(self, place, camera: str = "CameraTop") -> np.ndarray:
        """A place of the world in the frame of a camera, m: X along its axis, Y left, Z up, as it really is."""
        pose = self._torso_in_world() @ self._transform(camera, TORSO)
        return (np.linalg.inv(pose) @ [*place, 1.0])[:3]

    def from_camera(self, ahead: float, left: float = 0.0, up: float = 0.0, camera: str = "CameraTop") -> np.ndarray:
        """A place in the world, m, from one in the frame of a camera."""
        return (self._torso_in_world() @ self._transform(camera, TORSO) @ [ahead, left, up, 1.0])[:3]

    def _torso_in_world(self) -> np.ndarray:
        pose = self._robot.true_pose()
        torso = quaternion_matrix([getattr(pose.orientation, axis) for axis in "xyzw"])
        torso[:3, 3] = [getattr(pose.position, axis) for axis in "xyz"]
        return torso

    def _transform(self, name: str, frame: int) -> np.ndarray:
        return np.array(self._motion.getTransform(name, frame, True)).reshape(4, 4)


def point(message) -> np.ndarray:
    """(3,) of a geometry_msgs/Point."""
    return np.array([message.x, message.y, message.z])


def angle_between(first, second) -> float:
    """Angle between two vectors, rad."""
    cosine = np.dot(first, second) / np.linalg.norm(first) / np.linalg.norm(second)
    return float(np.arccos(np.clip(cosine, -1.0, 1.0)))
