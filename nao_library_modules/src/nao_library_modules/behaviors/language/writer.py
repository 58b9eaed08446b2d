"""From goals to the text of a behaviour."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from ...base.errors import BadGoal
from ...base.field_checks import UNUSUAL
from .expressions import IDENTIFIER, escaped
from .messages import fields_of
from .servers import OWN
from .yaml_text import dump


def step_of(server: str, goal: Any, unusual: bool = False) -> dict[str, Any]:
    """A goal as a step of a file: a function, or a chain of them; `unusual`: with numbers that are not usual.

    Raises BadGoal if steps may not use the server.
    """
    meant = {UNUSUAL: True} if unusual else {}
    if server == OWN:
        raise BadGoal("server", server, "another one", "a behavior that sends goals to NaoBehavior would end itself")
    messages = getattr(goal, goal.__slots__[0])
    functions = [escaped(fields_of(message)) for message in messages]
    if len(functions) == 1 and IDENTIFIER.fullmatch(functions[0].get("function", "")):
        fields = dict(functions[0])
        return {f"{server}.{fields.pop('function')}": fields, **meant}
    return {"chain": {server: functions}, **meant}


def text_of(help_: str, steps: Sequence[Mapping[str, Any]], tags: Sequence[str] = ()) -> str:
    """The text of a behaviour without parameters."""
    content: dict[str, Any] = {"help": help_}
    if tags:
        content["tags"] = list(tags)
    return dump({**content, "do": [dict(step) for step in steps]})


def from_goal(server: str, goal: Any, help_: str = "", unusual: bool = False) -> str:
    """Write down one goal as a behaviour; what is returned can be stored: `store.save(name, text)`.

    `unusual`: as `step_of` takes it.

    Raises BadGoal if steps may not use the server.
    """
    return text_of(help_ or f"A goal of {server}.", [step_of(server, goal, unusual)])
