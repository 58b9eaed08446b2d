"""Part of ALVideoDevice: the cameras themselves."""

from __future__ import annotations

from nao_sim_bridge.cameras.cameras import Cameras
from nao_sim_bridge.cameras.settings import CAMERA_NAMES, CAMERAS
from nao_sim_bridge.naoqi.cameras.video_device_states import CameraStates
from nao_sim_bridge.naoqi.cameras.video_device_subscribers import VideoSubscribers


class VideoDeviceCameras:
    """What cameras there are, and turning them on and off."""

    def __init__(self, cameras: Cameras, subscribers: VideoSubscribers, states: CameraStates) -> None:
        self._cameras = cameras
        self._subscribers = subscribers
        self._states = states

    def getCameraIndexes(self) -> list:
        return list(CAMERAS)

    def getCameraName(self, camera: int) -> str:
        return CAMERA_NAMES[self._index(camera)]

    def getCameraModel(self, camera: int) -> int:
        self._index(camera)
        return self._cameras.tables.model_id

    def hasDepthCamera(self) -> bool:
        return False

    def getHorizontalFOV(self, camera: int) -> float:
        return self._cameras.optics(self._index(camera)).hfov

    def getVerticalFOV(self, camera: int) -> float:
        return self._cameras.optics(self._index(camera)).vfov

    def getHorizontalAperture(self, camera: int) -> float:
        return self.getHorizontalFOV(camera)

    def getVerticalAperture(self, camera: int) -> float:
        return self.getVerticalFOV(camera)

    def isCameraOpen(self, camera: int) -> bool:
        self._subscribers.clean_up()
        return self._states.is_open(self._index(camera))

    def isCameraStarted(self, camera: int) -> bool:
        self._subscribers.clean_up()
        return self._states.runs(self._index(camera))

    def openCamera(self, camera: int) -> bool:
        self._states.open(self._index(camera))
        return True

    def closeCamera(self, camera: int) -> bool:
        self._states.close(self._index(camera))
        return True

    def startCamera(self, camera: int) -> bool:
        self._states.start(self._index(camera))
        return True

    def stopCamera(self, camera: int) -> bool:
        self._states.stop(self._index(camera))
        return True

    def startFrameGrabber(self, *camera: int) -> bool:
        index = self._index(*camera)
        self._states.open(index)
        self._states.start(index)
        return True

    def stopFrameGrabber(self, *camera: int) -> bool:
        self._states.close(self._index(*camera))
        return True

    def isFrameGrabberOff(self, *camera: int) -> bool:
        return not self.isCameraOpen(self._index(*camera))

    def resetCamera(self, camera: int) -> bool:
        index = self._index(camera)
        self._cameras.reset_parameters(index)
        self._cameras.show(index, None)
        self._states.reset(index)
        return True

    def _index(self, *camera: int) -> int:
        return self._cameras.tables.camera(camera[0]) if camera else self._cameras.active
