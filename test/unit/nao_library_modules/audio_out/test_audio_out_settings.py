"""What is set goes back, and what functions answer."""

from __future__ import annotations

import pytest
from audio_out_goals import calls, f, play
from genpy import Duration


def test_what_is_set_goes_back_after_the_wait(audio, speech, player, device, edge):
    seen = []
    wait = edge.clock.wait

    def look(*args):
        seen.append((device.volume, device.muted, speech.voice, speech.volume, player.master))
        return wait(*args)

    edge.clock.wait = look
    short = Duration.from_sec(0.01)
    server = play(
        audio,
        f("setOutputVolume", volume=20, revert=True, time=short),
        f("muteAudioOut", enable=True, revert=True, time=short),
        f("setVoice", "naofrf", revert=True, time=short),
        f("setVolume", volume=0.1, revert=True, time=short),
        f("setMasterVolume", volume=0.2, revert=True, time=short),
    )
    assert server.end == "succeeded", server.text
    assert seen == [
        (20, False, "naoenu", 0.75, 1.0),
        (60, True, "naoenu", 0.75, 1.0),
        (60, False, "naofrf", 0.75, 1.0),
        (60, False, "naoenu", 0.1, 1.0),
        (60, False, "naoenu", 0.75, 0.2),
    ]
    assert (device.volume, device.muted, speech.voice, speech.volume, player.master) == (60, False, "naoenu", 0.75, 1.0)


def test_what_is_set_without_revert_stays(audio, device, speech):
    server = play(audio, f("setOutputVolume", volume=20), f("setLanguage", "French"), f("getOutputVolume"))
    assert (device.volume, speech.voice) == (20, "naofrf")
    assert (server.result.memList, server.result.volume) == (["20"], 20.0)


def test_parameters_of_the_voice_and_of_the_sound_card(audio, speech, device, edge):
    server = play(
        audio,
        f("setParameter", names=["pitchShift", "speed"], values=[1.5, 80], revert=True),
        f("setParameter", names=["speed"], values=[150]),
        f("setParameter", "outputSampleRate", values=[16000]),
        f("getParameter", names=["speed", "pitchShift"]),
        f("getParameter", "outputSampleRate"),
        f("getParameter", "speed"),
    )
    assert server.end == "succeeded", server.text
    assert speech.parameters == {"speed": 150.0, "pitchShift": 1.0}
    assert device.parameters["outputSampleRate"] == 16000
    assert server.result.memList == ["150.0", "1.0", "16000", "150.0"]


def test_volume_of_speech_and_of_a_sound(audio, speech, player):
    server = play(
        audio,
        f("setVolume", volume=0.5),
        f("loadFile", "one.wav"),
        f("setVolume", "one.wav", volume=0.25, revert=True),
        f("setVolume", volume=0.5, sound_id=9),
        f("getVolume"),
        f("getVolume", sound_id=9),
    )
    assert server.end == "succeeded", server.text
    assert (speech.volume, player.volumes) == (0.5, {7: 1.0, 9: 0.5})
    assert server.result.memList == ["7", "0.5", "0.5"]


def test_numbers_of_the_robot_are_told_as_they_were_meant(audio, speech):
    speech.volume = 0.30000001192092896  # 32 bits of 0.3
    assert play(audio, f("getVolume")).result.memList == ["0.3"]


def test_words_are_taught_and_forgotten(audio, speech):
    server = play(
        audio,
        f("addToDictionary", "NAO", texts=["now"]),
        f("addToDictionary", "type", texts=["word", "1", "phonetic", "accent"]),
        f("deleteFromDictionary", "NAO"),
    )
    assert (server.end, server.result.memList) == ("succeeded", ["True", "True", "True"])
    assert speech.words == {"type": ("word", "1", "phonetic", "accent")}


def test_tags_link_words_and_animations(audio, robot):
    play(audio, f("addTagsToWords", "hello", texts=["hi", "hey"]), f("setBodyLanguageMode", body_language="random"))
    assert calls(robot, "ALAnimatedSpeech") == [
        ("addTagsToWords", {"hello": ["hi", "hey"]}),
        ("setBodyLanguageModeFromStr", "random"),
    ]


ASKING = {
    "getVoice": ["naoenu"],
    "getAvailableVoices": ["naoenu", "naofrf"],
    "getLanguage": ["English"],
    "getAvailableLanguages": ["English", "French"],
    "getSupportedLanguages": ["English", "French", "Klingon"],
    "locale": ["en_US"],
    "getVolume": ["0.75"],
    "getMasterVolume": ["1.0"],
    "getBodyLanguageMode": ["contextual"],
    "getLoadedFilesIds": [],
    "getLoadedFilesNames": [],
    "getInstalledSoundSetsList": ["Bips"],
    "getLoadedSoundSetsList": ["Bips"],
    "getOutputVolume": ["60"],
    "isAudioOutMuted": ["False"],
    "isOutputClosed": ["False"],
    "isInputClosed": ["False"],
    "listOutputs": ['["speakers", 2]'],
    "listInputs": ['["microphones", 4]'],
    "resetSpeed": [],
    "reset": [],
    "showDictionary": [],
    "flushAudioOutputs": [],
    "openAudioOutputs": [],
    "closeAudioOutputs": [],
    "openAudioInputs": [],
    "closeAudioInputs": [],
    "unloadAllFiles": [],
    "waitUntilSilent": [],
}


@pytest.mark.parametrize("function", ASKING)
def test_answers(audio, function):
    server = play(audio, f(function))
    assert (server.end, server.result.memList) == ("succeeded", ASKING[function]), server.text
