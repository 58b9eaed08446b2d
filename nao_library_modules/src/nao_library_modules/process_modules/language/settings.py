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
    """What words of designators mean in numbers: lengths in m, times in s, angles in rad."""

    gripper: Dict[str, float]  # openings 0..1 by word: open, closed
    gripper_tolerance: float  # of the opening
    gripper_time: float  # of a motion
    head: Dict[str, Tuple[float, float]]  # (yaw, pitch) by word, as forward
    head_speed: float  # rad/s
    head_tolerance: float
    camera: Dict[str, float]  # on the head, see `space.head_angles`: forward, up, neck, tilt
    arm_targets: Dict[str, Tuple[float, float, float]]  # of the left hand by word, in the torso frame; right: mirrored
    arm_speed: float  # rad/s
    arm_tolerance: float  # of the hand
    shoulder: Tuple[float, float, float]  # the left one, in the torso frame
    pointing_reach: float  # from the shoulder to the hand that points
    shortest_motion: float
    stable: Dict[str, float]  # angles of all joints of the stable pose
    stable_time: float  # of the motion there
    eyes: float  # above the torso's frame
    robot_radius: float  # around the middle of the robot, has to be free
    robot_height: float  # above the floor, has to be free up to there
    eye_height: float  # above the floor, of a standing robot
    near_distance: float  # from the edge of a thing that a place is near to
    seeing_distances: Tuple[float, ...]  # to look at things from, in order of preference
    steepest_look: float  # downward, of the top camera with the head fully bowed
    shoulder_height: float  # above the floor, of a standing robot
    shoulder_aside: float  # from the middle of the robot
    reaching_distances: Tuple[float, ...]  # of things ahead, in order of preference
    longest_reach: float  # from a shoulder to the hand
    walk_tolerance: Tuple[float, float]  # m and rad at the target
    walk_speed: Tuple[float, float]  # m/s and rad/s at least: with the distance, the time limit of a walk


def load_settings(file: Path | str = FILE) -> Settings:
    """Read settings. Raises NaoError if the file cannot be read, or a key is unknown or missing."""
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
        problems = [f"unknown {key!r}{did_you_mean(str(key), names)}" for key in unknown]
        problems += [f"missing {', '.join(missing)}"] * bool(missing)
        raise NaoError(f"{path.name}: {'; '.join(problems)} (keys are {', '.join(names)})")
    return Settings(**{name: _tuples(content[name]) for name in names})


@lru_cache(maxsize=None)
def numbers_of_nao() -> Settings:
    """Settings of the package, for rules without a robot; read once."""
    return load_settings()


def _tuples(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {key: _tuples(inner) for key, inner in value.items()}
    return tuple(value) if isinstance(value, list) else value
