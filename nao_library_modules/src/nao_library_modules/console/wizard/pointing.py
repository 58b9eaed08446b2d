"""Head angles from the picture of a camera: of a point that is clicked, and of a picture that is dragged. Pure."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Tuple

from ...base.rotations import about, product, rotate
from ...functions.known_robot import robot_facts
from ...nao.gaze import CameraMount, Head, look_at

Angles = Tuple[float, float]
"""HeadYaw, positive to the left, and HeadPitch, positive down, rad."""
HEAD = ("HeadYaw", "HeadPitch")
DISTANCE = 2.0
"""m that a clicked point is taken to be away. The eye moves by a few cm with the head: what is 0.5 m away is missed by
4 degrees at most, what is farther by less."""


@dataclass(frozen=True)
class CameraLens:
    """A pinhole: focal lengths and centre as shares of the picture's width and height."""

    focal_x: float
    focal_y: float
    centre_x: float = 0.5
    centre_y: float = 0.5

    @staticmethod
    def of(width: int, height: int, k: Tuple[float, ...]) -> CameraLens:
        """From a camera matrix, row by row, in pixels of a picture of this size; raises ValueError if it is none."""
        if len(k) != 9 or width <= 0 or height <= 0 or not (k[0] > 0.0 and k[4] > 0.0):
            raise ValueError(f"no camera matrix for pictures of {width}x{height}: {tuple(k)}")
        return CameraLens(k[0] / width, k[4] / height, k[2] / width, k[5] / height)

    def slopes(self, x: float, y: float) -> tuple[float, float]:
        """Of the ray through a point of the picture: to the right and down, for each m ahead.

        `x`, `y`: from 0 at the left and at the top to 1.
        """
        return (x - self.centre_x) / self.focal_x, (y - self.centre_y) / self.focal_y


def looked_at(head: Head, mount: CameraMount, lens: CameraLens, at: tuple[float, float], now: Angles) -> Angles:
    """Angles that bring a point of the picture into its middle, within what the joints can do.

    `at`: the point, as `CameraLens.slopes` takes it. `now`: angles when the picture was taken.
    """
    right, down = lens.slopes(*at)
    yaw, pitch = now
    turned = product(about((0.0, 0.0, 1.0), yaw), about((0.0, 1.0, 0.0), pitch))
    ray = rotate(product(turned, about((0.0, 1.0, 0.0), mount.down)), (1.0, -right, -down))
    eye = rotate(turned, (mount.ahead, 0.0, mount.above))
    reach = DISTANCE / math.sqrt(sum(part * part for part in ray))
    x, y, z = (of_eye + reach * of_ray for of_eye, of_ray in zip(eye, ray))
    return within_limits(look_at(head, mount, (x, y, z + head.height)))


def dragged(lens: CameraLens, start: tuple[float, float], at: tuple[float, float], before: Angles) -> Angles:
    """Angles that keep what was under the pointer under it, within what the joints can do.

    `start`, `at`: where the drag began and where it is. `before`: angles when it began.
    """
    (right0, down0), (right1, down1) = lens.slopes(*start), lens.slopes(*at)
    yaw, pitch = before
    return within_limits((yaw + math.atan(right1) - math.atan(right0), pitch - (math.atan(down1) - math.atan(down0))))


def within_limits(angles: Angles) -> Angles:
    """The closest angles that the joints can have; the pitch may have to stay below that, depending on the yaw."""
    (yaw_low, yaw_high), (pitch_low, pitch_high) = head_limits()
    return min(max(angles[0], yaw_low), yaw_high), min(max(angles[1], pitch_low), pitch_high)


@lru_cache(maxsize=None)
def head_limits() -> tuple[tuple[float, float], tuple[float, float]]:
    """Least and greatest HeadYaw and HeadPitch, rad, of all robots of the family."""
    facts = robot_facts()["ALMotion"]
    names, limits = (
        dict((tuple(asked), answer) for asked, answer in facts[method])[("Body",)]
        for method in ("getBodyNames", "getLimits")
    )
    of = dict(zip(names, limits))
    return tuple((of[joint][0], of[joint][1]) for joint in HEAD)  # type: ignore[return-value]
