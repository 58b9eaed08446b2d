"""Motion functions for effectors in space, and for the head that turns to a point."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial

from ..core.chain import checked_by
from ..core.errors import BadGoal
from ..core.fields import require_count, require_length
from ..core.nao_facts import load_head, look_at
from .motion_fields import (
    CAMERA,
    FRAMES,
    Camera,
    Commanded,
    Duration,
    Frame,
    Point,
    Relative,
    SomeJoints,
    Speed,
    Stiffness,
)
from .motion_plan import BODY, DEFAULT_SPEED, BodyPart
from .walk_fields import (
    EFFECTORS,
    POSES,
    AxisMask,
    Effectors,
    Parts,
    PoseChanges,
    PosePath,
    Poses,
    PoseTimes,
    TransformPath,
    Transforms,
)

POSITION = 7
POSE, TRANSFORM = 6, 12


def _rows(values: Sequence[float], count: int, size: int) -> list[list[float]]:
    require_count("values", values, count * size, f"{size} for each of {count}")
    return [list(values[i * size : (i + 1) * size]) for i in range(count)]


class CartesianFunctions(BodyPart):
    def get_position(self, names: Parts, frame: Frame, commanded: Commanded) -> list[list[float]]:
        """Pose of each effector, joint or sensor: x, y, z in m, wx, wy, wz in rad."""
        return [list(self.motion("getPosition", name, frame, not commanded)) for name in names]

    def get_transform(self, names: Parts, frame: Frame, commanded: Commanded) -> list[list[float]]:
        """Transform of each effector, joint or sensor: 16 numbers, row by row."""
        return [list(self.motion("getTransform", name, frame, not commanded)) for name in names]

    def _check_move(self, names: Sequence[str], stiffness: float) -> list[str]:
        """See that effectors can move; the joints that will."""
        joints = [joint for joint in dict.fromkeys(self._joints_of(names)) if not joint.endswith("Hand")]
        self.body.plan.require_stiff(joints, stiffness)
        self.body.plan.leave_to_robot(joints)
        return joints

    # `size`: POSE or TRANSFORM, how many numbers there are for each effector.

    def _check_targets(self, names: Sequence[str], values: Sequence[float], stiffness: float, size: int) -> None:
        self.body.plan.aim(self._check_move(names, stiffness))
        _rows(values, len(names), size)

    def _check_paths(
        self, names: Sequence[str], values: Sequence[float], times: Sequence[float], stiffness: float, size: int
    ) -> None:
        self._check_move(names, stiffness)
        require_length("times", len(names) * len(times), POSES)
        _rows(values, len(names) * len(times), size)
        self.body.plan.takes(times[-1])

    @checked_by(partial(_check_targets, size=POSE))
    def set_position(
        self, names: Effectors, values: Poses, frame: Frame, axis_mask: AxisMask, speed: Speed, stiffness: Stiffness
    ) -> None:
        """Give effectors poses as targets and go on at once."""
        rows = self._targets(names, values, POSE, stiffness)
        self.motion("setPositions", list(names), frame, rows, speed or DEFAULT_SPEED, axis_mask or POSITION)

    @checked_by(partial(_check_targets, size=TRANSFORM))
    def set_transform(
        self,
        names: Effectors,
        values: Transforms,
        frame: Frame,
        axis_mask: AxisMask,
        speed: Speed,
        stiffness: Stiffness,
    ) -> None:
        """Give effectors transforms (12 numbers each, row by row) as targets and go on at once."""
        rows = self._targets(names, values, TRANSFORM, stiffness)
        self.motion("setTransforms", list(names), frame, rows, speed or DEFAULT_SPEED, axis_mask or POSITION)

    @checked_by(partial(_check_targets, size=POSE))
    def change_position(
        self,
        names: Effectors,
        values: PoseChanges,
        frame: Frame,
        axis_mask: AxisMask,
        speed: Speed,
        stiffness: Stiffness,
    ) -> None:
        """Move effectors by differences of poses and go on at once."""
        for name, change in zip(names, self._targets(names, values, POSE, stiffness)):
            self.motion("changePosition", name, frame, change, speed or DEFAULT_SPEED, axis_mask or POSITION)

    @checked_by(partial(_check_paths, size=POSE))
    def position_interpolation(
        self,
        names: Effectors,
        values: PosePath,
        times: PoseTimes,
        frame: Frame,
        axis_mask: AxisMask,
        relative: Relative,
        stiffness: Stiffness,
    ) -> None:
        """Move effectors through poses at given times, and wait for the end; all poses of the first one come first."""
        paths, moments = self._paths(names, values, POSE, times, stiffness)
        masks = [axis_mask or POSITION] * len(names)
        self.motion("positionInterpolations", list(names), frame, paths, masks, moments, not relative)

    @checked_by(partial(_check_paths, size=TRANSFORM))
    def transform_interpolation(
        self,
        names: Effectors,
        values: TransformPath,
        times: PoseTimes,
        frame: Frame,
        axis_mask: AxisMask,
        relative: Relative,
        stiffness: Stiffness,
    ) -> None:
        """Move effectors through transforms (12 numbers each) at given times, and wait for the end."""
        paths, moments = self._paths(names, values, TRANSFORM, times, stiffness)
        masks = [axis_mask or POSITION] * len(names)
        self.motion("transformInterpolations", list(names), frame, paths, masks, moments, not relative)

    def get_com(self, frame: Frame, commanded: Commanded, names: SomeJoints) -> list[list[float]]:
        """Centre of mass of the body, or of each joint or chain that is named: x, y, z in m."""
        return [list(self.motion("getCOM", name, frame, not commanded)) for name in names or [BODY]]

    def get_support_polygon(self, frame: Frame, commanded: Commanded) -> list[list[float]]:
        """Corners of the support polygon: x, y in m."""
        return [list(corner) for corner in self.motion("getSupportPolygon", frame, not commanded)]

    def _targets(self, names: Sequence[str], values: Sequence[float], size: int, stiffness: float) -> list[list[float]]:
        """Numbers of each effector, which is stiffened."""
        self.body.stiffen(self._joints_of(names), stiffness)
        return _rows(values, len(names), size)

    def _paths(
        self, names: Sequence[str], values: Sequence[float], size: int, times: Sequence[float], stiffness: float
    ) -> tuple[list[list[list[float]]], list[list[float]]]:
        """Numbers of each effector at each time, and the times of each; the effectors are stiffened."""
        self.body.stiffen(self._joints_of(names), stiffness)
        rows = _rows(values, len(names) * len(times), size)
        paths = [rows[i * len(times) : (i + 1) * len(times)] for i in range(len(names))]
        return paths, [list(times)] * len(names)

    def _joints_of(self, names: Sequence[str]) -> list[str]:
        chains = self.body.facts.chains
        return [joint for name in names for chain in EFFECTORS[name] for joint in chains[chain]]

    functions = {
        "getPosition": get_position,
        "getTransform": get_transform,
        "setPosition": set_position,
        "setTransform": set_transform,
        "changePosition": change_position,
        "positionInterpolation": position_interpolation,
        "transformInterpolation": transform_interpolation,
        "getCOM": get_com,
        "getSupportPolygon": get_support_polygon,
    }


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
