"""What fields of the functions of speech and sounds may hold, told without a robot; what needs one is in its tests."""

from __future__ import annotations

import math

import pytest
from goal_functions import audio_out as f

from nao_library_actions.msg import NaoAudioOutGoal
from nao_library_modules.audio_out.audio_out_server import NaoAudioOutput
from nao_library_modules.core.chain import FunctionChain, declared_fields, fields_taken
from nao_library_modules.core.describe import LANGUAGES, VOICES
from nao_library_modules.core.errors import BadGoal
from nao_library_modules.core.goal_checks import check_goals, offline_module
from nao_library_modules.nao_audio import DeviceParameter, DeviceSetting, OutputRate
from nao_library_msgs.msg import AudioOutFunction

FUNCTIONS = NaoAudioOutput.declared_functions()
FIELDS, NAN = AudioOutFunction.__slots__, math.nan
HI, WAV, SOUND = {"str_param": "Hi"}, {"str_param": "a.wav"}, {"sound_id": 7}
SINE = {"frequency": 440, "duration": 1.0}


@pytest.fixture(scope="module")
def refusals():
    """What is refused of a chain of functions, as texts."""
    chain = FunctionChain(offline_module(NaoAudioOutput).function_table)
    return lambda *functions: [str(failed) for failed in chain.failures(functions)]


@pytest.mark.parametrize(
    ("name", "fields", "field", "values", "text"),
    [
        ("say", {}, "str_param", ["", " \n\t"], "it is empty: the text to say"),
        ("say", HI, "volume", [1.5, -0.1, NAN], "is not allowed: 0..1"),
        ("say", HI, "speed", [20, 401, NAN], "is not allowed: 50..400 %, or 0 for the robot's own"),
        ("say", HI, "pitch", [300, 49, NAN], "is not allowed: 50..200 %, or 0 for the robot's own"),
        ("say", {**HI, "background": True}, "volume", [0.5], "nothing, for a text in the background; or set it before"),
        ("say", {**HI, "background": True}, "voice", ["naofrf"], "nothing, for a text in the background"),
        ("animatedSay", {**HI, "background": True}, "language", ["French"], "nothing, for a text in the background"),
        ("animatedSay", HI, "body_language", ["wild"], "'wild' is not known: one of disabled, random, contextual"),
        ("setBodyLanguageMode", {}, "body_language", ["", "wild"], "is not known: one of disabled, random, contextual"),
        ("sayToFile", HI, "file_name", [""], "it is empty: the name of a file"),
        ("sayToFile", HI, "file_name", ["hi.mp3"], "is not a file of a known kind"),
        ("sayToFile", HI, "file_name", ["a\n.wav"], "has characters that names do not have"),
        ("sayToFile", HI, "file_name", ["~a.wav"], "is not the name of a file"),
        ("sayToFile", HI, "file_name", ["a" * 300 + ".wav"], "the name is too long: up to 255 characters"),
        ("addTagsToWords", {"texts": ["hello"]}, "str_param", [" "], "it is empty: the tag"),
        ("addTagsToWords", HI, "texts", [[], ["a", ""]], "the words or animations of the tag, one or more"),
        ("declareAnimationsPackage", {}, "str_param", [""], "it is empty: the name of a package of animations"),
        ("setVoice", {}, "str_param", ["", " "], "it is empty: the name of a voice"),
        ("setLanguage", {}, "str_param", ["", " "], "it is empty: the name of a language"),
        ("setLanguageDefaultVoice", {"str_param": "English"}, "voice", [""], "it is empty: the name of a voice"),
        ("loadVoicePreference", {}, "str_param", [""], "it is empty: the name of a voice preference"),
        ("setParameter", {"values": [1.0]}, "names", [["pich"]], "no parameter of the voice: did you mean 'pitch'"),
        ("setParameter", {"values": [1.0]}, "names", [[]], "nothing is named: one or more of speed"),
        ("setParameter", {"names": ["speed"]}, "values", [[], [1.0, 2.0]], "is not allowed: 1: one for each of speed"),
        ("setParameter", {"names": ["speed"]}, "values", [[10], [0], [NAN]], "is not allowed: speed is 50..400"),
        ("setParameter", {"names": [" doubleVoice"]}, "values", [[5]], "doubleVoice is 0 (off) or 1..4"),
        (
            "setParameter",
            {"str_param": "outputSampleRate"},
            "values",
            [[8000], []],
            "one of 16000, 22050, 44100, 48000",
        ),
        ("setParameter", {"values": [1.0]}, "str_param", ["inputBufferSize"], "parameter of ALAudioDevice that can be"),
        ("getParameter", {}, "str_param", ["loudness"], "'loudness' is no parameter"),
        ("getParameter", {}, "names", [[]], "nothing is named"),
        ("addToDictionary", HI, "texts", [[], [" "], ["now", "then"]], "is not allowed: how it is spoken"),
        ("addToDictionary", {"texts": ["Nao"]}, "str_param", [""], "it is empty: the word"),
        ("deleteFromDictionary", HI, "texts", [["now", "then"]], "is not allowed: nothing; or, of a Japanese type"),
        ("setOutputVolume", {}, "volume", [101, 0.5, -1, NAN, 1e300], "is not allowed: a whole number 0..100 (%)"),
        ("playFile", {}, "str_param", ["", " "], "it is empty: the name of a file"),
        ("playFile", {}, "str_param", ["/etc/a.wav", "/home/nao/../a.wav", "../a.wav"], "leads out of the folder"),
        ("sayToFile", HI, "file_name", ["/usr/share/naoqi/a.wav"], "leads out of the folders for sounds"),
        ("playFile", {}, "str_param", ["sounds", "a.txt"], "is not a file of a known kind: a relative name or one in"),
        ("playFile", WAV, "pan", [-2, NAN], "is not allowed: -1 (left) .. 1 (right)"),
        ("playFile", WAV, "duration", [-1, NAN, 3601], "is not allowed: 0.001..3600 s, or 0"),
        (
            "playFile",
            {**WAV, "background": True},
            "duration",
            [1.0],
            "0 for a sound in the background; stopAll ends it",
        ),
        ("playFileFromPosition", WAV, "position", [-1, NAN, 3601], "is not allowed: 0.001..3600 s, or 0"),
        ("playSine", SINE, "frequency", [0, 440.5, NAN, 1e6], "is not allowed: a whole number 20..20000 (Hz)"),
        ("playSine", SINE, "duration", [0, -1, NAN], "is not allowed: 0.001..3600 s"),
        ("playSine", SINE, "pan", [0.5, NAN], "is not allowed: -1 (left), 0 or 1 (right)"),
        ("playWebStream", {}, "str_param", [""], "it is empty: the address of a stream"),
        (
            "playWebStream",
            {},
            "str_param",
            ["file:///a", "http://", "http://[b", "ftp://x/y"],
            "begins with http:// or",
        ),
        ("pause", {}, "sound_id", [-1], "-1 is not allowed: as loadFile answers it, or 0 for the one in str_param"),
        ("goTo", SOUND, "position", [NAN, -1], "is not allowed: 0.001..3600 s, or 0"),
        ("setPitch", SOUND, "pitch", [NAN, 1e9], "is not allowed: -1e+08..1e+08"),
        ("setVolume", {"volume": 0.5}, "sound_id", [-1], "-1 is not allowed: as loadFile answers it"),
        ("setVolume", {}, "volume", [1.5, -0.1, NAN], "is not allowed: 0..1"),
        ("setMasterVolume", {}, "volume", [1.5, -0.1, NAN], "is not allowed: 0..1"),
        ("setPanorama", {}, "pan", [1.5, NAN], "is not allowed: -1 (left) .. 1 (right)"),
        ("playSoundSetFile", {}, "file_name", [" "], "it is empty: the name of a file of the sound set"),
        ("loadSoundSet", {}, "str_param", [" "], "it is empty: the name of a sound set"),
        ("isSoundSetFileInstalled", HI, "file_name", [""], "it is empty: the name of a file of the sound set"),
    ],
)
def test_what_is_refused_names_what_is_allowed(refusals, name, fields, field, values, text):
    for value in values:
        (told,) = refusals(f(name, **{**fields, field: value}))
        assert told.startswith(f"function 1 ({name}): field {field}: ") and text in told, (value, told)


@pytest.mark.parametrize(
    "function",
    [
        f("say", "Hi", speed=50.0, pitch=200.0, volume=1.0),
        f("say", "Hi", background=True, speed=100.0),
        f("animatedSay", "Hi", body_language=" random "),
        f("addToDictionary", "NAO", texts=["now"]),
        f("addToDictionary", "type", texts=["a", "b", "c", "d"]),
        f("deleteFromDictionary", "NAO"),
        f("setParameter", names=["pitchShift", " speed"], values=[0.0, 400.0]),
        f("setParameter", "nonsense", names=["speed"], values=[100.0]),
        f("setParameter", " outputSampleRate", values=[22050]),
        f("getParameter", "inputBufferSize"),
        f("getParameter", "pitch"),
        f("playFile", "/home/nao/a.WAV", pan=-1.0, duration=0.001),
        f("playFile", "/usr/share/naoqi/wav/random.wav"),
        f("sayToFile", "Hi", file_name="/tmp/a.wav", overwrite=True),
        f("playSine", frequency=20, duration=3600.0, pan=1.0),
        f("playWebStream", " https://host/a "),
        f("goTo", sound_id=7),
        f("getVolume"),
        f("playSoundSetFile", file_name="bip", loop=True, background=True),
    ],
    ids=lambda function: function.function,
)
def test_what_is_right_is_taken(refusals, function):
    assert refusals(function) == []


def test_without_a_robot_it_is_not_known_whether_a_file_is_there():
    goal = NaoAudioOutGoal([f("sayToFile", "Hi", file_name="/tmp/a.wav")])
    check = check_goals(offline_module(NaoAudioOutput), [goal])
    assert [each.function for each in check.unchecked] == ["sayToFile"] and not check.problems


def test_a_sound_is_known_from_where_it_is_loaded_to_where_it_is_unloaded(refusals):
    load, play = f("loadFile", " a.wav "), f("play", "a.wav")
    assert refusals(load, play, f("pause"), f("unloadFile")) == []
    (told,) = refusals(load, f("unloadFile"), play)
    assert "function 3 (play): field str_param: 'a.wav' is not loaded: loadFile comes first" in told
    (told,) = refusals(load, f("unloadAllFiles"), f("setPitch", pitch=1.0))
    assert "function 3 (setPitch): field sound_id: no sound is loaded" in told


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_field_that_a_function_takes_is_declared(name):
    declared = declared_fields(FUNCTIONS[name], FIELDS)
    assert list(declared) == fields_taken(FUNCTIONS[name], FIELDS)
    assert all(field.help for field in declared.values())


@pytest.mark.parametrize(
    ("name", "field", "asked"),
    [
        ("say", "voice", VOICES),
        ("sayToFile", "language", LANGUAGES),
        ("setVoice", "str_param", VOICES),
        ("setLanguage", "str_param", LANGUAGES),
        ("setLanguageDefaultVoice", "str_param", LANGUAGES),
        ("setLanguageDefaultVoice", "voice", VOICES),
    ],
)
def test_the_robot_is_asked_for_its_voices_and_languages(name, field, asked):
    assert declared_fields(FUNCTIONS[name], FIELDS)[field].asked == asked


def test_of_the_sound_card_the_sample_rate_can_be_set_and_two_parameters_read():
    (setting,), (parameter,), (rate,) = (kind.__metadata__ for kind in (DeviceSetting, DeviceParameter, OutputRate))
    parameter.require("str_param", " inputBufferSize")
    rate.require("values", [48000.0])
    for field, value, text in [
        (setting, "inputBufferSize", "no parameter of ALAudioDevice that can be set: one of outputSampleRate"),
        (parameter, "volume", "no parameter of ALAudioDevice: one of outputSampleRate, inputBufferSize"),
        (rate, [8000.0], "is not allowed: one of 16000, 22050, 44100, 48000 (Hz)"),
        (rate, [], "is not allowed: one of 16000, 22050, 44100, 48000 (Hz)"),
    ]:
        with pytest.raises(BadGoal) as refused:
            field.require("values", value)
        assert text in str(refused.value)
