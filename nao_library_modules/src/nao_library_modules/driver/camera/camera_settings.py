"""Parameters of a camera's stream and of its driver, and the tuning of the camera at the robot. No ROS."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import vision_definitions as vision
from naoqi.errors import CallTimeout, NaoError, RobotUnreachable, UnknownModule

from ...core.nao_facts import BOTTOM, CAMERA_NAMES, CAMERAS, TOP
from ..base.reconfigure import ReconfigureField
from .camera_images import COLOR_SPACES, RESOLUTIONS
from .camera_stream import StreamSettings

log = logging.getLogger(__name__)

LEAST_RATE, MOST_RATE = 1.0, 30.0
OFF_OR_AUTO = {0: "off: the fixed value", 1: "the camera chooses"}
ALGORITHMS = {0: "average", 1: "weighted average", 2: "for highlights", 3: "for lowlights"}


@dataclass(frozen=True)
class Tuning:
    """A parameter of the picture that the camera itself has; it holds for all clients of the camera.

    The limits of `field` are the widest that a camera of a NAO has: each has some of its own.
    """

    id: int  # NAOqi's number
    field: ReconfigureField
    automatic: str = ""  # parameter that must be 0 for this one to take effect


TUNINGS = {
    tuning.field.name: tuning
    for tuning in (
        # The automatic ones come first: the camera takes a fixed value only while it does not choose itself.
        Tuning(
            vision.kCameraAutoExpositionID,
            ReconfigureField("auto_exposition", 1, "whether the camera chooses exposure and gain", 0, 1, OFF_OR_AUTO),
        ),
        Tuning(
            vision.kCameraAutoWhiteBalanceID,
            ReconfigureField(
                "auto_white_balance", 1, "whether the camera chooses the white balance", 0, 1, OFF_OR_AUTO
            ),
        ),
        Tuning(
            vision.kCameraExposureAlgorithmID,
            ReconfigureField("auto_exposure_algo", 1, "how the camera chooses the exposure (V4, V5)", 0, 3, ALGORITHMS),
        ),
        Tuning(
            vision.kCameraExposureID,
            ReconfigureField("exposure", 32, "time of exposure in steps of the camera; ends auto_exposition", 0, 65535),
            "auto_exposition",
        ),
        Tuning(
            vision.kCameraGainID,
            ReconfigureField("gain", 16, "amplification; ends auto_exposition", 0, 1023),
            "auto_exposition",
        ),
        Tuning(vision.kCameraBrightnessID, ReconfigureField("brightness", 0, "brightness", -255, 255)),
        Tuning(vision.kCameraContrastID, ReconfigureField("contrast", 32, "contrast", 0, 255)),
        Tuning(vision.kCameraSaturationID, ReconfigureField("saturation", 64, "how strong colours are", 0, 255)),
        Tuning(vision.kCameraHueID, ReconfigureField("hue", 0, "turn of the colours, degrees", -180, 180)),
        Tuning(vision.kCameraSharpnessID, ReconfigureField("sharpness", 4, "sharpness of edges", -7, 9)),
        Tuning(
            vision.kCameraWhiteBalanceID,
            ReconfigureField("white_balance", -50, "white balance (V4, V5); ends auto_white_balance", -120, 6500),
            "auto_white_balance",
        ),
    )
}
"""Name of a parameter, as naoqi_camera has it -> what it is at the robot."""


def fields_of(
    resolution: int, frame_rate: float, use_ros_time: bool, camera: int, alone: bool
) -> tuple[ReconfigureField, ...]:
    """The parameters of one camera, under the names of naoqi_camera.

    `alone`: the node serves this camera only, and can switch to the other.
    """
    source = (ReconfigureField("source", camera, "camera", TOP, BOTTOM, CAMERAS),) if alone else ()
    return (
        *source,
        ReconfigureField(
            "resolution", resolution, "size of the pictures", min(RESOLUTIONS), max(RESOLUTIONS), RESOLUTIONS
        ),
        ReconfigureField("frame_rate", frame_rate, "pictures a second", LEAST_RATE, MOST_RATE),
        ReconfigureField(
            "color_space",
            vision.kBGRColorSpace,
            "colour space, which gives the encoding",
            min(COLOR_SPACES),
            max(COLOR_SPACES),
            COLOR_SPACES,
        ),
        ReconfigureField(
            "camera_info_url", "", "calibration: file:// or package://; empty: the one that was set, or computed"
        ),
        ReconfigureField("use_ros_time", use_ros_time, "whether stamps are in ROS time, instead of the robot's own"),
        *(tuning.field for tuning in TUNINGS.values()),
    )


def stream_settings(config: Mapping[str, Any], camera: int) -> StreamSettings:
    """Settings of the stream, of `camera` unless `config` has a `source`; raises NaoError for an unknown number."""
    for name, known in (("resolution", RESOLUTIONS), ("color_space", COLOR_SPACES), ("source", CAMERAS)):
        if name in config and config[name] not in known:
            listed = ", ".join(f"{number} ({text})" for number, text in sorted(known.items()))
            raise NaoError(f"{name} is {config[name]!r}: one of {listed}")
    rate = round(config["frame_rate"])
    return StreamSettings(config.get("source", camera), config["resolution"], config["color_space"], rate)


def settled(before: Mapping[str, Any], after: Mapping[str, Any]) -> dict[str, Any]:
    """New values made consistent: a fixed value switches off its automatic. `before` is empty at the start."""
    values = {**after, "frame_rate": float(round(after["frame_rate"]))}
    for name, tuning in TUNINGS.items():
        automatic = tuning.automatic
        changed = automatic and before and after[name] != before[name]
        if changed and after[automatic] == before[automatic]:
            values[automatic] = 0
    return values


def changed_tunings(before: Mapping[str, Any], after: Mapping[str, Any]) -> dict[str, int]:
    return {name: after[name] for name in TUNINGS if after[name] != before[name]}


NO_ANSWER = (RobotUnreachable, UnknownModule, CallTimeout)
"""A robot that is gone, still starting, or busy: nothing is known about its camera then, and asking again may help."""


class CameraTuning:
    """Sets chosen values, again on a robot that has forgotten them, and leaves the rest as it is.

    They belong to the camera: other subscribers see the same. Any thread may call; the lock is held during calls to the
    robot, so that values of two callers do not mix. `ask` calls a method of ALVideoDevice.
    """

    def __init__(self, ask: Callable[..., Any], chosen: Mapping[str, int]) -> None:
        self._ask = ask
        self._chosen = dict(chosen)
        self._missing: set[tuple[int, str]] = set()  # not there when it was read
        self._told: set[tuple[int, str]] = set()
        self._lock = threading.Lock()

    def choose(self, camera: int, values: Mapping[str, int], connected: bool) -> None:
        """Set values, now if the robot is connected, and on a robot that comes later.

        Raises NaoError if the camera cannot be set to one of them; then none is set.
        """
        with self._lock:
            if connected:
                self._set(camera, self._possible(camera, values))
            self._chosen.update(values)

    def set_again(self, camera: int) -> None:
        """Set all chosen values; refusals are logged. Raises one of `NO_ANSWER`."""
        with self._lock:
            for name in TUNINGS:
                if name not in self._chosen:
                    continue
                try:
                    self._set(camera, self._possible(camera, {name: self._chosen[name]}))
                except NO_ANSWER:
                    raise
                except NaoError as error:
                    log.warning("%s", error)

    def read(self, camera: int) -> dict[str, int]:
        """Name -> value of all that the camera has; raises one of `NO_ANSWER`."""
        values = {}
        with self._lock:
            for name, tuning in TUNINGS.items():
                if (camera, name) in self._missing:
                    continue
                try:
                    value = self._ask("getParameter", camera, tuning.id)
                except NO_ANSWER:
                    raise
                except NaoError as error:
                    log.debug("%s has no %s: %s", CAMERA_NAMES[camera], name, error)
                    self._missing.add((camera, name))
                    continue
                if isinstance(value, int):
                    values[name] = value
        return values

    def _possible(self, camera: int, values: Mapping[str, int]) -> dict[str, int]:
        """Those of the values that this camera has, in the order in which it takes them.

        Raises NaoError if one is out of the camera's range.
        """
        possible = {}
        for name in (name for name in TUNINGS if name in values):
            limits = self._range(camera, name)
            if limits is None:
                continue
            lowest, highest = limits
            if not lowest <= values[name] <= highest:
                asked = f"{name} is {values[name]}"
                raise NaoError(f"{asked}: the robot's {CAMERA_NAMES[camera]} takes {lowest} to {highest}")
            possible[name] = values[name]
        return possible

    def _range(self, camera: int, name: str) -> tuple[int, int] | None:
        """Least and greatest value; None, and one warning, if the camera does not have the parameter."""
        try:
            lowest, highest = self._ask("getParameterRange", camera, TUNINGS[name].id)[:2]
        except NO_ANSWER:
            raise
        except NaoError as error:
            if (camera, name) not in self._told:
                log.warning("the robot's %s has no %s, which is left out", CAMERA_NAMES[camera], name)
            log.debug("%s of %s: %s", name, CAMERA_NAMES[camera], error)
            self._told.add((camera, name))
            return None
        return lowest, highest

    def _set(self, camera: int, values: Mapping[str, int]) -> None:
        for name, value in values.items():
            automatic = TUNINGS[name].automatic
            if automatic and self._ask("getParameter", camera, TUNINGS[automatic].id):
                continue  # the camera chooses it, and would refuse
            if self._ask("setParameter", camera, TUNINGS[name].id, value) is False:
                raise NaoError(f"the robot's {CAMERA_NAMES[camera]} refuses {name} {value}")
