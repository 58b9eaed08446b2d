"""Part of ALVideoDevice: methods of old programs, which have newer names; without a camera they mean the active one."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.cameras.cameras import Cameras
from nao_sim_bridge.naoqi.cameras.video_device_angles import VideoDeviceAngles
from nao_sim_bridge.naoqi.cameras.video_device_cameras import VideoDeviceCameras
from nao_sim_bridge.naoqi.cameras.video_device_settings import VideoDeviceSettings
from nao_sim_bridge.naoqi.cameras.video_device_subscribers import VideoSubscribers

SELECT, SET_DEFAULTS = 18, 19
"""Numbers of what once were parameters: the active camera, and setting all to their defaults."""
UNKNOWN = -1


class VideoDeviceOld:
    """See above."""

    def __init__(
        self,
        cameras: Cameras,
        subscribers: VideoSubscribers,
        settings: VideoDeviceSettings,
        device: VideoDeviceCameras,
        angles: VideoDeviceAngles,
    ) -> None:
        self._cameras = cameras
        self._subscribers = subscribers
        self._settings = settings
        self._device = device
        self._angles = angles

    # --- subscribers and the active camera ------------------------------------------------------------------------

    def getGVMResolution(self, handle: str) -> int:
        return self._settings.getResolution(handle)

    def getGVMColorSpace(self, handle: str) -> int:
        return self._settings.getColorSpace(handle)

    def getGVMFrameRate(self, handle: str) -> int:
        return self._settings.getFrameRate(handle)

    def getVIMResolution(self) -> int:
        return self._settings.getResolution(self._cameras.active)

    def getVIMColorSpace(self) -> int:
        return self._settings.getColorSpace(self._cameras.active)

    def getVIMFrameRate(self) -> int:
        return self._settings.getFrameRate(self._cameras.active)

    def getCameraModelID(self) -> int:
        return self._device.getCameraModel(self._cameras.active)

    # --- parameters -----------------------------------------------------------------------------------------------

    def getParam(self, number: int, *camera: int) -> int:
        if number == SELECT:
            return self._cameras.active
        return self._settings.getParameter(self._camera(*camera), number)

    def setParam(self, number: int, value: int, *camera: int) -> None:
        if number == SELECT:
            self._settings.setActiveCamera(value)
        elif number == SET_DEFAULTS:
            self._settings.setAllParametersToDefault(self._camera(*camera))
        else:
            self._settings.setParameter(self._camera(*camera), number, value)

    def setParamDefault(self, number: int) -> None:
        if number == SELECT:
            self._settings.setActiveCamera(0)
        else:
            self._settings.setParameterToDefault(self._cameras.active, number)

    # --- sizes and angles -----------------------------------------------------------------------------------------

    def resolutionToSizes(self, resolution: int) -> list:
        size = self._cameras.tables.resolution(resolution)
        return [size.width, size.height]

    def sizesToResolution(self, width: int, height: int) -> int:
        sizes = {(size.width, size.height): size.id for size in self._cameras.tables.resolutions.values()}
        return sizes.get((width, height), UNKNOWN)

    def getAngPosFromImgPos(self, place: Any) -> list:
        return self._angles.getAngularPositionFromImagePosition(self._cameras.active, place)

    def getAngSizeFromImgSize(self, size: Any) -> list:
        return self._angles.getAngularSizeFromImageSize(self._cameras.active, size)

    def getImgPosFromAngPos(self, angles: Any) -> list:
        return self._angles.getImagePositionFromAngularPosition(self._cameras.active, angles)

    def getImgSizeFromAngSize(self, size: Any) -> list:
        return self._angles.getImageSizeFromAngularSize(self._cameras.active, size)

    def getImgInfoFromAngInfo(self, info: Any) -> list:
        return self._angles.getImageInfoFromAngularInfo(self._cameras.active, info)

    def getImgInfoFromAngInfoWithRes(self, info: Any, resolution: int) -> list:
        return self._angles.getImageInfoFromAngularInfoWithResolution(self._cameras.active, info, resolution)

    def _camera(self, *camera: int) -> int:
        return camera[0] if camera else self._cameras.active
