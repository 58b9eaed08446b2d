"""The action servers by name, and the types of their goals: for programs that send goals to any of them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from importlib import import_module
from typing import Any

from .suggestion import did_you_mean

PACKAGE = "nao_library_actions"
SERVERS = {
    "NaoLights": ("NaoLed", "lights.NaoLights"),
    "NaoMotion": ("NaoMotion", "motion.NaoMotion"),
    "nao_audio_out": ("NaoAudioOut", "audio_out.NaoAudioOutput"),
    "nao_audio_in": ("NaoAudioIn", "audio_in.NaoAudioInput"),
    "NaoVision": ("NaoVision", "vision.NaoVision"),
    "NaoTactile": ("NaoTactile", "tactile.NaoTactile"),
    "NaoBehavior": ("NaoBehavior", "behaviors.server.NaoBehavior"),
}
"""Relative name of each server -> its action in nao_library_actions, and the class behind it in this package."""
ACTIONS = {name: action for name, (action, _) in SERVERS.items()}


@dataclass(frozen=True)
class ServerType:
    """Types of one server.

    Attributes:
        name: Relative name of the server.
        action: Type of its action, as NaoLedAction.
        goal: Type of its goals; their first field is the list of function messages.
        function: Type of the function messages, as LedFunction.
        path: The class behind it, in this package: lights.NaoLights.
    """

    name: str
    action: type
    goal: type
    function: type
    path: str

    @property
    def module(self) -> type:
        """The class behind it; it is imported when it is asked for first."""
        source, _, name = self.path.rpartition(".")
        return getattr(import_module(f".{source}", __package__), name)


@lru_cache(maxsize=None)
def server_type(name: str) -> ServerType:
    """The types of a server; they are imported when they are asked for first.

    Raises:
        KeyError: There is no such server; the text names those that there are.
    """
    if name not in SERVERS:
        raise KeyError(f"no server {name!r}{did_you_mean(name, SERVERS)}; there are {', '.join(SERVERS)}")
    action, path = SERVERS[name]
    messages = import_module(f"{PACKAGE}.msg")
    goal = getattr(messages, f"{action}Goal")
    return ServerType(name, getattr(messages, f"{action}Action"), goal, _message_type(goal._slot_types[0]), path)


def _message_type(kind: str) -> Any:
    package, name = kind[:-2].split("/")  # without the brackets of a list
    return getattr(import_module(f"{package}.msg"), name)
