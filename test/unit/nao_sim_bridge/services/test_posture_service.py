"""ALRobotPosture over the network: changes of posture, what they answer, and the events about them."""

from __future__ import annotations

import pytest

NAMES = ["Crouch", "LyingBack", "LyingBelly", "Sit", "SitRelax", "Stand", "StandInit", "StandZero"]
FAMILIES = [
    "Standing",
    "Crouching",
    "Sitting",
    "SittingOnChair",
    "LyingBelly",
    "LyingBack",
    "LyingLeft",
    "LyingRight",
]


@pytest.fixture(autouse=True)
def three_tries(robot):
    yield
    robot.ALRobotPosture.setMaxTryNumber(3)


def test_the_lists_are_those_of_the_robot(robot):
    assert robot.ALRobotPosture.getPostureList() == NAMES
    assert robot.ALRobotPosture.getPostureFamilyList() == FAMILIES


def test_it_goes_to_a_posture(stiff_robot):
    assert stiff_robot.finish("ALRobotPosture", "goToPosture", "Crouch", 1.0, after=3.0) is True
    assert stiff_robot.ALRobotPosture.getPosture() == "Crouch"
    assert stiff_robot.ALRobotPosture.getPostureFamily() == "Crouching"


def test_going_to_a_posture_wakes_the_robot(robot):
    assert robot.ALMotion.robotIsWakeUp() is False
    assert robot.finish("ALRobotPosture", "goToPosture", "StandInit", 1.0, after=3.0) is True
    assert robot.ALMotion.robotIsWakeUp() is True
    assert robot.ALMotion.getStiffnesses("Body") == [1.0] * 26


def test_a_robot_that_was_pushed_over_gets_up(stiff_robot):
    stiff_robot.server.push([60.0, 0.0, 0.0], 0.2, "torso")
    stiff_robot.advance(2.5)
    assert stiff_robot.ALRobotPosture.getPostureFamily() == "LyingBelly"
    assert stiff_robot.finish("ALRobotPosture", "goToPosture", "Stand", 1.0, after=15.0) is True
    assert stiff_robot.ALRobotPosture.getPosture() == "Stand"


def test_a_change_is_a_task_of_almotion(stiff_robot):
    future = stiff_robot.post("ALRobotPosture", "goToPosture", "Crouch", 0.5)
    stiff_robot.handed_over("ALRobotPosture")
    stiff_robot.advance(0.5)
    assert [name for name, _ in stiff_robot.ALMotion.getTaskList()] == ["goToPosture"]
    stiff_robot.ALMotion.killAll()
    assert stiff_robot.answer(future) is False


def test_stop_move_ends_a_change(stiff_robot):
    future = stiff_robot.post("ALRobotPosture", "goToPosture", "Crouch", 0.3)
    stiff_robot.handed_over("ALRobotPosture")
    stiff_robot.advance(1.0)
    stiff_robot.ALRobotPosture.stopMove()
    assert stiff_robot.answer(future) is False
    before = stiff_robot.ALMotion.getAngles("Body", False)
    stiff_robot.advance(1.0)
    assert stiff_robot.ALMotion.getAngles("Body", False) == before


def test_stop_move_stops_nothing_when_nothing_moves(robot):
    assert robot.ALRobotPosture.stopMove() is None


def test_a_cancelled_change_ends(stiff_robot):
    future = stiff_robot.post("ALRobotPosture", "goToPosture", "Crouch", 0.3)
    stiff_robot.handed_over("ALRobotPosture")
    stiff_robot.advance(1.0)
    future.cancel()
    stiff_robot.handed_over("ALRobotPosture")
    assert stiff_robot.ALMotion.getTaskList() == []
    assert future.wait(5000) and future.isCanceled()


def test_a_motion_of_its_own_gives_way(stiff_robot):
    older = stiff_robot.post("ALMotion", "angleInterpolation", ["HeadYaw"], [1.0], 5.0, True)
    stiff_robot.handed_over("ALMotion")
    stiff_robot.advance(0.5)
    assert stiff_robot.finish("ALRobotPosture", "goToPosture", "StandInit", 1.0, after=3.0) is True
    assert older.isFinished()


def test_apply_posture_takes_the_joints_there(stiff_robot):
    assert stiff_robot.finish("ALRobotPosture", "applyPosture", "Crouch", 0.4, after=3.0) is True
    assert stiff_robot.ALRobotPosture.getPosture() == "Crouch"


def test_apply_posture_does_not_wake_the_robot(robot):
    assert robot.finish("ALRobotPosture", "applyPosture", "Crouch", 1.0, after=3.0) is False
    assert robot.ALMotion.robotIsWakeUp() is False


@pytest.mark.parametrize("method", ["goToPosture", "applyPosture"])
@pytest.mark.parametrize(
    "name, speed, text",
    [
        ("Standing", 1.0, "postureName is 'Standing', allowed is one of Crouch, .*, StandZero"),
        ("Stand", 0.0, "maxSpeedFraction is 0.0, allowed is above 0 to 1"),
        ("Stand", 1.5, "maxSpeedFraction is 1.5, allowed is 0 to 1"),
    ],
)
def test_what_is_wrong_is_named(robot, method, name, speed, text):
    with pytest.raises(RuntimeError, match=f"ALRobotPosture::{method} {text}"):
        getattr(robot.ALRobotPosture, method)(name, speed)


def test_at_least_one_try(robot):
    with pytest.raises(RuntimeError, match="pMaxTryNumber is 0, allowed is 1 or more"):
        robot.ALRobotPosture.setMaxTryNumber(0)


def test_changes_are_events(stiff_robot, listener):
    memory = stiff_robot.ALMemory
    stiff_robot.advance(2.0)
    assert memory.getData("PostureChanged") == "Stand"
    assert memory.getData("PostureFamilyChanged") == "Standing"
    for event in ("PostureChanged", "PostureFamilyChanged"):
        memory.subscribeToEvent(event, "Listener", "onEvent")
    stiff_robot.finish("ALRobotPosture", "goToPosture", "Crouch", 1.0, after=3.0)
    heard = set()
    while ("PostureChanged", "Crouch") not in heard or ("PostureFamilyChanged", "Crouching") not in heard:
        heard.add(listener.heard.get(timeout=stiff_robot.patience)[:2])
    for event in ("PostureChanged", "PostureFamilyChanged"):
        memory.unsubscribeToEvent(event, "Listener")
    assert memory.getData("PostureChanged") == "Crouch"
    assert memory.getExtractorEvent("ALRobotPosture") == ["PostureChanged", "PostureFamilyChanged"]


def test_an_event_comes_only_when_something_changed(stiff_robot):
    stiff_robot.advance(2.0)
    before = stiff_robot.ALMemory.getEventHistory("PostureChanged")
    stiff_robot.advance(3.0)
    assert stiff_robot.ALMemory.getEventHistory("PostureChanged") == before
