"""Settings of the cameras: at the robot, at the nodes that read them, and back again."""

from __future__ import annotations

import pytest
from fake_vision import BOTTOM, TOP, f

from nao_library_modules.errors import BadGoal
from nao_library_modules.vision_cameras import (
    PARAMETERS,
    RESOLUTIONS,
    camera_name,
    parameter_number,
    resolution_name,
    resolution_of,
)

TOP_NODE = "nao_camera/top"


@pytest.fixture
def connected(robot, device, monkeypatch, vision):
    robot.connection.state = "connected"
    vision._took_over = True  # no extractors here
    return device


@pytest.fixture
def node(topics):
    topics.servers[TOP_NODE] = {"resolution": 1, "frame_rate": 15.0, "brightness": 0}
    return topics.servers[TOP_NODE]


def test_the_constants_are_those_of_the_sdk():
    import vision_definitions

    for name, number in PARAMETERS.items():
        assert getattr(vision_definitions, f"kCamera{name}ID") == number
    for name, (number, _, _) in RESOLUTIONS.items():
        assert getattr(vision_definitions, f"k{name}") == number


@pytest.mark.parametrize("text", ["brightness", "Brightness", "kCameraBrightnessID", "camera_brightness", " 0 "])
def test_spellings_of_a_parameter(text):
    assert parameter_number(text) == 0


@pytest.mark.parametrize(
    "text, number",
    [("auto_exposure", 11), ("exposition", 17), ("exposure", 17), ("HFlip", 7), ("auto_white_balance", 12), ("43", 43)],
)
def test_parameters(text, number):
    assert parameter_number(text) == number


@pytest.mark.parametrize(
    "text, problem",
    [
        ("", "'' is no parameter of a camera"),
        ("brigthness", "did you mean 'Brightness'"),
        ("64", "'64' is no parameter"),
        ("resolution", "setResolution and its like are for that"),
        ("kCameraFrameRateID", "setFrameRate and its like"),
        ("18", "setActiveCamera"),
    ],
)
def test_what_is_no_parameter(text, problem):
    with pytest.raises(BadGoal) as caught:
        parameter_number(text)
    assert problem in str(caught.value)


@pytest.mark.parametrize("text", ["VGA", "vga", "kVGA", "2", "640x480", "640 x 480"])
def test_spellings_of_a_resolution(text):
    assert resolution_name(text) == "VGA"


def test_resolutions():
    with pytest.raises(BadGoal, match="'641x480' is no resolution.*VGA .or 2, 640x480."):
        resolution_name("641x480")
    assert (resolution_of(4), resolution_of(77)) == ("16VGA", "77")


def test_cameras():
    assert [camera_name(text, "bottom") for text in ("top", "0", "1", "Bottom", "")] == [
        "top", "top", "bottom", "bottom", "bottom",
    ]  # fmt: skip


def test_the_active_camera_is_the_robots_as_well(vision, connected, succeed):
    wait = f("setActiveCamera", camera="bottom", revert=True)
    result = succeed(f("setActiveCamera", camera="bottom"), f("getActiveCamera"))
    assert (result.memList, connected.active) == (["bottom"], 1)
    succeed(f("setActiveCamera", camera="top"), wait)
    assert (vision.active_camera, connected.active) == ("top", 0)


def test_without_a_robot_there_is_an_active_camera(vision, succeed):
    assert succeed(f("setActiveCamera", camera="bottom"), f("getActiveCamera")).memList == ["bottom"]


def test_cameras_and_their_topics(succeed):
    assert succeed(f("getCameras")).memList == [
        f'["top", "{TOP}", "CameraTop_optical_frame"]',
        f'["bottom", "{BOTTOM}", "CameraBottom_optical_frame"]',
    ]


def test_parameters_are_set_at_the_robot(connected, succeed):
    result = succeed(
        f("setParameter", str_param="brightness", values=[100]),
        f("setParameter", str_param="kCameraContrastID", values=[50], camera="bottom"),
        f("getParameter", str_param="0"),
        f("getParameter", str_param="contrast", camera="1"),
        f("getParameterRange", str_param="contrast"),
    )
    assert result.memList == ["100", "50", "0", "255", "32"]
    assert connected.values == {0: {0: 100, 1: 32, 11: 1, 12: 1}, 1: {0: 0, 1: 50, 11: 1, 12: 1}}
    succeed(f("setAllParametersToDefault"))
    assert connected.values[0][0] == 0


def test_what_is_set_goes_back(connected, robot, succeed):
    succeed(
        f("setParameter", str_param="brightness", values=[100], revert=True),
        f("setAutoExposure", enable=False, camera="bottom", revert=True),
        f("setAutoWhiteBalance", enable=False, revert=True),
    )
    assert [call[1:] for call in robot.proxy("ALVideoDevice").calls if call[0] == "setParameter"] == [
        (0, 0, 100), (0, 0, 0), (1, 11, 0), (1, 11, 1), (0, 12, 0), (0, 12, 1),
    ]  # fmt: skip


@pytest.mark.parametrize(
    "function, problem",
    [
        (f("setParameter", str_param="brightness"), "field values: [] is not allowed: one whole number"),
        (f("setParameter", str_param="brightness", values=[0.5]), "one whole number"),
        (f("setParameter", str_param="brightness", values=[float("inf")]), "one whole number"),
        (f("setParameter", str_param="brightness", values=[1e12]), "field values"),
        (f("setParameter", str_param="brightness", values=[300]), "the top camera refuses: see getParameterRange"),
        (f("getParameter", str_param="focus"), "no parameter 43"),
        (f("setActiveCamera"), "field camera: it is empty"),
        (f("setResolution"), "field resolution: '' is no resolution"),
        (f("setFrameRate", rate=0.0), "field rate: 0.0 is not allowed: 1..30 frames a second"),
        (f("setResolution", resolution="VGA", camera="bottom"), "no service nao_camera/bottom/set_parameters"),
    ],
    ids=lambda value: getattr(value, "function", None),
)
def test_what_cannot_be_set_is_told(connected, refused, function, problem):
    assert problem in refused(function)


def test_resolution_and_rate_are_set_at_the_node(node, succeed):
    result = succeed(
        f("setResolution", resolution="VGA"), f("setFrameRate", rate=5), f("getResolution"), f("getFrameRate")
    )
    assert result.memList == ["VGA", "5.0"]
    assert node == {"resolution": 2, "frame_rate": 5.0, "brightness": 0}
    result = succeed(
        f("setResolution", resolution="QQVGA", revert=True), f("setFrameRate", rate=30, revert=True), f("getFrameRate")
    )
    assert (node["resolution"], node["frame_rate"], result.memList) == (2, 5.0, ["5.0"])


def test_a_node_that_keeps_its_own_is_told(node, topics, refused, monkeypatch):
    monkeypatch.setattr(topics, "set", lambda server, values: {"frame_rate": 10.0})
    assert "nao_camera/top keeps frame_rate at 10.0 instead of 30.0" in refused(f("setFrameRate", rate=30))
    del node["resolution"]
    assert "has no parameter resolution; it has brightness, frame_rate" in refused(f("getResolution"))
