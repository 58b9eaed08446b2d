"""Part of ALVideoDevice: what subscribers see, and the parameters of the cameras."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Callable

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.cameras.cameras import Cameras
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.cameras.video_device_states import CameraStates
from nao_sim_bridge.naoqi.cameras.video_device_subscribers import Subscriber, VideoSubscribers

NATIVE, IDLE_RESOLUTION, IDLE_RATE = 9, 1, 5
"""Colour space that the cameras themselves give, and size and rate of a camera that nobody looks through."""


class VideoDeviceSettings:
    """Active cameras, sizes, colour spaces, rates and parameters, of cameras and of subscribers."""

    def __init__(self, cameras: Cameras, subscribers: VideoSubscribers, states: CameraStates) -> None:
        self._cameras = cameras
        self._subscribers = subscribers
        self._states = states

    # --- cameras of subscribers -----------------------------------------------------------------------------------

    def getActiveCamera(self, *handle: str) -> int:
        return self._one(*handle).views[0].camera if handle else self._cameras.active

    def setActiveCamera(self, *arguments: Any) -> bool:
        camera = self._cameras.tables.camera(arguments[-1])
        if len(arguments) == 1:
            self._cameras.active = camera
        else:
            view = self._one(arguments[0]).views[0]
            self._subscribers.change(arguments[0], [replace(view, camera=camera)])
            self._states.use(camera)
        return True

    def getActiveCameras(self, handle: str) -> list:
        return [view.camera for view in self._subscribers.get(handle).views]

    def setActiveCameras(self, handle: str, cameras: Any) -> list:
        return self._set_each(handle, cameras, "cameraIndexes", "camera")

    # --- sizes, colour spaces and rates ---------------------------------------------------------------------------

    def getResolution(self, of: Any) -> int:
        if isinstance(of, str):
            return self._one(of).views[0].resolution
        tables = self._cameras.tables
        used = [stream.size for stream in self._cameras.streams if stream.camera == tables.camera(of)]
        return max(used, key=lambda size: size.width).id if used else IDLE_RESOLUTION

    def setResolution(self, handle: str, resolution: int) -> bool:
        self._subscribers.change(handle, [replace(self._one(handle).views[0], resolution=resolution)])
        return True

    def getResolutions(self, handle: str) -> list:
        return [view.resolution for view in self._subscribers.get(handle).views]

    def setResolutions(self, handle: str, resolutions: Any) -> list:
        return self._set_each(handle, resolutions, "resolutions", "resolution")

    def getColorSpace(self, of: Any) -> int:
        if isinstance(of, str):
            return self._one(of).views[0].color_space
        self._cameras.tables.camera(of)
        return NATIVE

    def setColorSpace(self, handle: str, color_space: int) -> bool:
        self._subscribers.change(handle, [replace(self._one(handle).views[0], color_space=color_space)])
        return True

    def getColorSpaces(self, handle: str) -> list:
        return [view.color_space for view in self._subscribers.get(handle).views]

    def setColorSpaces(self, handle: str, color_spaces: Any) -> list:
        return self._set_each(handle, color_spaces, "colorSpaces", "color_space")

    def getFrameRate(self, of: Any) -> int:
        if isinstance(of, str):
            return self._subscribers.get(of).fps
        return round(self._cameras.rate(of)) or IDLE_RATE

    def setFrameRate(self, handle: str, fps: int) -> bool:
        self._subscribers.change(handle, fps=fps)
        return True

    # --- parameters of cameras ------------------------------------------------------------------------------------

    def getParameter(self, camera: int, number: int) -> int:
        return self._cameras.parameter(camera, number)

    def setParameter(self, camera: int, number: int, value: int) -> bool:
        self._cameras.set_parameter(camera, number, value)
        return True

    def getParameterRange(self, camera: int, number: int) -> list:
        self._cameras.tables.camera(camera)
        parameter = self._cameras.tables.parameter(number)
        return [parameter.least, parameter.most]

    def getParameterInfo(self, camera: int, number: int) -> list:
        parameter = self._cameras.tables.parameter(number)
        value = self._cameras.parameter(camera, number)
        facts = (
            ("name", parameter.name),
            ("value", value),
            ("min", parameter.least),
            ("max", parameter.most),
            ("default", parameter.default),
        )
        return [list(fact) for fact in facts]

    def setParameterToDefault(self, camera: int, number: int) -> bool:
        return self.setParameter(camera, number, self._cameras.tables.parameter(number).default)

    def setAllParametersToDefault(self, camera: int) -> bool:
        self._cameras.reset_parameters(camera)
        return True

    # --- parameters by subscriber ---------------------------------------------------------------------------------

    def getCameraParameter(self, handle: str, number: int) -> int:
        return self.getParameter(self.getActiveCamera(handle), number)

    def setCameraParameter(self, handle: str, number: int, value: int) -> bool:
        return self.setParameter(self.getActiveCamera(handle), number, value)

    def getCameraParameterRange(self, handle: str, number: int) -> list:
        return self.getParameterRange(self.getActiveCamera(handle), number)

    def getCameraParameterInfo(self, handle: str, number: int) -> list:
        return self.getParameterInfo(self.getActiveCamera(handle), number)

    def setCameraParameterToDefault(self, handle: str, number: int) -> bool:
        return self.setParameterToDefault(self.getActiveCamera(handle), number)

    def setAllCameraParametersToDefault(self, handle: str) -> bool:
        return all([self.setAllParametersToDefault(camera) for camera in self.getActiveCameras(handle)])

    def getCamerasParameter(self, handle: str, number: int) -> list:
        return self._each(handle, lambda camera: self.getParameter(camera, number))

    def setCamerasParameter(self, handle: str, number: int, values: Any) -> list:
        cameras = self.getActiveCameras(handle)
        if not isinstance(values, (list, tuple)) or len(values) != len(cameras):
            raise BadValue("values", values, f"a list of {len(cameras)} whole numbers, one a camera")
        return [self.setParameter(camera, number, value) for camera, value in zip(cameras, values)]

    def setCamerasParameterToDefault(self, handle: str, number: int) -> list:
        return self._each(handle, lambda camera: self.setParameterToDefault(camera, number))

    # --- inside ---------------------------------------------------------------------------------------------------

    def _one(self, handle: str) -> Subscriber:
        """A subscriber that looks through one camera."""
        subscriber = self._subscribers.get(handle)
        if len(subscriber.views) > 1:
            raise NaoqiError(f"{handle!r} looks through several cameras; use the method for several of them")
        return subscriber

    def _each(self, handle: str, action: Callable[[int], Any]) -> list:
        return [action(camera) for camera in self.getActiveCameras(handle)]

    def _set_each(self, handle: str, values: Any, name: str, field: str) -> list:
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
