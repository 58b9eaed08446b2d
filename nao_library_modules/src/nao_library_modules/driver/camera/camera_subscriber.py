"""A subscriber of the robot's cameras: what it asks for, and the calls for that. No ROS."""

from __future__ import annotations

import logging
from dataclasses import dataclass
from typing import Any

from naoqi.errors import NaoError, RobotError, RobotUnreachable

from ...nao.camera_facts import CAMERA_NAMES

log = logging.getLogger(__name__)

DEVICE = "ALVideoDevice"
ANSWER_LIMIT = 5.0


@dataclass(frozen=True)
class StreamSettings:
    """What a subscriber of ALVideoDevice asks for.

    Attributes:
        camera: NAOqi's number of the camera.
        resolution: NAOqi's number of the size.
        color_space: NAOqi's number.
        frame_rate: Pictures a second.
    """

    camera: int
    resolution: int
    color_space: int
    frame_rate: int

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
    """Subscribes to the cameras of one robot under one name, for one subscription at a time. Keeps nothing."""

    def __init__(self, robot: Any, name: str) -> None:
        """Remember whom to ask.

        Args:
            robot: Its proxies, see `nao_library_modules.robot`.
            name: Name under which the robot knows the subscriber.
        """
        self._robot = robot
        self._name = name

    def subscribe(self, wanted: StreamSettings) -> str:
        """The handle of a new subscription.

        Raises:
            NaoError: If there is none to be had.
        """
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
        """Tell the robot what is new; not of the camera.

        Raises:
            NaoError: If it refuses.
        """
        for name, method in CHANGES.items():
            value = getattr(after, name)
            if value != getattr(before, name) and self._ask(method, handle, value) is False:
                raise NaoError(f"the robot refuses the {name} {value} for its {CAMERA_NAMES[after.camera]}")

    def unsubscribe(self, handle: str) -> None:
        """End a subscription.

        Raises:
            NaoError: If the robot cannot be asked.
        """
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
