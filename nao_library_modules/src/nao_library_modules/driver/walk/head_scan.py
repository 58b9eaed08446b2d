"""A sweep of the head from the ground to above the horizon, for what looks out of the head. No ROS."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable

from naoqi.errors import NaoError

from ...base.cancellation import CancellationToken
from ...functions.joint_trajectory import KeyFrames
from ..joints.joint_controller import JointController

YAW, PITCH = "HeadYaw", "HeadPitch"
DOWN, UP, AFTERWARDS = math.radians(28.0), math.radians(-35.0), math.radians(22.0)
"""HeadPitch at the beginning and the end of the sweep, and after it, rad; those of nao_robot."""
SWEEP_SPEED = math.radians(3.3)
"""rad/s: a laser scanner at 10 Hz then has a line each third of a degree, as in nao_robot."""


class HeadScan:
    """The head of one robot. A scan runs in the thread that asks for it, which may be any.

    `speed` is the fraction of the joints' top speed on the way to the sweep, and from it.
    """

    def __init__(self, controller: JointController, speed: float) -> None:
        self.speed = speed
        self._controller = controller
        self._closed = CancellationToken()
        self._scanning = threading.Lock()

    @property
    def active(self) -> bool:
        return self._scanning.locked()

    def run(self, prepare: Callable[[], None] = lambda: None) -> None:
        """Look down, sweep up, look at the ground before the feet; `prepare` is called first, as a part of it.

        Raises NaoError if a scan is under way, the robot refuses or is lost, or the node ends.
        """
        if not self._scanning.acquire(blocking=False):
            raise NaoError("a head scan is under way")
        try:
            prepare()
            self._look(DOWN)
            sweep = KeyFrames((PITCH,), ((DOWN - UP) / SWEEP_SPEED,), ((UP,),))
            self._require_end(self._controller.follow(sweep, self._closed).preempted)
            self._look(AFTERWARDS)
        finally:
            self._scanning.release()

    def close(self) -> None:
        """End a scan that is under way; the head stops where it is."""
        self._closed.stop()

    def _look(self, pitch: float) -> None:
        reached = self._controller.move((YAW, PITCH), (0.0, pitch), self.speed, False, self._closed)
        self._require_end(reached.preempted)

    @staticmethod
    def _require_end(preempted: bool) -> None:
        if preempted:
            raise NaoError("the head scan was ended before time: the node ends")
