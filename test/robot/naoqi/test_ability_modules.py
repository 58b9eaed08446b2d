"""The modules of single abilities, while life is disabled: what the robot does when they are switched on."""

import numpy as np
import pytest
from simulator import PATIENCE

MOVED = 0.1
"""From this on, in rad, an arm has moved."""
EYE = "Face/Led/Red/Left/0Deg"


@pytest.fixture
def robot(stiff_robot):
    return stiff_robot


@pytest.fixture
def arm_moves(robot):
    """Whether an arm moves while a text is said."""

    def say(module, text):
        commands, running, future = [], [], robot.post(module, "say", text)
        robot.handed_over(module)
        while future.isRunning():
            robot.advance(0.2)
            commands.append(robot.ALMotion.getAngles(["LArm", "RArm"], False))
            running.append(robot.ALSpeakingMovement.isRunning())
        future.value(int(1000 * PATIENCE))
        return bool(np.ptp(commands, axis=0).max() > MOVED), any(running)

    return say


def test_the_breath_moves_the_arms_of_a_robot_that_stands_until_it_is_switched_off(robot):
    breath = robot.ALBackgroundMovement
    assert not breath.isEnabled() and not breath.isRunning()
    breath.setEnabled(True)
    robot.advance(3.0)
    assert breath.isEnabled() and breath.isRunning() and robot.ALMotion.getBreathEnabled("Body")
    seen = []
    for _ in range(10):
        robot.advance(0.3)
        seen.append(robot.ALMotion.getAngles("LShoulderPitch", False)[0])
    assert np.ptp(seen) > 0.02
    breath.setEnabled(False)
    assert not breath.isEnabled() and not breath.isRunning() and not robot.ALMotion.getBreathEnabled("Body")


def test_posted_calls_have_a_number_by_which_to_ask_whether_they_run(robot):
    speech = robot.ALSpeakingMovement
    call = speech.pCall("wait", speech.pCall("isRunning"))
    robot.settled()
    assert speech.isRunning(call) is False and speech.isRunning() is False
    assert robot.proxy("ALSpeakingMovement").isRunning() is False
    with pytest.raises(RuntimeError, match="ALSpeakingMovement::isRunning no posted call has the id 7"):
        speech.isRunning(7)


def test_a_limp_robot_may_be_told_to_breathe_and_does_not(robot):
    robot.ALMotion.setStiffnesses("Body", 0.0)
    robot.ALBackgroundMovement.setEnabled(True)
    robot.advance(1.0)
    assert robot.ALBackgroundMovement.isEnabled() and not robot.ALBackgroundMovement.isRunning()


@pytest.mark.parametrize("on", [True, False])
def test_eyes_blink_while_it_is_switched_on(robot, on):
    robot.ALLeds.on("FaceLeds")
    robot.ALAutonomousBlinking.setEnabled(True)
    robot.ALAutonomousBlinking.setEnabled(on)
    lights = []
    for _ in range(140):
        robot.advance(0.05)
        lights.append(robot.led(EYE))
    assert robot.ALAutonomousBlinking.isEnabled() == on and (min(lights) < 0.5) == on and max(lights) == 1.0


def test_who_speaks_gets_a_nod_while_listening_movements_are_on(robot):
    listening, pitch = robot.ALListeningMovement, lambda: robot.ALMotion.getAngles("HeadPitch", False)[0]
    begin = pitch()
    for on in (False, True):
        listening.setEnabled(on)
        robot.ALMemory.raiseEvent("SpeechDetected", True)
        robot.settled()
        robot.advance(0.4)
        assert listening.isRunning() == on and (pitch() > begin + 0.05) == on


def test_arms_move_with_speech_as_it_is_switched(robot, arm_moves):
    text = "Hello, my name is Nao. Yes, I explain everything."
    movement = robot.ALSpeakingMovement
    assert movement.isEnabled() and arm_moves("ALAnimatedSpeech", text) == (True, True)
    assert arm_moves("ALTextToSpeech", text) == (False, False)
    movement.setEnabled(True)
    assert arm_moves("ALTextToSpeech", text) == (True, True)
    movement.setEnabled(False)
    assert not movement.isEnabled() and robot.ALAnimatedSpeech.getBodyLanguageModeToStr() == "disabled"
    assert arm_moves("ALAnimatedSpeech", text) == (False, False) == arm_moves("ALTextToSpeech", text)


def test_its_mode_is_that_of_animated_speech_and_added_words_are_forgotten(robot):
    movement, library = robot.ALSpeakingMovement, robot.server._robot.speech.library
    movement.setMode("random")
    assert movement.getMode() == robot.ALAnimatedSpeech.getBodyLanguageModeToStr() == "random"
    with pytest.raises(RuntimeError, match="^ALSpeakingMovement::setMode mode is 'disabled', allowed is one of random"):
        movement.setMode("disabled")
    shipped = library.of_word("hello")
    movement.addTagsToWords({"hello": ["testword"]})
    assert library.of_word("testword") == library.tagged("hello") != []
    movement.resetTagsToWords()
    assert library.of_word("hello") == shipped and library.of_word("testword") == []


def test_life_decides_anew_when_its_state_changes(robot):
    robot.ALBackgroundMovement.setEnabled(True)
    robot.finish("ALAutonomousLife", "setState", "solitary", after=3.0)
    assert robot.ALListeningMovement.isEnabled() and robot.ALBackgroundMovement.isEnabled()
    robot.ALAutonomousLife.setState("disabled")
    assert not robot.ALBackgroundMovement.isEnabled() and not robot.ALListeningMovement.isEnabled()
