"""What fields of the functions of hearing may hold, told without a robot; the robot's tests have what needs one."""

from __future__ import annotations

import math

import pytest
from goal_functions import audio_in as f

from nao_library_modules.audio_in.audio_in_server import NaoAudioInput
from nao_library_modules.core.chain import FunctionChain, declared_fields, fields_taken
from nao_library_modules.core.describe import HEARD_LANGUAGES
from nao_library_modules.core.goal_checks import offline_module
from nao_library_msgs.msg import AudioInFunction

FUNCTIONS = NaoAudioInput.declared_functions()
FIELDS, NAN = AudioInFunction.__slots__, math.nan
RECORD = {"str_param": "a.wav", "duration": 1.0}
HOUSE = {"str_param": "house"}


@pytest.fixture(scope="module")
def refusals():
    """What is refused of a chain of functions, as texts."""
    chain = FunctionChain(offline_module(NaoAudioInput).function_table)
    return lambda *functions: [str(failed) for failed in chain.failures(functions)]


@pytest.mark.parametrize(
    ("name", "fields", "field", "values", "text"),
    [
        ("record", RECORD, "duration", [0.0, NAN, 4000.0], "is not allowed: 0.001..3600 s"),
        ("record", RECORD, "str_param", [" ", "a.mp3", "../a.wav", "/etc/a.wav"], "field str_param: "),
        ("record", RECORD, "rate", [44100, -1], "is not allowed: 16000, 48000 (Hz), or 0: as the channels need"),
        ("record", RECORD, "channels", [["fornt"]], "did you mean 'front'"),
        ("record", RECORD, "channels", [[" left"]], "' left' is not allowed: one of left, right, front, rear"),
        ("record", RECORD, "channels", [["left", "left"]], "each microphone once"),
        ("record", RECORD, "channels", [["left", "rear"]], "2 channel(s): one of left, right, front, rear at 16000 Hz"),
        ("record", {**RECORD, "rate": 48000}, "channels", [["left"]], "1 channel(s) at 48000 Hz"),
        ("record", RECORD, "file_type", ["mp3"], "'mp3' is no type of recordings: one of wav, ogg"),
        ("record", RECORD, "file_type", ["ogg"], "'a.wav' is no ogg: wav, as the file's name ends"),
        ("startRecording", {}, "str_param", [""], "it is empty: the name of a file"),
        ("setFileAsInput", {}, "str_param", ["a.txt"], "not a file of a known kind"),
        ("setVocabulary", {}, "vocabulary", [[]], "it is empty: at least one word or phrase"),
        ("listen", {}, "vocabulary", [[]], "it is empty: at least one word or phrase, here or by setVocabulary before"),
        ("startRecognition", {}, "vocabulary", [["yes", " "]], "there is an empty phrase in it"),
        ("setLanguage", {}, "str_param", [" "], "it is empty: a language by NAOqi's name, such as English"),
        ("detectSound", {}, "timeout", [NAN, -1.0, 1e7], "is not allowed: up to 3600 s, or 0 for the default"),
        ("detectSound", {}, "confidence", [1.5, -0.1, NAN], "is not allowed: 0..1"),
        ("localizeSound", {}, "duration", [NAN, -1.0], "is not allowed: 0..3600 s"),
        ("getRearMicEnergy", {}, "duration", [-1.0, NAN, 4000.0], "is not allowed: 0..3600 s"),
        ("setSensitivity", {}, "sensitivity", [0.0, 1.1, -0.1, NAN], "is not allowed: above 0 to 1"),
        ("setSensitivity", {"sensitivity": 0.5}, "str_param", ["smell"], "one of speech, detection, localization"),
        ("setParameter", {"str_param": "Sensitivity"}, "values", [[], [1.0, 2.0]], "is not allowed: one number"),
        ("setParameter", {"str_param": "Sensitivity"}, "values", [[NAN], [1e9]], "is not allowed: -1e+08..1e+08"),
        ("setParameter", {"str_param": "outputSampleRate"}, "values", [[8000]], "one of 16000, 22050, 44100, 48000"),
        ("setParameter", {"values": [1.0]}, "str_param", ["inputBufferSize"], "parameter of ALAudioDevice that can be"),
        ("getParameter", {}, "str_param", ["", " "], "it is empty: the name of a parameter"),
        ("removeContext", {}, "str_param", [" "], "it is empty: a name"),
        (
            "compile",
            HOUSE,
            "vocabulary",
            [["x.bnf"], ["x.bnf", ""], ["in", "out", "more"]],
            "file of the grammar, file to write",
        ),
        ("getRules", HOUSE, "vocabulary", [[], ["start", "slot"]], "start, active, activatable or slot"),
        ("getRules", HOUSE, "vocabulary", [["strat"]], "'strat' is no type of rules: did you mean 'start'"),
        ("activateRule", HOUSE, "vocabulary", [[], [""], ["order", "answer"]], "name of the rule"),
        ("addWordListToSlot", HOUSE, "vocabulary", [[], ["slot"], ["slot", ""]], "name of the slot, words"),
        ("setContextParam", {**HOUSE, "vocabulary": ["p"]}, "values", [[], [1.0, 2.0]], "the value of the parameter"),
    ],
)
def test_what_is_refused_names_what_is_allowed(refusals, name, fields, field, values, text):
    for value in values:
        (told,) = refusals(f(name, **{**fields, field: value}))
        assert told.startswith(f"function 1 ({name}): field {field}: ") and text in told, (value, told)


@pytest.mark.parametrize(
    "function",
    [
        f("record", **RECORD),
        f("record", **{**RECORD, "file_type": "wav", "rate": 48000}),
        f("record", **{**RECORD, "channels": ["rear", "front", "left", "right"]}),
        f("localizeSound", confidence=1.0, timeout=3600.0),
        f("getEnergy"),
        f("setSensitivity", sensitivity=1.0),
        f("setParameter", str_param="NbHypotheses", values=[3]),
        f("setParameter", str_param="outputSampleRate", values=[16000]),
        f("compile", str_param="English", vocabulary=["house.bnf", "house.lcf"]),
        f("getRules", str_param="house", vocabulary=["active"]),
        f("addWordListToSlot", str_param="house", vocabulary=["room", "kitchen", "hall"]),
    ],
    ids=lambda function: function.function,
)
def test_what_is_right_is_taken(refusals, function):
    assert refusals(function) == []


def test_words_of_an_earlier_function_will_do(refusals):
    assert refusals(f("setVocabulary", vocabulary=["yes"]), f("listen"), f("startRecognition")) == []
    (told,) = refusals(f("pause"), f("listen", vocabulary=["yes"]))
    assert "the recognition is paused: resume comes first" in told


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_field_that_a_function_takes_is_declared(name):
    declared = declared_fields(FUNCTIONS[name], FIELDS)
    assert list(declared) == fields_taken(FUNCTIONS[name], FIELDS)
    assert all(field.help for field in declared.values())


@pytest.mark.parametrize("name", ["setLanguage", "listen", "compile"])
def test_the_robot_is_asked_for_the_languages_that_it_hears(name):
    assert declared_fields(FUNCTIONS[name], FIELDS)["str_param"].asked == HEARD_LANGUAGES
