"""Functions that set the cameras.

What belongs to a camera of the robot (brightness, exposure, ...) is set at the robot, by ALVideoDevice: it counts for
whoever looks through that camera, and needs no node that does. Resolution and frame rate are those of the node that
reads the camera: they are its own subscription at the robot, so that it alone can change them, by dynamic_reconfigure;
any other camera's node that has parameters of these names can stand in.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Any

from naoqi.errors import NaoError

from ...base.errors import BadGoal
from .base import VisionBase
from .cameras import (
    CAMERAS,
    OPTICAL_FRAMES,
    PARAMETERS,
    RESOLUTIONS,
    VIDEO,
    camera_name,
    parameter_number,
    resolution_name,
    resolution_of,
)
from .fields import (
    AutoExposure,
    AutoWhiteBalance,
    Camera,
    FrameRate,
    NamedCamera,
    Parameter,
    Resolution,
    Revert,
    Value,
)

log = logging.getLogger(__name__)

RESOLUTION, FRAME_RATE = "resolution", "frame_rate"
"""Parameters of the node that reads a camera."""


class SettingFunctions(VisionBase):
    """Settings of the cameras. Parameters are fields of VisionFunction."""

    # Which camera

    def get_cameras(self) -> list[list[str]]:
        """Name, topic and optical frame of each camera."""
        return [[name, self.source(name, ""), OPTICAL_FRAMES[name]] for name in CAMERAS]

    def set_active_camera(self, camera: NamedCamera, revert: Revert) -> None:
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

    def set_parameter(self, camera: Camera, str_param: Parameter, values: Value, revert: Revert) -> None:
        """Set a parameter of a camera: brightness, contrast, ..."""
        self._set(camera, parameter_number(str_param), int(values[0]), revert)

    def get_parameter(self, camera: Camera, str_param: Parameter) -> int:
        """A parameter of a camera."""
        return int(self._ask("getParameter", camera, parameter_number(str_param)))

    def get_parameter_range(self, camera: Camera, str_param: Parameter) -> list[int]:
        """The least, the greatest and the usual value of a parameter of a camera."""
        return [int(value) for value in self._ask("getParameterRange", camera, parameter_number(str_param))]

    def set_all_parameters_to_default(self, camera: Camera) -> None:
        """Set all parameters of a camera to their usual values."""
        self._ask("setAllParametersToDefault", camera)

    def set_auto_exposure(self, camera: Camera, enable: AutoExposure, revert: Revert) -> None:
        """Have a camera choose exposure and gain by itself, or leave them as they are now."""
        self._set(camera, PARAMETERS["AutoExposition"], int(enable), revert)

    def set_auto_white_balance(self, camera: Camera, enable: AutoWhiteBalance, revert: Revert) -> None:
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

    def set_resolution(self, camera: Camera, resolution: Resolution, revert: Revert) -> None:
        """Set the resolution that a camera is read with."""
        self._configure(camera, RESOLUTION, RESOLUTIONS[resolution_name(resolution)][0], revert)

    def get_resolution(self, camera: Camera) -> str:
        """Resolution that a camera is read with: VGA, ..."""
        return resolution_of(self._configured(camera, RESOLUTION))

    def set_frame_rate(self, camera: Camera, rate: FrameRate, revert: Revert) -> None:
        """Set how many frames a second are read from a camera."""
        self._configure(camera, FRAME_RATE, rate, revert)

    def get_frame_rate(self, camera: Camera) -> float:
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

    functions = {
        "getCameras": get_cameras,
        "setActiveCamera": set_active_camera,
        "getActiveCamera": get_active_camera,
        "setParameter": set_parameter,
        "getParameter": get_parameter,
        "getParameterRange": get_parameter_range,
        "setAllParametersToDefault": set_all_parameters_to_default,
        "setAutoExposure": set_auto_exposure,
        "setAutoWhiteBalance": set_auto_white_balance,
        "setResolution": set_resolution,
        "getResolution": get_resolution,
        "setFrameRate": set_frame_rate,
        "getFrameRate": get_frame_rate,
    }
