"""The parts of the driver: their names and classes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from importlib import import_module
from typing import Any

from naoqi.errors import NaoError

from ..base.suggestion import did_you_mean

PARTS = {
    "controller": ("nao_controller", "joints.nao_controller.NaoController"),
    "joint_states": ("nao_joint_states", "joints.nao_joint_states.NaoJointStates"),
    "poses": ("pose_manager", "joints.pose_manager.PoseManager"),
    "walker": ("nao_walker", "walk.nao_walker.NaoWalker"),
    "path_follower": ("nao_path_follower", "path_follower.path_follower.NaoPathFollower"),
    "footsteps": ("nao_footsteps", "walk.footsteps.NaoFootsteps"),
    "moveto": ("naoqi_moveto", "walk.moveto.NaoqiMoveTo"),
    "speech": ("nao_speech", "audio.nao_speech.NaoSpeech"),
    "microphone": ("nao_robot/microphone/naoqi_microphone", "audio.nao_microphone.NaoMicrophone"),
    "audio": ("nao_audio", "audio.nao_audio.NaoAudioServices"),
    "cameras": ("nao_camera", "camera.nao_camera.NaoCamera"),
    "vision": ("nao_vision", "sensors.nao_vision.NaoVisionServices"),
    "tactile": ("nao_tactile", "sensors.nao_tactile.NaoTactileNode"),
    "sonar": ("nao_sonar", "sensors.nao_sonar.NaoSonar"),
    "memory": ("nao_memory", "memory.nao_memory.NaoMemory"),
    "leds": ("nao_leds", "life.nao_leds.NaoLeds"),
    "behaviors": ("nao_behaviors", "life.nao_behaviors.NaoBehaviors"),
    "alife": ("nao_alife", "life.nao_alife.NaoAlife"),
    "diagnostics": ("nao_diagnostic_updater", "sensors.nao_diagnostic_updater.NaoDiagnosticUpdater"),
}
"""Word -> the name that the part has in ROS, relative; its class, in this package."""
ALL = "all"


def chosen(words: str | Sequence[str]) -> list[str]:
    """The named parts, in the order of the table: words between blanks, or a list of them; "all" stands for all.

    Raises NaoError if there is no such part, or none is named.
    """
    named = words.split() if isinstance(words, str) else list(words)
    for word in named:
        if word not in PARTS and word != ALL:
            hint = did_you_mean(str(word), PARTS)
            raise NaoError(f"~parts: there is no part {word!r}{hint}; there are {ALL}, {', '.join(PARTS)}")
    if not named:
        raise NaoError(f"~parts is empty: {ALL}, or some of {', '.join(PARTS)}")
    return [part for part in PARTS if ALL in named or part in named]


def part_class(part: str) -> Callable[..., Any]:
    module, _, name = PARTS[part][1].rpartition(".")
    return getattr(import_module(f".{module}", __package__), name)
