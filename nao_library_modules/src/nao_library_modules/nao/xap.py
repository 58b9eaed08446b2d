"""Poses from Choregraphe's pose libraries (.xap files).

Such a file is XML: `position` elements, each with a `name`, a `version` and `Motors`, and in these `Motor` elements
with `name` and `value`. Version 2 has angles in rad; before that they were in degrees. Hands are shares of their
opening in both. The XML namespace is not looked at, because it changed with the owner of the format.

Source: the parser of naoqi_pose, by the names of elements that it looks for.
"""

from __future__ import annotations

import math
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from pathlib import Path

from naoqi.errors import NaoError

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
