"""Bezier key frames as NAOqi takes them: [angle, [type, dTime, dAngle], [type, dTime, dAngle]]."""

from __future__ import annotations

from typing import Any, Sequence

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.sizes import require_few
from nao_sim_bridge.control.joints.bezier import BezierCurve, Handle, Interpolation, KeyPoint
from nao_sim_bridge.naoqi.binding.arguments import number, numbers

TYPES = ", ".join(f"{kind.value} ({kind.name})" for kind in Interpolation)
POINT_FORM = "an angle, or [angle, [type, dTime, dAngle], [type, dTime, dAngle]] with the handles before and after"


def bezier_key_points(count: int, times: Any, points: Any) -> list[list[KeyPoint]]:
    """Key points of each of `count` joints.

    Args:
        count: How many joints there are.
        times: A list of rising times in s for each joint; a single joint may have its times alone.
        points: As many control points for each joint; a single joint may have its points alone when its times are.

    Raises:
        BadValue: Something has another shape, there are too many points, times do not rise from above 0, or a handle
            points the wrong way.
    """
    if count == 1 and isinstance(times, (list, tuple)) and times and not isinstance(times[0], (list, tuple)):
        times, points = [times], [points]
    time_lists = _one_list_each(times, count, "times")
    point_lists = _one_list_each(points, count, "controlPoints")
    require_few("controlPoints", sum(map(len, point_lists)), "key_frames")
    return [_joint(joint_times, joint_points) for joint_times, joint_points in zip(time_lists, point_lists)]


def bezier_curve(start: float, points: Sequence[KeyPoint], is_absolute: bool = True) -> BezierCurve:
    """The curve of a joint from its command `start` (rad) through `points`; relative ones count from the start."""
    # The start has no handle of its own: a joint at rest leaves flat.
    leave = Handle(points[0].before.kind, points[0].time / 3.0, 0.0)
    offset = 0.0 if is_absolute else start
    shifted = [KeyPoint(p.time, p.angle + offset, p.before, p.after) for p in points]
    return BezierCurve((KeyPoint(0.0, start, after=leave), *shifted))


def _one_list_each(values: Any, count: int, field: str) -> list[Sequence[Any]]:
    if not isinstance(values, (list, tuple)) or len(values) != count:
        raise BadValue(field, values, f"{count} lists, one for each joint")
    if any(not isinstance(entry, (list, tuple)) or not entry for entry in values):
        raise BadValue(field, values, "lists that are not empty, one for each joint")
    return list(values)


def _joint(times: Sequence[Any], points: Sequence[Any]) -> list[KeyPoint]:
    at = numbers(times, "times")
    if at[0] <= 0.0 or any(b <= a for a, b in zip(at, at[1:])):
        raise BadValue("times", at, "times that rise, the first above 0 s")
    if len(at) != len(points):
        raise BadValue("controlPoints", points, f"as many points as times for each joint: {len(at)} here")
    return [_point(time, point) for time, point in zip(at, points)]


def _point(time: float, point: Any) -> KeyPoint:
    if not isinstance(point, (list, tuple)):
        return KeyPoint(time, number(point, "controlPoints"))
    if len(point) not in (1, 2, 3):
        raise BadValue("controlPoints", point, POINT_FORM)
    handles = [_handle(entry) for entry in point[1:]] + [Handle()] * (3 - len(point))
    before, after = handles
    if before.time > 0.0 or after.time < 0.0:
        raise BadValue("controlPoints", point, "a first handle with dTime of 0 or less and a second one of 0 or more")
    return KeyPoint(time, number(point[0], "controlPoints"), before, after)


def _handle(entry: Any) -> Handle:
    if not isinstance(entry, (list, tuple)) or len(entry) != 3:
        raise BadValue("controlPoints", entry, POINT_FORM)
    kind, time, angle = numbers(entry, "handle")
    if kind not in list(Interpolation):
        raise BadValue("type of a handle", kind, TYPES)
    return Handle(Interpolation(int(kind)), time, angle)
