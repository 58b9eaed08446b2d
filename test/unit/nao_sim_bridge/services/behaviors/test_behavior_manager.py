"""ALBehaviorManager and ALAnimationPlayer over the network."""

from __future__ import annotations

import pytest

HEY, SLEEP, BREATHE = "animations/Stand/Gestures/Hey_1", "nao_library/sleep", "nao_library/breathe"
MINE = """
behaviors:
  mine/look:
    nature: interactive
    tags: [mine]
    do: [{frames: [{time: 0.4, angles: {HeadYaw: 0.4}}]}]
  mine/wait:
    do: [{wait: 30.0}]
"""


@pytest.fixture
def manager(stiff_robot):
    """The manager of a robot on stiff legs."""
    yield stiff_robot.ALBehaviorManager
    stiff_robot.ALBehaviorManager.stopAllBehaviors()
    stiff_robot.settled()


@pytest.fixture
def installed(manager, stiff_robot):
    """A file of a client, installed."""
    (stiff_robot.server.files.folder / "mine.yaml").write_text(MINE)
    assert manager.installBehavior("mine.yaml")
    yield "mine/look"
    if manager.getUserBehaviorNames():
        manager.removeBehavior("mine")


def begin(robot, module, method, *arguments):
    """Call a method that takes time; its future when it has begun."""
    future = robot.post(module, method, *arguments)
    robot.handed_over(module)
    return future


def test_what_comes_with_a_robot_is_installed(manager):
    names = manager.getInstalledBehaviors()
    assert {HEY, SLEEP, "animations/Sit/Gestures/Hey_3", "animations/Stand/Waiting/FunnyDancer_1"} <= set(names)
    assert manager.getBehaviorNames() == names == manager.getSystemBehaviorNames()
    assert manager.isBehaviorInstalled(HEY)
    assert manager.isBehaviorPresent("User/" + HEY)
    assert not manager.isBehaviorInstalled("Hey_1")
    assert manager.resolveBehaviorName("Hey_1") == HEY


def test_tags_and_natures(manager):
    assert HEY in manager.getBehaviorsByTag("hello")
    assert "hello" in manager.getBehaviorTags(HEY)
    assert "hello" in manager.getTagList()
    assert manager.getBehaviorNature(SLEEP) == "solitary"
    assert manager.getBehaviorNature(HEY) == "no nature"


def test_a_behaviour_that_runs_ends_its_call_when_it_is_over(manager, stiff_robot):
    future = begin(stiff_robot, "ALBehaviorManager", "runBehavior", HEY)
    assert manager.getRunningBehaviors() == [HEY] == manager.getLoadedBehaviors()
    stiff_robot.advance(2.0)
    assert future.isRunning()
    stiff_robot.advance(1.0)
    stiff_robot.answer(future)
    assert not manager.isBehaviorRunning(HEY)
    assert stiff_robot.ALMemory.getData("BehaviorsRun") == []


def test_a_call_that_is_cancelled_stops_the_behaviour(manager, stiff_robot):
    future = begin(stiff_robot, "ALBehaviorManager", "runBehavior", BREATHE)
    future.cancel()
    assert future.wait(int(1000 * stiff_robot.patience)) is not None
    stiff_robot.settled()
    assert future.isCanceled()
    assert manager.getRunningBehaviors() == []


def test_stopping_ends_the_call_that_runs_it(manager, stiff_robot):
    future = begin(stiff_robot, "ALBehaviorManager", "runBehavior", BREATHE)
    stiff_robot.advance(0.5)
    manager.stopBehavior(BREATHE)
    assert stiff_robot.answer(future) is None


def test_several_may_run_and_all_are_stopped(manager, stiff_robot, installed, heard):
    runs = heard("BehaviorsRun")
    manager.startBehavior("mine/wait")
    assert runs.get(timeout=stiff_robot.patience) == ["mine/wait"]
    manager.startBehavior("mine/look")
    assert runs.get(timeout=stiff_robot.patience) == ["mine/wait", "mine/look"]
    assert manager.getRunningBehaviors() == ["mine/wait", "mine/look"]
    manager.stopAllBehaviors()
    assert manager.getRunningBehaviors() == []
    # Both within a moment: libqi may bring them in another order.
    assert sorted(runs.get(timeout=stiff_robot.patience) for _ in range(2)) == [[], ["mine/look"]]
    assert stiff_robot.ALMemory.getData("BehaviorsRun") == []


def test_what_is_installed_is_told_runs_and_goes(manager, stiff_robot, heard):
    added, removed, several = (
        heard(f"ALBehaviorManager/{what}") for what in ("BehaviorAdded", "BehaviorRemoved", "BehaviorsAdded")
    )
    (stiff_robot.server.files.folder / "mine.yaml").write_text(MINE)
    assert manager.installBehavior("mine.yaml") is True
    assert several.get(timeout=stiff_robot.patience) == ["mine/look", "mine/wait"]
    assert {added.get(timeout=stiff_robot.patience) for _ in range(2)} == {"mine/look", "mine/wait"}
    assert manager.getUserBehaviorNames() == ["mine/look", "mine/wait"]
    manager.runBehavior("mine/look", _async=True)
    stiff_robot.handed_over("ALBehaviorManager")
    stiff_robot.advance(0.6)
    assert stiff_robot.ALMotion.getAngles("HeadYaw", True)[0] == pytest.approx(0.4, abs=0.03)
    assert manager.removeBehavior("mine") is True
    assert {removed.get(timeout=stiff_robot.patience) for _ in range(2)} == {"mine/look", "mine/wait"}
    assert manager.getUserBehaviorNames() == []


def test_it_may_get_another_name_and_keeps_what_is_there(manager, installed):
    assert manager.installBehavior("mine.yaml", "other", True)
    assert manager.isBehaviorInstalled("other/look")
    with pytest.raises(RuntimeError, match="a name that is free"):
        manager.installBehavior("mine.yaml", "other", False)
    manager.removeBehavior("other")


def test_default_behaviours_are_started_together(manager, stiff_robot, installed):
    manager.addDefaultBehavior("mine/look")
    manager.addDefaultBehavior("mine/wait")
    assert manager.getDefaultBehaviors() == ["mine/look", "mine/wait"]
    manager.playDefaultProject()
    assert manager.getRunningBehaviors() == ["mine/look", "mine/wait"]
    manager.removeBehavior("mine")
    assert manager.getDefaultBehaviors() == []


def test_what_is_preloaded_is_loaded(manager, installed):
    assert not manager.isBehaviorLoaded(installed)
    assert manager.preloadBehavior(installed)
    assert manager.isBehaviorLoaded(installed)


@pytest.mark.parametrize(
    "method, arguments, told",
    [
        ("runBehavior", ["animations/Stand/Gestures/Hei_1"], "did you mean .*Hey_1"),
        ("startBehavior", ["Gestures"], "unknown behavior"),
        ("stopBehavior", [HEY], "does not run; running is none"),
        ("removeBehavior", [HEY], "not one of the robot"),
        ("removeDefaultBehavior", [HEY], "one of the default behaviors: none"),
        ("installBehavior", ["../mine.yaml"], "not inside"),
        ("installBehavior", ["nothing.yaml"], "no file"),
    ],
)
def test_what_is_wrong_is_told(manager, method, arguments, told):
    with pytest.raises(RuntimeError, match=told):
        manager.call(method, *arguments)


def test_one_that_runs_does_not_begin_again(manager, installed):
    manager.startBehavior("mine/wait")
    with pytest.raises(RuntimeError, match="runs already"):
        manager.startBehavior("mine/wait")


def test_a_limp_robot_says_why_it_does_not_move(robot):
    with pytest.raises(RuntimeError, match="are limp, wakeUp or a stiffness comes first"):
        robot.ALBehaviorManager.startBehavior(HEY)


# --- ALAnimationPlayer ------------------------------------------------------------------------------------------------


def test_the_player_knows_the_posture(manager, stiff_robot):
    future = begin(stiff_robot, "ALAnimationPlayer", "run", "animations/[posture]/Gestures/Hey_1")
    assert manager.getRunningBehaviors() == [HEY]
    stiff_robot.advance(3.0)
    stiff_robot.answer(future)
    with pytest.raises(RuntimeError, match="unknown behavior"):
        stiff_robot.ALAnimationPlayer.run("animations/[posture]/Nothing_1")


def test_the_player_chooses_by_tag(manager, stiff_robot):
    player = stiff_robot.ALAnimationPlayer
    begin(stiff_robot, "ALAnimationPlayer", "runTag", "hello")
    assert manager.getRunningBehaviors() == [HEY]
    manager.stopAllBehaviors()
    with pytest.raises(RuntimeError, match="no animation with the tag 'salute' for the posture Stand"):
        player.runTag("salute")
    player.addTagForAnimations({"salute": ["Nod_1"]})
    begin(stiff_robot, "ALAnimationPlayer", "runTag", "Stand", "salute")
    assert manager.getRunningBehaviors() == ["animations/Stand/Gestures/Nod_1"]
    player.reset()
    with pytest.raises(RuntimeError, match="no animation"):
        player.runTag("salute")
