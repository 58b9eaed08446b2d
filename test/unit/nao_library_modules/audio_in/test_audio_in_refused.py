"""What is refused before anything runs."""

from __future__ import annotations

import math

import pytest
from audio_in_goals import LISTEN, YES_NO, f, play, succeed
from genpy import Duration

from naoqi.errors import RobotError

NAN, INF = math.nan, math.inf
FIRST = f("setOutputVolume", volume=10)


@pytest.mark.parametrize(
    "bad, told",
    [
        (f("record", str_param="a.wav"), "field duration: 0.0 is not allowed: above 0 to 3600 s"),
        (f("record", str_param="a.wav", duration=NAN), "field duration"),
        (f("record", str_param="a.wav", duration=-1.0), "field duration"),
        (f("record", str_param="a.wav", duration=1e9), "field duration"),
        (f("record", duration=1.0), "field str_param: it is empty"),
        (f("record", str_param="../a.wav", duration=1.0), "leads out of the folder"),
        (f("record", str_param="/etc/a.wav", duration=1.0), "leads out of the folder"),
        (f("record", str_param="a.mp3", duration=1.0), "ends in .wav, .ogg"),
        (f("record", str_param="a.wav", file_type="ogg", duration=1.0), "field file_type"),
        (f("record", str_param="a.wav", file_type="flac", duration=1.0), "'flac' is no type of recordings"),
        (f("record", str_param="a.wav", rate=44100, duration=1.0), "field rate: 44100 is not allowed: 16000, 48000"),
        (f("record", str_param="a.wav", channels=["fornt"], duration=1.0), "did you mean 'front'"),
        (f("record", str_param="a.wav", channels=["left", "left"], duration=1.0), "each microphone once"),
        (f("record", str_param="a.wav", channels=["left", "rear"], duration=1.0), "2 channel(s): one of left, right"),
        (f("startRecording", str_param="a.wav", rate=48000, channels=["left"]), "1 channel(s) at 48000 Hz"),
        (f("startRecording", str_param="a.wav", rate=-1), "field rate"),
        (f("listen"), "field vocabulary: it is empty: at least one word or phrase, here or by setVocabulary before"),
        (f("listen", vocabulary=["yes", " "]), "there is an empty phrase in it"),
        (f("listen", vocabulary=["yes|no"]), "'|' in 'yes|no' cannot be said"),
        (f("listen", vocabulary=["<yes>"]), "'<' in '<yes>' cannot be said"),
        (f("listen", vocabulary=["a\x07b"]), "cannot be said"),
        (f("listen", vocabulary=["☎"]), "cannot be said"),
        (f("listen", vocabulary=["..."]), "nothing to say in '...'"),
        (f("listen", vocabulary=["word " * 50]), "is too long"),
        (f("listen", vocabulary=["word"] * 1001), "1001 words and phrases are too many"),
        (f("listen", vocabulary=YES_NO, timeout=NAN), "field timeout"),
        (f("listen", vocabulary=YES_NO, timeout=-1.0), "field timeout"),
        (f("listen", vocabulary=YES_NO, timeout=1e7), "field timeout: 10000000.0 is not allowed: up to 3600 s"),
        (f("listen", vocabulary=YES_NO, confidence=1.5), "field confidence: 1.5 is not allowed: 0..1"),
        (f("listen", vocabulary=YES_NO, confidence=NAN), "field confidence"),
        (
            f("listen", vocabulary=YES_NO, str_param="Frensh"),
            "did you mean 'French', 'English'?: one of English, French",
        ),
        (f("setVocabulary"), "at least one word or phrase"),
        (f("startRecognition"), "at least one word or phrase"),
        (f("setLanguage", str_param="Klingon"), "no language that the robot recognises"),
        (f("detectSound", timeout=INF), "field timeout"),
        (f("detectSound", confidence=-0.1), "field confidence"),
        (f("localizeSound", timeout=NAN), "field timeout"),
        (f("localizeSound", duration=NAN), "field duration"),
        (f("getEnergy", duration=-1.0), "field duration"),
        (f("setSensitivity"), "field sensitivity: 0.0 is not allowed: above 0 to 1"),
        (f("setSensitivity", sensitivity=2.0), "field sensitivity"),
        (f("setSensitivity", sensitivity=0.5, str_param="smell"), "one of speech, detection, localization"),
        (f("setParameter", str_param="Sensitivity"), "field values: [] is not allowed: one number"),
        (f("setParameter", values=[1.0]), "the name of a parameter"),
        (f("setParameter", str_param="outputSampleRate", values=[11025]), "16000, 22050, 44100, 48000"),
        (f("getParameter"), "the name of a parameter"),
        (f("setFileAsInput", str_param="a.txt"), "not a file of a known kind"),
        (f("setOutputVolume", volume=101), "field volume"),
        (f("lisen", vocabulary=YES_NO), "did you mean 'listen'"),
        (f("listen", vocabulary=YES_NO, time=Duration(-1)), "field time"),
    ],
)
def test_a_bad_function_moves_nothing_of_its_chain(hearing, ears, bad, told):
    server = play(hearing, FIRST, bad)
    assert server.end == "aborted"
    assert server.text.startswith(f"function 2 ({bad.function}): ") and told in server.text, server.text
    assert ears.card.volume == 60 and ears.idle()


@pytest.mark.parametrize("phrase", ["don't", "stand-up", "Größe", "R2 D2", "bon jour", "3.5", "now!"])
def test_what_people_say_is_allowed(hearing, ears, phrase):
    succeed(hearing, f("setVocabulary", vocabulary=[phrase]))
    assert ears.recognition.vocabulary == ([phrase], False)


def test_a_robot_without_hearing_is_told_and_the_server_stays(hearing, ears, robot):
    class Deaf:
        def call_async(self, method, *args):
            raise RobotError("naoqi", method, "there is no module ALSpeechRecognition")

    robot._proxies["ALSpeechRecognition"] = Deaf()
    server = play(hearing, LISTEN)
    assert server.end == "aborted" and "no module ALSpeechRecognition" in server.text
    assert ears.idle()
    succeed(hearing, f("ping"))
