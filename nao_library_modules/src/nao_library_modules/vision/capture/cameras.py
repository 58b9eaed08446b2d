"""Names of cameras, resolutions and parameters in goals. Pure."""

from __future__ import annotations

import re

from ...base.errors import BadGoal
from ...base.suggestion import did_you_mean
from ...nao import camera_facts
from ...nao.camera_facts import CAMERA_NAMES, RESOLUTIONS

VIDEO = "ALVideoDevice"
"""NAOqi's module for the cameras."""
CAMERAS = {name: number for number, name in camera_facts.CAMERAS.items()}
"""Name -> NAOqi's number."""
OPTICAL_FRAMES = {name: f"{CAMERA_NAMES[number]}_optical_frame" for name, number in CAMERAS.items()}
ONE_CAMERA = "top or 0, bottom or 1"
ANY_CAMERA = f"{ONE_CAMERA}, empty: the active one"
KNOWN_RESOLUTIONS = "one of " + ", ".join(
    f"{name} (or {number}, {w}x{h})" for name, (number, w, h) in RESOLUTIONS.items()
)
FRAME_RATES = (1, 30)
"""Frames a second, the least and the most."""

PARAMETERS = {
    "Brightness": 0,
    "Contrast": 1,
    "Saturation": 2,
    "Hue": 3,
    "RedChroma": 4,
    "BlueChroma": 5,
    "Gain": 6,
    "HFlip": 7,
    "VFlip": 8,
    "AutoExposition": 11,
    "AutoWhiteBalance": 12,
    "AutoGain": 13,
    "Exposure": 17,
    "ExposureCorrection": 21,
    "ExposureAlgorithm": 22,
    "Sharpness": 24,
    "WhiteBalance": 33,
    "BacklightCompensation": 34,
    "KeepAlive": 35,
    "Temperature": 38,
    "AverageLuminance": 39,
    "AutoFocus": 40,
    "Focus": 43,
}
"""Parameter of a camera, NAOqi's name without kCamera and ID -> NAOqi's number. Not every camera has all of them, and
the robot takes other numbers as well."""
KNOWN_PARAMETERS = f"one of {', '.join(PARAMETERS)}, also by NAOqi's name or number"
MOST_PARAMETERS = 64
_SPELLINGS = {name.lower(): number for name, number in PARAMETERS.items()}
_SPELLINGS.update(exposition=17, autoexposure=11)
_OTHERWISE = {"14": "setResolution", "15": "setFrameRate", "18": "setActiveCamera", "19": "setAllParametersToDefault"}
_OTHERWISE.update(resolution="setResolution", framerate="setFrameRate", select="setActiveCamera")
_OTHERWISE.update(setdefaultparams="setAllParametersToDefault")


def camera_name(text: str, active: str) -> str:
    """Name of a camera from its name or NAOqi's number in a goal; the active one for an empty text.

    Raises BadGoal if there is no such camera.
    """
    bare = text.strip().lower()
    if not bare:
        return active
    for name, number in CAMERAS.items():
        if bare in (name, str(number)):
            return name
    problem = f"{text!r} is no camera{did_you_mean(bare, CAMERAS)}"
    raise BadGoal("camera", text, ANY_CAMERA, problem=problem)


def resolution_name(text: str) -> str:
    """Name of a resolution, without the k (VGA), from its name, NAOqi's number or 640x480.

    Raises BadGoal if there is no such resolution.
    """
    bare = re.sub(r"\s", "", text).lower()
    for name, (number, width, height) in RESOLUTIONS.items():
        if bare in (name.lower(), f"k{name.lower()}", f"{width}x{height}", str(number)):
            return name
    problem = f"{text!r} is no resolution{did_you_mean(bare, [*RESOLUTIONS])}"
    raise BadGoal("resolution", text, KNOWN_RESOLUTIONS, problem=problem)


def resolution_of(number: int) -> str:
    """Name of a resolution by NAOqi's number; the number itself where it has none."""
    return next((name for name, (own, *_) in RESOLUTIONS.items() if own == number), str(number))


def parameter_number(text: str) -> int:
    """NAOqi's number of a parameter from brightness, kCameraBrightnessID or 0.

    Raises BadGoal if there is no such parameter, or another function sets it.
    """
    bare = re.sub(r"^k?camera_?|_?id$", "", text.strip(), flags=re.IGNORECASE).replace("_", "").lower()
    if bare in _OTHERWISE:
        problem = f"{text!r} is no parameter of the picture"
        raise BadGoal("str_param", text, f"{_OTHERWISE[bare]} and its like are for that", problem=problem)
    if bare.isdigit() and int(bare) < MOST_PARAMETERS:
        return int(bare)
    if bare not in _SPELLINGS:
        problem = f"{text!r} is no parameter of a camera{did_you_mean(bare, PARAMETERS)}"
        raise BadGoal("str_param", text, KNOWN_PARAMETERS, problem=problem)
    return _SPELLINGS[bare]
