"""Poses by name: from parameters as nao_robot has them, from Choregraphe's libraries, and those that come along."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from naoqi.errors import NaoError

from ..base.paths import config_file
from ..base.suggestion import did_you_mean
from .xap import read_poses

FIELDS = ("joint_names", "positions", "time_from_start")
XAP_TIME = 2.0
"""s in which a pose of a library is taken; the libraries hold no times."""


class BadPose(NaoError):
    """The table of poses has an entry that is no pose. `name`: name of the pose."""

    def __init__(self, name: str, problem: str) -> None:
        super().__init__(f"pose {name!r}: {problem}; a pose has {', '.join(FIELDS)}")
        self.name = name


class UnknownPose(NaoError):
    """Nobody knows a pose of that name. `name`: the name. `known`: the names there are."""

    def __init__(self, name: str, known: Iterable[str], what: str = "pose") -> None:
        self.name = name
        self.known = sorted(known)
        super().__init__(f"unknown {what} {name!r}{did_you_mean(name, self.known)}; known are {', '.join(self.known)}")


@dataclass(frozen=True)
class Pose:
    """Angles that joints take together."""

    joints: tuple[str, ...]  # names of joints and chains
    positions: tuple[float, ...]  # rad (hands: 0..1), one for each joint behind the names
    time: float  # s to get there


def pose_table(table: Any) -> dict[str, Pose]:
    """Poses from a table as nao_robot's parameter `~poses` holds it: name -> joint_names, positions, time_from_start.

    Raises BadPose if an entry is no pose.
    """
    if not isinstance(table, Mapping):
        raise BadPose("poses", f"the table is {table!r}")
    return {str(name): _pose_of_entry(str(name), entry) for name, entry in table.items()}


def built_in() -> dict[str, Pose]:
    """The poses that come along: init, zero and crouch."""
    table = json.loads(config_file("poses.json").read_text())
    table.pop("_source")
    return pose_table(table)


def library(path: str) -> dict[str, Pose]:
    """Poses of a library of Choregraphe (.xap). Raises BadPoseFile if it cannot be read."""
    return {name: Pose(tuple(pose), tuple(pose.values()), XAP_TIME) for name, pose in read_poses(path).items()}


def _pose_of_entry(name: str, entry: Any) -> Pose:
    if not isinstance(entry, Mapping) or set(entry) != set(FIELDS):
        found = ", ".join(map(str, entry)) if isinstance(entry, Mapping) else repr(entry)
        raise BadPose(name, f"it has {found or 'nothing'}")
    names = entry["joint_names"]
    joints = [names] if isinstance(names, str) else list(names)
    positions = _numbers(name, entry["positions"])
    (time,) = _numbers(name, [entry["time_from_start"]])
    if not joints or not positions or time <= 0.0:
        raise BadPose(name, f"{len(joints)} joint_names, {len(positions)} positions, {time:g} s")
    return Pose(tuple(map(str, joints)), tuple(positions), time)


def _numbers(name: str, values: Any) -> Sequence[float]:
    listed = values if isinstance(values, (list, tuple)) else [values]
    for value in listed:
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
            raise BadPose(name, f"{value!r} is no number")
    return [float(value) for value in listed]
