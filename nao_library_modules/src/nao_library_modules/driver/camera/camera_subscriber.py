"""A subscriber of the robot's cameras: its settings, and the calls to ALVideoDevice. No ROS."""

from __future__ import annotations

import logging
from dataclasses import dataclass
from typing import Any

from naoqi.errors import NaoError, RobotError, RobotUnreachable
from naoqi.limits import ANSWER_LIMIT

from ...nao.camera_facts import CAMERA_NAMES

log = logging.getLogger(__name__)

DEVICE = "ALVideoDevice"


@dataclass(frozen=True)
class StreamSettings:
    """A subscription to ALVideoDevice; camera, resolution and colour space are NAOqi's numbers."""

    camera: int
    resolution: int
    color_space: int
    frame_rate: int  # pictures a second

    @property
    def period(self) -> float:
        """Time between two pictures, s."""
        return 1.0 / self.frame_rate


CHANGES = {
    "resolution": "setResolution",
    "color_space": "setColorSpace",
    "frame_rate": "setFrameRate",
}
"""What of the settings can be changed while pictures come, and by which method."""


class CameraSubscriber:
    """Subscribes to the cameras of one robot under one name, for one subscription at a time. Has no state.

    Methods raise NaoError if the robot refuses or cannot be asked.
    """

    def __init__(self, robot: Any, name: str) -> None:
        self._robot = robot
        self._name = name

    def subscribe(self, wanted: StreamSettings) -> str:
        """The handle of a new subscription."""
        arguments = (self._name, wanted.camera, wanted.resolution, wanted.color_space, wanted.frame_rate)
        try:
            handle = self._ask("subscribeCamera", *arguments)
        except RobotUnreachable:
            raise
        except NaoError as error:
            handle, refused = "", error
        else:
            refused = NaoError(f"the robot does not accept {self._name} as a subscriber of its cameras")
        # A node that was killed leaves its subscriptions behind, and a name may have a few only.
        if not handle and self._end_leftovers():
            handle = self._ask("subscribeCamera", *arguments)
        if not handle:
            raise refused
        return handle

    def change(self, handle: str, before: StreamSettings, after: StreamSettings) -> None:
        """Apply new settings to a subscription, all but the camera."""
        for name, method in CHANGES.items():
            value = getattr(after, name)
            if value != getattr(before, name) and self._ask(method, handle, value) is False:
                raise NaoError(f"the robot refuses the {name} {value} for its {CAMERA_NAMES[after.camera]}")

    def unsubscribe(self, handle: str) -> None:
        try:
            self._ask("unsubscribe", handle)
        except RobotError as error:  # the robot has forgotten it
            log.debug("%s: %s", self._name, error)

    def _end_leftovers(self) -> int:
        leftovers = [each for each in self._ask("getSubscribers") if each.rpartition("_")[0] == self._name]
        for handle in leftovers:
            self.unsubscribe(handle)
        return len(leftovers)

    def _ask(self, method: str, *arguments: Any) -> Any:
        return self._robot.proxy(DEVICE).call_async(method, *arguments).result(timeout=ANSWER_LIMIT)
