"""When it was that something was heard: words, sounds, recordings; and from when on words are heard."""

from __future__ import annotations

import pytest
from goal_functions import audio_in as f
from sounds import noise, put
from word_trials import WAY, listens, says, trial

from nao_library_actions.msg import NaoAudioInGoal
from nao_library_modules.audio_in.audio_in_server import NaoAudioInput

WORDS = ["yes", "no", "stop", "hello", "seven", "good morning"]
EXACT = 0.06


def seconds(times):
    return [time.to_sec() for time in times]


def spoken_by_robot(goal):
    return [told.status for told in goal.feedback]


@pytest.mark.parametrize("noisy", [False, True])
def test_the_times_of_a_word_are_those_at_the_microphones_in_quiet_and_in_noise(robot, ears, noisy):
    robot.ALSpeechRecognition.setAudioExpression(True)
    if noisy:
        put(robot, (0.0, 1.5, 0.5), noise(2.0), 48.0, loop=True, name="fan")
        robot.advance(2.0)
    for text, voice in (("hello", "slt"), ("seven", "awb"), ("good morning", "rms")):
        result, onset, end, answered = trial(robot, ears, text, voice, WORDS)
        assert result.words == [text]
        (done,) = result.results
        assert seconds(result.onsets) == pytest.approx([onset], abs=EXACT)
        assert seconds(result.ends) == pytest.approx([end], abs=EXACT)
        assert (done.onset, done.offset) == (result.onsets[0], result.ends[0])
        assert done.end.to_sec() == pytest.approx(answered, abs=0.05)


def test_a_phrase_within_a_longer_sentence_has_times_of_its_own(robot, ears):
    goal = ears.send(f("listen", vocabulary=["good morning"], word_spotting=True, timeout=8.0))
    listens(robot, goal)
    onset, end = says(robot, "hello my friend good morning to everybody")
    result = goal.finish().result
    assert result.words == ["good morning"]
    first, last = result.onsets[0].to_sec(), result.ends[0].to_sec()
    assert onset + 0.3 < first < last < end - 0.3 and 0.3 < last - first < 0.9
    (heard,) = [told for told in goal.feedback if told.words]
    assert heard.stamp == result.onsets[0] and list(heard.ends) == list(result.ends)


def test_no_word_is_lost_that_begins_just_after_the_feedback_says_listening(robot, ears):
    robot.ALSpeechRecognition.setAudioExpression(True)
    heard = [trial(robot, ears, text, "slt", WORDS)[0].words for text in WORDS]
    assert heard == [[text] for text in WORDS]


def test_a_robot_that_listens_already_hears_at_once_and_a_paused_one_not(robot, ears):
    service = robot.ALSpeechRecognition
    service.subscribe("another program")
    ears.succeed(f("setVocabulary", vocabulary=WORDS))
    goal = ears.send(f("listen", timeout=4.0))
    listens(robot, goal)
    assert spoken_by_robot(goal).count("listening") == 1
    service.pause(True)
    robot.advance(0.5)
    service.pause(False)
    robot.advance_until(lambda: spoken_by_robot(goal).count("listening") == 2, 2.0)
    goal.finish()
    service.unsubscribe("another program")


def test_nothing_heard_is_said(robot, ears):
    functions = [
        f("listen", vocabulary=WORDS, timeout=0.6),
        f("detectSound", timeout=0.7),
        f("localizeSound", timeout=1),
    ]
    alone = [ears.send(function).finish().text for function in functions]
    assert alone == ["nothing recognised within 0.6 s", "no sound within 0.7 s", "no sound within 1 s"]
    text = ears.send(*functions[1:]).finish().text
    assert text == "function 1 (detectSound): no sound within 0.7 s; function 2 (localizeSound): no sound within 1 s"


def test_a_robot_that_only_says_that_somebody_speaks_tells_when_that_was_less_what_that_takes(robot, goals_to):
    memory = robot.ALMemory
    memory.removeData("NaoSimulation/WordTimes")  # as on a robot
    ears = goals_to(NaoAudioInput, NaoAudioInGoal, parameters={"speech_onset_delay": 0.2, "speech_end_delay": 0.4})
    goal = ears.send(f("listen", vocabulary=WORDS, timeout=9.0))
    listens(robot, goal)
    robot.advance(0.5)
    times = []
    for name, value in (("SpeechDetected", True), ("SpeechDetected", False), ("WordRecognized", ["no", 0.7])):
        memory.raiseEvent(name, value)
        times.append(robot.now.time)
        robot.proxy("ALMemory").ping()
        robot.advance(1.0)
    result = goal.finish().result
    assert result.words == ["no"]
    assert seconds([*result.onsets, *result.ends]) == pytest.approx([times[0] - 0.2, times[1] - 0.4], abs=0.03)


def test_sounds_and_recordings_have_the_times_at_which_they_began(robot, ears, subscribers):
    for function in ("detectSound", "localizeSound"):
        goal = ears.send(f(function, timeout=5.0))
        robot.advance_until(subscribers, 5.0)
        robot.advance(0.5)
        began = robot.now.time + WAY
        put(robot, (1.0, 0.0, 0.5), noise(1.0), 70.0)
        result = goal.finish().result
        assert result.sounds[0].header.stamp.to_sec() == pytest.approx(began, abs=EXACT)
        assert result.results[0].onset == result.sounds[0].header.stamp
        robot.advance(1.5)
    began = robot.now.time
    (done,) = ears.succeed(f("record", str_param="a.wav", duration=0.5)).results
    assert seconds([done.onset, done.offset]) == pytest.approx([began, began + 0.5], abs=0.05)
