"""Motion functions for effectors in space: where they are, and moving them along poses and transforms."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from ..base.errors import BadGoal
from ..base.field_checks import require_count, require_each, require_length, require_rising
from ..base.limits import limit
from ..base.suggestion import did_you_mean
from ..functions.chain import checked_by
from .base import DEFAULT_SPEED, MotionBase
from .facts import BODY
from .plan import DURATION, MotionPlan, require_fraction

FRAMES = ("FRAME_TORSO", "FRAME_WORLD", "FRAME_ROBOT")
POSITION, ALL_AXES = 7, 63
POSE, TRANSFORM = 6, 12
POSE_NUMBER, POSES = limit("pose"), limit("poses")
# Chains that an effector moves; the torso moves on both legs.
CHAINS: Mapping[str, Sequence[str]] = {
    "Head": ("Head",),
    "LArm": ("LArm",),
    "RArm": ("RArm",),
    "LLeg": ("LLeg",),
    "RLeg": ("RLeg",),
    "Torso": ("LLeg", "RLeg"),
}


def require_frame(frame: int) -> None:
    """Check the number of a frame.

    Raises:
        BadGoal: If there is no such frame.
    """
    if not 0 <= frame < len(FRAMES):
        raise BadGoal("frame", frame, ", ".join(f"{i} ({name})" for i, name in enumerate(FRAMES)))


def _effectors(names: Sequence[str]) -> list[str]:
    if not names:
        raise BadGoal("names", [], f"one or more of {', '.join(CHAINS)}", problem="no effector is named")
    for name in names:
        if name not in CHAINS:
            raise BadGoal(
                "names",
                name,
                f"one of {', '.join(CHAINS)}",
                problem=f"{name!r} is no effector{did_you_mean(name, CHAINS)}",
            )
    return list(names)


def _rows(values: Sequence[float], count: int, size: int) -> list[list[float]]:
    """Numbers as `count` rows of `size`."""
    require_count("values", values, count * size, f"{size} for each of {count}")
    require_each("values", values, POSE_NUMBER)
    return [list(values[i * size : (i + 1) * size]) for i in range(count)]


def check_place(_self: MotionBase, names: Sequence[str], frame: int) -> None:
    """One name, a known frame; the robot tells whether it has such a place."""
    require_frame(frame)
    if not names:
        raise BadGoal("names", [], "effectors, joints or sensors", problem="nothing is named")


def check_frame(_self: MotionBase, frame: int) -> None:
    """A known frame."""
    require_frame(frame)


def _check_move(plan: MotionPlan, names: Sequence[str], frame: int, axis_mask: int, stiffness: float) -> list[str]:
    """See that effectors can move; the joints that will."""
    require_frame(frame)
    if not 0 <= axis_mask <= ALL_AXES:
        raise BadGoal("axis_mask", axis_mask, "1..63: the sum of 1 x, 2 y, 4 z, 8 wx, 16 wy, 32 wz; 0 for 7")
    joints = [joint for name in _effectors(names) for chain in CHAINS[name] for joint in plan.facts.chains[chain]]
    joints = [joint for joint in dict.fromkeys(joints) if not joint.endswith("Hand")]
    plan.require_stiff(joints, stiffness)
    plan.touch(joints)
    plan.forget(joints)
    return joints


def _check_with_speed(
    self: MotionBase,
    names: Sequence[str],
    values: Sequence[float],
    size: int,
    frame: int,
    axis_mask: int,
    speed: float,
    stiffness: float,
) -> None:
    self.plan.aim(_check_move(self.plan, names, frame, axis_mask, stiffness))
    _rows(values, len(names), size)
    require_fraction("speed", speed, DEFAULT_SPEED)


def check_poses(
    self: MotionBase,
    names: Sequence[str],
    values: Sequence[float],
    frame: int,
    axis_mask: int,
    speed: float,
    stiffness: float,
) -> None:
    """Known effectors on stiff chains, a pose each, a frame, an axis mask, a speed."""
    _check_with_speed(self, names, values, POSE, frame, axis_mask, speed, stiffness)


def check_transforms(
    self: MotionBase,
    names: Sequence[str],
    values: Sequence[float],
    frame: int,
    axis_mask: int,
    speed: float,
    stiffness: float,
) -> None:
    """As setPosition, with transforms."""
    _check_with_speed(self, names, values, TRANSFORM, frame, axis_mask, speed, stiffness)


def _check_paths(
    self: MotionBase,
    names: Sequence[str],
    values: Sequence[float],
    size: int,
    times: Sequence[float],
    frame: int,
    axis_mask: int,
    stiffness: float,
) -> None:
    _check_move(self.plan, names, frame, axis_mask, stiffness)
    require_rising("times", times, DURATION, POSES)
    require_length("times", len(names) * len(times), POSES)
    _rows(values, len(names) * len(times), size)
    self.plan.takes(times[-1])


def check_pose_paths(
    self: MotionBase,
    names: Sequence[str],
    values: Sequence[float],
    times: Sequence[float],
    frame: int,
    axis_mask: int,
    stiffness: float,
) -> None:
    """Known effectors on stiff chains, a pose for each time, a frame, an axis mask."""
    _check_paths(self, names, values, POSE, times, frame, axis_mask, stiffness)


def check_transform_paths(
    self: MotionBase,
    names: Sequence[str],
    values: Sequence[float],
    times: Sequence[float],
    frame: int,
    axis_mask: int,
    stiffness: float,
) -> None:
    """As positionInterpolation, with transforms."""
    _check_paths(self, names, values, TRANSFORM, times, frame, axis_mask, stiffness)


class CartesianFunctions(MotionBase):
    """Functions of ALMotion for effectors in space. Parameters are fields of MotionFunction."""

    def cartesian_functions(self) -> dict[str, Callable[..., Any]]:
        """Name -> function, to be put into the function table of a module."""
        return {
            "getPosition": self.get_position,
            "getTransform": self.get_transform,
            "setPosition": self.set_position,
            "setTransform": self.set_transform,
            "changePosition": self.change_position,
            "positionInterpolation": self.position_interpolation,
            "transformInterpolation": self.transform_interpolation,
            "getCOM": self.get_com,
            "getSupportPolygon": self.get_support_polygon,
        }

    @checked_by(check_place)
    def get_position(self, names: Sequence[str], frame: int, commanded: bool) -> list[list[float]]:
        """Pose of each effector, joint or sensor: x, y, z in m, wx, wy, wz in rad."""
        return [list(self.motion("getPosition", name, frame, not commanded)) for name in names]

    @checked_by(check_place)
    def get_transform(self, names: Sequence[str], frame: int, commanded: bool) -> list[list[float]]:
        """Transform of each effector, joint or sensor: 16 numbers, row by row."""
        return [list(self.motion("getTransform", name, frame, not commanded)) for name in names]

    @checked_by(check_poses)
    def set_position(
        self,
        names: Sequence[str],
        values: Sequence[float],
        frame: int,
        axis_mask: int,
        speed: float,
        stiffness: float,
    ) -> None:
        """Give effectors poses as targets and go on at once."""
        self._set("setPositions", names, _rows(values, len(names), POSE), frame, axis_mask, speed, stiffness)

    @checked_by(check_transforms)
    def set_transform(
        self,
        names: Sequence[str],
        values: Sequence[float],
        frame: int,
        axis_mask: int,
        speed: float,
        stiffness: float,
    ) -> None:
        """Give effectors transforms (12 numbers each, row by row) as targets and go on at once."""
        self._set("setTransforms", names, _rows(values, len(names), TRANSFORM), frame, axis_mask, speed, stiffness)

    @checked_by(check_poses)
    def change_position(
        self,
        names: Sequence[str],
        values: Sequence[float],
        frame: int,
        axis_mask: int,
        speed: float,
        stiffness: float,
    ) -> None:
        """Move effectors by differences of poses and go on at once."""
        self._stiffen(names, stiffness)
        for name, change in zip(names, _rows(values, len(names), POSE)):
            self.motion("changePosition", name, frame, change, speed or DEFAULT_SPEED, axis_mask or POSITION)

    @checked_by(check_pose_paths)
    def position_interpolation(
        self,
        names: Sequence[str],
        values: Sequence[float],
        times: Sequence[float],
        frame: int,
        axis_mask: int,
        relative: bool,
        stiffness: float,
    ) -> None:
        """Move effectors through poses at given times, and wait for the end; all poses of the first one come first."""
        self._follow("positionInterpolations", names, values, POSE, times, frame, axis_mask, relative, stiffness)

    @checked_by(check_transform_paths)
    def transform_interpolation(
        self,
        names: Sequence[str],
        values: Sequence[float],
        times: Sequence[float],
        frame: int,
        axis_mask: int,
        relative: bool,
        stiffness: float,
    ) -> None:
        """Move effectors through transforms (12 numbers each) at given times, and wait for the end."""
        self._follow("transformInterpolations", names, values, TRANSFORM, times, frame, axis_mask, relative, stiffness)

    @checked_by(check_frame)
    def get_com(self, frame: int, commanded: bool, names: Sequence[str]) -> list[list[float]]:
        """Centre of mass of the body, or of each joint or chain that is named: x, y, z in m."""
        return [list(self.motion("getCOM", name, frame, not commanded)) for name in names or [BODY]]

    @checked_by(check_frame)
    def get_support_polygon(self, frame: int, commanded: bool) -> list[list[float]]:
        """Corners of the support polygon: x, y in m."""
        return [list(corner) for corner in self.motion("getSupportPolygon", frame, not commanded)]

    def _set(
        self,
        method: str,
        names: Sequence[str],
        rows: list[list[float]],
        frame: int,
        axis_mask: int,
        speed: float,
        stiffness: float,
    ) -> None:
        self._stiffen(names, stiffness)
        self.motion(method, list(names), frame, rows, speed or DEFAULT_SPEED, axis_mask or POSITION)

    def _follow(
        self,
        method: str,
        names: Sequence[str],
        values: Sequence[float],
        size: int,
        times: Sequence[float],
        frame: int,
        axis_mask: int,
        relative: bool,
        stiffness: float,
    ) -> None:
        self._stiffen(names, stiffness)
        rows = _rows(values, len(names) * len(times), size)
        paths = [rows[i * len(times) : (i + 1) * len(times)] for i in range(len(names))]
        masks = [axis_mask or POSITION] * len(names)
        self.motion(method, list(names), frame, paths, masks, [list(times)] * len(names), not relative)

    def _stiffen(self, names: Sequence[str], stiffness: float) -> None:
        if stiffness > 0.0:
            chains = self.access.facts.chains
            self.stiffen([joint for name in names for chain in CHAINS[name] for joint in chains[chain]], stiffness)
