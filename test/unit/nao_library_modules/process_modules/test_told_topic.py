"""A topic whose first message waits for those who listen: what is connected, and what the master knows."""

from __future__ import annotations

import pytest

from nao_library_modules.process_modules import told_topic
from nao_library_modules.process_modules.told_topic import OTHERS_LIMIT, PERIOD, ToldTopic

LIMIT = 10.0


class World:
    """Listeners that connect after a while, and what the master knows of them.

    Attributes:
        connects_at: Time at which each listener is connected, s.
        known: How many the master knows.
        now: Time, s.
        told: Messages, each with the number of those who got it.
    """

    def __init__(self):
        self.connects_at, self.known, self.now, self.told = [], 1, 0.0, []
        self.resolved_name = "/speech"

    def get_num_connections(self):
        return sum(at <= self.now for at in self.connects_at)

    def publish(self, message):
        self.told.append((message, self.get_num_connections()))

    def getSystemState(self):  # noqa: N802  the master's name for it
        return [], [["/other", ["/x"] * 9], ["/speech", [f"/node{i}" for i in range(self.known)]]], []

    def sleep(self, duration):
        self.now += duration


@pytest.fixture
def world(monkeypatch):
    world = World()
    monkeypatch.setattr(told_topic, "sleep", world.sleep)
    monkeypatch.setattr(told_topic.rospy, "Publisher", lambda *arguments, **options: world)
    monkeypatch.setattr(told_topic.rospy, "get_name", lambda: "/plan")
    monkeypatch.setattr(told_topic.rosgraph, "Master", lambda name: world)
    return world


def test_the_first_message_reaches_all_who_listen(world):
    world.connects_at, world.known = [0.1, 1.0], 2
    assert ToldTopic("speech", str).tell("hello", LIMIT)
    assert world.told == [("hello", 2)]
    assert world.now == pytest.approx(1.0, abs=PERIOD)


def test_one_that_the_master_knows_and_that_never_connects_is_not_waited_for_long(world):
    world.connects_at, world.known = [0.0], 2
    topic = ToldTopic("speech", str)
    assert topic.tell("hello", LIMIT)
    assert world.now == pytest.approx(OTHERS_LIMIT, abs=2 * PERIOD)
    assert topic.tell("again", LIMIT)
    assert world.now == pytest.approx(OTHERS_LIMIT, abs=2 * PERIOD)
    assert world.told == [("hello", 1), ("again", 1)]


def test_nobody_is_told_when_nobody_listens(world):
    assert not ToldTopic("speech", str).tell("hello", LIMIT)
    assert world.told == [] and world.now == pytest.approx(LIMIT, abs=2 * PERIOD)


def test_a_topic_that_the_master_does_not_know_yet_counts_those_who_are_connected(world):
    world.connects_at, world.known = [0.0], 0
    assert ToldTopic("speech", str).tell("hello", LIMIT)
    assert (world.told, world.now) == ([("hello", 1)], 0.0)
