"""Functions that set the cameras.

Parameters of a camera of the robot (brightness, exposure, ...) are set at the robot, by ALVideoDevice: they apply to
all its users, and need no node. Resolution and frame rate belong to the subscription of the node that reads the camera,
so that only the node can change them, by dynamic_reconfigure; any node with parameters of these names will do.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from naoqi.errors import NaoError

from ...base.errors import BadGoal
from ...functions.parts import Part
from .base import Cameras
from .cameras import (
    CAMERAS,
    OPTICAL_FRAMES,
    PARAMETERS,
    RESOLUTIONS,
    VIDEO,
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

if TYPE_CHECKING:
    from ...server.nao_basic import NaoBasic

log = logging.getLogger(__name__)

RESOLUTION, FRAME_RATE = "resolution", "frame_rate"
"""Parameters of the node that reads a camera."""


class SettingFunctions(Part):
    def __init__(self, module: NaoBasic, cameras: Cameras, servers: Mapping[str, str]) -> None:
        """Keep what the functions need. `servers`: camera -> where its node takes dynamic_reconfigure."""
        self._module = module
        self._cameras = cameras
        self._servers = servers

    # Which camera

    def get_cameras(self) -> list[list[str]]:
        """Name, topic and optical frame of each camera."""
        return [[name, self._cameras.source(name, ""), OPTICAL_FRAMES[name]] for name in CAMERAS]

    def set_active_camera(self, camera: NamedCamera, revert: Revert) -> None:
        """Choose the camera that functions take which name none; the robot's own choice too, if it is there."""
        before, name = self._cameras.active, self._cameras.name(camera)
        if revert:
            self._module.after_wait(lambda: self._activate(before, self._module.call_now))
        self._activate(name, self._module.call)

    def get_active_camera(self) -> str:
        """The camera that functions take which name none."""
        return self._cameras.active

    def _activate(self, name: str, call: Callable[..., Any]) -> None:
        self._cameras.active = name
        if self._module.robot.connection.state == "connected":  # topics of other cameras need no robot
            try:
                call(self._module.robot.proxy(VIDEO), "setActiveCamera", CAMERAS[name])
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
        index = CAMERAS[self._cameras.name(camera)]
        return self._module.call(self._module.robot.proxy(VIDEO), method, index, *args)

    def _set(self, camera: str, number: int, value: int, revert: bool) -> None:
        name = self._cameras.name(camera)
        if revert:
            before = int(self._ask("getParameter", name, number))
            proxy = self._module.robot.proxy(VIDEO)
            self._module.after_wait(lambda: self._module.call_now(proxy, "setParameter", CAMERAS[name], number, before))
        if self._ask("setParameter", name, number, value) is False:
            problem = f"the {name} camera refuses"
            raise BadGoal(
                "values",
                [value],
                f"see getParameterRange of parameter {number}, and whether an automatic chooses it",
                problem=problem,
            )

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
        server = self._servers[self._cameras.name(camera)]
        known = self._cameras.topics.settings(server)
        if parameter not in known:
            text = f"the node of {server} has no parameter {parameter}; it has {', '.join(sorted(known))}"
            raise NaoError(text)
        return known[parameter]

    def _configure(self, camera: str, parameter: str, value: float, revert: bool) -> None:
        server = self._servers[self._cameras.name(camera)]
        before = self._configured(camera, parameter)
        value = type(before)(value)  # dynamic_reconfigure takes whole numbers and others for different things
        if revert:
            self._module.after_wait(lambda: self._cameras.topics.set(server, {parameter: before}))
        reached = self._cameras.topics.set(server, {parameter: value}).get(parameter, value)
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
