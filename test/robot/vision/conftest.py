"""NaoVision on the simulated robot."""

from __future__ import annotations

import json
import math
from types import SimpleNamespace

import numpy as np
import pytest
from camera_topics import BOTTOM, TOP, Topics, numbered_image

TORSO, ROBOT = 0, 2
"""NAOqi's frames."""


@pytest.fixture
def topics():
    return Topics()


@pytest.fixture
def vision(goals_to, topics, tmp_path):
    from nao_library_actions.msg import NaoVisionGoal
    from nao_library_modules.vision import NaoVision

    goals = goals_to(NaoVision, NaoVisionGoal, topics=topics, record_dir=str(tmp_path / "files"))
    yield goals
    goals.module.jobs.close()


@pytest.fixture
def camera(robot, topics):
    """Both cameras send a numbered frame every 0.1 s of simulated time; `numbers` relates stamps to them."""
    numbers = {}

    def look(snapshot):
        if round(snapshot.time * 1000) % 100 < 1000 * robot.server.simulation.settings.tick_s:
            number = len(numbers) + 1
            numbers[round(snapshot.time, 6)] = number
            for topic in (TOP, BOTTOM):
                topics.send(topic, numbered_image(number % 256, snapshot.time))

    robot.server.simulation.after_tick.append(look)
    yield SimpleNamespace(numbers=numbers)
    robot.server.simulation.after_tick.remove(look)


def _matrix(position, orientation):
    x, y, z, w = orientation
    rotation = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = rotation, position
    return pose


class Things:
    """Things in the world, and where they really are, seen from the robot; m, rad."""

    facing = math.pi
    """Heading of a card or a person ahead of the robot that looks back at it."""

    def __init__(self, robot):
        self._robot = robot

    def place(self, name, position, heading=0.0, **entry):
        entry.update(name=name, position=[float(value) for value in position], rpy=[0.0, 0.0, float(heading)])
        self._robot.NaoSimulation.placeObject(json.dumps(entry))
        return np.asarray(position, dtype=float)

    def move(self, name, position, heading=0.0, duration=0.0):
        """Move a thing; the future of its arrival."""
        arguments = [float(value) for value in position], [0.0, 0.0, float(heading)], float(duration)
        return self._robot.post("NaoSimulation", "moveObject", name, *arguments)

    def remove(self, name):
        self._robot.NaoSimulation.removeObject(name)

    def in_base(self, place):
        """A place of the world in NAOqi's FRAME_ROBOT."""
        base = self._torso() @ np.linalg.inv(self._transform("Torso", ROBOT))
        return (np.linalg.inv(base) @ [*place, 1.0])[:3]

    def in_camera(self, place, camera="CameraTop"):
        """A place of the world in the frame of a camera: X along its axis, Y left, Z up."""
        return (np.linalg.inv(self._torso() @ self._transform(camera, TORSO)) @ [*place, 1.0])[:3]

    def from_camera(self, ahead, left=0.0, up=0.0, camera="CameraTop"):
        """A place in the world from one in the frame of a camera."""
        return (self._torso() @ self._transform(camera, TORSO) @ [ahead, left, up, 1.0])[:3]

    def _torso(self):
        torso = self._robot.now.torso
        return _matrix(torso.position, torso.orientation)

    def _transform(self, name, frame):
        return np.array(self._robot.ALMotion.getTransform(name, frame, True)).reshape(4, 4)


@pytest.fixture
def things(robot):
    """A stiff robot in an empty world, to which things are added."""
    robot.ALMotion.setStiffnesses("Body", 1.0)
    robot.ALMotion.setAngles(["HeadYaw", "HeadPitch"], [0.0, 0.0], 1.0)
    robot.advance(0.5)
    return Things(robot)
