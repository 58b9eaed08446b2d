"""NAOqi's methods as the robot publishes them: overloads, names and summaries.

Those of NAOqi 2.8 are in `config/naoqi_api.json`, modules of earlier versions in `config/older_names.json`.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Any, Mapping, NamedTuple, Sequence, Tuple

from nao_sim_bridge.base.config import config_file, read_json
from nao_sim_bridge.base.errors import ConfigError

FILE, OLDER_FILE = "naoqi_api.json", "older_names.json"
COMMON = "_common_module"
DEPRECATED = re.compile(r"deprecated[^;]*")

SIMPLE_TYPES = {
    "void": "v",
    "bool": "b",
    "int": "i",
    "float": "f",
    "string": "s",
    "ALValue": "m",
    "object": "o",
    "buffer": "r",
    # A raw address in the robot's memory; on the wire it would be a number.
    "pointer": "L",
    # Structures of single modules: ability, enabled, running; tag to animations.
    "AutonomousAbilityStatus": "(sbb)",
    "TagForAnimations": "{s[s]}",
    "PackageInfo2": "(sssssssss{sm})<PackageInfo2,uuid,version,author,channel,organization,date,typeVersion,installer,"
    "path,elems>",
}


class Overload(NamedTuple):
    """One way to call a method: parameter types as NAOqi writes them, and their names."""

    types: Tuple[str, ...]
    names: Tuple[str, ...]

    @property
    def signature(self) -> str:
        """The parameters as a libqi signature, for example "(sf)"."""
        return "(" + "".join(qi_type(t) for t in self.types) + ")"

    def __str__(self) -> str:
        """The parameters as a person reads them, for example "string name, float intensity"."""
        return ", ".join(f"{t} {n}" for t, n in zip(self.types, self.names))


class Method(NamedTuple):
    """One method of a NAOqi module; `older` says what to use today, and is empty for a method of today."""

    name: str
    overloads: Tuple[Overload, ...]
    returns: str
    summary: str
    older: str = ""

    def usage(self) -> str:
        """All ways to call it, one a line."""
        return "\n".join(f"{self.returns} {self.name}({overload})" for overload in self.overloads)


class Table(NamedTuple):
    """Methods of one table, and the names of the tables that it inherits from."""

    shared: Tuple[str, ...]
    methods: Mapping[str, Method]


@lru_cache(maxsize=None)
def qi_type(name: str) -> str:
    """Libqi's letter code of a type as NAOqi writes it; a ConfigError when it is unknown."""
    if name in SIMPLE_TYPES:
        return SIMPLE_TYPES[name]
    kind, _, inner = name.partition("<")
    parts = _split(inner[:-1])
    if kind == "list" and len(parts) == 1:
        return f"[{qi_type(parts[0])}]"
    if kind == "map" and len(parts) == 2:
        return "{" + "".join(map(qi_type, parts)) + "}"
    if (kind == "tuple" and parts) or (kind == "pair" and len(parts) == 2):
        return "(" + "".join(map(qi_type, parts)) + ")"
    raise ConfigError(FILE, f"unknown type {name!r}")


@lru_cache(maxsize=None)
def published_type(returns: str) -> str:
    """Libqi's letter code of what a method answers; pictures and their like are any value, as on a robot.

    A C++ client takes each element of them as any value, which it cannot with those of a structure.
    """
    return SIMPLE_TYPES["ALValue"] if holds_buffer(returns) else qi_type(returns)


def holds_buffer(returns: str) -> bool:
    """Whether a method answers a list, or lists, with a buffer among other values."""
    return "buffer" in returns and returns != "buffer"


@lru_cache(maxsize=1)
def older_tables() -> Mapping[str, Any]:
    """What is known of NAOqi before 2.8; `_meta` in the file tells its form."""
    return read_json(config_file(OLDER_FILE))


@lru_cache(maxsize=1)
def _tables() -> Mapping[str, Table]:
    tables = dict(read_json(config_file(FILE)))
    del tables["_meta"]
    for module, methods in older_tables()["modules"].items():
        tables[module] = {**methods, **tables.get(module, {})}
    return {name: _table(name, entries) for name, entries in tables.items()}


def tables_of(module: str) -> list[str]:
    """Names of the tables with the methods of a module, the last is its own: "_inherits" names the others.

    A ConfigError when the module is not in the table.
    """
    tables = _tables()
    if module not in tables:
        raise ConfigError(FILE, f"no module {module!r}")
    return [*tables[module].shared, module]


def module_methods(module: str) -> Mapping[str, Method]:
    """Methods of a module by name, those included that it shares with others; see `tables_of`."""
    methods: dict[str, Method] = {}
    for table in tables_of(module):
        for name, method in own_methods(table).items():
            methods[name] = _beside(method, methods[name]) if name in methods else method
    return methods


def _beside(own: Method, shared: Method) -> Method:
    """A method of a module that takes other numbers of arguments than one of this name that it shares with others."""
    return own._replace(overloads=own.overloads + shared.overloads, summary=f"{own.summary}; {shared.summary}")


def own_methods(table: str) -> Mapping[str, Method]:
    """Methods of one table: what a module shares with no others, or what several share."""
    return _tables()[table].methods


def make_method(name: str, entry: Mapping[str, Any], older: str = "") -> Method:
    """The method of an entry of one of the two files."""
    if "ways" in entry:
        overloads = tuple(_overload(way["takes"]) for way in entry["ways"])
    else:
        overloads = tuple(
            Overload(tuple(types), tuple(n or f"arg{i}" for i, n in enumerate(names)))
            for types, names in zip(entry["overloads"], entry["params"])
        )
    return Method(name, overloads, entry["returns"], entry["summary"], older)


def _table(name: str, entries: Mapping[str, Any]) -> Table:
    # The common methods are of every module, also of one whose entry does not say so.
    shared = dict.fromkeys([COMMON, *entries.get("_inherits", ())])
    shared.pop(name, None)
    own = {name: make_method(name, entry, _older(entries, entry)) for name, entry in _methods(entries)}
    return Table(tuple(shared), own)


def _methods(entries: Mapping[str, Any]) -> list[tuple[str, Any]]:
    """Those entries of a table that are methods: one of a private method begins with _ as other things of it do."""
    return [(name, entry) for name, entry in entries.items() if isinstance(entry, Mapping) and "returns" in entry]


def _overload(takes: Sequence[str]) -> Overload:
    pairs = [each.rsplit(" ", 1) for each in takes]
    return Overload(tuple(kind for kind, _ in pairs), tuple(name for _, name in pairs))


def _older(table: Mapping[str, Any], entry: Mapping[str, Any]) -> str:
    if "_last" in table:
        return f"of a module of NAOqi {table['_last']} and before; today there is {table['_now']}"
    if not entry.get("deprecated"):
        return ""
    told = DEPRECATED.search(entry["summary"])
    return told[0].strip() if told else "deprecated"


def _split(text: str) -> list[str]:
    """Split at commas that are not inside angle brackets."""
    parts, depth, start = [], 0, 0
    for i, letter in enumerate(text):
        depth += (letter == "<") - (letter == ">")
        if letter == "," and depth == 0:
            parts.append(text[start:i])
            start = i + 1
    return [*parts, text[start:]] if text else []
