"""The predefined postures of ALRobotPosture, from `config/nao_postures.json`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from nao_sim_bridge.base.config import check_keys, config_file, read_json, vector
from nao_sim_bridge.base.errors import UnknownName
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.robot_model import RobotModel, frozen_mapping

FILE = "nao_postures.json"
SECTIONS = ("_meta", "posture_families", "family_of", "description", "postures")
OPTIONAL_SECTIONS = ("unknown_posture_name", "default_max_tries_goToPosture", "alternatives")
# Pitch of the torso in world, rad, by the family of the posture: near the pose in which the stiff robot comes to rest.
PITCH_OF_FAMILY = {"Sitting": -0.28, "LyingBelly": 1.45, "LyingBack": -1.5}
# Leaning back on the hands, the seat and the heels at once.
PITCH_OF_POSTURE = {"SitRelax": -0.05}


@dataclass(frozen=True, eq=False)
class Posture:
    """A predefined posture.

    Attributes:
        name: For example `StandInit`.
        family: For example `Standing`.
        angles: (26,) in Body order, rad (hands: opening in [0, 1]), read-only.
    """

    name: str
    family: str
    angles: np.ndarray


@dataclass(frozen=True, eq=False)
class Postures:
    """All postures the robot knows, by name, and all families, also those without a predefined posture."""

    by_name: Mapping[str, Posture]
    families: tuple[str, ...]


@lru_cache(maxsize=None)
def load_postures() -> Postures:
    """The predefined postures, read once.

    Raises:
        ConfigError: If the file has a wrong, unknown or missing entry.
    """
    tables = check_keys(read_json(config_file(FILE)), FILE, SECTIONS, OPTIONAL_SECTIONS)
    names = [joint.name for joint in load_model().joints]
    postures = {}
    for name, angles in tables["postures"].items():
        where = f"{FILE}: postures.{name}"
        check_keys(angles, where, names)
        array = vector([angles[joint] for joint in names], where, len(names))
        postures[name] = Posture(name, tables["family_of"][name], array)
    return Postures(frozen_mapping(postures), tuple(tables["posture_families"]))


def posture(model: RobotModel, name: str) -> tuple[float, ...]:
    """Joint angles of a predefined posture in Body order, rad (hands 0..1), kept within the joint limits.

    Raises:
        UnknownName: If there is no such posture.
    """
    by_name = load_postures().by_name
    if name not in by_name:
        raise UnknownName("posture", name, by_name)
    lower, upper = model.limits_array().T
    return tuple(np.clip(by_name[name].angles, lower, upper).tolist())


def start_pitch(name: str) -> float | None:
    """Pitch of the torso in world at the start, rad, positive with the face down; None when on the feet."""
    return PITCH_OF_POSTURE.get(name, PITCH_OF_FAMILY.get(load_postures().by_name[name].family))
