"""The motion function that turns the head to a point."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ..base.errors import BadGoal
from ..functions.chain import checked_by
from ..nao.gaze import load_head, look_at
from .body import DEFAULT_SPEED, BodyPart
from .fields import CAMERA, FRAMES, Camera, Duration, Frame, Point, Speed, Stiffness

HEAD = ("HeadYaw", "HeadPitch")
TORSO = 0


class GazeFunctions(BodyPart):
    def _check_look(self, duration: float, stiffness: float) -> None:
        self.body.plan.require_stiff(HEAD, stiffness)
        self.body.plan.leave_to_robot(HEAD, duration)

    @checked_by(_check_look)
    def look_at(
        self, values: Point, frame: Frame, str_param: Camera, speed: Speed, duration: Duration, stiffness: Stiffness
    ) -> list[float]:
        """Turn the head so that a camera looks at a point, as far as it goes; answers yaw, pitch, and rad missing."""
        head = load_head()
        point = self._in_torso(values, frame)
        try:
            wanted = look_at(head, head.cameras[str_param or CAMERA], point)
        except ValueError as error:
            raise BadGoal("values", list(values), f"a point in front of the head ({FRAMES[frame]}): {error}") from error
        angles = [self.body.facts.limits[joint].within(angle) for joint, angle in zip(HEAD, wanted)]
        self.body.stiffen(HEAD, stiffness)
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

    functions = {
        "lookAt": look_at,
    }
