"""Functions that set the cameras.

What belongs to a camera of the robot (brightness, exposure, ...) is set at the robot, by ALVideoDevice: it counts for
whoever looks through that camera, and needs no node that does. Resolution and frame rate are those of the node that
reads the camera: they are its own subscription at the robot, so that it alone can change them, by dynamic_reconfigure;
any other camera's node that has parameters of these names can stand in.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Callable, Sequence
from typing import Any

from naoqi.errors import NaoError

from ...base.errors import BadGoal
from ...base.field_checks import require_number
from ...functions.chain import checked_by
from .base import VisionBase
from .cameras import (
    CAMERAS,
    FRAME_RATES,
    OPTICAL_FRAMES,
    PARAMETERS,
    RESOLUTIONS,
    VIDEO,
    camera_name,
    parameter_number,
    resolution_name,
    resolution_of,
)

log = logging.getLogger(__name__)

RESOLUTION, FRAME_RATE = "resolution", "frame_rate"
"""Parameters of the node that reads a camera."""
LARGEST_VALUE = 1 << 31


# Checks


def check_camera(self: VisionBase, camera: str) -> None:
    """A camera of the robot."""
    camera_name(camera, self.active_camera)


def check_active_camera(_self: object, camera: str) -> None:
    """A camera that is named."""
    if not camera.strip():
        raise BadGoal("camera", camera, "top or 0, bottom or 1", problem="it is empty")
    camera_name(camera, "top")


def check_parameter(self: VisionBase, camera: str, str_param: str) -> None:
    """A camera and a parameter."""
    check_camera(self, camera)
    parameter_number(str_param)


def check_setting(self: VisionBase, camera: str, str_param: str, values: Sequence[float]) -> None:
    """A camera, a parameter and its value; its range the robot knows."""
    check_parameter(self, camera, str_param)
    if len(values) != 1 or not math.isfinite(values[0]) or values[0] != int(values[0]):
        raise BadGoal("values", list(values), "one whole number")
    require_number("values", values[0], -LARGEST_VALUE, LARGEST_VALUE - 1)


def check_resolution(self: VisionBase, camera: str, resolution: str) -> None:
    """A camera and a resolution."""
    check_camera(self, camera)
    resolution_name(resolution)


def check_frame_rate(self: VisionBase, camera: str, rate: float) -> None:
    """A camera and a rate."""
    check_camera(self, camera)
    require_number("rate", rate, *FRAME_RATES, f"{FRAME_RATES[0]}..{FRAME_RATES[1]} frames a second")


class SettingFunctions(VisionBase):
    """Settings of the cameras. Parameters are fields of VisionFunction."""

    def setting_functions(self) -> dict[str, Callable[..., Any]]:
        """Name -> function, to be put into the function table of a module."""
        return {
            "getCameras": self.get_cameras,
            "setActiveCamera": self.set_active_camera,
            "getActiveCamera": self.get_active_camera,
            "setParameter": self.set_parameter,
            "getParameter": self.get_parameter,
            "getParameterRange": self.get_parameter_range,
            "setAllParametersToDefault": self.set_all_parameters_to_default,
            "setAutoExposure": self.set_auto_exposure,
            "setAutoWhiteBalance": self.set_auto_white_balance,
            "setResolution": self.set_resolution,
            "getResolution": self.get_resolution,
            "setFrameRate": self.set_frame_rate,
            "getFrameRate": self.get_frame_rate,
        }

    # Which camera

    def get_cameras(self) -> list[list[str]]:
        """Name, topic and optical frame of each camera."""
        return [[name, self.source(name, ""), OPTICAL_FRAMES[name]] for name in CAMERAS]

    @checked_by(check_active_camera)
    def set_active_camera(self, camera: str, revert: bool) -> None:
        """Choose the camera that functions take which name none; the robot's own choice too, if it is there."""
        before, name = self.active_camera, camera_name(camera, self.active_camera)
        if revert:
            self.after_wait(lambda: self._activate(before, self.call_now))
        self._activate(name, self.call)

    def get_active_camera(self) -> str:
        """The camera that functions take which name none."""
        return self.active_camera

    def _activate(self, name: str, call: Callable[..., Any]) -> None:
        self.active_camera = name
        if self.robot.connection.state == "connected":  # topics of other cameras need no robot
            try:
                call(self.robot.proxy(VIDEO), "setActiveCamera", CAMERAS[name])
            except NaoError as error:
                log.warning("the robot has its own active camera now: %s", error)

    # The robot's cameras

    @checked_by(check_setting)
    def set_parameter(self, camera: str, str_param: str, values: Sequence[float], revert: bool) -> None:
        """Set a parameter of a camera: brightness, contrast, ..."""
        self._set(camera, parameter_number(str_param), int(values[0]), revert)

    @checked_by(check_parameter)
    def get_parameter(self, camera: str, str_param: str) -> int:
        """A parameter of a camera."""
        return int(self._ask("getParameter", camera, parameter_number(str_param)))

    @checked_by(check_parameter)
    def get_parameter_range(self, camera: str, str_param: str) -> list[int]:
        """The least, the greatest and the usual value of a parameter of a camera."""
        return [int(value) for value in self._ask("getParameterRange", camera, parameter_number(str_param))]

    @checked_by(check_camera)
    def set_all_parameters_to_default(self, camera: str) -> None:
        """Set all parameters of a camera to their usual values."""
        self._ask("setAllParametersToDefault", camera)

    @checked_by(check_camera)
    def set_auto_exposure(self, camera: str, enable: bool, revert: bool) -> None:
        """Have a camera choose exposure and gain by itself, or leave them as they are now."""
        self._set(camera, PARAMETERS["AutoExposition"], int(enable), revert)

    @checked_by(check_camera)
    def set_auto_white_balance(self, camera: str, enable: bool, revert: bool) -> None:
        """Have a camera choose the white balance by itself, or leave it as it is now."""
        self._set(camera, PARAMETERS["AutoWhiteBalance"], int(enable), revert)

    def _ask(self, method: str, camera: str, *args: Any) -> Any:
        index = CAMERAS[camera_name(camera, self.active_camera)]
        return self.call(self.robot.proxy(VIDEO), method, index, *args)

    def _set(self, camera: str, number: int, value: int, revert: bool) -> None:
        name = camera_name(camera, self.active_camera)
        if revert:
            before = int(self._ask("getParameter", name, number))
            proxy = self.robot.proxy(VIDEO)
            self.after_wait(lambda: self.call_now(proxy, "setParameter", CAMERAS[name], number, before))
        if self._ask("setParameter", name, number, value) is False:
            problem = f"the {name} camera refuses"
            raise BadGoal("values", [value], f"see getParameterRange of parameter {number}", problem=problem)

    # The nodes that read them

    @checked_by(check_resolution)
    def set_resolution(self, camera: str, resolution: str, revert: bool) -> None:
        """Set the resolution that a camera is read with."""
        self._configure(camera, RESOLUTION, RESOLUTIONS[resolution_name(resolution)][0], revert)

    @checked_by(check_camera)
    def get_resolution(self, camera: str) -> str:
        """Resolution that a camera is read with: VGA, ..."""
        return resolution_of(self._configured(camera, RESOLUTION))

    @checked_by(check_frame_rate)
    def set_frame_rate(self, camera: str, rate: float, revert: bool) -> None:
        """Set how many frames a second are read from a camera."""
        self._configure(camera, FRAME_RATE, rate, revert)

    @checked_by(check_camera)
    def get_frame_rate(self, camera: str) -> float:
        """How many frames a second are read from a camera."""
        return float(self._configured(camera, FRAME_RATE))

    def _configured(self, camera: str, parameter: str) -> Any:
        server = self.camera_servers[camera_name(camera, self.active_camera)]
        known = self.topics.settings(server)
        if parameter not in known:
            text = f"the node of {server} has no parameter {parameter}; it has {', '.join(sorted(known))}"
            raise NaoError(text)
        return known[parameter]

    def _configure(self, camera: str, parameter: str, value: float, revert: bool) -> None:
        server = self.camera_servers[camera_name(camera, self.active_camera)]
        before = self._configured(camera, parameter)
        value = type(before)(value)  # dynamic_reconfigure takes whole numbers and others for different things
        if revert:
            self.after_wait(lambda: self.topics.set(server, {parameter: before}))
        reached = self.topics.set(server, {parameter: value}).get(parameter, value)
        if reached != value:
            raise NaoError(f"the camera's node {server} keeps {parameter} at {reached} instead of {value}")
