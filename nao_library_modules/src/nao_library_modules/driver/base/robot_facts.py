"""What kind of robot it is, from its memory. No ROS."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

CONFIG = "RobotConfig/{}"
KEYS = {
    "head type": CONFIG.format("Head/Type"),
    "body type": CONFIG.format("Body/Type"),
    "head version": CONFIG.format("Head/Version"),
    "body version": CONFIG.format("Body/Version"),
    "arm version": CONFIG.format("Body/Device/LeftArm/Version"),
    "legs version": CONFIG.format("Body/Device/Legs/Version"),
    "left hand version": CONFIG.format("Body/Device/Hand/Left/Version"),
    "laser": CONFIG.format("Head/Device/Laser/Version"),
    "software": CONFIG.format("Body/SoftwareRequirement"),
    "body id": "Device/DeviceList/ChestBoard/BodyId",
    "head id": "RobotConfig/Head/FullHeadId",
}
"""Fact -> its key."""
TYPES = {"nao": 0, "romeo": 1, "juliette": 2, "pepper": 2}
"""As nao_library_msgs/RobotInfo numbers them. NAOqi calls a Pepper by its older name."""


def facts_of(values: Mapping[str, Any]) -> dict[str, str]:
    """Fact -> text, from key -> value; empty for a fact that the robot does not know."""
    return {fact: "" if values.get(key) is None else str(values[key]).strip() for fact, key in KEYS.items()}


def info_fields(facts: Mapping[str, str], joints: int) -> dict[str, Any]:
    """Fields of a nao_library_msgs/RobotInfo from `facts_of`.

    A NAO of 26 joints moves wrists and hands, and with 22 it does not.
    """
    kind = (facts["body type"] or facts["head type"] or "nao").lower()
    number = TYPES.get(kind, TYPES["nao"])
    nao = number == TYPES["nao"]
    return {
        "type": number,
        "model": ("nao_h25" if joints >= 26 else "nao_h21") if nao else kind,
        "head_version": facts["head version"],
        "body_version": facts["body version"],
        "arm_version": facts["arm version"],
        "has_laser": facts["laser"] not in ("", "0"),
        "has_extended_arms": False,
        "number_of_legs": 2 if nao or facts["legs version"] else 1,
        "number_of_arms": 2,
        "number_of_hands": 2 if not nao or joints >= 26 else 0,
    }
