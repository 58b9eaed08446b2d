"""Sound on the robot: microphones, files, volume, directions, speech and the recognition of words."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from nao_library_modules.core.errors import Preempted
from nao_library_modules.core.waiting import CancellationToken
from nao_library_modules.driver.audio.nao_audio import AudioPlayer, SoundDirections, read_recording
from nao_library_modules.driver.audio.nao_microphone import Microphone
from nao_library_modules.driver.audio.robot_speech import LONGEST_QUEUE, RobotSpeech, SpeechSettings
from nao_library_modules.driver.audio.speech_recognition import RecognizedWords, WordRecognition
from nao_library_modules.driver.base import lazy_subscription
from naoqi.errors import NaoError, RobotError

LIMIT = 60.0
BLOCK = 0.17


@pytest.fixture(autouse=True)
def _impatient(monkeypatch):
    """What runs on demand is looked after at once."""
    for name, seconds in (("RETRY", 0.02), ("FIRST_RETRY", 0.02), ("LOOK_PERIOD", 0.02)):
        monkeypatch.setattr(lazy_subscription, name, seconds)


def test_blocks_come_while_somebody_listens_with_samples_times_and_places(
    driver_robot, clock, closing, robot, until, eventually
):
    blocks = []
    microphone = closing(Microphone(driver_robot, "ros_naoqi_microphone", clock, blocks.append))
    assert microphone.report().message == "no subscriber"
    microphone.want(True)
    eventually(lambda: microphone.report().message == "heard")
    robot.post("ALAudioDevice", "playSine", 1000, 80, 0, 2.0)
    until(lambda: len(blocks) >= 6)
    assert {(block.rate, len(block.places), len(block.samples)) for block in blocks} == {(16000, 1, 2720)}
    assert np.diff([block.time.robot for block in blocks]) == pytest.approx(BLOCK, abs=1e-3)
    spectrum = np.abs(np.fft.rfft(blocks[-2].samples))
    assert np.argmax(spectrum) * 16000 / 2720 == pytest.approx(1000.0, abs=6.0)
    assert microphone.report().values["lost blocks"] == "0"
    driver_robot.lose()
    blocks.clear()
    until(lambda: len(blocks) >= 2, limit=60.0, step=BLOCK)
    microphone.set_rate(48000)
    until(lambda: blocks[-1].rate == 48000)
    assert (len(blocks[-1].places), len(blocks[-1].samples)) == (4, 4 * 8160)
    microphone.want(False)
    eventually(lambda: microphone.report().message == "no subscriber")
    robot.advance(0.5)
    count = len(blocks)
    robot.advance(1.0)
    assert len(blocks) == count
    for rate in (0, 22050, 44100):
        with pytest.raises(NaoError, match=rf"{rate}: 16000 \(1 channel\) or 48000 \(4 channels\)"):
            microphone.set_rate(rate)


def recording(seconds, name="driver/tone.wav"):
    return read_recording(name, seconds, 0, (True,) * 4, 48000)


def test_a_recording_takes_its_time_of_the_robot_and_plays_as_long(driver_robot, clock, robot, until, begin):
    player = AudioPlayer(driver_robot, clock, CancellationToken())
    start = robot.now.time
    record = begin(player.record, recording(2))
    robot.advance(0.5)
    with pytest.raises(NaoError, match="one at a time"):
        player.record(recording(1, "b.wav"))
    until(record.done)
    record.result()
    assert robot.now.time - start >= 2.0
    start = robot.now.time
    play = begin(player.play, recording(1).file)
    until(play.done)
    play.result()
    assert robot.now.time - start >= 1.9
    with pytest.raises(RobotError, match="no file"):
        player.play("/home/nao/missing.wav")
    player.set_volume(35)
    assert player.volume() == robot.ALAudioDevice.getOutputVolume() == 35


def test_an_interrupt_ends_what_is_played_and_completes_what_is_recorded(driver_robot, clock, robot, until, begin):
    interrupt = CancellationToken()
    player = AudioPlayer(driver_robot, clock, interrupt)
    record = begin(player.record, recording(20, "cut.wav"))
    robot.advance(1.0)
    interrupt.trigger()
    until(record.done, limit=1.0)
    with pytest.raises(Preempted):
        record.result()
    interrupt.clear()
    start = robot.now.time
    play = begin(player.play, recording(1, "cut.wav").file)
    until(play.done)
    play.result()  # what was recorded until then
    assert 0.8 <= robot.now.time - start < 10.0
    play = begin(player.play, recording(1, "cut.wav").file)
    robot.advance(0.2)
    interrupt.trigger()
    until(play.done, limit=0.3)
    with pytest.raises(Preempted):
        play.result()


def test_sounds_are_located_only_while_somebody_listens_and_once_after_a_loss(robot, driver_robot, closing, eventually):
    found, event = [], [[12, 500000], [0.5, -0.1, 0.9, 0.04], [0.0, 0.0, 0.1265, 0.0, 0.1, 0.2], [0.0] * 6]
    directions = closing(SoundDirections(driver_robot, "ros_nao_audio", 0.8, found.append))
    subscribers = robot.ALSoundLocalization.getSubscribersInfo
    robot.ALMemory.raiseEvent("ALSoundLocalization/SoundLocated", event)
    assert not subscribers() and directions.report().message == "no subscriber"
    directions.want(True)
    eventually(lambda: directions.report().message == "sounds are located")
    assert [name for name, *_ in subscribers()] == ["ros_nao_audio"]
    driver_robot.lose()
    eventually(lambda: directions.report().message == "sounds are located")
    robot.ALMemory.raiseEvent("ALSoundLocalization/SoundLocated", event)
    eventually(lambda: found)
    directions.want(False)
    eventually(lambda: not subscribers())
    robot.ALMemory.raiseEvent("ALSoundLocalization/SoundLocated", event)
    assert [each.azimuth for each in found] == [0.5]


@pytest.fixture
def settings():
    return [SpeechSettings()]


@pytest.fixture
def speech(robot, driver_robot, clock, settings, closing):
    return closing(RobotSpeech(driver_robot, clock, lambda: settings[0]))


def voice(robot):
    tts = robot.ALTextToSpeech
    return tts.getLanguage(), tts.getVoice(), round(tts.getVolume(), 3)


@pytest.fixture
def speaks(robot, until):
    """Lets time pass until the robot talks."""
    return lambda: until(lambda: robot.value("ALTextToSpeech/TextStarted") in (1, True))


def test_texts_wait_for_each_other_are_said_once_and_their_starts_are_told(speech, robot, until):
    events = []
    said = robot.heard("ALTextToSpeech/CurrentSentence")
    texts = [speech.say(text, on_start=lambda text=text: events.append(text)) for text in ("one", "two")]
    assert events == []
    until(lambda: events == ["one"])
    assert not texts[1].ended.is_set() and speech.report().message == "speaks"
    until(texts[1].ended.is_set)
    assert [text.error for text in texts] == [None, None] and events == ["one", "two"]
    sentences = [said.get(timeout=LIMIT) for _ in range(said.qsize())]
    assert [text for text in sentences if text] == ["one", "two"]
    assert speech.report().values["said"] == "2" and speech.report().message == "ready for texts"


def test_voice_language_and_volume_are_used_for_the_text_and_put_back(speech, robot, settings, until):
    robot.ALTextToSpeech.setVoice("slt")
    before, during = voice(robot), []
    for chosen in (SpeechSettings(voice="rms", volume=0.6), SpeechSettings(language="French")):
        settings[0] = chosen
        text = speech.say("bonjour", on_start=lambda: during.append(voice(robot)))
        until(text.ended.is_set)
        assert text.error is None and voice(robot) == before
    assert during == [("English", "rms", 0.6), ("French", "naofrf", before[2])]


def test_a_text_is_silenced_at_once_or_before_it_begins(speech, robot, settings, eventually, until, begin):
    settings[0] = SpeechSettings(volume=0.6)
    before, started = voice(robot), []
    first, second, third = (
        speech.say(text, on_start=lambda text=text: started.append(text))
        for text in ("a very long text that goes on and on and on", "two", "three")
    )
    until(lambda: started)
    now = robot.now.time
    for text in (second, first):
        speech.silence(text)
    eventually(first.ended.is_set)
    assert robot.now.time == now and isinstance(first.error, Preempted) and isinstance(second.error, Preempted)
    until(third.ended.is_set)
    assert third.error is None and len(started) == 2 and voice(robot) == before
    assert speech.report().values["interrupted"] == "2"
    texts = [speech.say(str(n)) for n in range(LONGEST_QUEUE)]
    with pytest.raises(NaoError, match="100 texts are waiting"):
        for n in range(2):
            texts.append(speech.say(str(n)))
    closed = begin(speech.close)
    until(closed.done)
    assert all(isinstance(text.error, Preempted) for text in texts) and voice(robot) == before


def test_texts_for_a_lost_robot_fail_and_later_ones_are_said_in_its_own_voice(
    speech, robot, driver_robot, settings, until
):
    before, failures = voice(robot), []
    settings[0] = SpeechSettings(volume=0.6)
    started = []
    first = speech.say("a text that goes on and on and on", lambda: started.append(1), failures.append)
    until(lambda: started)
    driver_robot.lose()
    until(first.ended.is_set)
    assert isinstance(first.error, NaoError) and failures == [first.error]
    speech.robot_is_back()
    until(lambda: voice(robot) == before)  # what was owed is put back
    second = speech.say("two", on_start=lambda: started.append(2))
    until(second.ended.is_set)
    assert second.error is None and started == [1, 2] and voice(robot) == before


@pytest.fixture
def heard():
    return []


@pytest.fixture
def recognition(robot, driver_robot, settings, heard, closing):
    robot.ALSpeechRecognition.setVocabulary(["yes"], False)  # its engine starts with the first words
    settings[0] = SpeechSettings(vocabulary=("yes", "no"), word_spotting=True, audio_expression=False)
    return closing(WordRecognition(driver_robot, "ros_nao_speech", lambda: settings[0], heard.append))


def listeners(robot):
    return [name for name, *_ in robot.ALSpeechRecognition.getSubscribersInfo()]


def test_it_listens_for_the_vocabulary_until_it_is_stopped(recognition, robot, settings, eventually):
    beeps = robot.ALSpeechRecognition.getAudioExpression()
    for _ in range(2):
        recognition.start()
        assert listeners(robot) == ["ros_nao_speech"] and recognition.report().message == "listens"
    assert robot.ALSpeechRecognition.getAudioExpression() is False
    for _ in range(2):
        recognition.stop()
    assert listeners(robot) == [] and robot.ALSpeechRecognition.getAudioExpression() is beeps
    settings[0] = SpeechSettings()
    with pytest.raises(NaoError, match="vocabulary is empty"):
        recognition.start()
    assert recognition.report().message == "does not listen" and listeners(robot) == []
    recognition.apply()  # while it does not listen a vocabulary waits
    good = settings[0] = SpeechSettings(vocabulary=("stop",))
    recognition.start()
    settings[0] = replace(good, vocabulary=("",))
    with pytest.raises(NaoError):
        recognition.apply()
    settings[0] = good
    assert listeners(robot) == ["ros_nao_speech"] and recognition.report().message == "listens"


def test_it_does_not_take_the_vocabulary_from_others_but_from_a_killed_run(recognition, robot):
    robot.ALSpeechRecognition.subscribe("Dialog")
    with pytest.raises(NaoError, match="in use by Dialog"):
        recognition.start()
    robot.ALSpeechRecognition.unsubscribe("Dialog")
    robot.ALSpeechRecognition.subscribe("ros_nao_speech")
    recognition.start()
    assert listeners(robot) == ["ros_nao_speech"]


def test_words_are_passed_on_whoever_listens_and_once_after_a_loss(recognition, robot, driver_robot, heard, eventually):
    def words():
        return [each for each in heard if each.words != ("warm up",)]

    def hears():
        """Whether events arrive by now."""
        count = len(heard)
        eventually(lambda: len(heard) > count or robot.ALMemory.raiseEvent("WordRecognized", ["warm up", 0.5]))

    hears()
    for value in (["", 0.0], ["yes", 0.7, "no", 0.1], ["<...> no <...>", 0.5]):
        robot.ALMemory.raiseEvent("WordRecognized", value)
    eventually(lambda: len(words()) == 2)
    assert sorted(words(), key=str) == [RecognizedWords(("no",), (0.5,)), RecognizedWords(("yes", "no"), (0.7, 0.1))]
    recognition.start()
    driver_robot.lose()
    eventually(lambda: listeners(robot) == ["ros_nao_speech"] and recognition.report().message == "listens")
    hears()
    robot.ALMemory.raiseEvent("WordRecognized", ["stop", 0.4])
    eventually(lambda: len(words()) == 3)
    hears()
    assert len(words()) == 3
    recognition.stop()
    driver_robot.lose()
    assert listeners(robot) == [] and recognition.report().message == "does not listen"
