"""ALMotion's tasks over the network: listed, killed, and what they hold."""

from __future__ import annotations

import pytest


def begin(robot, name, to=0.4):
    """A motion of 2 s that has begun; the future of its answer."""
    future = robot.post("ALMotion", "angleInterpolation", name, to, 2.0, True)
    robot.handed_over("ALMotion")
    robot.advance(0.5)
    return future


def names(robot):
    return [name for name, _ in robot.ALMotion.getTaskList()]


def test_tasks_are_listed_with_name_and_number_while_they_run(stiff_robot):
    assert stiff_robot.ALMotion.getTaskList() == []
    future = begin(stiff_robot, "HeadYaw")
    ((name, number),) = stiff_robot.ALMotion.getTaskList()
    assert name == "angleInterpolation"
    assert isinstance(number, int) and number > 0
    stiff_robot.advance(1.6)
    stiff_robot.answer(future)
    assert stiff_robot.ALMotion.getTaskList() == []


def test_targets_are_no_tasks(stiff_robot):
    stiff_robot.ALMotion.setAngles("HeadYaw", 1.0, 0.1)
    assert stiff_robot.ALMotion.getTaskList() == []


def test_a_killed_task_answers_and_stays_where_it_is(stiff_robot):
    future, other = begin(stiff_robot, "HeadYaw"), begin(stiff_robot, "HeadPitch")
    (_, number), _ = stiff_robot.ALMotion.getTaskList()
    assert stiff_robot.ALMotion.killTask(number) is True
    assert stiff_robot.answer(future) is None
    before = stiff_robot.ALMotion.getAngles("HeadYaw", False)
    stiff_robot.advance(2.0)
    assert stiff_robot.ALMotion.getAngles("HeadYaw", False) == before != [0.4]
    stiff_robot.answer(other)
    assert stiff_robot.ALMotion.getAngles("HeadPitch", False) == pytest.approx([0.4])


def test_killing_a_task_that_is_not_there_tells_so(stiff_robot):
    assert stiff_robot.ALMotion.killTask(4711) is False


def test_resources_are_busy_until_the_last_task_on_them_ends(stiff_robot):
    future = begin(stiff_robot, "HeadYaw")
    available = stiff_robot.ALMotion.areResourcesAvailable
    assert [available([name]) for name in ("HeadYaw", "Head", "HeadPitch", "LArm")] == [False, False, True, True]
    assert available(["LArm", "HeadYaw"]) is False
    stiff_robot.advance(1.6)
    stiff_robot.answer(future)
    assert available(["Head"]) is True


def test_killing_by_resource_spares_the_others(stiff_robot):
    head, arm = begin(stiff_robot, "HeadYaw"), begin(stiff_robot, "LShoulderPitch", 1.0)
    stiff_robot.ALMotion.killTasksUsingResources(["Head"])
    stiff_robot.answer(head)
    assert names(stiff_robot) == ["angleInterpolation"]
    assert arm.isRunning()
    stiff_robot.advance(2.0)
    stiff_robot.answer(arm)


def test_kill_all_stops_everything(stiff_robot):
    futures = [begin(stiff_robot, name, 1.0) for name in ("HeadYaw", "LShoulderPitch", "HeadYaw")]
    stiff_robot.ALMotion.setAngles("RShoulderPitch", 1.0, 0.1)
    stiff_robot.ALMotion.killAll()
    for future in futures:
        stiff_robot.answer(future)
    before = stiff_robot.ALMotion.getAngles("Body", False)
    stiff_robot.advance(1.0)
    assert stiff_robot.ALMotion.getAngles("Body", False) == before
    assert stiff_robot.ALMotion.getTaskList() == []


@pytest.mark.parametrize("method", ["areResourcesAvailable", "killTasksUsingResources"])
def test_unknown_resources_offer_the_closest(shared_robot, method):
    with pytest.raises(RuntimeError, match=f"ALMotion::{method} unknown joint or chain 'Hed': did you mean 'Head'"):
        getattr(shared_robot.ALMotion, method)(["Hed"])


def test_a_posted_motion_can_be_stopped_by_its_number(stiff_robot):
    number = stiff_robot.ALMotion.pCall("angleInterpolation", "HeadYaw", 1.0, 2.0, True)
    stiff_robot.advance(0.5)
    assert stiff_robot.ALMotion.isRunning(number) is True
    stiff_robot.ALMotion.stop(number)
    stiff_robot.settled()
    assert stiff_robot.ALMotion.isRunning(number) is False
    assert stiff_robot.ALMotion.getTaskList() == []
