"""The tables of docs/compatibility.md: which of NAOqi's modules, methods and older names the simulator answers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import yaml
from markdown_tables import code, table

from nao_sim_bridge.naoqi.binding.api import module_methods, older_tables, own_methods
from nao_sim_bridge.naoqi.binding.binding import offered
from nao_sim_bridge.naoqi.binding.older import older_methods

KNOWN = Path(__file__).with_name("compatibility.yaml")
NEWEST = "2.8"
"""The version of NAOqi that the simulator's is of."""
NONE = "–"
Modules = Mapping[str, Sequence[Any]]


def known() -> Mapping[str, Any]:
    """What `compatibility.yaml` says: `refused` calls, and `modules` that are not there."""
    return yaml.safe_load(KNOWN.read_text(encoding="utf-8"))


def refused(module: str) -> dict[str, str]:
    """Methods of a module that always refuse, and what they say."""
    return {call.partition("(")[0]: why for call, why in known()["refused"].get(module, {}).items()}


def compatibility(modules: Modules) -> dict[str, str]:
    """The tables by the names in their marks; `modules` are those of a simulator, with their parts."""
    counts = {module: _Counts(module, parts) for module, parts in sorted(modules.items())}
    return {
        "compatibility count": _sentence(counts),
        "compatibility modules": _modules(counts),
        "compatibility versions": _versions(counts),
        "compatibility missing": _missing(modules),
        "compatibility deprecated": _deprecated(modules),
        "compatibility older": _older(modules),
        "compatibility not offered": _not_offered(),
    }


class _Counts:
    """A module's methods of its own: without those that all modules have, or all extractors.

    Attributes:
        last: The last version of NAOqi that had the module.
        answered: Those that do something or tell something.
        refused: Those that always refuse, with their reason.
        open: Those that are not there.
        older: Those that it had before, and that are there.
    """

    def __init__(self, module: str, parts: Sequence[Any]) -> None:
        self.last = older_tables()["modules"].get(module, {}).get("_last", NEWEST)
        own = [name for name in own_methods(module) if not name.startswith("_")]
        answered, open_ = ([name for name in names if name in own] for names in offered(module, parts))
        self.refused = {name: why for name, why in refused(module).items() if name in answered}
        self.answered = [name for name in answered if name not in self.refused]
        self.open = open_
        self.older = list(older_methods(module))

    @property
    def all(self) -> int:
        return len(self.answered) + len(self.refused) + len(self.open)


def _sentence(counts: Mapping[str, _Counts]) -> str:
    newest = [each for each in counts.values() if each.last == NEWEST]
    of_others = sum(methods for module, (methods, _) in known()["modules"].items() if module not in counts)
    answered, there = sum(len(each.answered) for each in newest), sum(each.all for each in newest)
    older = sum(len(each.older) for each in counts.values())
    before = [each for each in counts.values() if each.last != NEWEST]
    refusing, missing = sum(len(each.refused) for each in newest), sum(len(each.open) for each in newest)
    return (
        f"Of the {there + of_others} methods that the modules of NAOqi {NEWEST} have of their own on a NAO, "
        f"**{answered}** answer, in {len(newest)} modules. {refusing} always refuse, with a reason, {missing} "
        f"methods of these modules are not there, and {of_others} are of modules that are not there. {older} "
        f"methods of earlier versions are there beside them, and {len(before)} modules with "
        f"{sum(each.all for each in before)} methods."
    )


def _modules(counts: Mapping[str, _Counts]) -> str:
    rows = []
    for module, each in counts.items():
        names: dict[str, list[str]] = {}
        for name, why in each.refused.items():
            names.setdefault(why, []).append(code(name))
        refusals = [f"{', '.join(methods)}: {why}" for why, methods in names.items()]
        open_ = f"not there: {', '.join(map(code, each.open))}" if each.open else ""
        rows.append(
            (
                code(module),
                "" if each.last == NEWEST else f"to {each.last}",
                f"{len(each.answered)} of {each.all}",
                str(len(each.older) or ""),
                "; ".join(filter(None, [*refusals, open_])),
            )
        )
    return table(("module", "NAOqi", "methods", "older names", "what is refused or not there, and why"), rows)


def _versions(counts: Mapping[str, _Counts]) -> str:
    """What programs of each version find beside what 2.8 has."""
    last = {method.last for module in counts for method in older_methods(module).values()}
    last |= {each.last for each in counts.values()}
    rows = []
    for version in sorted(last, key=_number):
        methods = [
            name
            for module in counts
            for name, method in older_methods(module).items()
            if _number(method.last) >= _number(version)
        ]
        of_then = [each for each in counts.items() if each[1].last != NEWEST]
        whole = [code(module) for module, each in of_then if _number(each.last) >= _number(version)]
        rows.append((version, str(len(methods)), ", ".join(whole) or "itself"))
    return table(("program for NAOqi", "methods beside those of 2.8", "modules beside those of 2.8"), rows)


def _number(version: str) -> tuple[int, ...]:
    return tuple(map(int, version.split(".")))


def _missing(modules: Modules) -> str:
    rows = [
        (code(module), str(methods), why)
        for module, (methods, why) in known()["modules"].items()
        if module not in modules
    ]
    return table(("module", "methods", "why it is not there"), rows)


def _deprecated(modules: Modules) -> str:
    rows = []
    for module in sorted(modules):
        if "_last" in older_tables()["modules"].get(module, {}):
            continue
        names: dict[str, list[str]] = {}
        for name, method in module_methods(module).items():
            if method.older:
                names.setdefault(_now(method.older), []).append(code(name))
        told = [", ".join(each) + (f" ({now})" if now else "") for now, each in names.items()]
        if told:
            rows.append((code(module), "; ".join(told)))
    return table(("module", "methods, and what to call instead"), rows)


def _now(text: str) -> str:
    return code(text.partition("see ")[2]) if "see " in text else ""


def _older(modules: Modules) -> str:
    rows = []
    for module in sorted(modules):
        whole = older_tables()["modules"].get(module, {})
        if whole:
            names = ", ".join(map(code, own_methods(module)))
            rows.append((code(module), names, whole["_last"], f"module of its own; today {whole['_now']}"))
        grouped: dict[tuple[str, str], list[str]] = {}
        for name, older in older_methods(module).items():
            grouped.setdefault((older.last, ", ".join(map(code, older.targets)) or "itself"), []).append(code(name))
        rows += [(code(module), ", ".join(names), last, now) for (last, now), names in sorted(grouped.items())]
    for name, entry in older_tables()["events"].items():
        rows.append(("event", code(name), entry["last"], code(entry["now"])))
    return table(("module", "older name", "to NAOqi", "what it does today"), rows)


def _not_offered() -> str:
    rows = []
    for what, why in older_tables()["not_offered"].items():
        module, _, methods = what.partition(".")
        rows.append((code(module), ", ".join(map(code, methods.split(", "))) if methods else "all", why))
    return table(("module", "older name", "since which version it is known, and why it is not there"), rows)
