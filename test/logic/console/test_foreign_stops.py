"""Stops of other programs, heard by who runs a trial."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
import rospy
from actionlib_msgs.msg import GoalID

from nao_library_modules.console.robots.robot_client import RobotClient
from nao_library_modules.console.robots.robot_goals import hear_stops


@pytest.fixture
def robot(monkeypatch):
    """A client whose topics give what they would call."""
    monkeypatch.setattr(rospy, "get_time", lambda: 1.0)
    monkeypatch.setattr(rospy, "get_name", lambda: "/nao_cli/run")
    client = RobotClient("/nao/", SimpleNamespace())
    topics = {}
    monkeypatch.setattr(client, "topic", lambda name, kind, callback, queue_size: topics.update({name: callback}))
    hear_stops(client)
    ((client.cancelled, client.take),) = topics.items()
    return client


def cancel(sender, **fields):
    message = GoalID(**fields)
    message._connection_header = {"callerid": sender}
    return message


def test_a_cancel_of_all_goals_is_a_stop_of_its_sender(robot):
    robot.take(cancel("/nao_console"))
    (event,) = robot.events.last()
    assert (robot.stops, event.kind, event.by) == (1, "stopped", "/nao_console")


def test_the_topic_is_no_one_of_an_action_whose_server_could_miss_the_cancel(robot):
    assert robot.cancelled == "nao_cli_run/cancel"


@pytest.mark.parametrize(
    "message",
    [cancel("/nao_cli/run"), cancel("/nao_console", id="one"), cancel("/nao_console", stamp=rospy.Time(5))],
    ids=["its own", "of one goal", "of goals before a time"],
)
def test_other_cancels_are_none(robot, message):
    robot.take(message)
    assert (robot.stops, robot.events.last()) == (0, [])
