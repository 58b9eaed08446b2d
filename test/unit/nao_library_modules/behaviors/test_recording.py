"""Recordings: goals with their times become a timeline that sends them again."""

from __future__ import annotations

import pytest
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoLedGoal, NaoMotionGoal
from nao_library_modules.behaviors import bind, from_goal, read
from nao_library_modules.behaviors.program import Goal, walk
from nao_library_modules.behaviors.recording import Recording
from nao_library_modules.behaviors.servers import NAMES
from nao_library_modules.behaviors.writer import text_of
from nao_library_modules.errors import BadGoal
from nao_library_msgs.msg import LedFunction, MotionFunction

RED = NaoLedGoal([LedFunction(function="setColor", lights=["FaceLeds"], str_param="${red}")])
MOVE = NaoMotionGoal(
    [MotionFunction(function="setAngles", names=["HeadYaw"], angles=[0.1]), MotionFunction(function="stopMove")]
)


def goals(text):
    program = bind(read(text, "test"), {}, lambda name: None)
    return [node for node in walk(program) if isinstance(node, Goal)]


def fine(step):
    """Everything may be stored."""


@pytest.mark.parametrize(("server", "goal"), [("NaoLights", RED), ("NaoMotion", MOVE)])
def test_a_goal_becomes_a_behaviour_that_sends_it(server, goal):
    (node,) = goals(from_goal(server, goal))
    assert (node.server, node.goal) == (server, goal)


def test_the_last_lines_of_a_goal_have_no_name_for_a_function_are_chains():
    odd = NaoLedGoal([LedFunction(function="no name")])
    (node,) = goals(from_goal("NaoLights", odd))
    assert node.goal == odd


def test_a_server_that_behaviours_cannot_use_is_refused():
    with pytest.raises(BadGoal, match="there is no server"):
        from_goal("NaoSmell", RED)


def test_goals_come_again_at_their_times():
    recording = Recording("x", NAMES)
    recording.sent("NaoMotion", "2", MOVE, 101.5)
    recording.sent("NaoLights", "1", RED, 100.25)
    recording.ended("1", GoalStatus.SUCCEEDED, 100.5)
    entries, left_out = recording.timeline(fine)
    assert left_out == []
    assert [entry["at"] for entry in entries] == [0.0, 1.25]
    assert [node.goal for node in goals(text_of("x", [{"timeline": entries}]))] == [RED, MOVE]


def test_goals_that_were_cut_short_are_so_again():
    recording = Recording("x", NAMES)
    recording.sent("NaoLights", "1", RED, 10.0)
    recording.sent("NaoLights", "2", RED, 12.0)
    recording.ended("1", GoalStatus.PREEMPTED, 12.1)
    recording.sent("NaoMotion", "3", MOVE, 12.0)
    recording.ended("3", GoalStatus.PREEMPTED, 12.5)
    recording.ended("2", GoalStatus.ABORTED, 13.0)
    entries, _ = recording.timeline(fine)
    # The first was replaced by the second: it goes when that one comes, not when it was over.
    assert [entry.get("for") for entry in entries] == [2.0, None, 0.5]
    assert [entry.get("on_error") for entry in entries] == [None, "skip", None]


def test_what_cannot_be_stored_is_left_out_and_told():
    recording = Recording("x", NAMES)
    recording.sent("NaoLights", "1", RED, 1.0)
    recording.sent("NaoMotion", "2", MOVE, 1.5)

    def check(step):
        if "chain" in step:
            raise BadGoal("function", "setAngles", "nothing")

    entries, left_out = recording.timeline(check)
    assert len(entries) == 1
    (text,) = left_out
    assert "NaoMotion at 0.500 s" in text and "setAngles" in text


def test_only_the_servers_that_were_named_count():
    recording = Recording("x", ["NaoMotion"])
    recording.sent("NaoLights", "1", RED, 1.0)
    with pytest.raises(BadGoal, match="nothing was sent"):
        recording.timeline(fine)
