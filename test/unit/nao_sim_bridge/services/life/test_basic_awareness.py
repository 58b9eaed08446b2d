"""ALBasicAwareness over the network: what it looks at, and what it tells. Events are raised as the extractors do."""

from __future__ import annotations

import math

import pytest

CAMERA = [0.0, 0.0, 0.5, 0.0, 0.0, 0.0]


def face(number, alpha):
    """`FaceDetected` with one face, 0.15 rad wide, `alpha` rad to the left of the robot."""
    info = [[0, alpha, 0.0, 0.15, 0.15], [number, 0.0, "", [], [], [], [], [], []]]
    return [[1, 0], [info, []], CAMERA, CAMERA, 0]


def sound(azimuth, confidence=0.9):
    return [[1, 0], [azimuth, 0.0, confidence, 0.0], CAMERA, CAMERA]


@pytest.fixture
def aware(stiff_robot):
    """Awareness of a robot on stiff legs; its extractors find nothing by themselves in an empty world."""
    awareness = stiff_robot.ALBasicAwareness
    awareness.setStimulusDetectionEnabled("Movement", False)  # a camera more takes its time
    awareness.setEnabled(True)
    stiff_robot.settled()
    yield awareness
    awareness.setEnabled(False)
    awareness.resetAllParameters()
    stiff_robot.settled()


def tell(robot, event, value, seconds):
    robot.ALMemory.raiseEvent(event, value)
    robot.settled()
    robot.advance(seconds)
    return robot.ALMotion.getAngles("HeadYaw", True)[0]


FACE, SOUND, TOUCH = "FaceDetected", "ALSoundLocalization/SoundLocated", "TouchChanged"


def test_it_listens_to_eyes_and_ears_while_it_is_on(aware, stiff_robot):
    def listens(module):
        stiff_robot.advance(0.1)
        return [name for name, *_ in getattr(stiff_robot, module).getSubscribersInfo()]

    aware.setStimulusDetectionEnabled("Movement", True)
    modules = ("ALFaceDetection", "ALSoundLocalization", "ALMovementDetection")
    assert [listens(module) for module in modules] == [["ALBasicAwareness"]] * 3
    aware.setStimulusDetectionEnabled("Sound", False)
    assert listens("ALSoundLocalization") == []
    aware.pauseAwareness()
    assert not aware.isAwarenessRunning()
    assert listens("ALFaceDetection") == []
    aware.resumeAwareness()
    assert listens("ALFaceDetection") == ["ALBasicAwareness"]


def test_a_face_is_told_and_followed_until_it_is_lost(aware, stiff_robot, heard):
    stimuli, tracked, lost = (
        heard(f"ALBasicAwareness/{what}") for what in ("StimulusDetected", "HumanTracked", "HumanLost")
    )
    assert tell(stiff_robot, FACE, face(3, 0.4), 1.0) == pytest.approx(0.4, abs=0.05)
    assert tell(stiff_robot, FACE, face(3, -0.3), 1.0) == pytest.approx(-0.3, abs=0.05)
    assert aware.engagePerson(3) is True
    assert aware.engagePerson(4) is False
    stiff_robot.advance(2.5)
    assert stimuli.get(timeout=stiff_robot.patience) == "People"
    assert [tracked.get(timeout=stiff_robot.patience) for _ in range(2)] == [3, -1]
    lost.get(timeout=stiff_robot.patience)


def test_a_sound_makes_it_look_there_and_back_when_nobody_is_there(aware, stiff_robot, heard):
    stimuli = heard("ALBasicAwareness/StimulusDetected")
    assert tell(stiff_robot, SOUND, sound(0.6), 1.0) == pytest.approx(0.6, abs=0.1)
    assert stimuli.get(timeout=stiff_robot.patience) == "Sound"
    stiff_robot.advance(2.5)
    assert abs(stiff_robot.ALMotion.getAngles("HeadYaw", True)[0]) < 0.05


def test_a_doubtful_sound_does_not(aware, stiff_robot):
    assert abs(tell(stiff_robot, SOUND, sound(0.6, 0.1), 1.0)) < 0.02


def test_a_touch_makes_it_look_up(aware, stiff_robot):
    before = stiff_robot.ALMotion.getAngles("HeadPitch", True)[0]
    tell(stiff_robot, TOUCH, [["Head/Touch/Front", True]], 1.0)
    assert stiff_robot.ALMotion.getAngles("HeadPitch", True)[0] < before - 0.2


def test_a_robot_on_a_table_looks_lower_for_who_touches_it(aware, stiff_robot):
    life = stiff_robot.ALAutonomousLife
    life.setRobotOffsetFromFloor(0.7)
    try:
        assert life.getRobotOffsetFromFloor() == pytest.approx(0.7)
        before = stiff_robot.ALMotion.getAngles("HeadPitch", True)[0]
        tell(stiff_robot, TOUCH, [["Head/Touch/Front", True]], 1.0)
        assert stiff_robot.ALMotion.getAngles("HeadPitch", True)[0] > before + 0.1
    finally:
        life.setRobotOffsetFromFloor(0.0)


@pytest.mark.parametrize("stimulus, why", [("TabletTouch", "no tablet"), ("NavigationMotion", "no infrared")])
def test_what_a_nao_has_no_sense_for_is_off_and_cannot_be_switched_on(aware, stimulus, why):
    assert aware.isStimulusDetectionEnabled(stimulus) is False
    with pytest.raises(RuntimeError, match=f"setStimulusDetectionEnabled {stimulus}: a NAO has {why}"):
        aware.setStimulusDetectionEnabled(stimulus, True)
    aware.setStimulusDetectionEnabled(stimulus, False)
    aware.resetAllParameters()
    assert aware.isStimulusDetectionEnabled(stimulus) is False
    assert aware.isStimulusDetectionEnabled("Touch") is True


@pytest.mark.parametrize("mode, turns", [("FullyEngaged", False), ("Unengaged", True)])
def test_who_is_engaged_is_not_distracted(aware, stiff_robot, mode, turns):
    aware.setEngagementMode(mode)
    aware.setParameter("MinTimeTracking", 0.5)
    tell(stiff_robot, FACE, face(5, 0.0), 0.8)
    yaw = tell(stiff_robot, SOUND, sound(0.7), 0.6)
    assert (yaw > 0.4) is turns


def test_a_stimulus_may_be_given_by_its_place(aware, stiff_robot):
    first = aware.triggerStimulus([1.0, 0.5, 0.5])
    stiff_robot.advance(1.0)
    assert stiff_robot.ALMotion.getAngles("HeadYaw", True)[0] == pytest.approx(math.atan2(0.5, 1.0), abs=0.05)
    assert aware.triggerStimulus([1.0, 0.0, 0.5]) == first + 1


def test_the_body_turns_to_what_is_far_aside(aware, stiff_robot):
    aware.setTrackingMode("BodyRotation")
    stiff_robot.advance(0.3)  # it has to feel its feet
    tell(stiff_robot, FACE, face(6, 0.9), 0.5)
    assert stiff_robot.ALMotion.moveIsActive()
    stiff_robot.ALMotion.killMove()


def test_the_tracker_has_the_head_for_itself(aware, stiff_robot):
    stiff_robot.ALTracker.registerTarget("Sound", [1.0, 0.5])
    stiff_robot.ALTracker.trackEvent("Test/Place")
    assert abs(tell(stiff_robot, FACE, face(7, 0.5), 0.8)) < 0.02
    stiff_robot.ALTracker.stopTracker()


@pytest.mark.parametrize(
    "method, arguments, told",
    [
        ("setEngagementMode", ["Married"], "Unengaged, SemiEngaged, FullyEngaged"),
        ("setTrackingMode", ["Feet"], "Head, BodyRotation"),
        ("setStimulusDetectionEnabled", ["Smell", True], "unknown stimulus"),
        ("setParameter", ["Mood", 1.0], "unknown parameter"),
        ("setParameter", ["LookStimulusSpeed", 3.0], "0.01 to 1"),
        ("getParameter", ["Mood"], "unknown parameter"),
        ("triggerStimulus", [[1.0]], "FRAME_WORLD"),
    ],
)
def test_what_is_wrong_is_told(stiff_robot, method, arguments, told):
    with pytest.raises(RuntimeError, match=told):
        stiff_robot.ALBasicAwareness.call(method, *arguments)


def test_parameters_are_kept_and_reset(aware):
    aware.setParameter("LookStimulusSpeed", 0.25)
    assert aware.getParameter("LookStimulusSpeed") == 0.25
    aware.resetAllParameters()
    assert aware.getParameter("LookStimulusSpeed") == 0.5
