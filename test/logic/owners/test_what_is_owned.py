"""What a process owns, what a watch knows of it, and what has to be stopped when its owner dies."""

from __future__ import annotations

import json

import pytest
from set_clock import CalledClock

from nao_library_modules.core.process_owners import OwnershipTable, rules

STOP_WALK = ["ALMotion", "stopMove", []]


@pytest.fixture
def clock():
    return CalledClock(0.0)


@pytest.fixture
def table(clock):
    return OwnershipTable(clock)


def says(table, owner, *messages):
    table.receive(owner, b"".join(json.dumps(message).encode() + b"\n" for message in messages))


def holds(number, cure=STOP_WALK, seconds=0.0, since=0.0):
    return {"hold": number, "what": "walk", "cure": cure, "seconds": seconds, "since": since}


def lost(table, owner):
    return [json.loads(each.cure) for each in table.remove(owner)]


def test_what_a_dead_owner_held_is_stopped_once(table):
    say = ["ALTextToSpeech", "stopAll", []]
    says(table, 1, {"owner": "NaoMotion"}, holds(0), holds(1, say), holds(2))
    assert [each.owner for each in table.remove(1)] == ["NaoMotion", "NaoMotion"]
    assert table.remove(1) == []


def test_what_was_let_go_is_not_stopped(table):
    says(table, 1, holds(0), {"release": 0})
    assert lost(table, 1) == []


@pytest.mark.parametrize("heard", [(1, 2), (2, 1)], ids=["as it was", "by a new watch"])
def test_who_began_last_owns_a_walk(table, heard):
    for owner in heard:
        says(table, owner, holds(0, since=owner))
    assert lost(table, 1) == []
    assert lost(table, 2) == [STOP_WALK]


def test_a_walk_that_was_taken_from_another_is_stopped(table):
    says(table, 2, holds(0, since=1.0))
    says(table, 1, holds(0, since=2.0))
    assert lost(table, 1) == [STOP_WALK]


def test_a_target_is_stopped_as_long_as_it_may_be_on_its_way(table, clock):
    aim = ["ALMotion", "setAngles", [["HeadYaw"]]]
    says(table, 1, holds(0, aim, 30.0))
    says(table, 2, holds(0, aim, 20.0))
    clock.now = 25.0
    assert lost(table, 2) == []
    assert lost(table, 1) == [aim]


def test_a_message_comes_in_pieces(table):
    text = json.dumps(holds(0)).encode() + b"\n"
    table.receive(1, text[:7])
    table.receive(1, text[7:])
    assert lost(table, 1) == [STOP_WALK]


@pytest.mark.parametrize(
    "noise", [b"hello\n", b"[1]\n", b'{"hold": 1}\n', b"x" * 70000], ids=["words", "a list", "half", "no end"]
)
def test_noise_is_refused(table, noise):
    with pytest.raises((ValueError, KeyError)):
        table.receive(1, noise)


def test_rules_say_what_stops_a_call():
    def cure(module, method, *arguments):
        rule = rules()[module, method]
        return [*rule.cure, rule.cure_arguments(arguments)]

    assert cure("ALMotion", "moveTo", 1.0, 0.0, 0.0) == STOP_WALK
    kill = ["ALMotion", "killTasksUsingResources", [["HeadYaw"]]]
    assert cure("ALMotion", "angleInterpolation", "HeadYaw", 1.0, 1.0, True) == kill
    assert cure("ALBehaviorManager", "runBehavior", "dance") == ["ALBehaviorManager", "stopBehavior", ["dance"]]


def test_a_walk_without_speed_is_its_end():
    rule = rules()["ALMotion", "moveToward"]
    assert rule.stands_still([0.0, 0.0, 0.0, [["Frequency", 0.5]]])
    assert not rule.stands_still([0.0, 0.0, 0.1])
    assert not rules()["ALMotion", "setFootSteps"].stands_still([["LLeg"], [[0.0, 0.1, 0.0]], [0.5], False])
