"""The ROS side as far as it goes without a master: events, logs, diagnostics, frames of /tf."""

from __future__ import annotations

import math
import queue
import time
from contextlib import nullcontext
from unittest.mock import Mock

import actionlib.msg
import pytest
import rospy
import tf2_ros
from actionlib_msgs.msg import GoalID, GoalStatus
from diagnostic_updater import DiagnosticStatusWrapper
from geometry_msgs.msg import TransformStamped

from nao_library_modules.core.health import Level, Report
from nao_library_modules.ros import diagnostics, server_node, time_and_frames
from nao_library_modules.ros.action_server import ActionServer, Results, can_have_noted, unless_closed
from naoqi.errors import NaoError


def test_events_are_published_with_name_value_and_type(monkeypatch):
    published = []

    class Publisher:
        def __init__(self, topic, message_type, queue_size):
            assert (topic, queue_size > 0) == ("memory_events", True)
            self.publish = published.append

    monkeypatch.setattr(server_node.rospy, "Publisher", Publisher)
    monkeypatch.setattr(server_node.rospy.Time, "now", lambda: server_node.rospy.Time(5))
    tell = server_node.ServerNode().event_sink()
    types = {
        "null": None, "bool": True, "int": 7, "float": 0.5, "string": "text", "list": [1.0, "x"], "object": {"a": 1},
    }  # fmt: skip
    for value in (*types.values(), (1, 2)):
        tell("FrontTactilTouched", value)
    assert [event.type for event in published] == [*types, "list"]
    event = published[5]
    assert (event.name, event.value, event.header.stamp.to_sec()) == ("FrontTactilTouched", '[1.0, "x"]', 5.0)


def test_a_report_that_fails_is_told_of_and_the_others_are_published_all_the_same(monkeypatch):
    published, shut_down = queue.Queue(), [rospy.ROSException("publish() to a closed topic")]

    class Updater:
        def __init__(self):
            self.tasks = {}
            self.setHardwareID, self.add = lambda _: None, self.tasks.__setitem__

        def force_update(self):
            if shut_down:
                raise shut_down.pop()
            statuses = {name: task(DiagnosticStatusWrapper()) for name, task in self.tasks.items()}
            published.put({name: (status.level, status.message) for name, status in statuses.items()})

    monkeypatch.setattr(diagnostics, "Updater", Updater)
    monkeypatch.setattr(diagnostics, "PERIOD", 0.001)
    reports = {"broken": lambda: {}["battery"], "well": lambda: Report(Level.OK, "runs")}
    publisher = diagnostics.DiagnosticsPublisher("127.0.0.1:9559", reports)
    expected = {"broken": (2, "there is no report: KeyError('battery')"), "well": (0, "runs")}
    assert published.get(timeout=60.0) == published.get(timeout=60.0) == expected
    publisher.close()


@pytest.mark.parametrize("ends", [True, False])
def test_the_status_of_goals_that_comes_when_the_topics_are_closed_is_no_error(monkeypatch, ends):
    def publish():
        raise rospy.ROSException("publish() to a closed topic")

    monkeypatch.setattr(rospy.core, "is_shutdown_requested", lambda: ends)
    with nullcontext() if ends else pytest.raises(rospy.ROSException):
        unless_closed(publish)


def test_the_status_waits_until_the_client_of_the_newest_goal_can_have_noted_it(monkeypatch):
    published = queue.Queue()
    monkeypatch.setattr(actionlib.ActionServer, "publish_status", lambda _: published.put(time.monotonic()))
    server = ActionServer("test", actionlib.msg.TestAction, lambda goal: None, auto_start=False, soonest=0.04)
    server.result_pub = Mock()  # not started, it has no topics
    server.publish_status()
    assert published.qsize() == 1, "with no goal there is nothing to wait for"
    published.get()
    came = time.monotonic()
    server.internal_goal_callback(actionlib.msg.TestActionGoal())
    for _ in range(3):
        server.publish_status()
    assert published.get(timeout=60.0) >= came + 0.04
    assert published.empty(), "three that came in the meantime are one"


@pytest.mark.parametrize("node, noted", [("/client", True), ("/other", False)])
def test_a_client_that_cancels_its_goal_has_noted_it(node, noted):
    server = ActionServer("test", actionlib.msg.TestAction, lambda goal: None, auto_start=False, soonest=60.0)
    server.register_cancel_callback(lambda goal: None)
    server.result_pub, goal = Results(Mock()), actionlib.msg.TestActionGoal(goal_id=GoalID(id="goal"))
    goal._connection_header = {"callerid": "/client"}
    server.internal_goal_callback(goal)
    came = server.came(goal.goal_id)
    assert not can_have_noted(came, 60.0)
    cancel = GoalID(id="goal")
    cancel._connection_header = {"callerid": node}
    server.internal_cancel_callback(cancel)
    assert can_have_noted(server.came(cancel), 60.0) is noted


def test_the_result_of_a_goal_is_published_before_the_status_with_its_end(monkeypatch):
    told = queue.Queue()
    for name in ("publish_result", "publish_status"):
        monkeypatch.setattr(actionlib.ActionServer, name, lambda *_, name=name: told.put((name, time.monotonic())))
    server = ActionServer("test", actionlib.msg.TestAction, lambda goal: None, auto_start=False)
    server.publish_result(GoalStatus(), None)
    server.publish_status()  # as actionlib's timer does
    (first, result), (second, status) = told.get(timeout=60.0), told.get(timeout=60.0)
    assert (first, second) == ("publish_result", "publish_status")
    assert status - result >= 0.01


# Frames


class Buffer(tf2_ros.BufferCore):
    """A buffer that is filled by hand, and waits for nothing."""

    def __init__(self):
        super().__init__(rospy.Duration(10))
        for child, x, y, turn in (("base_footprint", 1.0, 0.0, math.pi / 2), ("table", 1.0, 0.6, math.pi)):
            stamped = TransformStamped()
            stamped.header.frame_id, stamped.child_frame_id, stamped.header.stamp = "odom", child, rospy.Time(1)
            stamped.transform.translation.x, stamped.transform.translation.y = x, y
            stamped.transform.rotation.z, stamped.transform.rotation.w = math.sin(turn / 2), math.cos(turn / 2)
            self.set_transform(stamped, "test")

    def lookup_transform(self, target, source, time, patience):
        return self.lookup_transform_core(target, source, time)


@pytest.fixture
def frames(monkeypatch):
    monkeypatch.setattr(time_and_frames.tf2_ros, "TransformListener", lambda buffer: None)
    monkeypatch.setattr(time_and_frames.tf2_ros, "Buffer", Buffer)
    monkeypatch.setattr(time_and_frames.rospy, "search_param", lambda name: None)
    return time_and_frames.RobotFrames()


def test_a_frame_is_seen_from_the_robot(frames):
    assert frames.locate("table") == pytest.approx((0.6, 0.0, math.pi / 2))
    assert frames.locate("/odom") == pytest.approx((0.0, 1.0, -math.pi / 2))
    with pytest.raises(NaoError, match="the frame chair cannot be found from base_footprint"):
        frames.locate("chair")
