"""A robot with a head and a hand, whose motions end when the test says so."""

from __future__ import annotations

import threading
import time
from types import SimpleNamespace

import pytest
from fake_proxy import FakeProxy

from naoqi.errors import RobotError

JOINTS = ("HeadYaw", "HeadPitch", "LHand")


class FakeMotion:
    """ALMotion of three joints. Interpolations are pending until the test ends them."""

    def __init__(self, make_call):
        self._make_call = make_call
        self.angles = dict.fromkeys(JOINTS, 0.25)
        self.stiffnesses = dict.fromkeys(JOINTS, 0.5)
        self.pending = []

    def getBodyNames(self, name):
        chains = {"Body": JOINTS, "Head": JOINTS[:2]}
        if name not in chains:
            raise RobotError("ALMotion", "getBodyNames", f"no chain {name}")
        return list(chains[name])

    def getAngles(self, names, use_sensors):
        return [self.angles[name] for name in names]

    def getStiffnesses(self, names):
        return [self.stiffnesses[name] for name in names]

    def setAngles(self, names, angles, speed):
        self.angles.update(zip(names, angles))

    def changeAngles(self, names, changes, speed):
        self.angles.update({name: self.angles[name] + change for name, change in zip(names, changes)})

    def setStiffnesses(self, names, stiffnesses):
        self.stiffnesses.update(zip(names, stiffnesses))

    def killTasksUsingResources(self, names):
        for call in self.pending:
            call.end()

    def _slow(self, *_):
        call = self._make_call()
        self.pending.append(call)
        return call

    angleInterpolation = _slow
    angleInterpolationBezier = _slow
    angleInterpolationWithSpeed = _slow
    stiffnessInterpolation = _slow


@pytest.fixture
def motion(make_call):
    return FakeMotion(make_call)


@pytest.fixture
def proxy(motion, make_call):
    return FakeProxy(motion, make_call)


@pytest.fixture
def robot(proxy):
    connection = SimpleNamespace(generation=1, state="connected")
    return SimpleNamespace(address="nao:9559", connection=connection, proxy={"ALMotion": proxy}.__getitem__)


@pytest.fixture
def eventually():
    """Waits for a condition that another thread brings about."""

    def wait(condition, limit=5.0):
        pause, deadline = threading.Event(), time.monotonic() + limit
        while not condition():
            assert time.monotonic() < deadline, "it did not come about"
            pause.wait(0.001)

    return wait
