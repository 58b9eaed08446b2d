"""ALBehaviorManager, ALAnimationPlayer and ALFrameManager: behaviours of the robot, of clients and of Choregraphe."""

import pytest
from choregraphe import TOUCHED, link, memory, project, says, to_end, waits
from simulator import PATIENCE

MANAGER = "ALBehaviorManager"
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
TIMELINE = """<Timeline enable="1" fps="10"><ActuatorList><ActuatorCurve actuator="HeadYaw" mute="0" unit="0">
<Key frame="5" value="20" /><Key frame="10" value="0" /></ActuatorCurve></ActuatorList></Timeline>"""
PROJECT = f'<ChoregrapheProject><Box name="root" id="-1">{TIMELINE}</Box></ChoregrapheProject>'


@pytest.fixture
def manager(stiff_robot):
    """The manager of a robot on stiff legs."""
    (stiff_robot.server.files.folder / "mine.yaml").write_text(MINE)
    return stiff_robot.ALBehaviorManager


def test_what_comes_with_a_robot_is_installed_with_tags_and_natures(manager):
    names = manager.getInstalledBehaviors()
    assert {HEY, SLEEP, "animations/Sit/Gestures/Hey_3", "animations/Stand/Waiting/FunnyDancer_1"} <= set(names)
    assert manager.getBehaviorNames() == names == manager.getSystemBehaviorNames()
    assert manager.isBehaviorInstalled(HEY) and manager.isBehaviorPresent("User/" + HEY)
    assert not manager.isBehaviorInstalled("Hey_1") and manager.resolveBehaviorName("Hey_1") == HEY
    assert len([name for name in names if name.startswith("animations/")]) > 434
    assert HEY in manager.getBehaviorsByTag("hello") and "hello" in manager.getBehaviorTags(HEY)
    assert "hello" in manager.getTagList()
    assert [manager.getBehaviorNature(name) for name in (SLEEP, HEY)] == ["solitary", "no nature"]


def test_a_behaviour_ends_its_call_when_it_is_over_stopped_or_cancelled(manager, stiff_robot, begin):
    future = begin(MANAGER, "runBehavior", HEY, after=2.0)
    assert manager.getRunningBehaviors() == [HEY] == manager.getLoadedBehaviors() and future.isRunning()
    stiff_robot.advance(1.0)
    stiff_robot.answer(future)
    assert not manager.isBehaviorRunning(HEY) and stiff_robot.value("BehaviorsRun") == []
    future = begin(MANAGER, "runBehavior", BREATHE, after=0.5)
    manager.stopBehavior(BREATHE)
    assert stiff_robot.answer(future) is None
    future = begin(MANAGER, "runBehavior", BREATHE)
    future.cancel()
    assert future.wait(int(1000 * PATIENCE)) is not None and future.isCanceled()
    stiff_robot.settled()
    assert manager.getRunningBehaviors() == []


def test_several_may_run_by_name_or_by_default_and_all_are_stopped(manager, stiff_robot):
    assert manager.installBehavior("mine.yaml")
    runs = stiff_robot.heard("BehaviorsRun")
    for count, name in enumerate(("mine/wait", "mine/look"), 1):
        manager.startBehavior(name)
        assert runs.get(timeout=PATIENCE) == ["mine/wait", "mine/look"][:count]
    with pytest.raises(RuntimeError, match="runs already"):
        manager.startBehavior("mine/wait")
    manager.stopAllBehaviors()
    assert manager.getRunningBehaviors() == [] == stiff_robot.value("BehaviorsRun")
    for name in ("mine/look", "mine/wait"):
        manager.addDefaultBehavior(name)
    assert manager.getDefaultBehaviors() == ["mine/look", "mine/wait"]
    manager.playDefaultProject()
    assert manager.getRunningBehaviors() == ["mine/look", "mine/wait"]
    manager.removeBehavior("mine")
    assert manager.getDefaultBehaviors() == [] == manager.getRunningBehaviors()


def test_what_is_installed_is_told_runs_and_goes(manager, stiff_robot, begin):
    kinds = ("BehaviorAdded", "BehaviorRemoved", "BehaviorsAdded")
    added, removed, several = (stiff_robot.heard(f"{MANAGER}/{what}") for what in kinds)
    both = ["mine/look", "mine/wait"]
    assert manager.installBehavior("mine.yaml") is True
    assert several.get(timeout=PATIENCE) == both == manager.getUserBehaviorNames()
    assert sorted(added.get(timeout=PATIENCE) for _ in both) == both
    assert not manager.isBehaviorLoaded("mine/look")
    assert manager.preloadBehavior("mine/look") and manager.isBehaviorLoaded("mine/look")
    begin(MANAGER, "runBehavior", "mine/look", after=0.6)
    assert stiff_robot.ALMotion.getAngles("HeadYaw", True)[0] == pytest.approx(0.4, abs=0.03)
    assert manager.removeBehavior("mine") is True and manager.getUserBehaviorNames() == []
    assert {"mine/look", "mine/wait"} <= {removed.get(timeout=PATIENCE) for _ in both}


def test_a_diagram_of_choregraphe_hears_events_until_its_end(stiff_robot, begin):
    folder, manager = stiff_robot.server.files.folder / "touched", stiff_robot.ALBehaviorManager
    folder.mkdir()
    boxes = waits(1, 0.5) + says(2, "never") + waits(3, 9.0)
    links = link(0, 1, end=TOUCHED) + to_end(1) + link(0, 3) + link(3, 2)
    (folder / "behavior.xar").write_bytes(project(boxes, links, memory("FrontTactilTouched")))
    with pytest.raises(RuntimeError, match="folder 'touched' has no manifest.xml, .* touched/behavior.xar"):
        manager.installBehavior("touched")
    manager.installBehavior("touched/behavior.xar")
    future = begin(MANAGER, "runBehavior", "touched/behavior", after=1.0)
    assert manager.getRunningBehaviors() == ["touched/behavior"]
    stiff_robot.ALMemory.raiseEvent("FrontTactilTouched", 1.0)
    stiff_robot.advance(0.6)
    assert stiff_robot.answer(future) is None and manager.getRunningBehaviors() == []
    assert stiff_robot.ALMemory.getSubscribers("FrontTactilTouched") == []


def test_what_is_wrong_is_told(robot, refuses):
    refuses(MANAGER, f"""
        runBehavior('animations/Stand/Gestures/Hei_1') -> did you mean .*Hey_1
        stopBehavior('{HEY}') -> does not run; running is none
        removeBehavior('{HEY}') -> not one of the robot
        installBehavior('../mine.yaml') -> not inside
    """)  # fmt: skip
    refuses("ALAnimationPlayer", """
        runTag('salute') -> no animation with the tag 'salute' for the posture Stand
    """)  # fmt: skip
    refuses("ALFrameManager", """
        playBehavior('7') -> unknown behavior id
        newBehaviorFromChoregraphe() -> unknown behavior
    """)  # fmt: skip


def test_a_limp_robot_plays_and_stays_as_it_is_and_that_is_told_once(robot, begin, caplog):
    before = robot.ALMotion.getAngles("Body", False)
    for module, method in ((MANAGER, "runBehavior"), ("ALAnimationPlayer", "run")):
        caplog.clear()
        future = begin(module, method, HEY, after=1.0)
        assert robot.ALBehaviorManager.getRunningBehaviors() == [HEY]
        robot.advance(2.0)
        assert robot.answer(future) is None and robot.ALMotion.getAngles("Body", False) == before
        (warning,) = [record.getMessage() for record in caplog.records if record.name == "nao_sim.behaviors"]
        assert f"behavior {HEY}: RShoulderPitch, RShoulderRoll, RElbowYaw... have no stiffness and stay" in warning


def test_joints_that_are_stiff_move_beside_limp_ones(robot, begin):
    robot.ALMotion.setStiffnesses("Head", 1.0)
    begin(MANAGER, "runBehavior", "animations/Stand/Gestures/Yes_1", after=0.3)
    pitch, shoulder = robot.ALMotion.getAngles(["HeadPitch", "RShoulderPitch"], False)
    assert pitch == pytest.approx(-0.17 + 0.22, abs=0.03) and shoulder == pytest.approx(1.44, abs=0.01)


def test_the_player_knows_the_posture_and_chooses_by_tag(manager, stiff_robot, begin):
    player = stiff_robot.ALAnimationPlayer
    future = begin("ALAnimationPlayer", "run", "animations/[posture]/Gestures/Hey_1")
    assert manager.getRunningBehaviors() == [HEY]
    stiff_robot.advance(3.0)
    stiff_robot.answer(future)
    begin("ALAnimationPlayer", "runTag", "hello")
    (running,) = manager.getRunningBehaviors()
    assert "hello" in manager.getBehaviorTags(running)
    manager.stopAllBehaviors()
    player.addTagForAnimations({"salute": ["Nod_1"]})
    begin("ALAnimationPlayer", "runTag", "Stand", "salute")
    assert manager.getRunningBehaviors() == ["animations/Stand/Gestures/Nod_1"]
    manager.stopAllBehaviors()
    begin("ALAnimationPlayer", "runTag", "animations/[posture]/Emotions/Negative", "bored")
    assert manager.getRunningBehaviors() == ["animations/Stand/Emotions/Negative/Bored_1"]
    player.reset()
    with pytest.raises(RuntimeError, match="no animation"):
        player.runTag("salute")


def test_a_path_for_tags_is_that_of_the_posture(manager, stiff_robot, begin):
    player = stiff_robot.ALAnimationPlayer
    (stiff_robot.server.files.folder / "mine.yaml").write_text(MINE.replace("mine/look", "mine/Sit/look"))
    manager.installBehavior("mine.yaml")
    player.declarePathForTags("mine/[posture]")
    with pytest.raises(RuntimeError, match="no animation with the tag 'mine' for the posture Stand"):
        player.runTag("mine")
    begin("ALAnimationPlayer", "runTag", "Sit", "mine")
    assert manager.getRunningBehaviors() == ["mine/Sit/look"]


def test_frames_play_timelines_files_and_what_choregraphe_has_sent(stiff_robot):
    frames, folder = stiff_robot.ALFrameManager, stiff_robot.server.files.folder / "mine"
    folder.mkdir()
    (folder / "behavior.xar").write_text(PROJECT)
    number = frames.createTimeline(TIMELINE)
    assert frames.behaviors() == [number] and frames.getMotionLength(number) == 1.0
    frames.playTimeline(number)
    stiff_robot.advance(0.55)
    assert frames.isBehaviorRunning(number)
    assert stiff_robot.ALMotion.getAngles("HeadYaw", True)[0] == pytest.approx(0.349, abs=0.03)
    stiff_robot.advance(0.6)
    assert not frames.isBehaviorRunning(number)
    number = frames.createBehavior("mine", "behavior.xar", "nod")
    assert frames.getBehaviorPath(number) == "mine/behavior.xar"
    stiff_robot.finish("ALFrameManager", "completeBehavior", number, after=1.2)
    assert not frames.isBehaviorRunning(number)
    stiff_robot.ALBehaviorManager.installBehavior("mine/behavior.xar", ".lastUploadedChoregrapheBehavior/a", True)
    assert frames.getMotionLength(frames.newBehaviorFromChoregraphe()) == 1.0
    frames.cleanBehaviors()
    assert frames.behaviors() == []
