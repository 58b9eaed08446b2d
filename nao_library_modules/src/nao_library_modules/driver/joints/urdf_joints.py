"""Joints of a robot description (URDF). Pure."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass

from naoqi.errors import NaoError

MOVABLE = ("revolute", "continuous", "prismatic")


@dataclass(frozen=True)
class UrdfJoint:
    """A joint that can be set by itself.

    Attributes:
        name: Its name.
        lower: rad, or m of a prismatic one.
        upper: rad, or m of a prismatic one.
    """

    name: str
    lower: float
    upper: float

    @property
    def rest(self) -> float:
        """Zero, or the limit that is nearest to it."""
        return min(max(0.0, self.lower), self.upper)


def movable_joints(description: str) -> list[UrdfJoint]:
    """Joints in the order of the description, without those that follow another one.

    Raises:
        NaoError: If it is no URDF.
    """
    try:
        root = ElementTree.fromstring(description)
    except ElementTree.ParseError as error:
        raise NaoError(f"the robot description is no XML: {error}") from error
    found = []
    for joint in root.findall("joint"):
        if joint.get("type") not in MOVABLE or joint.find("mimic") is not None:
            continue
        limit = joint.find("limit")
        if joint.get("type") == "continuous" or limit is None:
            lower, upper = -math.pi, math.pi
        else:
            lower, upper = float(limit.get("lower", 0.0)), float(limit.get("upper", 0.0))
        found.append(UrdfJoint(joint.get("name", ""), lower, upper))
    if not found:
        raise NaoError("the robot description has no joint that moves")
    return found
