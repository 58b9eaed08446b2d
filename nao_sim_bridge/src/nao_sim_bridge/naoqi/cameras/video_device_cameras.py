"""Parts of ALVideoDevice: the cameras, which of them run, what they see from outside; places in pictures, angles."""

from __future__ import annotations

import math
import threading
from typing import Any, Callable

import numpy as np

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.cameras.cameras import Cameras
from nao_sim_bridge.cameras.settings import CAMERA_NAMES, CAMERAS
from nao_sim_bridge.naoqi.binding.arguments import vector, whole_number
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.cameras.video_device_subscribers import VideoSubscribers

LAYERS = 3
SIZE = (640, 480)
MOST_PIXELS = 2560 * 1920
LIMIT = 1.57
"""Angles beyond it, rad, are in no picture."""
UNKNOWN = -1


def of_active(method: Callable[..., Any]) -> Callable[..., Any]:
    """The method of old programs that has no camera among its arguments: it means the active one."""
    return lambda self, *arguments: method(self, self._cameras.active, *arguments)


class CameraStates:
    """The cameras' states; any thread. A camera is open and runs by itself while somebody looks.

    `fail` is called with a camera and a reason when there will be no frames.
    """

    def __init__(self, cameras: Cameras, fail: Callable[[int, str], None]) -> None:
        self._cameras = cameras
        self._fail = fail
        self._lock = threading.RLock()
        self._opened = [False for _ in CAMERAS]
        self._started = [False for _ in CAMERAS]
        self._closed = [False for _ in CAMERAS]

    def is_open(self, camera: int) -> bool:
        return not self._closed[camera] and (self._opened[camera] or self._wanted(camera))

    def runs(self, camera: int) -> bool:
        return not self._cameras.stopped(camera) and (self._started[camera] or self._wanted(camera))

    def open(self, camera: int) -> None:
        """Open it; if it had been closed, it takes no pictures before it is started."""
        with self._lock:
            self._opened[camera], self._closed[camera] = True, False

    def close(self, camera: int) -> None:
        """Close it: nobody gets pictures any more."""
        with self._lock:
            self._opened[camera], self._closed[camera] = False, True
            self._stop(camera, "closed: openCamera and startCamera")

    def start(self, camera: int) -> None:
        """Let it take pictures; a NaoqiError when it is closed."""
        with self._lock:
            if self._closed[camera]:
                raise NaoqiError(f"camera {camera} is closed; open it with openCamera first")
            self._opened[camera] = self._started[camera] = True
            self._cameras.set_stopped(camera, False)

    def stop(self, camera: int) -> None:
        with self._lock:
            self._stop(camera, "stopped: startCamera")

    def use(self, camera: int) -> None:
        """Somebody begins to look: whatever it was, it runs."""
        with self._lock:
            self._closed[camera] = False
            self._cameras.set_stopped(camera, False)

    def reset(self, camera: int) -> None:
        with self._lock:
            self._opened[camera] = self._started[camera] = False
            self.use(camera)

    def check(self, camera: int) -> None:
        """Make sure that a camera has pictures for somebody who looks; a NaoqiError when it is closed or stopped."""
        with self._lock:
            if self._closed[camera]:
                raise NaoqiError(_no_pictures(camera, "closed: openCamera and startCamera"))
            if self._cameras.stopped(camera):
                raise NaoqiError(_no_pictures(camera, "stopped: startCamera"))

    def _stop(self, camera: int, reason: str) -> None:
        self._started[camera] = False
        self._cameras.set_stopped(camera, True)
        self._fail(camera, _no_pictures(camera, reason))

    def _wanted(self, camera: int) -> bool:
        looked = any(stream.camera == camera for stream in self._cameras.streams)
        return looked or self._cameras.kept_alive(camera)


def _no_pictures(camera: int, reason: str) -> str:
    return f"camera {camera} gives no pictures, it is {reason} lets it go on"


class VideoDeviceCameras:
    """What cameras there are, turning them on and off, and what they see instead of the world.

    The first picture from outside takes a camera's place in the world; `resetCamera` gives it back.
    """

    def __init__(self, cameras: Cameras, subscribers: VideoSubscribers, states: CameraStates) -> None:
        self._cameras = cameras
        self._subscribers = subscribers
        self._states = states
        self._size = SIZE

    def getCameraIndexes(self) -> list:
        return list(CAMERAS)

    def getCameraName(self, camera: int) -> str:
        return CAMERA_NAMES[self._index(camera)]

    def getCameraModel(self, camera: int) -> int:
        self._index(camera)
        return self._cameras.tables.model_id

    getCameraModelID = of_active(getCameraModel)

    def hasDepthCamera(self) -> bool:
        return False

    def getHorizontalFOV(self, camera: int) -> float:
        return self._cameras.optics(self._index(camera)).hfov

    def getVerticalFOV(self, camera: int) -> float:
        return self._cameras.optics(self._index(camera)).vfov

    getHorizontalAperture, getVerticalAperture = getHorizontalFOV, getVerticalFOV

    # --- on and off -----------------------------------------------------------------------------------------------

    def isCameraOpen(self, *camera: int) -> bool:
        self._subscribers.clean_up()
        return self._states.is_open(self._index(*camera))

    def isCameraStarted(self, camera: int) -> bool:
        self._subscribers.clean_up()
        return self._states.runs(self._index(camera))

    def openCamera(self, camera: int) -> bool:
        self._states.open(self._index(camera))
        return True

    def closeCamera(self, *camera: int) -> bool:
        self._states.close(self._index(*camera))
        return True

    def startCamera(self, camera: int) -> bool:
        self._states.start(self._index(camera))
        return True

    def stopCamera(self, camera: int) -> bool:
        self._states.stop(self._index(camera))
        return True

    def startFrameGrabber(self, *camera: int) -> bool:
        index = self._index(*camera)
        return self.openCamera(index) and self.startCamera(index)

    stopFrameGrabber = closeCamera

    def isFrameGrabberOff(self, *camera: int) -> bool:
        return not self.isCameraOpen(*camera)

    def resetCamera(self, camera: int) -> bool:
        index = self._index(camera)
        self._cameras.reset_parameters(index)
        self._cameras.show(index, None)
        self._states.reset(index)
        return True

    # --- pictures from outside ------------------------------------------------------------------------------------

    def setSimCamInputSize(self, width: int, height: int) -> bool:
        self._size = _size(width, height)
        return True

    def putImage(self, *arguments: Any) -> bool:
        *where, pixels = arguments
        camera, width, height = where or (self._cameras.active, *self._size)
        self._cameras.show(self._cameras.tables.camera(camera), _picture(pixels, *_size(width, height)))
        return True

    def _index(self, *camera: int) -> int:
        return self._cameras.tables.camera(camera[0]) if camera else self._cameras.active


class VideoDeviceAngles:
    """Places are normalised, (0, 0) upper left, (1, 1) lower right; angles are positive to the left and downwards."""

    def __init__(self, cameras: Cameras) -> None:
        self._cameras = cameras

    def resolutionToSizes(self, resolution: int) -> list:
        size = self._cameras.tables.resolution(resolution)
        return [size.width, size.height]

    def sizesToResolution(self, width: int, height: int) -> int:
        sizes = {(size.width, size.height): size.id for size in self._cameras.tables.resolutions.values()}
        return sizes.get((width, height), UNKNOWN)

    def getAngularPositionFromImagePosition(self, camera: int, place: Any) -> list:
        return list(self._cameras.optics(camera).angles(*_pair(place, "ImagePosition")))

    def getAngularSizeFromImageSize(self, camera: int, size: Any) -> list:
        return list(self._cameras.optics(camera).angular_size(*_pair(size, "ImageSize", least=0.0)))

    def getImagePositionFromAngularPosition(self, camera: int, angles: Any) -> list:
        return list(self._cameras.optics(camera).place(*_pair(angles, "AngularPosition", -LIMIT, LIMIT)))

    def getImageSizeFromAngularSize(self, camera: int, size: Any) -> list:
        return list(self._cameras.optics(camera).image_size(*_pair(size, "AngularSize", 0.0, 2.0 * LIMIT)))

    def getImageInfoFromAngularInfo(self, camera: int, info: Any) -> list:
        values = vector(info, "AngularInfo", 4, "[alpha, beta, width, height] in rad")
        place = self.getImagePositionFromAngularPosition(camera, values[:2])
        return place + self.getImageSizeFromAngularSize(camera, values[2:])

    def getImageInfoFromAngularInfoWithResolution(self, camera: int, info: Any, resolution: int) -> list:
        size = self._cameras.tables.resolution(resolution)
        x, y, width, height = self.getImageInfoFromAngularInfo(camera, info)
        return [x * size.width, y * size.height, width * size.width, height * size.height]

    getAngPosFromImgPos = of_active(getAngularPositionFromImagePosition)
    getAngSizeFromImgSize = of_active(getAngularSizeFromImageSize)
    getImgPosFromAngPos = of_active(getImagePositionFromAngularPosition)
    getImgSizeFromAngSize = of_active(getImageSizeFromAngularSize)
    getImgInfoFromAngInfo = of_active(getImageInfoFromAngularInfo)
    getImgInfoFromAngInfoWithRes = of_active(getImageInfoFromAngularInfoWithResolution)


def _pair(values: Any, field: str, least: float = -math.inf, most: float = math.inf) -> list[float]:
    return vector(values, field, 2, "two numbers", least, most)


def _size(width: int, height: int) -> tuple[int, int]:
    whole_number(width, "width", 2, MOST_PIXELS)
    whole_number(height, "height", 2, MOST_PIXELS)
    if width * height > MOST_PIXELS:
        raise BadValue("width and height", (width, height), f"at most {MOST_PIXELS} pixels")
    return width, height


def _picture(pixels: Any, width: int, height: int) -> np.ndarray:
    """(height, width, 3) RGB of its bytes."""
    expected = width * height * LAYERS
    if not isinstance(pixels, (bytes, bytearray)):
        raise BadValue("imageBuffer", pixels, f"{expected} raw bytes")
    if len(pixels) != expected:
        raise BadValue(
            "length of imageBuffer", len(pixels), f"{expected}: {LAYERS} bytes (RGB) a pixel, {width}x{height}"
        )
    return np.frombuffer(bytes(pixels), dtype=np.uint8).reshape(height, width, LAYERS)
