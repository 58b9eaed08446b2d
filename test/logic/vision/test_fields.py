"""What the functions of vision let pass in a single field, and what they say to the rest."""

from __future__ import annotations

import pytest
from goal_functions import vision as f

from nao_library_modules.core.chain import FunctionChain, declared_fields, fields_taken
from nao_library_modules.core.errors import BadGoal
from nao_library_modules.core.goal_checks import offline_module
from nao_library_modules.vision.camera_functions import PictureFunctions, SettingFunctions
from nao_library_modules.vision.detectors import DetectionFunctions, FaceFunctions
from nao_library_modules.vision.streaming import StreamingFunctions
from nao_library_modules.vision.tracking import TrackingFunctions
from nao_library_modules.vision.vision_server import NaoVision
from nao_library_msgs.msg import VisionFunction

GROUPS = (
    StreamingFunctions, PictureFunctions, SettingFunctions, DetectionFunctions, FaceFunctions, TrackingFunctions,
)  # fmt: skip
FUNCTIONS = {name: function for group in GROUPS for name, function in group.functions.items()}
NAN = float("nan")


def taken(function):
    return declared_fields(FUNCTIONS[function], VisionFunction.__slots__)


@pytest.mark.parametrize("function, field, values", [
    ("subscribe", "id", ["a", " my camera ", "x" * 64]),
    ("listThreads", "id", ["", " ", "a"]),
    ("getParameter", "camera", ["", "0", "bottom", " TOP "]),
    ("setActiveCamera", "camera", ["1", "Top"]),
    ("subscribe", "topic", ["", "/a/b_1", "~image", "a"]),
    ("subscribe", "rate", [0.0, 0.001, 1000.0]),
    ("startRecording", "width", [0, 1, 8192]),
    ("startRecording", "str_param", ["", "walk", "a/b.mp4", "b.AVI", "x" * 246]),
    ("takePicture", "str_param", ["walk.jpeg", "walk.tif"]),
    ("takePicture", "file_type", ["", "JPG", ".tif"]),
    ("takePicture", "quality", [0, 100]),
    ("takePictures", "count", [0, 10000]),
    ("setParameter", "str_param", ["brightness", "0", "kCameraGainID"]),
    ("setParameter", "values", [[0.0], [2.0**31 - 1], [-(2.0**31)]]),
    ("setResolution", "resolution", ["VGA", "2", "640x480"]),
    ("setFrameRate", "rate", [1.0, 30.0]),
    ("detectLandmarks", "str_param", ["", "064"]),
    ("learnFace", "str_param", [" Anna ", "x" * 100]),
    ("lookFor", "str_param", ["ball", "face Anna", "landmark 64", "code hello world"]),
    ("trackFace", "duration", [0.0, 3600.0]),
])  # fmt: skip
def test_a_field_may_hold_this(function, field, values):
    for value in values:
        taken(function)[field].require(field, value)


@pytest.mark.parametrize("function, field, value, text", [
    ("subscribe", "id", " ", "it is empty: a name of up to 64 characters, without slashes"),
    ("subscribe", "id", "a/b", "'a/b' is not allowed: a name of up to 64 characters, without slashes"),
    ("listThreads", "id", "~a", "'~a' is not allowed: a name of up to 64"),
    ("stopThread", "id", "x" * 65, "x' is not allowed: a name of up to 64"),
    ("subscribe", "camera", "botom", "'botom' is no camera: did you mean 'bottom'?; top or 0, bottom or 1, empty: "),
    ("setActiveCamera", "camera", " ", "it is empty: top or 0, bottom or 1"),
    ("detectBall", "camera", "2", "'2' is no camera"),
    ("subscribe", "topic", "no topic", "'no topic' is not allowed: letters, digits and underscores, with slashes in"),
    ("subscribe", "topic_out", "/", "'/' is not allowed: letters, digits and underscores"),
    ("subscribe", "rate", -1.0, "-1.0 is not allowed: 0.001..1000 Hz, or 0: all"),
    ("createRecording", "rate", NAN, "nan is not allowed: 0.001..1000 Hz, or 0: all"),
    ("subscribe", "width", -2, "-2 is not allowed: 1..8192 pixels, or 0"),
    ("takePicture", "height", 8193, "8193 is not allowed: 1..8192 pixels, or 0"),
    ("startRecording", "str_param", "a.mkv", "'mkv' is no type of file for this: one of mp4, avi"),
    ("takePictures", "str_param", "x" * 247, "the name is too long: up to 245 bytes"),
    ("takePicture", "file_type", "pgn", "'pgn' is no type of file for this: did you mean 'png', 'jpg'?; one of png"),
    ("takePicture", "quality", 101, "101 is not allowed: 1..100, or 0 for the default"),
    ("takePicture", "timeout", 3601.0, "3601.0 is not allowed: up to 3600 s, or 0: 10 s"),
    ("takePictures", "count", -1, "-1 is not allowed: 1..10000, or 0: 1"),
    ("takePictures", "interval", -1.0, "-1.0 is not allowed: 0..3600 s"),
    ("getParameterRange", "str_param", "brigthness", "'brigthness' is no parameter of a camera: did you mean 'Bright"),
    ("setParameter", "values", [], "[] is not allowed: one whole number"),
    ("setParameter", "values", [0.5], "[0.5] is not allowed: one whole number"),
    ("setParameter", "values", [NAN], "[nan] is not allowed: one whole number"),
    ("setParameter", "values", [2.0**31], "2147483648.0 is not allowed: -2.14748e+09..2.14748e+09"),
    ("setResolution", "resolution", "", "'' is no resolution: one of QQQQVGA (or 8, 40x30), "),
    ("setFrameRate", "rate", 0.0, "0.0 is not allowed: 1..30 frames a second"),
    ("detectFaces", "timeout", -1.0, "-1.0 is not allowed: up to 3600 s, or 0 for the default"),
    ("readBarcodes", "confidence", 1.1, "1.1 is not allowed: 0..1"),
    ("detectBall", "count", 1001, "1001 is not allowed: up to 1000 looks, or 0 for one"),
    ("trackBall", "size", -0.1, "-0.1 is not allowed: up to 100 m, or 0 for the default"),
    ("detectMovement", "sensitivity", 2.0, "2.0 is not allowed: 0..1"),
    ("detectLandmarks", "str_param", "x", "'x' is not allowed: the number of a landmark, or nothing for all"),
    ("learnFace", "str_param", "", "it is empty: the name of a person"),
    ("forgetPerson", "str_param", "x" * 101, "... is too long: up to 100 characters"),
    ("reLearnFace", "str_param", "a\nb", "is not allowed: a name of characters that can be printed"),
    ("trackFace", "duration", -1.0, "-1.0 is not allowed: up to 3600 s, or 0: until the goal is preempted"),
    ("lookFor", "speed", 1.5, "1.5 is not allowed: 0..1 of the top speed, or 0 for a moderate one"),
    ("lookFor", "str_param", "cat", "'cat' is nothing to look for: ball, face, landmark, code; a name, a number or"),
    ("lookFor", "str_param", "ball red", "balls have no names: ball"),
    ("lookFor", "str_param", "landmark x", "'x' is not allowed: the number of a landmark, or nothing for all"),
])  # fmt: skip
def test_a_field_may_not_hold_that(function, field, value, text):
    with pytest.raises(BadGoal) as caught:
        taken(function)[field].require(field, value)
    assert str(caught.value).startswith(f"field {field}: ") and text in str(caught.value)


@pytest.mark.parametrize("function", FUNCTIONS)
def test_every_field_that_a_function_takes_is_declared(function):
    assert list(taken(function)) == fields_taken(FUNCTIONS[function], VisionFunction.__slots__)


@pytest.fixture(scope="module")
def refusals():
    """What is refused of a chain of functions, as texts."""
    chain = FunctionChain(offline_module(NaoVision).function_table)
    return lambda *functions: [str(failed) for failed in chain.failures(functions)]


def test_two_streams_of_one_chain_do_not_publish_on_the_same_topic(refusals):
    first, second = (f("createStream", id=name, topic_out="/both") for name in ("first", "second"))
    (refusal,) = refusals(first, second)
    assert refusal == "function 2 (createStream): field topic_out: 'first' publishes /both: another topic"
    assert refusals(first, f("deleteThread", id="first"), second) == []
    assert refusals(first, f("createStream", id="first", topic_out="/both")) == []
