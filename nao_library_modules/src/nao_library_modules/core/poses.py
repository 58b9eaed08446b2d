"""Poses by name: from nao_robot's parameters, from Choregraphe's libraries (.xap files), and the bundled ones."""

from __future__ import annotations

import json
import math
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from naoqi.errors import NaoError

from .errors import did_you_mean
from .files import config_file

RADIANS_VERSION = "2"
HANDS = ("LHand", "RHand")


class BadPoseFile(NaoError):
    """A pose library cannot be read. `path`: the file. `problem`: what is wrong with it."""

    def __init__(self, path: Path, problem: str) -> None:
        super().__init__(f"pose library {path}: {problem}")
        self.path = path
        self.problem = problem


def read_poses(path: str | Path) -> dict[str, dict[str, float]]:
    """Read a pose library.

    Raises BadPoseFile if it cannot be read, is no XML, or holds no pose or a broken one.

    Args:
        path: The .xap file.

    Returns:
        Name of the pose -> joint -> angle in rad (hands: 0..1).
    """
    path = Path(path).expanduser()
    try:
        root = ElementTree.parse(path).getroot()
    except OSError as error:
        raise BadPoseFile(path, error.strerror or str(error)) from error
    except ElementTree.ParseError as error:
        raise BadPoseFile(path, f"no XML: {error}") from error
    poses: dict[str, dict[str, float]] = {}
    for position in _named(root, "position"):
        name = _text(position, "name")
        if not name:
            raise BadPoseFile(path, f"position {len(poses) + 1} has no name")
        if name in poses:
            raise BadPoseFile(path, f"two positions are called {name!r}")
        poses[name] = _pose(path, name, position)
    if not poses:
        raise BadPoseFile(path, "it holds no position")
    return poses


def _pose(path: Path, name: str, position: ElementTree.Element) -> dict[str, float]:
    in_radians = _text(position, "version") == RADIANS_VERSION
    pose: dict[str, float] = {}
    for motor in _named(position, "Motor"):
        joint, value = _text(motor, "name"), _text(motor, "value")
        try:
            angle = float(value)
        except ValueError:
            raise BadPoseFile(path, f"{name}: {joint or 'a motor without name'} has the value {value!r}") from None
        if not joint or not math.isfinite(angle):
            raise BadPoseFile(path, f"{name}: {joint or 'a motor without name'} has the value {value!r}")
        if joint in pose:
            raise BadPoseFile(path, f"{name}: {joint} comes twice")
        pose[joint] = angle if in_radians or joint in HANDS else math.radians(angle)
    if not pose:
        raise BadPoseFile(path, f"{name}: no motors")
    return pose


def _named(element: ElementTree.Element, name: str) -> Iterator[ElementTree.Element]:
    """Descendants of that name in any namespace."""
    return (each for each in element.iter() if _local_name(each) == name)


def _text(element: ElementTree.Element, name: str) -> str:
    """Text of the child of that name, "" if there is none."""
    child = next((each for each in element if _local_name(each) == name), None)
    return "" if child is None or child.text is None else child.text.strip()


def _local_name(element: ElementTree.Element) -> str:
    return str(element.tag).rpartition("}")[2]


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
