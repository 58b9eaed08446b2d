"""The action servers by name and the types of their goals, for programs that send goals to any of them."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from naoqi.errors import NaoError

from .errors import BadGoal, of_those

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


DESCRIBE = "/describe"
"""What the service by which a server describes itself is called behind the name of the action."""
MESSAGE = re.compile(r"[A-Za-z]\w*/[A-Za-z]\w*", re.ASCII)
"""Name of a message, as package/Name."""
PACKAGE = "nao_library_actions"
FIELDS = {
    "goal": ("functions",),
    "function message": ("function", "time", "str_param"),
    "result": ("memList", "results"),
    "feedback": ("index", "function", "count", "waiting"),
}
"""What each action of a server has, whoever wrote it."""
SERVERS = {
    "NaoLights": ("NaoLed", "lights.lights_server.NaoLights"),
    "NaoMotion": ("NaoMotion", "motion.motion_server.NaoMotion"),
    "nao_audio_out": ("NaoAudioOut", "audio_out.audio_out_server.NaoAudioOutput"),
    "nao_audio_in": ("NaoAudioIn", "audio_in.audio_in_server.NaoAudioInput"),
    "NaoVision": ("NaoVision", "vision.vision_server.NaoVision"),
    "NaoTactile": ("NaoTactile", "tactile.tactile_server.NaoTactile"),
    "NaoBehavior": ("NaoBehavior", "behaviors.server.NaoBehavior"),
}
"""Relative name of each server -> its action in nao_library_actions, and the class behind it in this package."""
ACTIONS = {name: action for name, (action, _) in SERVERS.items()}


def servers_among(services: Iterable[str]) -> list[str]:
    """Names of the servers that describe themselves by one of these services, in their order; full names of both.

    A server that is found by two names is named once, by its own.
    """
    names = (name[: -len(DESCRIBE)] for name in services if name.endswith(DESCRIBE))
    return [name for name in names if not is_second(name)]


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
    messages are not found by this process.
    """
    kinds = (f"{response.action}Action", f"{response.action}Goal", response.message)
    types = [installed_message(kind) for kind in kinds]
    if None in types:
        process = _this_process()
        packages = " and ".join(dict.fromkeys(kind.partition("/")[0] for kind, found in zip(kinds, types) if not found))
        cure = (
            f"build {packages}, source devel/setup.bash of its workspace, and in that shell start it again, with the"
            " launch file that it belongs to"
        )
        raise BadGoal("step", name, cure, f"{process} does not find the messages of {name}, of the package {packages}")
    return ServerType(name, *types, path="")


def _this_process() -> str:
    """The name by which people know this process: of its node, else of its program."""
    import rospy

    return rospy.get_name() if rospy.core.is_initialized() else Path(sys.argv[0]).name


def require_fields(action: type) -> None:
    """See that an action has the fields that every server fills and reads.

    Raises NaoError that names those which are missing.
    """
    parts = action()
    goal = parts.action_goal.goal
    kind = goal._slot_types[0] if goal.__slots__ else ""
    function = _message_type(kind) if kind.endswith("[]") and "/" in kind else None
    there = {
        "goal": goal.__slots__,
        "function message": function.__slots__ if function else (),
        "result": parts.action_result.result.__slots__,
        "feedback": parts.action_feedback.feedback.__slots__,
    }
    missing = [
        f"{field} in its {part}" for part, fields in FIELDS.items() for field in fields if field not in there[part]
    ]
    if missing:
        raise NaoError(f"the action {action._type} lacks {', '.join(missing)}; docs/your_own.md shows one that has all")


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
