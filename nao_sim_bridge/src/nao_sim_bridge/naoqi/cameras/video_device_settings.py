"""Part of ALVideoDevice: what subscribers see, and the parameters of the cameras."""

from __future__ import annotations

import logging
from dataclasses import replace
from typing import Any, Callable

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.cameras.cameras import Cameras, ChosenAutomatically
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.cameras.video_device_cameras import CameraStates, of_active
from nao_sim_bridge.naoqi.cameras.video_device_subscribers import Subscriber, VideoSubscribers, tells_success

log = logging.getLogger("nao_sim.cameras")

NATIVE, IDLE_RESOLUTION, IDLE_RATE = 9, 1, 5
"""Colour space that the cameras themselves give, and size and rate of a camera that nobody looks through."""
SELECT, SET_DEFAULTS = 18, 19
"""Numbers of what once were parameters: the active camera, and setting all to their defaults."""


def _of_views(field: str) -> Callable[..., list]:
    """A method that answers a field of all views of a subscriber."""

    def read(self: VideoDeviceSettings, handle: str) -> list:
        return [getattr(view, field) for view in self._subscribers.get(handle).views]

    return read


def _changes_views(field: str, name: str) -> Callable[..., list]:
    """A method that changes a field of all views of a subscriber: a value for each, called `name` in errors."""

    def change(self: VideoDeviceSettings, handle: str, values: Any) -> list:
        views = self._subscribers.get(handle).views
        if not isinstance(values, (list, tuple)) or len(values) != len(views):
            raise BadValue(name, values, f"a list of {len(views)} whole numbers, one a camera")
        changed = [replace(view, **{field: value}) for view, value in zip(views, values)]
        if len({view.camera for view in changed}) < len(changed):
            raise BadValue(name, values, "different cameras")
        self._subscribers.change(handle, changed)
        if field == "camera":
            for view in changed:
                self._states.use(view.camera)
        return [True for _ in views]

    return change


def _by_handle(method: Callable[..., Any]) -> Callable[..., Any]:
    """The method for the camera that a subscriber looks through."""
    return lambda self, handle, *arguments: method(self, self.getActiveCamera(handle), *arguments)


class VideoDeviceSettings:
    """Active cameras, sizes, colour spaces, rates and parameters, of cameras and of subscribers."""

    def __init__(self, cameras: Cameras, subscribers: VideoSubscribers, states: CameraStates) -> None:
        self._cameras = cameras
        self._subscribers = subscribers
        self._states = states

    # --- cameras of subscribers -----------------------------------------------------------------------------------

    def getActiveCamera(self, *handle: str) -> int:
        return self._one(*handle).views[0].camera if handle else self._cameras.active

    @tells_success
    def setActiveCamera(self, *arguments: Any) -> bool:
        camera = self._cameras.tables.camera(arguments[-1])
        if len(arguments) == 1:
            self._cameras.active = camera
        else:
            self._change_one(arguments[0], camera=camera)
            self._states.use(camera)
        return True

    getActiveCameras, setActiveCameras = _of_views("camera"), _changes_views("camera", "cameraIndexes")

    # --- sizes, colour spaces and rates ---------------------------------------------------------------------------

    def getResolution(self, of: Any) -> int:
        if isinstance(of, str):
            return self._one(of).views[0].resolution
        camera = self._cameras.tables.camera(of)
        used = [stream.size for stream in self._cameras.streams if stream.camera == camera]
        return max(used, key=lambda size: size.width).id if used else IDLE_RESOLUTION

    @tells_success
    def setResolution(self, handle: str, resolution: int) -> bool:
        return self._change_one(handle, resolution=resolution)

    getResolutions, setResolutions = _of_views("resolution"), _changes_views("resolution", "resolutions")

    def getColorSpace(self, of: Any) -> int:
        if isinstance(of, str):
            return self._one(of).views[0].color_space
        self._cameras.tables.camera(of)
        return NATIVE

    @tells_success
    def setColorSpace(self, handle: str, color_space: int) -> bool:
        return self._change_one(handle, color_space=color_space)

    getColorSpaces, setColorSpaces = _of_views("color_space"), _changes_views("color_space", "colorSpaces")

    def getFrameRate(self, of: Any) -> int:
        if isinstance(of, str):
            return self._subscribers.get(of).fps
        return round(self._cameras.rate(of)) or IDLE_RATE

    @tells_success
    def setFrameRate(self, handle: str, fps: int) -> bool:
        self._subscribers.change(handle, fps=fps)
        return True

    def getExpectedImageParameters(self, *camera: int) -> list:
        index = self._cameras.tables.camera(camera[0]) if camera else self._cameras.active
        return [self.getResolution(index), self.getFrameRate(index)]

    getGVMResolution, getVIMResolution = getResolution, of_active(getResolution)
    getGVMColorSpace, getVIMColorSpace = getColorSpace, of_active(getColorSpace)
    getGVMFrameRate, getVIMFrameRate = getFrameRate, of_active(getFrameRate)

    # --- parameters of cameras ------------------------------------------------------------------------------------

    def getParameter(self, camera: int, number: int) -> int:
        return self._cameras.parameter(camera, number)

    def setParameter(self, camera: int, number: int, value: int) -> bool:
        """False, with a line in the log, while an automatic chooses it."""
        try:
            self._cameras.set_parameter(camera, number, value)
        except ChosenAutomatically as error:
            log.warning("setParameter: %s", error)
            return False
        return True

    def getParameterRange(self, camera: int, number: int) -> list:
        self._cameras.tables.camera(camera)
        parameter = self._cameras.tables.parameter(number)
        return [parameter.least, parameter.most]

    def getParameterInfo(self, camera: int, number: int) -> list:
        parameter = self._cameras.tables.parameter(number)
        value = self._cameras.parameter(camera, number)
        limits = [["min", parameter.least], ["max", parameter.most], ["default", parameter.default]]
        return [["name", parameter.name], ["value", value], *limits]

    def setParameterToDefault(self, camera: int, number: int) -> bool:
        return self.setParameter(camera, number, self._cameras.tables.parameter(number).default)

    def setAllParametersToDefault(self, camera: int) -> bool:
        self._cameras.reset_parameters(camera)
        return True

    def getParam(self, number: int, *camera: int) -> int:
        if number == SELECT:
            return self._cameras.active
        return self.getParameter(self._camera(*camera), number)

    def setParam(self, number: int, value: int, *camera: int) -> None:
        if number == SELECT:
            self.setActiveCamera(value)
        elif number == SET_DEFAULTS:
            self.setAllParametersToDefault(self._camera(*camera))
        else:
            self.setParameter(self._camera(*camera), number, value)

    def setParamDefault(self, number: int) -> None:
        if number == SELECT:
            self.setActiveCamera(0)
        else:
            self.setParameterToDefault(self._cameras.active, number)

    # --- parameters by subscriber ---------------------------------------------------------------------------------

    getCameraParameterRange, getCameraParameterInfo = _by_handle(getParameterRange), _by_handle(getParameterInfo)
    setCameraParameterToDefault = tells_success(_by_handle(setParameterToDefault))

    def getCameraParameter(self, handle: str, number: int) -> int:
        camera = self.getActiveCamera(handle)
        return camera if number == SELECT else self.getParameter(camera, number)

    @tells_success
    def setCameraParameter(self, handle: str, number: int, value: int) -> bool:
        camera = self.getActiveCamera(handle)
        if number == SELECT:
            return self.setActiveCamera(handle, value)
        if number == SET_DEFAULTS:
            return self.setAllParametersToDefault(camera)
        return self.setParameter(camera, number, value)

    @tells_success
    def setAllCameraParametersToDefault(self, handle: str) -> bool:
        return all([self.setAllParametersToDefault(camera) for camera in self.getActiveCameras(handle)])

    def getCamerasParameter(self, handle: str, number: int) -> list:
        return [self.getParameter(camera, number) for camera in self.getActiveCameras(handle)]

    def setCamerasParameter(self, handle: str, number: int, values: Any) -> list:
        cameras = self.getActiveCameras(handle)
        if not isinstance(values, (list, tuple)) or len(values) != len(cameras):
            raise BadValue("values", values, f"a list of {len(cameras)} whole numbers, one a camera")
        return [self.setParameter(camera, number, value) for camera, value in zip(cameras, values)]

    def setCamerasParameterToDefault(self, handle: str, number: int) -> list:
        return [self.setParameterToDefault(camera, number) for camera in self.getActiveCameras(handle)]

    def _one(self, handle: str) -> Subscriber:
        """A subscriber that looks through one camera."""
        subscriber = self._subscribers.get(handle)
        if len(subscriber.views) > 1:
            raise NaoqiError(f"{handle!r} looks through several cameras; use the method for several of them")
        return subscriber

    def _change_one(self, handle: str, **changed: int) -> bool:
        self._subscribers.change(handle, [replace(self._one(handle).views[0], **changed)])
        return True

    def _camera(self, *camera: int) -> int:
        return camera[0] if camera else self._cameras.active
