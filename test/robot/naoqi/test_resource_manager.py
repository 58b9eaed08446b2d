"""ALResourceManager: programs agree on who has which part of the robot."""

import pytest
from simulator import PATIENCE, connected

from nao_sim_bridge.naoqi.system import resource_manager

MANAGER = "ALResourceManager"


@pytest.fixture
def manager(robot):
    return robot.ALResourceManager


def test_the_robot_has_resources_in_each_other(manager):
    names = dict(manager.getResources())
    assert [chain for chain, _ in names["Motors"]] == ["Head", "LArm", "LLeg", "RLeg", "RArm"]
    assert manager.isInGroup("Motors", "HeadYaw") and manager.isInGroup("Audio", "Audio player")
    assert manager.isInGroup("Audio", "HeadYaw") is False
    manager.createResource("Ball", "")
    manager.createResourcesList(["Red ball", "Blue ball"], "Ball")
    assert manager.getResources()[-1] == ["Ball", [["Red ball", []], ["Blue ball", []]]]
    manager.deleteResource("Ball", True)


def test_a_resource_is_had_until_it_is_released(manager):
    assert manager.areResourcesFree(["Head", "Leds"]) is True
    manager.acquireResource("Head", "dance", "", 0)
    assert manager.isResourceFree("HeadYaw") is False and manager.areResourcesOwnedBy(["HeadYaw"], "dance") is True
    assert manager.ownersGet() == [["Head", "dance"]]
    with pytest.raises(RuntimeError, match="acquireResourcesTree Head belongs to dance"):
        manager.acquireResourcesTree(["Leds", "Motors"], "look", "", 0)
    assert manager.areResourcesFree(["Leds"]) is True
    manager.releaseResource("Head", "dance")
    manager.acquireResourcesTree(["Leds", "Motors"], "look", "", 0)
    assert manager.waitForOptionalResourcesTree(["Cameras"], "dance", "", 0, ["Leds", "Stiffness"]) == ["Stiffness"]
    manager.releaseResources(["Leds", "Motors"], "look")


def test_who_waits_gets_it_when_it_is_free_first_come_first_served(manager, robot, begin):
    manager.acquireResource("Head", "dance", "", 0)
    first, second = (begin(MANAGER, "acquireResource", "HeadYaw", owner, "", -1, after=0.1) for owner in "ab")
    assert first.isRunning() and second.isRunning()
    manager.releaseResource("Head", "dance")
    assert robot.answer(first) is None and second.isRunning()
    manager.releaseResource("HeadYaw", "a")
    assert robot.answer(second) is None and manager.ownersGet() == [["HeadYaw", "b"]]


def test_the_timeout_is_in_simulated_time_and_a_wait_can_be_cancelled(manager, robot, begin):
    manager.acquireResource("Leds", "dance", "", 0)
    waiting = begin(MANAGER, "acquireResource", "FaceLeds", "look", "", 2, after=1.9)
    assert waiting.isRunning()
    robot.advance(0.2)
    with pytest.raises(RuntimeError, match="acquireResource Leds belongs to dance still after the timeout"):
        robot.answer(waiting)
    cancelled = begin(MANAGER, "acquireResource", "FaceLeds", "look", "", -1)
    cancelled.cancel()
    cancelled.wait(int(1000 * PATIENCE))
    assert cancelled.isCanceled()
    manager.releaseResource("Leds", "dance")
    assert manager.ownersGet() == []


def test_who_waits_for_what_is_deleted_with_its_parent_is_told_and_others_go_on(manager, robot, begin):
    manager.createResource("Ball", "")
    manager.createResource("Red ball", "Ball")
    manager.acquireResource("Head", "dance", "", 0)
    lost = begin(MANAGER, "acquireResourcesTree", ["Red ball", "Head"], "play", "", 1)
    waiting = begin(MANAGER, "acquireResource", "Head", "look", "", -1)
    manager.deleteResource("Ball", True)
    with pytest.raises(RuntimeError, match="acquireResourcesTree deleted meanwhile: Red ball"):
        robot.answer(lost)
    manager.releaseResource("Head", "dance")
    assert robot.answer(waiting) is None and manager.ownersGet() == [["Head", "look"]]


def test_the_optional_ones_come_with_the_others_and_not_with_a_wait_that_was_cancelled(manager, robot, begin):
    manager.acquireResource("Head", "dance", "", 0)
    wait = ("waitForOptionalResourcesTree", ["Head"], "look", "", -1, ["Leds", "HeadYaw"])
    cancelled, waiting = begin(MANAGER, *wait), begin(MANAGER, *wait)
    cancelled.cancel()
    cancelled.wait(int(1000 * PATIENCE))
    assert cancelled.isCanceled()
    assert manager.ownersGet() == [["Head", "dance"]]
    manager.releaseResource("Head", "dance")
    assert robot.answer(waiting) == ["Leds", "HeadYaw"]
    assert sorted(manager.ownersGet()) == [["Head", "look"], ["HeadYaw", "look"], ["Leds", "look"]]


def test_of_too_many_calls_that_wait_the_oldest_is_given_up(manager, robot, begin, monkeypatch):
    monkeypatch.setattr(resource_manager, "MOST_WAITING", 2)
    manager.acquireResource("Head", "dance", "", 0)
    waiting = [begin(MANAGER, "acquireResource", "Head", "look", "", -1) for _ in range(3)]
    with pytest.raises(RuntimeError, match="given up: more than 2 calls wait for resources"):
        robot.answer(waiting[0])
    manager.releaseResource("Head", "dance")
    assert [robot.answer(call) for call in waiting[1:]] == [None, None]


def test_a_disabled_state_is_waited_for(manager, robot, begin):
    manager.enableStateResource("Standing", False)
    waiting = begin(MANAGER, "acquireResource", "Standing", "walk", "", -1, after=0.1)
    assert waiting.isRunning() and manager.checkStateResourceFree(["Standing"]) is False
    manager.enableStateResource("Standing", True)
    assert robot.answer(waiting) is None


def test_the_owner_is_asked_by_its_callback_and_may_release(manager, robot, listener, begin):
    manager.acquireResource("Head", "Listener", "onConflict", 0)
    waiting = begin(MANAGER, "acquireResource", "HeadYaw", "look", "", -1)
    assert listener.conflicts.get(timeout=PATIENCE) == ("Head", "Listener")
    manager.releaseResource("Head", "Listener")
    assert robot.answer(waiting) is None


def test_a_module_that_has_left_has_nothing_and_waits_for_nothing(manager, robot, begin):
    session = connected(robot.port)
    session.listen("tcp://127.0.0.1:0")
    session.registerService("dance", type("Dance", (), {})())
    manager.acquireResource("Leds", "look", "", 0)
    manager.acquireResource("Head", "dance", "", 0)
    given_up = begin(MANAGER, "acquireResource", "Leds", "dance", "", -1)
    waiting = begin(MANAGER, "acquireResource", "HeadYaw", "look", "", -1)
    session.close()
    assert robot.answer(waiting) is None and robot.answer(given_up) is None
    assert manager.ownersGet() == [["HeadYaw", "look"], ["Leds", "look"]]


def test_what_cannot_be_had_is_refused(manager, refuses):
    refuses(MANAGER, """
        acquireResource('Hed', 'look', '', 0) -> unknown resource 'Hed': did you mean 'Head'
        waitForOptionalResourcesTree(['Leds'], 'look', '', 0, ['Hed']) -> unknown resource 'Hed'
        acquireResource('Head', '', '', 0) -> moduleName is '', allowed is the name of the module
        releaseResource('Head', 'look') -> Head belongs to nobody, not to look
        deleteResource('Head') -> Head comes with the robot
        createResource('Head', '') -> resourceName is 'Head', allowed is a name that no resource has
    """)  # fmt: skip
    assert manager.ownersGet() == []
