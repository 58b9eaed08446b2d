"""Stand-ins for a robot that feels. What touches it is told by the test, through the events of the memory."""

from __future__ import annotations

import threading

from fake_hearing import FakeExtractor

from nao_library_modules.tactile_names import SENSORS
from naoqi.errors import NaoError

DEVICE = "Device/SubDeviceList/{}/Sensor/Value"
CHAINS = {"Head": ["HeadYaw", "HeadPitch"], "Body": ["HeadYaw", "HeadPitch", "RHand"]}


class FakeBody:
    """ALMotion, as far as it knows its joints."""

    def getBodyNames(self, chain):
        return CHAINS[chain]


class Skin:
    """What there is to be felt of one robot."""

    def __init__(self, robot):
        self.memory = robot.memory
        self.sonar = FakeExtractor()
        robot.add("ALSonar", self.sonar)
        robot.add("ALMotion", FakeBody())
        self.touch(False, *[sensor.name for sensor in SENSORS])

    def touch(self, pressed, *names):
        """Press sensors or let them go, and tell who has subscribed."""
        for sensor in SENSORS:
            if sensor.name in names:
                self.memory.data[DEVICE.format(sensor.devices[0])] = float(pressed)
                self.memory.data.update({DEVICE.format(device): 0.0 for device in sensor.devices[1:]})
                if sensor.event in self.memory.signals:
                    self.memory.signals[sensor.event](float(pressed))

    def set(self, **values):
        """Values of devices, with _ for /."""
        self.memory.data.update({DEVICE.format(name.replace("_", "/")): value for name, value in values.items()})

    def raise_event(self, name, value=None):
        self.memory.signals[name](value)

    def idle(self):
        """Nobody measures, no event is subscribed."""
        assert self.sonar.subscribers == []
        assert not any(signal.links for signal in self.memory.signals.values())
        return True


class FakeRunner:
    """Runs behaviours as long as the test wants.

    Attributes:
        runs: (behaviour, parameters) of each, in the order in which they were started.
        started: Set at each start.
        broken: Whether there is no server.
    """

    def __init__(self):
        self.runs = []
        self.ends = []
        self.started = threading.Event()
        self.broken = self.closed = False

    def run(self, behavior, parameters, done):
        if self.broken:
            self.started.set()
            raise NaoError("there is no server")
        self.runs.append((behavior, list(parameters)))
        self.ends.append(done)
        self.started.set()

    def wait(self):
        """Wait for the next start."""
        assert self.started.wait(5.0), "nothing was started"
        self.started.clear()

    def close(self):
        self.closed = True
