"""A robot that stands on stiff legs in an empty room, and things in front of it."""

from __future__ import annotations

import json

import pytest

FACING = 3.14159


@pytest.fixture
def robot(stiff_robot):
    return stiff_robot


@pytest.fixture
def place(robot):
    """Puts a thing into the world that stays where it is, its picture towards the robot."""

    def put(name, x, y, z, **entry):
        thing = {"name": name, "position": [x, y, z], "mass": 0.0, **entry}
        if not {"ball", "rpy"} & set(entry):
            thing["heading"] = FACING
        robot.NaoSimulation.placeObject(json.dumps(thing))

    return put


class Witness:
    """Hears an event, in the thread that raises it."""

    def __init__(self, server, event):
        self.values, self.times, self._server = [], [], server
        server.memory.listen(event, self._hear)

    def _hear(self, value):
        self.values.append(value)
        self.times.append(self._server.simulation.time)

    @property
    def stamps(self):
        return [seconds + microseconds / 1e6 for (seconds, microseconds), *_ in filter(None, self.values)]


@pytest.fixture
def witness(robot):
    return lambda event: Witness(robot.server, event)
