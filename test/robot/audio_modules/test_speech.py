"""ALTextToSpeech: speech, events, files, the voice and its parameters."""

from __future__ import annotations

import json

import numpy as np
import pytest
import soundfile
from sounds import loudness, played, until

LONG = "This is a text that takes a while, and nobody hears its end."
EVENTS = ["TextStarted", "TextDone", "TextInterrupted", "CurrentWord", "PositionOfCurrentWord", "CurrentSentence"]
EVENTS += ["CurrentBookMark", "Status"]


@pytest.fixture
def tts(robot):
    return robot.ALTextToSpeech


@pytest.fixture
def begin(robot, tts):
    def call(*arguments, method="say"):
        future = robot.post("ALTextToSpeech", method, *arguments)
        robot.handed_over("ALTextToSpeech")
        return future

    return call


@pytest.fixture
def say(robot, begin):
    """Says a text; how long it takes, s."""
    return lambda *arguments: until(robot, begin(*arguments))


@pytest.fixture
def events(robot):
    """What events tell, as (event, value, time)."""
    found = []
    for name in EVENTS:
        key = f"ALTextToSpeech/{name}"
        robot.server.memory.listen(key, lambda value, name=name: found.append((name, value, robot.now.time)))
    return found


def test_say_is_over_when_the_sound_is_and_events_tell_what_is_said(robot, say, events):
    began = robot.now.time
    duration = say(r"Hello \mrk=12\ world.")
    sound = played(robot, began)
    loud = np.flatnonzero(np.abs(sound[:, 0]) > 0.02) / 48000.0
    assert 0.5 < duration < 2.5 and loud[0] < 0.25 and duration - 0.7 < loud[-1] < duration
    assert np.array_equal(sound[:, 0], sound[:, 1])
    (number,) = {value[0] for name, value, _ in events if name == "Status"}
    assert [(name, value) for name, value, _ in events] == [
        ("Status", [number, "enqueued"]),
        ("Status", [number, "started"]),
        ("TextStarted", True),
        ("CurrentSentence", "Hello world."),
        ("PositionOfCurrentWord", 0),
        ("CurrentWord", "Hello"),
        ("CurrentBookMark", 12),
        ("PositionOfCurrentWord", 1),
        ("CurrentWord", "world"),
        ("Status", [number, "done"]),
        ("TextStarted", False),
        ("TextDone", True),
    ]
    assert robot.ALMemory.getData("ALTextToSpeech/TextDone") is True


@pytest.mark.parametrize("way", ["stopAll", "stop", "cancel", "reset"])
def test_a_stop_is_silence_at_once_for_those_that_wait_too(robot, tts, begin, events, way):
    if way == "stop":
        number = tts.pCall("say", LONG)
        robot.handed_over("ALTextToSpeech")
    else:
        futures = [begin(LONG) for _ in range(1 if way == "cancel" else 3)]
    robot.advance(1.0)
    assert np.abs(played(robot, robot.now.time - 0.5)).max() > 0.05
    if way == "stop":
        tts.stop(number)
    else:
        {"stopAll": tts.stopAll, "cancel": futures[0].cancel, "reset": robot.NaoSimulation.reset}[way]()
        for future in futures:
            future.wait(int(1000 * robot.patience))
            assert not future.isRunning()
        assert [value[1] for name, value, _ in events if name == "Status"].count("stopped") == len(futures)
        assert ("TextInterrupted", True) in [event[:2] for event in events]
    robot.settled()
    stopped = robot.now.time
    robot.advance(0.5)
    assert not played(robot, stopped + 0.05).any() and ("TextDone", True) not in [event[:2] for event in events]
    assert way != "stop" or not tts.isRunning(number)


def test_a_file_has_the_speech_and_nothing_is_heard(robot, tts, say):
    duration, path = say("This is in a file."), robot.server.files.folder / "day/one.wav"
    began = robot.now.time
    tts.sayToFile("This is in a file.", "day/one.wav")
    robot.advance(0.5)
    assert not played(robot, began).any()
    sound, rate = soundfile.read(path)
    assert (rate, sound.ndim) == (22050, 1) and soundfile.info(str(path)).subtype == "PCM_16"
    assert len(sound) / rate == pytest.approx(duration, abs=0.06)
    tts.sayToFile("This is in a file.", "/home/nao/day/one.raw")
    assert np.corrcoef(np.fromfile(path.with_suffix(".raw"), "<i2") / 32768.0, sound)[0, 1] > 0.999


def test_languages_and_voices_belong_together(tts, say):
    assert say("Guten Tag.", "German") > 0.3
    assert (tts.getLanguage(), tts.getVoice()) == ("English", "naoenu")
    assert tts.locale() == "en_US" and tts.getLanguageEncoding("French") == "UTF-8"
    assert set(tts.getAvailableLanguages()) <= set(tts.getSupportedLanguages())
    tts.setLanguage("French")
    assert (tts.getVoice(), tts.locale()) == ("naofrf", "fr_FR")
    tts.setVoice("rms")
    assert tts.getLanguage() == "English"
    tts.setLanguageDefaultVoice("English", "awb")
    assert tts.getVoice() == "awb"
    tts.setLanguage("German")
    tts.setLanguage("English")
    assert tts.getVoice() == "awb"
    tts.setLanguageDefaultVoice("English", "naoenu")


def test_speed_has_a_default_that_it_goes_back_to(tts, say):
    usual = say("We are all away now.")
    tts.setParameter("speed", 200.0)
    assert say("We are all away now.") == pytest.approx(usual / 2.0, rel=0.25)
    tts.resetSpeed()
    assert tts.getParameter("speed") == 100.0
    tts.setParameter("defaultVoiceSpeed", 150.0)
    assert tts.getParameter("speed") == 150.0
    tts.setLanguage("German")
    assert tts.getParameter("defaultVoiceSpeed") == tts.getParameter("speed") == 100.0


def test_volume_makes_it_quieter_and_reset_brings_back_the_start(robot, tts, say):
    levels = []
    for volume in (1.0, 0.5):
        tts.setVolume(volume)
        began = robot.now.time
        say("Away.")
        levels.append(loudness(played(robot, began, began + 0.6)))
    assert tts.getVolume() == 0.5 and levels[1] == pytest.approx(0.5 * levels[0], rel=0.01)
    for name, value in (("pitchShift", 0.8), ("volume", 30.0)):
        tts.setParameter(name, value)
    tts.setVoice("kal")
    tts.reset()
    assert tts.getParameter("pitchShift") == 1.0 and tts.getParameter("volume") == 80.0
    assert (tts.getVolume(), tts.getVoice()) == (1.0, "naoenu")


def test_volumes_beyond_a_limit_are_taken_for_it(robot, tts, caplog):
    tts.setVolume(1.5)
    robot.ALAudioDevice.setOutputVolume(-3)
    assert (tts.getVolume(), robot.ALAudioDevice.getOutputVolume()) == (1.0, 0)
    told = [record.getMessage() for record in caplog.records if record.name == "nao_sim.limits"]
    taken = ["volume is 1.5, and taken for 1: allowed is 0 to 1", "volume is -3, and taken for 0: allowed is 0 to 100"]
    assert told == taken


def test_a_voice_preference_is_a_file(robot, tts):
    path = robot.server.files.folder / "ALTextToSpeech_Voice_mine.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps({"voice": "rms", "volume": 0.5, "parameters": {"speed": 120}}))
    tts.loadVoicePreference("mine")
    assert (tts.getVoice(), tts.getVolume(), tts.getParameter("speed")) == ("rms", 0.5, 120.0)
    path.write_text(json.dumps({"volume": 0.9, "parameters": {"sped": 120}}))
    with pytest.raises(RuntimeError, match="parameter is 'sped': did you mean 'speed'\\? allowed is one of pitchShift"):
        tts.loadVoicePreference("mine")
    assert tts.getVolume() == 0.5


def test_errors_name_what_is_wrong_and_what_is_allowed(tts, refused):
    rows = [
        ("setVoice", ("Bob",), "voice is 'Bob', allowed is one of naoenu, slt"),
        ("setLanguage", ("Klingon",), "language is 'Klingon', allowed is one of English, French"),
        ("setLanguageDefaultVoice", ("French", "rms"), "Voice is 'rms', allowed is a voice of French: naofrf"),
        ("setParameter", ("speed", 20.0), "speed is 20.0, allowed is 50 to 400"),
        ("setParameter", ("pitchShift", 0.25), r"pitchShift is 0.25, allowed is 0 \(off\) or 0.5 to 4"),
        ("getParameter", ("sped",), "parameter is 'sped': did you mean 'speed'\\? allowed is one of"),
        ("sayToFile", ("text", "one.mp3"), r"pFileName is 'one.mp3', allowed is a name that ends in .wav or .raw"),
        ("loadVoicePreference", ("none",), "no file 'ALTextToSpeech_Voice_none.json'"),
    ]
    refused("ALTextToSpeech", rows)
    assert (tts.getVoice(), tts.getVolume(), tts.getParameter("speed")) == ("naoenu", 1.0, 100.0)
