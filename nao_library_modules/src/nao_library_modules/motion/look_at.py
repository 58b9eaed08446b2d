"""The motion function that turns the head to a point."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

from ..base.errors import BadGoal
from ..base.field_checks import require_each, require_zero_or
from ..base.limits import limit
from ..base.suggestion import did_you_mean
from ..functions.chain import checked_by
from .base import DEFAULT_SPEED, MotionBase
from .cartesian import FRAMES, require_frame
from .gaze import load_head, look_at
from .plan import DURATION, require_fraction

HEAD = ("HeadYaw", "HeadPitch")
CAMERA = "CameraTop"
TORSO = 0
POINT = limit("point")


def check_look(
    self: MotionBase,
    values: Sequence[float],
    frame: int,
    str_param: str,
    speed: float,
    duration: float,
    stiffness: float,
) -> None:
    """A point in a known frame, a camera, a speed or a time, a stiff head."""
    if len(values) != 3:
        raise BadGoal("values", list(values), "x, y, z of a point in m")
    require_each("values", values, POINT)
    require_frame(frame)
    cameras = load_head().cameras
    if str_param and str_param not in cameras:
        problem = f"there is no camera {str_param!r}{did_you_mean(str_param, cameras)}"
        raise BadGoal("str_param", str_param, f"{', '.join(cameras)}, or nothing for {CAMERA}", problem=problem)
    require_fraction("speed", speed, DEFAULT_SPEED)
    require_zero_or("duration", duration, DURATION)
    self.plan.require_stiff(HEAD, stiffness)
    self.plan.touch(HEAD)
    self.plan.forget(HEAD)
    self.plan.takes(duration)


class GazeFunctions(MotionBase):
    """Looking at points. Parameters are fields of MotionFunction."""

    def gaze_functions(self) -> dict[str, Callable[..., Any]]:
        """Name -> function, to be put into the function table of a module."""
        return {"lookAt": self.look_at}

    @checked_by(check_look)
    def look_at(
        self,
        values: Sequence[float],
        frame: int,
        str_param: str,
        speed: float,
        duration: float,
        stiffness: float,
    ) -> list[float]:
        """Turn the head so that a camera looks at a point, as far as it goes; answers yaw, pitch, and rad missing."""
        head = load_head()
        point = self._in_torso(values, frame)
        try:
            wanted = look_at(head, head.cameras[str_param or CAMERA], point)
        except ValueError as error:
            raise BadGoal("values", list(values), f"a point in front of the head ({FRAMES[frame]}): {error}") from error
        angles = []
        for joint, angle in zip(HEAD, wanted):
            limits = self.access.facts.limits[joint]
            angles.append(min(max(angle, limits.lower), limits.upper))
        self.stiffen(HEAD, stiffness)
        if duration > 0.0:
            self.motion("angleInterpolation", list(HEAD), [[angle] for angle in angles], [[duration]] * 2, True)
        else:
            self.motion("angleInterpolationWithSpeed", list(HEAD), angles, speed or DEFAULT_SPEED)
        # The limits of the pitch depend on the yaw; the robot keeps to them.
        reached = self.motion("getAngles", list(HEAD), False)
        return [*reached, math.hypot(*(r - w for r, w in zip(reached, wanted)))]

    def _in_torso(self, point: Sequence[float], frame: int) -> tuple[float, float, float]:
        x, y, z = point
        if frame == TORSO:
            return x, y, z
        t = self.motion("getTransform", "Torso", frame, True)
        d = (x - t[3], y - t[7], z - t[11])
        return tuple(sum(t[4 * row + column] * d[row] for row in range(3)) for column in range(3))  # type: ignore
