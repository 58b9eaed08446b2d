"""The ROS side as far as it goes without a master."""

from __future__ import annotations

import logging
import threading

import pytest
from diagnostic_updater import DiagnosticStatusWrapper

from nao_library_modules import diagnostics, ros_edge
from nao_library_modules.health import Level, Report


@pytest.mark.parametrize(
    "value, name",
    [
        (None, "null"),
        (True, "bool"),
        (7, "int"),
        (0.5, "float"),
        ("text", "string"),
        ([1, 2], "list"),
        ((1, 2), "list"),
        ({"a": 1}, "object"),
    ],
)
def test_types_of_events_are_those_of_json(value, name):
    assert ros_edge._json_type(value) == name


def test_events_are_published_with_name_value_and_type(monkeypatch):
    published = []

    class FakePublisher:
        def __init__(self, topic, message_type, queue_size):
            assert (topic, queue_size > 0) == ("memory_events", True)

        def publish(self, message):
            published.append(message)

    monkeypatch.setattr(ros_edge.rospy, "Publisher", FakePublisher)
    monkeypatch.setattr(ros_edge.rospy.Time, "now", lambda: ros_edge.rospy.Time(5))
    ros_edge.RosEdge().event_sink()("FrontTactilTouched", [1.0, "x"])
    (event,) = published
    assert (event.name, event.value, event.type) == ("FrontTactilTouched", '[1.0, "x"]', "list")
    assert event.header.stamp.to_sec() == 5.0


@pytest.mark.parametrize("level", [logging.DEBUG, logging.INFO, logging.WARNING, logging.ERROR, logging.CRITICAL])
def test_records_reach_the_log_of_the_node_at_their_level(level):
    heard = []

    class Listen(logging.Handler):
        def emit(self, record):
            heard.append((record.levelno, record.getMessage()))

    node_log = logging.getLogger("rosout")
    listen = Listen()
    node_log.addHandler(listen)
    before = node_log.level
    node_log.setLevel(logging.DEBUG)
    try:
        record = logging.LogRecord("naoqi", level, __file__, 1, "100 %% of %s", ("calls",), None)
        ros_edge.RosoutHandler().emit(record)
    finally:
        node_log.removeHandler(listen)
        node_log.setLevel(before)
    assert heard == [(level, "100 % of calls")]


def test_reports_become_diagnostics_once_and_again_until_closed(monkeypatch):
    statuses = []
    twice = threading.Event()

    class FakeUpdater:
        def __init__(self):
            self.tasks = {}

        def setHardwareID(self, hardware_id):
            self.hardware_id = hardware_id

        def add(self, name, run):
            self.tasks[name] = run

        def force_update(self):
            for name, run in self.tasks.items():
                statuses.append((self.hardware_id, name, run(DiagnosticStatusWrapper())))
            if len(statuses) >= 2:
                twice.set()

    monkeypatch.setattr(diagnostics, "Updater", FakeUpdater)
    monkeypatch.setattr(diagnostics, "PERIOD", 0.001)
    report = Report(Level.WARN, "connected, but slow", {"latency (ms)": "800.0"})
    publisher = diagnostics.DiagnosticsPublisher("10.0.0.7:9559", {"robot": lambda: report})
    assert twice.wait(5.0)
    publisher.close()
    publisher._thread.join(5.0)
    assert not publisher._thread.is_alive()
    hardware_id, name, status = statuses[0]
    assert (hardware_id, name) == ("10.0.0.7:9559", "robot")
    assert (status.level, status.message) == (1, "connected, but slow")
    assert [(v.key, v.value) for v in status.values] == [("latency (ms)", "800.0")]
