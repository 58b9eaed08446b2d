"""Arguments of ALMotion in the many shapes that NAOqi takes: joints, key frames, Bezier points, effectors, paths."""

from __future__ import annotations

from collections import Counter
from typing import Any, Callable, Sequence

import numpy as np

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.sizes import require_few
from nao_sim_bridge.control.joints.bezier import BezierCurve, Handle, Interpolation, KeyPoint
from nao_sim_bridge.model.frames import ROBOT, TORSO, WORLD
from nao_sim_bridge.model.kinematics import matrix_rpy, rpy_matrix, transform
from nao_sim_bridge.model.robot_model import RobotModel, joint_names
from nao_sim_bridge.naoqi.binding.arguments import known, number, numbers, vector
from nao_sim_bridge.naoqi.binding.errors import NaoqiError

TYPES = ", ".join(f"{kind.value} ({kind.name})" for kind in Interpolation)
POINT_FORM = "an angle, or [angle, [type, dTime, dAngle], [type, dTime, dAngle]] with the handles before and after"
EFFECTORS = ("Head", "LArm", "RArm", "LLeg", "RLeg", "Torso")
LARGEST_MASK = 63


def joint_indices(names: Any, model: RobotModel) -> list[int]:
    """Body indices of `joint_names`; a NaoqiError when a joint is named twice."""
    found = joint_names(names, model)
    twice = sorted(name for name, count in Counter(found).items() if count > 1)
    if twice:
        raise NaoqiError(f"named twice: {', '.join(twice)}")
    return [model.joint_index[name] for name in found]


def space_of(value: Any) -> int:
    """The frame that a caller names by its number; a BadValue when there is none."""
    if isinstance(value, bool) or value not in (TORSO, WORLD, ROBOT):
        raise BadValue("space", value, "0 (FRAME_TORSO), 1 (FRAME_WORLD) or 2 (FRAME_ROBOT)")
    return int(value)


def require_rising(times: Sequence[float], field: str, given: Any) -> None:
    """Raise a BadValue that shows what was `given`, unless times rise and the first is above 0 s."""
    if times[0] <= 0.0 or any(b <= a for a, b in zip(times, times[1:])):
        raise BadValue(field, given, "times that rise, the first above 0 s")


def key_frames(count: int, values: Any, times: Any, field: str) -> list[tuple[list[float], list[float]]]:
    """(times, values) of each of `count` joints from the shapes NAOqi takes.

    One value or one list for one joint; for several joints one value for all, or a list with one value or one list
    each. Times likewise; one number or one list of times serves all joints. A BadValue when a size does not fit, there
    are too many, or times do not rise from above 0.
    """
    value_lists = _one_each(values, count, field)
    require_few(field, sum(map(len, value_lists)), "key_frames")
    time_lists = _time_lists(times, count, [len(v) for v in value_lists])
    for joint_values, joint_times in zip(value_lists, time_lists):
        if len(joint_values) != len(joint_times):
            raise BadValue("timeLists", times, f"as many times as values for each joint: {len(joint_values)} here")
        require_rising(joint_times, "timeLists", joint_times)
    return list(zip(time_lists, value_lists))


def _one_each(values: Any, count: int, field: str) -> list[list[float]]:
    if not isinstance(values, (list, tuple)):
        return [[number(values, field)]] * count
    if not values:
        raise BadValue(field, values, "at least one value")
    nested = any(isinstance(v, (list, tuple)) for v in values)
    if count == 1 and not nested:
        return [numbers(values, field)]
    if len(values) != count:
        raise BadValue(field, values, f"{count} entries, one for each joint; there are {len(values)}")
    lists = [numbers(v, field) if isinstance(v, (list, tuple)) else [number(v, field)] for v in values]
    if not all(lists):
        raise BadValue(field, values, "at least one value for each joint")
    return lists


def _time_lists(times: Any, count: int, lengths: Sequence[int]) -> list[list[float]]:
    if not isinstance(times, (list, tuple)):
        return [[number(times, "timeLists")]] * count
    if not times:
        raise BadValue("timeLists", times, "at least one time")
    if any(isinstance(t, (list, tuple)) for t in times):
        return _one_each(times, count, "timeLists")
    flat = numbers(times, "timeLists")
    if count > 1 and len(flat) == count and all(length == 1 for length in lengths):
        return [[t] for t in flat]
    return [flat] * count


def bezier_key_points(count: int, times: Any, points: Any) -> list[list[KeyPoint]]:
    """Key points of each of `count` joints.

    `times` are a list of rising times in s for each joint, `points` as many control points for each; a single joint may
    have both without the list around them. A BadValue when something has another shape, there are too many points,
    times do not rise from above 0, or a handle points the wrong way.
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
    require_rising(at, "times", at)
    if len(at) != len(points):
        raise BadValue("controlPoints", points, f"as many points as times for each joint: {len(at)} here")
    return [_point(time, point) for time, point in zip(at, points)]


def _point(time: float, point: Any) -> KeyPoint:
    if not isinstance(point, (list, tuple)):
        return KeyPoint(time, number(point, "controlPoints"))
    if len(point) not in (1, 2, 3):
        raise BadValue("controlPoints", point, POINT_FORM)
    before, after = [_handle(entry) for entry in point[1:]] + [Handle()] * (3 - len(point))
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


def pairs(config: Any, field: str, example: str) -> Sequence[Sequence[Any]]:
    """Pairs of a name and a value, such as the `example`; a BadValue when the list has another shape."""

    def right(pair: Any) -> bool:
        return isinstance(pair, (list, tuple)) and len(pair) == 2 and isinstance(pair[0], str)

    if not isinstance(config, (list, tuple)) or not all(map(right, config)):
        raise BadValue(field, config, f"pairs such as {example}")
    return config


def effectors(names: Any) -> list[str]:
    """Effectors, each once.

    An UnknownName when one is no such effector; a BadValue when none is given, or one twice.
    """
    listed = [names] if isinstance(names, str) else names
    if not isinstance(listed, (list, tuple)) or not listed or len(set(map(str, listed))) != len(listed):
        raise BadValue("names", names, f"one or several of {', '.join(EFFECTORS)}, each once")
    return [known(name, "effector", EFFECTORS) for name in listed]


def mask_of(value: Any) -> int:
    """An axis mask: x 1, y 2, z 4, and the rotations about them 8, 16, 32, added."""
    if isinstance(value, bool) or not isinstance(value, int) or not 1 <= value <= LARGEST_MASK:
        raise BadValue("axisMask", value, f"a whole number of 1 to {LARGEST_MASK}")
    return value


def one_each(value: Any, count: int, field: str, nested: bool = False) -> list[Any]:
    """One value for all of `count` effectors, or a list of one each; `nested` where a value is itself a list."""
    many = isinstance(value, (list, tuple)) and (not nested or any(isinstance(v, (list, tuple)) for v in value))
    if not many:
        return [value] * count
    if len(value) != count:
        raise BadValue(field, value, f"{count} entries, one for each effector")
    return list(value)


def pose_of_position(value: Any) -> np.ndarray:
    """(4, 4) pose of x, y, z in m and wx, wy, wz in rad."""
    six = vector(value, "position", 6, "x, y, z in m and wx, wy, wz in rad")
    return transform(rpy_matrix(six[3:]), six[:3])


def pose_of_transform(value: Any) -> np.ndarray:
    """(4, 4) pose of 12 or 16 numbers, row by row."""
    listed = numbers(value, "transform")
    if len(listed) not in (12, 16):
        raise BadValue("transform", value, "12 or 16 numbers, a matrix row by row")
    pose = np.vstack((np.reshape(listed[:12], (3, 4)), (0.0, 0.0, 0.0, 1.0)))
    rotation = pose[:3, :3]
    if not np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-3) or np.linalg.det(rotation) < 0.0:
        raise BadValue("transform", value, "a rotation in the first three columns")
    return pose


def as_position(pose: np.ndarray) -> list[float]:
    """x, y, z in m and wx, wy, wz in rad of a (4, 4) pose."""
    return [*pose[:3, 3].tolist(), *matrix_rpy(pose[:3, :3])]


def as_transform(pose: np.ndarray) -> list[float]:
    """16 numbers of a (4, 4) pose, row by row."""
    return pose.ravel().tolist()


def paths_of(
    paths: Any, times: Any, count: int, pose: Callable[[Any], np.ndarray]
) -> list[tuple[list[float], list[np.ndarray]]]:
    """(times in s, poses) of each of `count` effectors.

    A path is one pose or a list of poses; times are one number or list for all effectors, or one list each. A BadValue
    when a size does not fit, there are too many poses, or times do not rise from above 0.
    """
    if not isinstance(paths, (list, tuple)) or not paths:
        raise BadValue("paths", paths, "one pose or list of poses for each effector")
    if count == 1 and not isinstance(paths[0], (list, tuple)):
        paths = [paths]
    # One effector's path may come without the list around it.
    if count == 1 and len(paths) > 1:
        paths = [paths]
    if len(paths) != count:
        raise BadValue("paths", paths, f"{count} entries, one for each effector")
    nested = isinstance(times, (list, tuple)) and any(isinstance(t, (list, tuple)) for t in times)
    time_lists = one_each(times, count, "times") if nested else [times] * count
    require_few("paths", sum(len(path) for path in paths if isinstance(path, (list, tuple))), "poses")
    found = []
    for path, at in zip(paths, time_lists):
        if not isinstance(path, (list, tuple)) or not path:
            raise BadValue("paths", path, "one pose or a list of poses")
        poses = [pose(p) for p in (path if isinstance(path[0], (list, tuple)) else [path])]
        moments = numbers(at if isinstance(at, (list, tuple)) else [at], "times")
        if len(moments) != len(poses):
            raise BadValue("times", at, f"as many times as poses: {len(poses)} here")
        require_rising(moments, "times", at)
        found.append((moments, poses))
    return found
