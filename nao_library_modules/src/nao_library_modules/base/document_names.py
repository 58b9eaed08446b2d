"""Second names of action servers: those that the texts of docs/documents.md use where nao_robot's names are others."""

from __future__ import annotations

SECOND_NAMES = {
    "nao_audio_out": "NaoAudioOut",
    "nao_audio_in": "NaoAudioIn",
    "joint_angles_action": "jointAngles",
    "joint_stiffness_trajectory": "jointStiffness",
    "joint_trajectory": "jointTrajectory",
    "walk_target": "walkTarget",
}
"""Name of an action -> the other name by which its server is found as well."""


def names_of(name: str) -> list[str]:
    """The names of an action, its own first; `name` may have a namespace, which stays."""
    namespace, slash, word = name.rpartition("/")
    second = SECOND_NAMES.get(word)
    return [name] if second is None else [name, namespace + slash + second]


def is_second(name: str) -> bool:
    """Whether a name, with or without a namespace, is a second one."""
    return name.rpartition("/")[2] in SECOND_NAMES.values()
