"""ALFrameManager over the network: behaviours of Choregraphe by their ids."""

from __future__ import annotations

import pytest
from naoqi_calls_life import TIMELINE

PROJECT = f'<ChoregrapheProject><Box name="root" id="-1">{TIMELINE}</Box></ChoregrapheProject>'


@pytest.fixture
def frames(stiff_robot):
    """The module of a robot on stiff legs."""
    (stiff_robot.server.files.folder / "mine").mkdir(exist_ok=True)
    (stiff_robot.server.files.folder / "mine" / "behavior.xar").write_text(PROJECT)
    yield stiff_robot.ALFrameManager
    stiff_robot.ALFrameManager.cleanBehaviors()
    stiff_robot.settled()


def test_a_timeline_is_played(frames, stiff_robot):
    number = frames.createTimeline(TIMELINE)
    assert frames.behaviors() == [number]
    assert frames.getMotionLength(number) == 1.0
    frames.playTimeline(number)
    stiff_robot.advance(0.55)
    assert frames.isBehaviorRunning(number)
    assert stiff_robot.ALMotion.getAngles("HeadYaw", True)[0] == pytest.approx(0.349, abs=0.03)
    stiff_robot.advance(0.6)
    assert not frames.isBehaviorRunning(number)


def test_a_behaviour_of_a_file_runs_to_its_end(frames, stiff_robot):
    number = frames.createBehavior("mine", "behavior.xar", "nod")
    assert frames.getBehaviorPath(number) == "mine/behavior.xar"
    stiff_robot.finish("ALFrameManager", "completeBehavior", number, after=1.2)
    assert not frames.isBehaviorRunning(number)


def test_leaving_and_deleting_stop_it(frames, stiff_robot):
    for stop in ("exitBehavior", "stopTimeline", "deleteBehavior"):
        number = frames.newBehaviorFromFile("mine/behavior.xar", "nod")
        frames.playBehavior(number)
        stiff_robot.advance(0.2)
        frames.call(stop, number)
        stiff_robot.settled()
        assert stiff_robot.ALBehaviorManager.getRunningBehaviors() == []


def test_what_choregraphe_has_sent_is_played(frames, stiff_robot):
    with pytest.raises(RuntimeError, match="unknown behavior"):
        frames.newBehaviorFromChoregraphe()
    stiff_robot.ALBehaviorManager.installBehavior("mine/behavior.xar", ".lastUploadedChoregrapheBehavior/a", True)
    assert frames.getMotionLength(frames.newBehaviorFromChoregraphe()) == 1.0
    stiff_robot.ALBehaviorManager.removeBehavior(".lastUploadedChoregrapheBehavior")


def test_what_is_wrong_is_told(frames):
    with pytest.raises(RuntimeError, match="unknown behavior id"):
        frames.playBehavior("7")
    with pytest.raises(RuntimeError, match="is no XML"):
        frames.newBehavior("text", "<Timeline")
