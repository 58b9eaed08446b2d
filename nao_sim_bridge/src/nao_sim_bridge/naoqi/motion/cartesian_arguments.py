"""Arguments of ALMotion's Cartesian methods: effectors, axis masks, poses and paths in the shapes that NAOqi takes."""

from __future__ import annotations

from typing import Any, Callable

import numpy as np

from nao_sim_bridge.base.errors import BadValue, UnknownName
from nao_sim_bridge.base.sizes import require_few
from nao_sim_bridge.model.kinematics import matrix_rpy, rpy_matrix, transform
from nao_sim_bridge.naoqi.binding.arguments import numbers

EFFECTORS = ("Head", "LArm", "RArm", "LLeg", "RLeg", "Torso")
LARGEST_MASK = 63


def effectors(names: Any) -> list[str]:
    """Effectors, each once.

    Raises:
        UnknownName: One is no such effector.
        BadValue: None is given, or one twice.
    """
    listed = [names] if isinstance(names, str) else names
    if not isinstance(listed, (list, tuple)) or not listed or len(set(map(str, listed))) != len(listed):
        raise BadValue("names", names, f"one or several of {', '.join(EFFECTORS)}, each once")
    for name in listed:
        if name not in EFFECTORS:
            raise UnknownName("effector", name, EFFECTORS)
    return list(listed)


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
    six = numbers(value, "position")
    if len(six) != 6:
        raise BadValue("position", value, "x, y, z in m and wx, wy, wz in rad")
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

    A path is one pose or a list of poses; times are one number or list for all effectors, or one list each.

    Raises:
        BadValue: A size does not fit, there are too many poses, or times do not rise from above 0.
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
        if moments[0] <= 0.0 or any(b <= a for a, b in zip(moments, moments[1:])):
            raise BadValue("times", at, "times that rise, the first above 0 s")
        found.append((moments, poses))
    return found
