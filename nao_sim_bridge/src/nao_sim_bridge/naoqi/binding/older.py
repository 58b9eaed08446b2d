"""Methods that modules had before NAOqi 2.8, as calls of what there is today: `methods` of `older_names.json`."""

from __future__ import annotations

import json
import logging
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Callable, Mapping, Sequence

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.naoqi.binding.api import Method, make_method, older_tables

log = logging.getLogger("nao_sim.services")
Call = Callable[..., Any]


@dataclass(frozen=True)
class OlderMethod:
    """A method that NAOqi 2.8 has no more.

    Attributes:
        method: How it is called.
        last: The last version of NAOqi that is known to have had it.
        calls: Of each overload, what is called one after the other: names of methods with their arguments. Without any
            the module has such a method itself.
        pick: Number of the entry of the last answer that is the answer; None for all of it.
        answer: What it answers instead; None for what the last call does.
        refuses: Parameters that have to be false, and what would be right.
    """

    method: Method
    last: str
    calls: Sequence[Sequence[Sequence[Any]]]
    pick: int | None
    answer: Any
    refuses: Mapping[str, str]

    @property
    def targets(self) -> list[str]:
        """Names of the methods that it calls."""
        return list(dict.fromkeys(name for calls in self.calls for name, *_ in calls))

    def bound_to(self, methods: Mapping[str, Call]) -> Call:
        """What answers it by calling these methods of its module."""

        def call(*arguments: Any) -> Any:
            way = next(i for i, each in enumerate(self.method.overloads) if len(each.names) == len(arguments))
            given = dict(zip(self.method.overloads[way].names, arguments))
            for name, right in self.refuses.items():
                if given[name]:
                    raise BadValue(name, given[name], right)
            return _in_turn([(methods[name], _filled(templates, given)) for name, *templates in self.calls[way]], end)

        def end(value: Any) -> Any:
            if self.method.returns == "void":
                return None
            if self.pick is not None:
                return value[self.pick]
            return value if self.answer is None else self.answer

        return call


@lru_cache(maxsize=None)
def older_methods(module: str) -> Mapping[str, OlderMethod]:
    """Methods by name that a module had and has no more."""
    entries = older_tables()["methods"].get(module, {})
    return {name: _older_method(name, entry) for name, entry in entries.items()}


def older_events() -> Mapping[str, Sequence[str]]:
    """Names that events had before, by their name of today."""
    names: dict[str, list[str]] = {}
    for older, entry in older_tables()["events"].items():
        names.setdefault(entry["now"], []).append(older)
    return names


def warning_once(module: str, method: Method, call: Call) -> Call:
    """`call`, whose first use is told in the log when it has an older name."""
    if not method.older:
        return call
    told: list[bool] = []

    def warns(*arguments: Any) -> Any:
        if not told:
            told.append(True)
            log.warning("%s.%s is an older name: %s", module, method.name, method.older)
        return call(*arguments)

    return warns


def _older_method(name: str, entry: Mapping[str, Any]) -> OlderMethod:
    calls = [way["calls"] for way in entry["ways"] if "calls" in way]
    now = dict.fromkeys(target for way in calls for target, *_ in way)
    text = f"of NAOqi {entry['last']} and before" + (f"; today it is {', '.join(now)}" if now else "")
    refuses, unused = entry.get("refuses", {}), _unused(entry)
    if unused:
        entry = {**entry, "summary": f"{entry['summary']}; not used: {', '.join(unused)}"}
    method = make_method(name, entry, text)
    return OlderMethod(method, entry["last"], calls, entry.get("pick"), entry.get("answer"), refuses)


def _unused(entry: Mapping[str, Any]) -> list[str]:
    """Parameters that are given to no call, and not refused."""
    ways = [(way["takes"], json.dumps(way["calls"])) for way in entry["ways"] if "calls" in way]
    names = [(each.split()[-1], calls) for takes, calls in ways for each in takes]
    return [name for name, calls in names if f'"${name}"' not in calls and name not in entry.get("refuses", ())]


def _filled(template: Any, given: Mapping[str, Any]) -> Any:
    """Arguments with what was given in the place of "$name", or a multiple of it for {"$name": factor}."""
    if isinstance(template, str) and template.startswith("$"):
        return given[template[1:]]
    if isinstance(template, dict):
        return next(factor * given[name[1:]] for name, factor in template.items())
    return [_filled(each, given) for each in template] if isinstance(template, list) else template


def _in_turn(calls: Sequence[tuple[Call, Sequence[Any]]], end: Callable[[Any], Any]) -> Any:
    """The answer of the last of some calls, passed through `end`; each is made when the one before has ended."""
    (call, arguments), *rest = calls
    return _after(call(*arguments), (lambda _: _in_turn(rest, end)) if rest else end)


def _after(result: Any, change: Callable[[Any], Any]) -> Any:
    if not isinstance(result, Task):
        return change(result)

    # Of what was killed there is no value to change.
    return result.then(lambda value: None if result.killed else _after(value, change))
