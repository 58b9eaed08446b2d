"""The action servers by name, and the types of their goals: for programs that send goals to any of them."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from ..base.errors import BadGoal
from ..base.suggestion import of_those

DESCRIBE = "/describe"
"""What the service by which a server describes itself is called behind the name of the action."""
MESSAGE = re.compile(r"[A-Za-z]\w*/[A-Za-z]\w*", re.ASCII)
"""Name of a message, as package/Name."""
PACKAGE = "nao_library_actions"
SERVERS = {
    "NaoLights": ("NaoLed", "lights.server.NaoLights"),
    "NaoMotion": ("NaoMotion", "motion.server.NaoMotion"),
    "nao_audio_out": ("NaoAudioOut", "audio_out.server.NaoAudioOutput"),
    "nao_audio_in": ("NaoAudioIn", "audio_in.server.NaoAudioInput"),
    "NaoVision": ("NaoVision", "vision.server.NaoVision"),
    "NaoTactile": ("NaoTactile", "tactile.server.NaoTactile"),
    "NaoBehavior": ("NaoBehavior", "behaviors.server.NaoBehavior"),
}
"""Relative name of each server -> its action in nao_library_actions, and the class behind it in this package."""
ACTIONS = {name: action for name, (action, _) in SERVERS.items()}


def servers_among(services: Iterable[str]) -> list[str]:
    """Names of the servers that describe themselves by one of these services, in their order; full names of both."""
    return [name[: -len(DESCRIBE)] for name in services if name.endswith(DESCRIBE)]


def those_in(space: str, names: Iterable[str]) -> list[str]:
    """Relative names of those that are right in a namespace, which has a slash at both ends, in their order."""
    inner = [name[len(space) :] for name in names if name.startswith(space)]
    return [name for name in inner if "/" not in name]


@dataclass(frozen=True)
class ServerType:
    """Types of one server."""

    name: str  # relative name of the server
    action: type  # type of its action, as NaoLedAction
    goal: type  # type of its goals; their first field is the list of function messages
    function: type  # type of the function messages, as LedFunction
    path: str  # the class behind it, in this package: lights.NaoLights; empty if it is none of this package's servers

    @property
    def ours(self) -> bool:
        """Whether this package has the class behind it."""
        return bool(self.path)

    @property
    def module(self) -> type:
        """The class behind it; it is imported when it is asked for first."""
        source, _, name = self.path.rpartition(".")
        return getattr(import_module(f"..{source}", __package__), name)


@lru_cache(maxsize=None)
def server_type(name: str) -> ServerType:
    """The types of a server; they are imported when they are asked for first.

    Raises KeyError if there is no such server; the text names those that there are.
    """
    if name not in SERVERS:
        raise KeyError(f"no server {name!r}{of_those(name, SERVERS)}")
    action, path = SERVERS[name]
    messages = import_module(f"{PACKAGE}.msg")
    goal = getattr(messages, f"{action}Goal")
    return ServerType(name, getattr(messages, f"{action}Action"), goal, _message_type(goal._slot_types[0]), path)


def described_type(name: str, response: Any) -> ServerType:
    """The types of a server that is none of this package's, as it describes itself.

    `name`: its relative name. `response`: DescribeFunctionsResponse of its service NAME/describe. Raises BadGoal if its
    messages are not known in this process.
    """
    types = [
        installed_message(kind) for kind in (f"{response.action}Action", f"{response.action}Goal", response.message)
    ]
    if None in types:
        problem = f"its messages {response.action} and {response.message} are not known to this process"
        raise BadGoal("step", name, "a server whose messages are built, in a workspace that was sourced", problem)
    return ServerType(name, *types, path="")


def installed_message(name: str) -> Any:
    """The class of a message that somebody else names; None if it was not built here.

    No module is imported for a name but a message that genpy has generated, nor is a class made from a definition.
    """
    package, _, word = name.partition("/")
    if not MESSAGE.fullmatch(name):
        return None
    try:
        spec = find_spec(package)  # of a module without a parent: it is not imported
    except ValueError:  # a module of this process that has no file
        return None
    folders = [Path(folder) for folder in (spec and spec.submodule_search_locations) or ()]
    if not any((folder / "msg" / f"_{word}.py").is_file() for folder in folders):
        return None
    return getattr(import_module(f"{package}.msg"), word, None)


def _message_type(kind: str) -> Any:
    package, name = kind[:-2].split("/")  # without the brackets of a list
    return getattr(import_module(f"{package}.msg"), name)
