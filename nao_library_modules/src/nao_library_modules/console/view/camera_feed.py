"""Pictures of a robot's cameras for all pages that look: taken from the driver as they are compressed there."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

from ...nao.camera_facts import CAMERAS
from .broadcast import Broadcast, FrameInbox
from .wire import picture_frame

NAMES = tuple(CAMERAS.values())
PICTURE = "picture"


class CameraFeed:
    """One camera of one robot; the topic is listened to while a page looks. Event loop only.

    ROS API (relative name):
        Subscribes `nao_robot/camera/NAME/image_raw/compressed` (sensor_msgs/CompressedImage).
    """

    def __init__(self, robot: Any, camera: str) -> None:
        self._robot = robot
        self._camera = camera
        self._pages = Broadcast()
        self._end: Callable[[], None] | None = None

    def attach(self) -> FrameInbox:
        inbox = self._pages.attach()
        if self._end is None:
            from sensor_msgs.msg import CompressedImage

            loop = asyncio.get_running_loop()

            def show(told: Any) -> None:  # in a thread of ROS
                frame = picture_frame(told.header.stamp.to_sec(), told.data, told.format.lower().endswith("png"))
                loop.call_soon_threadsafe(self._pages.put, PICTURE, frame)

            topic = f"nao_robot/camera/{self._camera}/image_raw/compressed"
            self._end = self._robot.topic(topic, CompressedImage, show)
        return inbox

    def detach(self, inbox: FrameInbox) -> None:
        self._pages.detach(inbox)
        if not len(self._pages) and self._end is not None:
            self._end()
            self._end = None
