"""Pictures of a robot's cameras for all pages that look: taken from the driver as they are compressed there."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

from ...nao.camera_facts import CAMERAS
from .background import in_background
from .broadcast import Broadcast, FrameInbox
from .wire import picture_frame

CAMERA_VIEWS = tuple(CAMERAS.values())
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
        self._changing = asyncio.Lock()  # one page comes or goes at a time
        self._end: Callable[[], None] | None = None

    async def attach(self) -> FrameInbox:
        """One more page looks."""
        async with self._changing:
            if self._end is None:
                self._end = await in_background(self._subscribe, asyncio.get_running_loop())
            return self._pages.attach()

    async def detach(self, inbox: FrameInbox) -> None:
        """A page has gone."""
        async with self._changing:
            self._pages.detach(inbox)
            if not len(self._pages) and self._end is not None:
                end, self._end = self._end, None
                await in_background(end)

    def _subscribe(self, loop: asyncio.AbstractEventLoop) -> Callable[[], None]:
        from sensor_msgs.msg import CompressedImage

        def show(told: Any) -> None:  # in a thread of ROS
            frame = picture_frame(told.header.stamp.to_sec(), told.data, told.format.lower().endswith("png"))
            loop.call_soon_threadsafe(self._pages.put, PICTURE, frame)

        return self._robot.topic(f"nao_robot/camera/{self._camera}/image_raw/compressed", CompressedImage, show)
