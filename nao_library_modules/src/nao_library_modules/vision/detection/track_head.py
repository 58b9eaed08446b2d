"""The head while it follows something: speeds, stiffness, and giving it back."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from naoqi.errors import NaoError

from ...motion.facts import MOTION, JointLimits
from ...motion.look_at import HEAD
from .base import DetectionBase
from .space import LocalizedDetection
from .track_plan import STILL, Angles, aim, fraction, off_axis, travel_time, within

log = logging.getLogger(__name__)

DEFAULT_SPEED = 0.2
"""Fraction of the head's top speed where a message leaves it to us."""
WAY_BACK = 0.3
"""Fraction of the top speed with which the head goes back to where it was."""


class Neck:
    """Turns the head for one function. Used from the thread that executes goals."""

    def __init__(self, motion: Callable[..., Any], speed: float) -> None:
        """Ask the robot what the head can do.

        Args:
            motion: Calls a method of ALMotion.
            speed: The most that is used of the head's top speed, 0..1.
        """
        self._motion = motion
        self.speed = speed
        limits = [motion("getLimits", joint)[0] for joint in HEAD]
        self.ranges = [JointLimits(float(lower), float(upper), float(top)) for lower, upper, top, *_ in limits]

    def angles(self, measured: bool) -> Angles:
        """Where the head is, or is told to be."""
        yaw, pitch = map(float, self._motion("getAngles", list(HEAD), measured))
        return yaw, pitch

    def turn(self, angles: Angles, share: float) -> None:
        """Begin to turn the head; it goes on by itself."""
        self._motion("setAngles", list(HEAD), list(angles), share)

    def follow(self, detection: LocalizedDetection) -> bool:
        """Turn towards what was seen; tells whether that is as far as the head can go.

        The aim is where the thing was, not how far off it was seen: it stays the same while the head is on its way,
        so that an old picture does no harm.
        """
        try:
            wanted = aim(detection)
        except ValueError as error:
            log.debug("%s: the head stays where it is", error)
            return True
        angle = off_axis(detection)
        yaw, pitch = (within(joint, value) for joint, value in zip(self.ranges, wanted))
        if angle > STILL:
            self.turn((yaw, pitch), fraction(angle, self.ranges, self.speed))
        return (yaw, pitch) != wanted

    def search(self, place: Angles) -> float:
        """Turn to where something is looked for; tells how long the way takes, s."""
        way = travel_time(self.angles(True), place, self.ranges, self.speed)
        self.turn(place, self.speed)
        return way


class HeadUse(DetectionBase):
    """To be mixed into NaoBasic."""

    after_wait: Callable[[Callable[[], None]], None]  # of NaoBasic: clean-up after the function's `time`

    @contextmanager
    def head(self, speed: float, revert: bool) -> Iterator[Neck]:
        """Have the head during a block; it is stiff, and stops at the end.

        Args:
            speed: The most that is used of its top speed, 0..1; 0 for a moderate one.
            revert: Whether it goes back to where it was after the function's `time`.
        """
        proxy = self.robot.proxy(MOTION)

        def motion(method: str, *args: Any) -> Any:
            return self.call(proxy, method, *args)

        neck = Neck(motion, speed or DEFAULT_SPEED)
        before = neck.angles(False)
        limp = [joint for joint, now in zip(HEAD, motion("getStiffnesses", list(HEAD))) if not now > 0.0]
        if limp:
            self.begin(MOTION, "setStiffnesses", [limp, [1.0] * len(limp)], "setStiffnesses", limp, [0.0] * len(limp))
            self.after_wait(lambda: self.call_now(proxy, "setStiffnesses", limp, [0.0] * len(limp)))
        if revert:
            self.after_wait(
                lambda: self.call_now(proxy, "angleInterpolationWithSpeed", list(HEAD), list(before), WAY_BACK)
            )
        try:
            yield neck
        finally:
            self._stop_head(proxy)

    def _stop_head(self, proxy: Any) -> None:
        try:
            self.call_now(proxy, "setAngles", list(HEAD), self.call_now(proxy, "getAngles", list(HEAD), False), 1.0)
        except NaoError as error:
            log.warning("the head may go on turning: %s", error)
