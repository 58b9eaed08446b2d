"""Numbers of the process modules, from `config/process_modules.yaml`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import lru_cache
from pathlib import Path
from typing import Any, Dict, Tuple

import yaml

from naoqi.errors import NaoError

from ...base.paths import config_file
from ...base.suggestion import did_you_mean

FILE = config_file("process_modules.yaml")


@dataclass(frozen=True)
class Settings:
    """What words of designators mean in numbers.

    Attributes:
        gripper: Openings 0..1 by word, as open and closed.
        gripper_tolerance: How far a gripper may be from there.
        gripper_time: s that it takes.
        head: (yaw, pitch) by word, as forward, rad.
        head_speed: rad/s; a motion takes at least `shortest_motion`.
        head_tolerance: rad.
        camera: Where the camera is on the head, see `space.head_angles`: forward, up, neck (m), tilt (rad).
        arm_targets: Points for the left hand by word, in the torso frame, m; of the right hand mirrored.
        arm_speed: rad/s.
        arm_tolerance: m that the hand may be away from its target.
        shoulder: Of the left arm in the torso frame, m.
        pointing_reach: m from the shoulder to a hand that points at something.
        shortest_motion: s.
        stable: Angles of all joints of the stable pose, rad, by joint.
        stable_time: s that it takes.
        eyes: m over the torso's frame.
        robot_radius: m around the middle of the robot that has to be free.
        robot_height: m over the floor up to which it has to be free.
        eye_height: m over the floor, of a robot that stands.
        seeing_distances: m from which things are looked at, in the order in which they are tried.
        steepest_look: rad down that the top camera looks with the whole head bowed.
        shoulder_height: m over the floor, of a robot that stands.
        shoulder_aside: m from the middle of the robot.
        reaching_distances: m in front of the robot that things are reached, in the order in which they are tried.
        longest_reach: m from a shoulder to the hand.
        walk_tolerance: m and rad that the robot may be away from its target.
        walk_speed: m/s and rad/s that a walk has at least: with the distance it tells when it takes too long.
    """

    gripper: Dict[str, float]
    gripper_tolerance: float
    gripper_time: float
    head: Dict[str, Tuple[float, float]]
    head_speed: float
    head_tolerance: float
    camera: Dict[str, float]
    arm_targets: Dict[str, Tuple[float, float, float]]
    arm_speed: float
    arm_tolerance: float
    shoulder: Tuple[float, float, float]
    pointing_reach: float
    shortest_motion: float
    stable: Dict[str, float]
    stable_time: float
    eyes: float
    robot_radius: float
    robot_height: float
    eye_height: float
    seeing_distances: Tuple[float, ...]
    steepest_look: float
    shoulder_height: float
    shoulder_aside: float
    reaching_distances: Tuple[float, ...]
    longest_reach: float
    walk_tolerance: Tuple[float, float]
    walk_speed: Tuple[float, float]


def load_settings(file: Path | str = FILE) -> Settings:
    """Settings of a file; those of the package if there is none.

    Raises:
        NaoError: The file cannot be read, or a key is unknown or missing.
    """
    path = Path(file)
    try:
        content = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (OSError, yaml.YAMLError) as error:
        raise NaoError(f"{path.name}: cannot be read: {error}") from error
    if not isinstance(content, Mapping):
        raise NaoError(f"{path.name}: is {content!r}, not keys and values")
    names = [field.name for field in fields(Settings)]
    unknown = [key for key in content if key not in names]
    missing = [name for name in names if name not in content]
    if unknown or missing:
        told = [f"unknown {key!r}{did_you_mean(str(key), names)}" for key in unknown]
        told += [f"missing {', '.join(missing)}"] * bool(missing)
        raise NaoError(f"{path.name}: {'; '.join(told)} (keys are {', '.join(names)})")
    return Settings(**{name: _tuples(content[name]) for name in names})


@lru_cache(maxsize=None)
def numbers_of_nao() -> Settings:
    """Settings of the package, for rules that have no robot to ask; read once.

    Raises:
        NaoError: As `load_settings`.
    """
    return load_settings()


def _tuples(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {key: _tuples(inner) for key, inner in value.items()}
    return tuple(value) if isinstance(value, list) else value
