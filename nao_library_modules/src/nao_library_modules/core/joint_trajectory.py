"""From trajectory_msgs/JointTrajectory to what ALMotion takes: checked key frames of joints. No ROS, no robot.

The message is read by its fields, so anything that has them will do. What nao_robot's clients send is understood:

- `joint_names` holds joints, chains ("Body", "Head", "LArm", ...) or both;
- a point holds one position for each joint, or a single one for all;
- a first point at time 0 is the place the joints start from. The robot starts from where it is, so it is left out;
- points with velocities are joined by cubic Hermite segments with these velocities, points without by ALMotion's own
  interpolation;
- points with accelerations as well are joined by quintic segments. ALMotion knows only cubic ones, so each is cut into
  PIECES of them: the way to the first point by `KeyFrames.absolute`, for where it starts is not known before.

Efforts are not looked at: ALMotion does not know them.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, List, Tuple

from .chain import seconds
from .errors import BadGoal, did_you_mean
from .fields import KEY_FRAMES, Limit, limit, require_each, require_length, require_zero_or

H25_BODY = tuple(
    """HeadYaw HeadPitch LShoulderPitch LShoulderRoll LElbowYaw LElbowRoll LWristYaw LHand
    LHipYawPitch LHipRoll LHipPitch LKneePitch LAnklePitch LAnkleRoll
    RHipYawPitch RHipRoll RHipPitch RKneePitch RAnklePitch RAnkleRoll
    RShoulderPitch RShoulderRoll RElbowYaw RElbowRoll RWristYaw RHand""".split()
)
"""The chain Body of a NAO with moving wrists and hands. Poses written for it are sent to NAOs without them as well."""
PIECES = 4
DURATION, ANGLE, NAMES = limit("duration"), limit("angle"), limit("names")
SLOPES = {"velocities": limit("joint velocity"), "accelerations": limit("joint acceleration")}
BEZIER = 3
"""ALMotion's number for a control point with tangents."""

Chains = Mapping[str, Sequence[str]]


@dataclass(frozen=True)
class KeyFrames:
    """Values of joints at common times.

    Attributes:
        joints: Names of the joints.
        times: s from the start, rising, the first above 0.
        values: Of each joint its values at the times, in rad (hands and stiffnesses: 0..1).
        velocities: Of each joint its velocities at the times, in rad/s; None leaves them to the robot.
        relative: Whether the values are added to those at the start.
        bend: Of each joint its acceleration in the first key frame, rad/s2, where the way there is to be cut into
            pieces; None where it is as it is to be.
    """

    joints: tuple[str, ...]
    times: tuple[float, ...]
    values: tuple[tuple[float, ...], ...]
    velocities: tuple[tuple[float, ...], ...] | None = None
    relative: bool = False
    bend: tuple[float, ...] | None = None

    @property
    def needs_start(self) -> bool:
        """Whether the robot takes them only as `absolute` gives them."""
        return self.bend is not None or (self.relative and self.velocities is not None)

    @property
    def duration(self) -> float:
        """Time of the last key frame, in s."""
        return self.times[-1]

    @property
    def targets(self) -> dict[str, float]:
        """Joint -> its value in the last key frame."""
        return {joint: values[-1] for joint, values in zip(self.joints, self.values)}

    def absolute(self, start: Sequence[float]) -> KeyFrames:
        """The same frames with values that are not relative, and with the pieces of the way to the first one.

        `start`: values of the joints at the start, in their order. They rest there.
        """
        frames = self
        if frames.relative:
            moved = tuple(tuple(first + value for value in values) for first, values in zip(start, frames.values))
            frames = replace(frames, values=moved, relative=False)
        return frames if frames.bend is None else frames._bent_from(start)

    def _bent_from(self, start: Sequence[float]) -> KeyFrames:
        assert self.velocities is not None and self.bend is not None
        rest = (0.0,) * len(self.joints)
        values, velocities = ([each[0] for each in rows] for rows in (self.values, self.velocities))
        times, values, velocities = _quintic_pieces(
            [0.0, self.times[0]], [tuple(start), values], [rest, velocities], [rest, self.bend]
        )
        return replace(
            self,
            times=(*times[1:-1], *self.times),
            values=tuple((*before, *after) for before, after in zip(zip(*values[1:-1]), self.values)),
            velocities=tuple((*before, *after) for before, after in zip(zip(*velocities[1:-1]), self.velocities)),
            bend=None,
        )

    def interpolation_arguments(self) -> tuple[list[str], list[list[float]], list[list[float]], bool]:
        """Arguments of ALMotion.angleInterpolation: names, angleLists, timeLists, isAbsolute."""
        times = [list(self.times) for _ in self.joints]
        return list(self.joints), [list(values) for values in self.values], times, not self.relative

    def bezier_arguments(self) -> tuple[list[str], list[list[float]], list[list[list[Any]]]]:
        """Arguments of ALMotion.angleInterpolationBezier: jointNames, times, controlPoints.

        A Bezier segment whose tangents reach a third of its time is the cubic Hermite segment of these velocities.
        Raises ValueError if there are no velocities, or the frames are not yet `absolute`.
        """
        if self.velocities is None or self.needs_start:
            raise ValueError("Bezier curves need velocities and absolute values")
        starts = (0.0, *self.times[:-1])
        before = [time - start for start, time in zip(starts, self.times)]
        after = [*before[1:], 0.0]
        points = [
            [
                [value, [BEZIER, -left / 3.0, -velocity * left / 3.0], [BEZIER, right / 3.0, velocity * right / 3.0]]
                for value, velocity, left, right in zip(values, velocities, before, after)
            ]
            for values, velocities in zip(self.values, self.velocities)
        ]
        return list(self.joints), [list(self.times) for _ in self.joints], points


def read_trajectory(trajectory: Any, chains: Chains, relative: bool = False) -> KeyFrames:
    """Check a trajectory and bring it into one shape.

    Raises BadGoal, which names the field that is wrong, what it holds and what is allowed.

    Args:
        trajectory: A trajectory_msgs/JointTrajectory.
        chains: Chain -> its joints on this robot; "Body" tells what joints there are.
        relative: Whether positions are added to the present ones.
    """
    names = [str(name) for name in trajectory.joint_names]
    joints = expand_names(names, chains, "trajectory.joint_names")
    points = list(trajectory.points)
    if not points:
        raise BadGoal("trajectory.points", [], "at least one point", problem="there is no point")
    pieces = PIECES if any(len(point.accelerations) for point in points) else 1
    require_length("trajectory.points", len(points) * len(joints) * pieces, KEY_FRAMES)
    times = _times(points)
    source = _body_order(names, joints, len(points[0].positions))
    values = [
        _row(point.positions, source, joints, f"trajectory.points[{i}].positions") for i, point in enumerate(points)
    ]
    velocities, bend = _slopes("velocities", points, source, joints), None
    accelerations = _slopes("accelerations", points, source, joints)
    if accelerations is not None:
        if velocities is None:
            name = "trajectory.points[0].velocities"
            raise BadGoal(name, [], "velocities beside accelerations", problem="there are accelerations alone")
        bend = None if times[0] == 0.0 else accelerations[0]
        times, values, velocities = _quintic_pieces(times, values, velocities, accelerations)
    first = 1 if times[0] == 0.0 else 0
    return KeyFrames(
        joints,
        tuple(times[first:]),
        tuple(zip(*values[first:])),
        None if velocities is None else tuple(zip(*velocities[first:])),
        bool(relative),
        bend,
    )


def expand_names(names: Sequence[str], chains: Chains, field: str = "joint_names") -> tuple[str, ...]:
    """Joints behind joint and chain names, in order.

    Raises BadGoal if there is none, one is unknown, a joint comes twice, or they are too many.

    Args:
        names: Names of joints and chains.
        chains: Chain -> its joints; "Body" tells what joints there are.
        field: What errors call the names.
    """
    require_length(field, len(names), NAMES)
    known = tuple(chains["Body"])
    if not names:
        raise BadGoal(field, list(names), "joints or chains", problem="no joint is named")
    joints: list[str] = []
    for name in names:
        if name in chains:
            joints.extend(chains[name])
        elif name in known:
            joints.append(name)
        else:
            near = did_you_mean(name, [*chains, *known])
            allowed = f"joints {', '.join(known)}; chains {', '.join(chains)}"
            raise BadGoal(field, name, allowed, problem=f"{name!r} is no joint and no chain{near}")
    twice = sorted(joint for joint, count in Counter(joints).items() if count > 1)
    if twice:
        raise BadGoal(field, list(names), "every joint once", problem=f"named twice: {', '.join(twice)}")
    return tuple(joints)


def one_each(values: Sequence[float], names: Sequence[str], chains: Chains, field: str) -> tuple[float, ...]:
    """One value for each joint behind `names`, as a point of a trajectory holds them.

    Raises BadGoal if names or values are wrong.

    Args:
        values: One value, one for each joint, or a whole H25 body for a robot that has fewer joints.
        names: Names of joints and chains.
        chains: Chain -> its joints; "Body" tells what joints there are.
        field: What errors call the values; the names are called joint_names.
    """
    joints = expand_names(names, chains)
    return _row(values, _body_order(names, joints, len(values)), joints, field)


def check_range(frames: KeyFrames, low: float, high: float) -> None:
    """See that all values are within a range, as stiffnesses are.

    Raises BadGoal, which names the joint, the value and the range.
    """
    for joint, values in zip(frames.joints, frames.values):
        for value in values:
            if not low <= value <= high:
                raise BadGoal("trajectory.points", value, f"{low:g} to {high:g}", problem=f"{joint} is to be {value:g}")


def _times(points: Sequence[Any]) -> list[float]:
    times = [seconds(point.time_from_start) for point in points]
    what = "times that rise, the first above 0 s (or 0 s where more points follow)"
    if times[0] < 0.0 or times == [0.0]:
        raise BadGoal("trajectory.points[0].time_from_start", times[0], what)
    for i, (before, time) in enumerate(zip(times, times[1:]), start=1):
        if not time > before:
            name = f"trajectory.points[{i}].time_from_start"
            raise BadGoal(name, time, what, problem=f"{time:g} s after {before:g} s")
    require_zero_or(f"trajectory.points[{len(times) - 1}].time_from_start", times[-1], DURATION)
    return times


def _slopes(
    what: str, points: Sequence[Any], source: Sequence[int] | None, joints: Sequence[str]
) -> list[tuple[float, ...]] | None:
    """Velocities or accelerations of the points; None if none has any."""
    given = [getattr(point, what) for point in points]
    if not any(map(len, given)):
        return None
    for i, numbers in enumerate(given):
        if not len(numbers):
            problem = f"point {i} has no {what}, others have"
            raise BadGoal(f"trajectory.points[{i}].{what}", [], f"{what} in every point or in none", problem=problem)
    kind = SLOPES[what]
    return [_row(numbers, source, joints, f"trajectory.points[{i}].{what}", kind) for i, numbers in enumerate(given)]


Rows = List[Tuple[float, ...]]


def _quintic_pieces(times: list[float], values: Rows, velocities: Rows, bends: Rows) -> tuple[list[float], Rows, Rows]:
    """Times, values and velocities at the points, and between them on the quintic curves with these accelerations."""
    new_times, new_values, new_velocities = times[:1], values[:1], velocities[:1]
    for i in range(1, len(times)):
        length = times[i] - times[i - 1]
        curves = [
            _quintic(length, start, end)
            for start, end in zip(
                zip(values[i - 1], velocities[i - 1], bends[i - 1]), zip(values[i], velocities[i], bends[i])
            )
        ]
        for piece in range(1, PIECES):
            at = length * piece / PIECES
            new_times.append(times[i - 1] + at)
            new_values.append(tuple(sum(c * at**n for n, c in enumerate(curve)) for curve in curves))
            new_velocities.append(
                tuple(sum(n * c * at ** (n - 1) for n, c in enumerate(curve) if n) for curve in curves)
            )
        new_times.append(times[i])
        new_values.append(values[i])
        new_velocities.append(velocities[i])
    return new_times, new_values, new_velocities


def _quintic(length: float, start: Sequence[float], end: Sequence[float]) -> tuple[float, ...]:
    """Coefficients, constant first, of the curve between two places with given velocities and accelerations."""
    (p, v, a), (q, w, b) = start, end
    way, t = q - p, length
    return (
        p,
        v,
        a / 2.0,
        (20.0 * way - (8.0 * w + 12.0 * v) * t - (3.0 * a - b) * t**2) / (2.0 * t**3),
        (-30.0 * way + (14.0 * w + 16.0 * v) * t + (3.0 * a - 2.0 * b) * t**2) / (2.0 * t**4),
        (12.0 * way - 6.0 * (w + v) * t - (a - b) * t**2) / (2.0 * t**5),
    )


def _body_order(names: Sequence[str], joints: Sequence[str], count: int) -> Sequence[int] | None:
    """Where the joints are in a pose of the whole H25 body, if this is one for a robot that has fewer joints."""
    if list(names) != ["Body"] or count != len(H25_BODY) or len(joints) == count:
        return None
    return [H25_BODY.index(joint) for joint in joints] if set(joints) < set(H25_BODY) else None


def _row(
    numbers: Sequence[float], source: Sequence[int] | None, joints: Sequence[str], field: str, kind: Limit = ANGLE
) -> tuple[float, ...]:
    row = [float(number) for number in numbers]
    require_each(field, row, kind)
    if source is not None and len(row) == len(H25_BODY):
        row = [row[i] for i in source]
    if len(row) == 1:
        row = row * len(joints)
    if len(row) != len(joints):
        problem = f"{len(row)} values for {len(joints)} joints ({', '.join(joints)})"
        raise BadGoal(field, row, f"{len(joints)} values, or 1 for all joints", problem=problem)
    return tuple(row)
