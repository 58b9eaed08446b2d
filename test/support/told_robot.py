"""A robot whose states a test tells: its topics and its memory, without ROS."""

from __future__ import annotations

import threading
from types import SimpleNamespace

from nao_library_modules.console.view.robot_state import FALLEN, FAMILY, POSTURE, BodyWatch
from nao_library_modules.console.view.senses import SENTENCE, SETTLED
from nao_library_modules.core.health import Thresholds, body_reports
from nao_library_modules.studies.robot_events import EventStream

ADDRESS = "127.0.0.1:9559"
LIMIT = 60.0
"""s of this computer that anything may take."""


class ToldRobot:
    """A robot and its memory without ROS. A test tells what topics and keys have; `keys`: what the memory holds.

    Whoever begins to listen is told the present value first, and so is everybody behind `restart`.
    """

    name = namespace = "/"

    def __init__(self, **keys):
        self.time = 0.0
        self.events = EventStream("/", lambda: self.time)
        self.keys = {FAMILY: "Standing", POSTURE: "Stand", **keys}
        self.latched = {}
        self.callbacks = {}
        self.links = {}
        self.all_there = threading.Event()

    def clock(self):
        return self.time

    def topic(self, name, kind, callback, queue_size=1):
        self.callbacks[name] = callback
        if name in self.latched:
            callback(self.latched[name])
        return lambda: self.callbacks.pop(name, None)

    def watch(self, key, kind, callback):
        self.callbacks[key] = callback
        self.links[key] = object()
        self.repeat(key)
        self.all_there.set()
        return lambda: self.callbacks.pop(key, None)

    def watch_last(self, key, last, callback):
        last.held = key in self.keys
        return self.watch(key, "string", callback)

    def repeat(self, key):
        if key in self.keys:
            header = SimpleNamespace(stamp=SimpleNamespace(to_sec=lambda: self.time))
            link = self.links[key]
            self.callbacks[key](SimpleNamespace(data=self.keys[key], header=header, _connection_header=link))

    def tell(self, key, value):
        self.keys[key] = value
        self.repeat(key)

    def stand(self, on_ground):
        self.latched["foot_contact"] = SimpleNamespace(data=on_ground)
        self.callbacks["foot_contact"](self.latched["foot_contact"])

    def connect(self, state):
        self.callbacks["connection"](SimpleNamespace(state=state, address=ADDRESS, last_error=""))

    def restart(self, driver=False):
        """The robot, or its driver, is gone for a moment: each state is told again."""
        self.connect("lost")
        if driver:
            self.links = {key: object() for key in self.links}
        for key in (FALLEN, SENTENCE, FAMILY, POSTURE):
            if key in self.callbacks:
                self.repeat(key)
        self.connect("connected")
        self.time += SETTLED + 1.0

    def report(self, *statuses):
        self.callbacks["/diagnostics"](SimpleNamespace(status=statuses))

    @property
    def texts(self):
        return [event.text for event in self.events.last()]


def watched(robot):
    """The state of a robot, followed."""
    body = BodyWatch(robot, robot, robot.clock)
    body.acquire()
    wait_for(robot, FALLEN)
    robot.connect("connected")
    return body


def wait_for(robot, key):
    for _ in iter(lambda: key in robot.callbacks, True):
        assert robot.all_there.wait(LIMIT)
        robot.all_there.clear()


def status(name, level=0, message="", hardware=ADDRESS, **values):
    pairs = [SimpleNamespace(key=key, value=value) for key, value in values.items()]
    return SimpleNamespace(name=name, level=level, message=message, hardware_id=hardware, values=pairs)


def reported(stiffness=1.0, charge=0.8, temperature=30.0, stale=False):
    """What the driver tells of a robot of one joint."""
    keys = {"Hardness/Actuator": stiffness, "Temperature/Sensor": temperature}
    values = {f"Device/SubDeviceList/HeadYaw/{key}/Value": value for key, value in keys.items()}
    values["Device/SubDeviceList/Battery/Charge/Sensor/Value"] = charge
    reports = body_reports(["HeadYaw"], values, Thresholds())
    return [status(name, 3 if stale else int(r.level), r.message, **r.values) for name, r in reports.items()]
