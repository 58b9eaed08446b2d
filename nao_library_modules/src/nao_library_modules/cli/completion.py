"""How a word can go on, as the running robot knows it. Whatever goes wrong, there is just nothing to offer."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from .chain_text import ASSIGN, NEXT, ends_function
from .robot_link import DirectRobot
from .settings import QUICK, CliSettings, quietly


@quietly
def servers(settings: CliSettings, *_: Any) -> list[str]:
    return settings.stack.servers()


@quietly
def all_functions(settings: CliSettings, *_: Any) -> list[str]:
    """Names of all functions of all servers, and of the servers."""
    names = dict.fromkeys(settings.stack.servers())
    for _, told in settings.stack.described(names=True):
        names.update(dict.fromkeys(function.name for function in told.functions))
    return list(names)


@quietly
def chain(settings: CliSettings, start: str, typed: Mapping[str, Any]) -> list[str]:
    """Next word of a chain: a function, a field, a value."""
    server, before = typed.get("server") or "", typed.get("chain") or ()
    last = max((i for i, word in enumerate(before) if word in NEXT or ends_function(word)), default=-1)
    piece = [word for word in before[last + 1 :] if word]
    if not piece:
        return [function.name for function in settings.stack.describe(server, names=True).functions]
    described = settings.stack.describe(server, [piece[0]])
    arguments = [argument for function in described.functions for argument in function.arguments]
    arguments += described.common
    field, assigned, value = start.partition(ASSIGN)
    if not assigned:
        used = {word.partition(ASSIGN)[0] for word in piece[1:]}
        return [f"{argument.name}{ASSIGN}" for argument in arguments if argument.name not in used]
    for argument in arguments:
        if argument.name == field:
            return [f"{field}{ASSIGN}{word}" for word in _values(argument, value)]
    return []


def choices(server: str, function: str, field: str) -> Callable[..., list[str]]:
    """An offer of the words that a field of a function may hold."""

    @quietly
    def offer(settings: CliSettings, *_: Any) -> list[str]:
        for described in settings.stack.describe(server, [function]).functions:
            for argument in described.arguments:
                if argument.name == field:
                    return list(argument.choices)
        return []

    return offer


@quietly
def behaviors(settings: CliSettings, *_: Any) -> list[str]:
    return [behavior["name"] for behavior in settings.stack.behaviors()]


@quietly
def parameters(settings: CliSettings, _start: str, typed: Mapping[str, Any]) -> list[str]:
    found = settings.stack.behaviors(typed.get("name") or "")
    return [f"{parameter['name']}=" for behavior in found for parameter in behavior["parameters"]]


@quietly
def keys(settings: CliSettings, start: str, _typed: Mapping[str, Any]) -> list[str]:
    """Keys and events of the robot's memory; up to the next slash, for there are more than a thousand."""
    with DirectRobot(settings.stack.robot_address(), QUICK) as robot:
        names = [name for name in robot.memory_names() if name.startswith(start)]
    return sorted({start + _to_slash(name[len(start) :]) for name in names})


def _to_slash(rest: str) -> str:
    head, slash, _ = rest.partition("/")
    return head + slash


def _values(argument: Any, typed: str) -> list[str]:
    if argument.type == "bool":
        return ["true", "false"]
    if argument.type.endswith("[]"):
        begun = typed.rpartition(",")[0]
        return [f"{begun},{word}" if begun else word for word in argument.choices]
    return list(argument.choices)
