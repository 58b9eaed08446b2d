"""ALVideoDevice: subscribers and their pictures."""

from __future__ import annotations

from typing import Any, Callable, Sequence

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.cameras.cameras import Cameras
from nao_sim_bridge.cameras.frame import Frame
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.cameras.video_device_cameras import CameraStates, VideoDeviceAngles, VideoDeviceCameras
from nao_sim_bridge.naoqi.cameras.video_device_recordings import RawRecordings
from nao_sim_bridge.naoqi.cameras.video_device_settings import NATIVE, VideoDeviceSettings
from nao_sim_bridge.naoqi.cameras.video_device_subscribers import VideoSubscribers, View, tells_success

NAME = "ALVideoDevice"


def _only_inside(remote: str) -> Callable[..., int]:
    """A method that answers an address; `remote` is the one for everybody else."""

    def refused(_self: Any, _handle: str) -> int:
        raise NaoqiError(f"addresses are for modules inside the robot's own process; use {remote}")

    return refused


class ALVideoDevice:
    """Subscriptions and pictures; `parts` has the other methods of the module."""

    def __init__(self, cameras: Cameras, files: ClientFiles) -> None:
        self._cameras = cameras
        self._subscribers = VideoSubscribers(cameras)
        self._states = CameraStates(cameras, self._subscribers.fail)
        self._recordings = RawRecordings(cameras, files)

    def parts(self) -> list[Any]:
        return [
            self,
            VideoDeviceSettings(self._cameras, self._subscribers, self._states),
            VideoDeviceCameras(self._cameras, self._subscribers, self._states),
            VideoDeviceAngles(self._cameras),
        ]

    def closing(self) -> list[Callable[[], None]]:
        """Steps that end recordings and all subscriptions."""
        return [self._recordings.close, self._subscribers.close]

    # --- subscriptions --------------------------------------------------------------------------------------------

    def subscribe(self, name: str, resolution: int, color_space: int, fps: int) -> str:
        return self.subscribeCamera(name, self._cameras.active, resolution, color_space, fps)

    def subscribeCamera(self, name: str, camera: int, resolution: int, color_space: int, fps: int) -> str:
        return self._subscribe(name, [View(camera, resolution, color_space)], fps, False)

    def subscribeCameras(self, name: str, cameras: Any, resolutions: Any, color_spaces: Any, fps: int) -> str:
        indexes = _whole_numbers(cameras, "cameraIndexes")
        sizes = _whole_numbers(resolutions, "resolutions", len(indexes))
        spaces = _whole_numbers(color_spaces, "colorSpaces", len(indexes))
        return self._subscribe(name, list(map(View, indexes, sizes, spaces)), fps, True)

    @tells_success
    def unsubscribe(self, handle: str) -> bool:
        self._subscribers.remove(handle)
        return True

    def unsubscribeAllInstances(self, name: str) -> None:
        self._subscribers.remove_all(name)

    client_gone = unsubscribeAllInstances

    def onClientDisconnected(self, _event: str, contents: Any, _message: str) -> None:
        self._subscribers.remove_all(str(contents))

    def getSubscribers(self) -> list:
        return self._subscribers.handles()

    # --- pictures -------------------------------------------------------------------------------------------------

    def getImageRemote(self, handle: str) -> Task:
        return self._images(handle, "getImageRemote", _first)

    def getImagesRemote(self, handle: str) -> Task:
        return self._images(handle, "getImagesRemote", _all)

    def getDirectRawImageRemote(self, handle: str) -> Task:
        self._check_native(handle)
        return self._images(handle, "getDirectRawImageRemote", _first)

    def getDirectRawImagesRemote(self, handle: str) -> Task:
        self._check_native(handle)
        return self._images(handle, "getDirectRawImagesRemote", _all)

    @tells_success
    def releaseImage(self, handle: str) -> bool:
        self._subscribers.get(handle)
        return True

    def releaseImages(self, handle: str) -> list:
        return [True for _ in self._subscribers.get(handle).views]

    releaseDirectRawImage, releaseDirectRawImages = releaseImage, releaseImages

    getImageLocal = _only_inside("getImageRemote")
    getImagesLocal = _only_inside("getImagesRemote")
    getDirectRawImageLocal = _only_inside("getDirectRawImageRemote")
    getDirectRawImagesLocal = _only_inside("getDirectRawImagesRemote")

    # --- files ----------------------------------------------------------------------------------------------------

    def recordVideo(self, handle: str, path: str, total: int, period: int) -> bool:
        self._recordings.start(self._subscribers.get(handle), path, total, period)
        return True

    def stopVideo(self, handle: str) -> Task:
        return self._recordings.stop(handle)

    def _subscribe(self, name: str, views: Sequence[View], fps: int, several: bool) -> str:
        handle = self._subscribers.add(name, views, fps, several)
        for view in views:
            self._states.use(view.camera)
        return handle

    def _images(self, handle: str, call: str, answer: Callable[[list[Frame]], Any]) -> Task:
        subscriber = self._subscribers.get(handle)
        if subscriber.several and answer is _first:
            raise NaoqiError(f"{handle!r} looks through several cameras; use {call.replace('Image', 'Images')}")
        for view in subscriber.views:
            self._states.check(view.camera)
        return self._subscribers.ask(handle, call, answer)

    def _check_native(self, handle: str) -> None:
        wrong = [v.color_space for v in self._subscribers.get(handle).views if v.color_space != NATIVE]
        if wrong:
            raise NaoqiError(
                f"{handle!r} asked for colour space {wrong[0]}, raw images are those of {NATIVE} (YUV422) only;"
                " subscribe with that one, or use getImageRemote"
            )


def container(frame: Frame) -> list:
    """A frame as NAOqi hands it over."""
    left, top = frame.hfov / 2.0, frame.vfov / 2.0
    size = (frame.width, frame.height, frame.layers)
    return [*size, frame.color_space, *frame.stamp, frame.data, frame.camera, left, top, -left, -top]


def _first(frames: list[Frame]) -> list:
    return container(frames[0])


def _all(frames: list[Frame]) -> list[list]:
    return list(map(container, frames))


def _whole_numbers(values: Any, field: str, count: int | None = None) -> list[int]:
    """A list of whole numbers, `count` of them if that is given; a BadValue for anything else."""
    right = isinstance(values, (list, tuple)) and all(isinstance(v, int) and not isinstance(v, bool) for v in values)
    if not right or (count is not None and len(values) != count):
        allowed = "a list of whole numbers" if count is None else f"a list of {count} whole numbers, one a camera"
        raise BadValue(field, values, allowed)
    return list(values)
