"""ALTextToSpeech over the network: speech, events, files, the voice and its parameters."""

from __future__ import annotations

import json
import threading
import time

import numpy as np
import pytest
import soundfile

from nao_sim_bridge.services.audio.text_to_speech import ALTextToSpeech

LONG = "This is a text that takes a while, and nobody hears its end."
EVENTS = ["TextStarted", "TextDone", "TextInterrupted", "CurrentWord", "PositionOfCurrentWord", "CurrentSentence"]
EVENTS += ["CurrentBookMark", "Status"]


@pytest.fixture
def tts(robot):
    """The service, as at the start, silent."""
    robot.ALTextToSpeech.setLanguage("English")
    robot.ALTextToSpeech.reset()
    yield robot.ALTextToSpeech
    robot.ALTextToSpeech.stopAll()


@pytest.fixture
def until(robot):
    """Lets time pass until a call is over; its duration in simulated time, exact to 0.05 s."""

    def wait(future, limit=30.0):
        robot.handed_over("ALTextToSpeech")
        began = robot.now.time
        while future.isRunning() and robot.now.time < began + limit:
            robot.advance(0.05)
        robot.answer(future)
        return robot.now.time - began

    return wait


@pytest.fixture
def heard(robot, listener):
    """What events tell from now on, as (event, value)."""
    memory = robot.ALMemory
    names = [f"ALTextToSpeech/{name}" for name in EVENTS]
    for name in names:
        memory.subscribeToEvent(name, "Listener", "onEvent")

    def so_far(last):
        """All up to and with an event of that value."""
        found = []
        while not found or found[-1] != last:
            name, value, _ = listener.heard.get(timeout=robot.patience)
            found.append((name.split("/")[1], value))
        return found

    yield so_far
    for name in names:
        memory.unsubscribeToEvent(name, "Listener")


def played(robot, seconds):
    """(frames, 2) of what the loudspeakers played last."""
    now = robot.server.simulation.time
    return robot.server.simulation.sound.loudspeakers.played(max(now - seconds, 0.0), now).samples


def said(robot, until, *arguments):
    """How long a text takes, s."""
    return until(robot.post("ALTextToSpeech", "say", *arguments))


# --- speaking ---------------------------------------------------------------------------------------------------------


def test_say_is_over_when_the_sound_is(robot, tts, until):
    duration = said(robot, until, "Hello, I am a robot.")
    sound = played(robot, duration)
    loud = np.flatnonzero(np.abs(sound[:, 0]) > 0.02) / 48000.0
    assert 1.0 < duration < 3.0
    assert loud[0] < 0.25 and duration - 0.7 < loud[-1] < duration
    assert np.array_equal(sound[:, 0], sound[:, 1])


def test_a_longer_text_takes_longer(robot, tts, until):
    one, both = "The first sentence. ", "The second sentence, which is longer."
    assert said(robot, until, one + both) == pytest.approx(said(robot, until, one) + said(robot, until, both), abs=0.15)


def test_events_tell_what_is_said(robot, tts, until, heard):
    until(robot.post("ALTextToSpeech", "say", r"Hello \mrk=12\ world."))
    found = heard(("TextDone", True))
    (number,) = {value[0] for name, value in found if name == "Status"}
    assert found == [
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


def test_events_come_at_the_time_of_what_they_tell(robot, tts, until):
    until(robot.post("ALTextToSpeech", "say", "One, two, three."))
    memory = robot.server.memory
    starts = {value: at for value, at in memory.history("ALTextToSpeech/CurrentWord")[-3:]}
    began = [at for value, at in memory.history("ALTextToSpeech/TextStarted") if value][-1]
    ended = memory.history("ALTextToSpeech/TextDone")[-1][1]
    assert list(starts) == ["One", "two", "three"]
    assert 0.0 <= starts["One"] - began < 0.1
    assert began < starts["One"] < starts["two"] - 0.2 < starts["three"] - 0.4 < ended
    sound = np.abs(played(robot, robot.now.time - began)[:, 0])
    for start in starts.values():
        begin = round((start - began) * 48000)
        assert sound[begin : begin + 12000].max() > 0.1


def test_the_keys_tell_while_it_speaks_that_it_is_not_done(robot, tts, until):
    said(robot, until, "One.")
    future = robot.post("ALTextToSpeech", "say", LONG)
    robot.handed_over("ALTextToSpeech")
    robot.advance(0.5)
    read = robot.ALMemory.getListData
    keys = [f"ALTextToSpeech/{name}" for name in ("TextStarted", "TextDone", "TextInterrupted")]
    assert read(keys) == [True, False, False]
    tts.stopAll()
    until(future)
    assert read(keys) == [False, False, True]


def test_texts_that_are_said_at_once_are_said_one_after_the_other(robot, tts, until):
    alone = [said(robot, until, text) for text in ("One two.", "Three four five.")]
    futures = [robot.post("ALTextToSpeech", "say", text) for text in ("One two.", "Three four five.")]
    assert until(futures[0]) == pytest.approx(alone[0], abs=0.11)
    assert futures[1].isRunning()
    assert until(futures[1]) == pytest.approx(alone[1], abs=0.11)


@pytest.mark.parametrize("way", ["stopAll", "stop", "cancel"])
def test_a_stop_is_silence_at_once(robot, tts, until, way):
    if way == "stop":
        number = tts.pCall("say", LONG)
    else:
        future = robot.post("ALTextToSpeech", "say", LONG)
    robot.handed_over("ALTextToSpeech")
    robot.advance(1.0)
    assert np.abs(played(robot, 0.5)).max() > 0.05
    if way == "cancel":
        future.cancel()
    else:
        tts.call(way, *([number] if way == "stop" else []))
    give_up = time.monotonic() + robot.patience
    while robot.server.speech.speaker.speaking and time.monotonic() < give_up:
        robot.settled()
    robot.advance(1.0)
    assert np.abs(played(robot, 0.97)).max() == 0.0
    assert not (tts.isRunning(number) if way == "stop" else future.isRunning())


def test_stop_all_stops_those_that_wait_too(robot, tts, heard):
    futures = [robot.post("ALTextToSpeech", "say", LONG) for _ in range(3)]
    robot.handed_over("ALTextToSpeech")
    robot.advance(0.5)
    tts.stopAll()
    for future in futures:
        robot.answer(future)
    found = heard(("TextInterrupted", True))
    assert [value[1] for name, value in found if name == "Status"].count("stopped") == 3
    assert ("TextDone", True) not in found


def test_a_posted_text_has_a_number_to_wait_for(robot, tts):
    number = tts.pCall("say", "One.")
    assert tts.isRunning(number)
    robot.finish("ALTextToSpeech", "wait", number, 0, after=2.0)
    assert not tts.isRunning(number)


def test_a_reset_of_the_robot_ends_speech(robot, tts):
    future = robot.post("ALTextToSpeech", "say", LONG)
    robot.handed_over("ALTextToSpeech")
    robot.advance(0.5)
    robot.NaoSimulation.reset()
    robot.answer(future)


def test_another_language_for_one_text(robot, tts, until):
    assert said(robot, until, "Guten Tag.", "German") > 0.3
    assert (tts.getLanguage(), tts.getVoice()) == ("English", "naoenu")


@pytest.mark.parametrize("text", ["", " \n", r"\rspd=80\ ", "..."])
def test_nothing_to_say_is_said_at_once(robot, tts, until, text):
    assert said(robot, until, text) < 0.2


def test_without_notifications_there_are_no_events(robot, tts, until, heard):
    tts.disableNotifications()
    said(robot, until, "One.")
    tts.enableNotifications()
    said(robot, until, "Two.")
    assert ("CurrentSentence", "One.") not in heard(("TextDone", True))


# --- files ------------------------------------------------------------------------------------------------------------


def test_a_file_has_the_speech_and_nothing_is_heard(robot, tts, until):
    duration = said(robot, until, "This is in a file.")
    began = robot.now.time
    tts.sayToFile("This is in a file.", "day/one.wav")
    robot.advance(1.0)
    assert np.abs(played(robot, robot.now.time - began)).max() == 0.0
    path = robot.server.files.folder / "day/one.wav"
    sound, rate = soundfile.read(path)
    assert (rate, sound.ndim) == (22050, 1) and soundfile.info(str(path)).subtype == "PCM_16"
    assert len(sound) / rate == pytest.approx(duration, abs=0.06)
    tts.sayToFile("This is in a file.", "/home/nao/day/one.raw")
    raw = np.fromfile(path.with_suffix(".raw"), "<i2") / 32768.0
    assert np.corrcoef(raw, sound)[0, 1] > 0.999


def test_a_file_can_be_heard_as_well(robot, tts, until):
    began = robot.now.time
    future = robot.post("ALTextToSpeech", "sayToFileAndPlay", "Twice.")
    while future.isRunning() and robot.now.time < began + 10.0:
        robot.advance(0.05)
    robot.answer(future)
    assert np.abs(played(robot, 1.0)).max() > 0.05
    assert (robot.server.files.folder / "sayToFileAndPlay.wav").exists()


def test_stop_all_also_stops_a_text_whose_file_is_being_written(robot, tts, monkeypatch):
    written, may_go_on = threading.Event(), threading.Event()

    def write(*_):
        written.set()
        assert may_go_on.wait(robot.patience)

    monkeypatch.setattr(ALTextToSpeech, "_write", write)
    future = robot.post("ALTextToSpeech", "sayToFileAndPlay", "Never heard.")
    assert written.wait(robot.patience)
    robot.answer(robot.post("ALTextToSpeech", "stopAll"))
    may_go_on.set()
    robot.answer(future)
    assert not robot.server.speech.speaker.speaking


# --- the voice --------------------------------------------------------------------------------------------------------


def test_languages_and_voices_belong_together(tts):
    assert tts.getLanguage() == "English" and tts.locale() == "en_US" and tts.getLanguageEncoding("French") == "UTF-8"
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


def test_speed_has_a_default_that_it_goes_back_to(robot, tts, until):
    usual = said(robot, until, LONG)
    tts.setParameter("speed", 200.0)
    assert said(robot, until, LONG) == pytest.approx(usual / 2.0, rel=0.2)
    tts.resetSpeed()
    assert tts.getParameter("speed") == 100.0
    tts.setParameter("defaultVoiceSpeed", 150.0)
    assert tts.getParameter("speed") == 150.0
    tts.setLanguage("German")
    assert tts.getParameter("defaultVoiceSpeed") == tts.getParameter("speed") == 100.0


def test_volume_makes_it_quieter(robot, tts, until):
    levels = []
    for volume in (1.0, 0.5):
        tts.setVolume(volume)
        duration = said(robot, until, "Away.")
        levels.append(np.abs(played(robot, duration)).max())
    assert tts.getVolume() == 0.5
    assert levels[1] == pytest.approx(0.5 * levels[0], rel=0.01)


def test_reset_brings_back_the_start(tts):
    tts.setParameter("pitchShift", 1.5)
    tts.setParameter("volume", 30.0)
    tts.setVolume(0.3)
    tts.setVoice("kal")
    tts.reset()
    assert tts.getParameter("pitchShift") == 1.0 and tts.getParameter("volume") == 80.0
    assert (tts.getVolume(), tts.getVoice()) == (1.0, "naoenu")


def test_the_dictionary_changes_what_is_heard(robot, tts, until):
    usual = said(robot, until, "xy")
    assert tts.addToDictionary("xy", "something that takes much longer") is True
    assert said(robot, until, "xy") > usual + 0.5
    tts.showDictionary()
    assert tts.addToDictionary("xy", r"\toi=lhp\E'mil\toi=orth\ ") is False
    assert tts.deleteFromDictionary("xy") is True and tts.deleteFromDictionary("xy") is False
    assert said(robot, until, "xy") == pytest.approx(usual, abs=0.06)
    assert tts.addToDictionary("noun", "ab", "1", "another one", "0") is True
    assert tts.deleteFromDictionary("noun", "ab") is True


def test_a_voice_preference_is_a_file(robot, tts):
    path = robot.server.files.folder / "ALTextToSpeech_Voice_mine.json"
    path.write_text(json.dumps({"voice": "rms", "volume": 0.5, "parameters": {"speed": 120}}))
    tts.loadVoicePreference("mine")
    assert (tts.getVoice(), tts.getVolume(), tts.getParameter("speed")) == ("rms", 0.5, 120.0)
    path.write_text(json.dumps({"volume": 0.9, "parameters": {"sped": 120}}))
    with pytest.raises(RuntimeError, match="parameter is 'sped', allowed is one of pitchShift"):
        tts.loadVoicePreference("mine")
    assert tts.getVolume() == 0.5
    path.write_text("{")
    with pytest.raises(RuntimeError, match="ALTextToSpeech_Voice_mine.json cannot be read"):
        tts.loadVoicePreference("mine")


@pytest.mark.parametrize(
    "method, arguments, problem",
    [
        ("setVoice", ("Bob",), "voice is 'Bob', allowed is one of naoenu, slt"),
        ("setLanguage", ("Klingon",), "language is 'Klingon', allowed is one of English, French"),
        ("say", ("text", "Klingon"), "language is 'Klingon', allowed is one of English, French"),
        ("setLanguageDefaultVoice", ("French", "rms"), "Voice is 'rms', allowed is a voice of French: naofrf"),
        ("getLanguageEncoding", ("Klingon",), "pLanguage is 'Klingon'"),
        ("setParameter", ("speed", 20.0), "speed is 20.0, allowed is 50 to 400"),
        ("setParameter", ("pitchShift", 0.5), r"pitchShift is 0.5, allowed is 0 \(off\) or 1 to 4"),
        ("setParameter", ("doubleVoice", float("nan")), "doubleVoice is nan, allowed is a finite number"),
        ("setParameter", ("sped", 100.0), "parameter is 'sped', allowed is one of pitchShift, doubleVoice"),
        ("getParameter", ("sped",), "parameter is 'sped', allowed is one of"),
        ("setVolume", (1.5,), "volume is 1.5, allowed is 0 to 1"),
        ("addToDictionary", (" ", "x"), "word is ' ', allowed is a word"),
        ("sayToFile", ("text", "one.mp3"), r"pFileName is 'one.mp3', allowed is a name that ends in .wav or .raw"),
        ("sayToFile", ("text", "../one.wav"), "file '../one.wav' is not inside"),
        ("loadVoicePreference", ("none",), "no file 'ALTextToSpeech_Voice_none.json'"),
    ],
)
def test_errors_name_what_is_wrong_and_what_is_allowed(tts, method, arguments, problem):
    with pytest.raises(RuntimeError, match=problem):
        tts.call(method, *arguments)
