#!/usr/bin/env python3
"""Writes the tables of README.md and docs/*.md from the code that they tell about.

A table named NAME stands between `<!-- begin: NAME -->` and `<!-- end: NAME -->`; what is between the two is
replaced. Needs the messages of the built workspace, but neither a ROS master nor a robot.
"""

from __future__ import annotations

import argparse
import ast
import inspect
import json
import re
import sys
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml
from compatibility_tables import compatibility
from markdown_tables import code, table

from nao_library_modules.core.describe import NO_UNIT, Described, Description, offline_servers, read_fields
from nao_library_modules.core.fields import table as limits_of_modules
from nao_library_modules.vision.pictures import size_rows as sizes_of_pictures
from nao_sim_bridge.base.config import robot_files_directory
from nao_sim_bridge.base.record_dir import load_places
from nao_sim_bridge.base.sizes import size_rows as sizes_of_simulator
from nao_sim_bridge.naoqi.binding.binding import offered
from nao_sim_bridge.naoqi.system.nao_simulation import NaoSimulation
from nao_sim_bridge.server.cli import parser as simulator_parser
from nao_sim_bridge.server.options import ServerOptions
from nao_sim_bridge.server.simulator_server import SimulatorServer
from nao_sim_bridge.speech.gesture_families import names as animation_names

try:
    from nao_sim_bridge.naoqi.binding.limits import table as limits_of_simulator
except ImportError:
    limits_of_simulator = list

ROOT = Path(__file__).resolve().parents[1]
DOCUMENTS = (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")))
CLIENT = ROOT / "nao_library_modules" / "examples" / "green_eyes.py"
NAOQI = ROOT / "nao_sim_bridge" / "src" / "nao_sim_bridge" / "config" / "naoqi_api.json"
NOT_WRAPPED = ROOT / "scripts" / "not_wrapped.yaml"
OUR_MESSAGES = "nao_library_msgs"
FEW = 5
"""Functions that are named where all that read a field read it alike."""
MOST_TAGS = 6
"""Tags of a folder of animations that are named."""
LAUNCH_FILES = ROOT / "launch" / "launch"
MARKED = re.compile(r"<!-- begin: (?P<name>[^>]+) -->\n(?P<body>.*?)<!-- end: (?P<end>[^>]+) -->", re.DOTALL)


class ReadmeError(Exception):
    """The marks in the text and the tables do not belong together."""


@dataclass(frozen=True)
class Server:
    """An action server as it presents itself to clients.

    Attributes:
        name: Relative name of the action.
        action: Type of the action, without its package.
        message: Type of the function messages, without its package.
        module: Class behind it.
        functions: Its own by name.
        shared: Those that all servers share, by name.
        answers: `result` and `feedback` -> the message of each.
    """

    name: str
    action: str
    message: str
    module: type
    functions: Mapping[str, Described]
    shared: Mapping[str, Described]
    answers: Mapping[str, type]


# Text


def fill(text: str, tables: Mapping[str, str]) -> str:
    """Put tables between their marks.

    Raises:
        ReadmeError: If marks have no table, or do not come in pairs.
    """

    def replaced(match: re.Match[str]) -> str:
        name = match["name"]
        if name != match["end"] or "<!-- begin:" in match["body"]:
            raise ReadmeError(f"the mark 'begin: {name}' is not followed by its 'end: {name}'")
        if name not in tables:
            raise ReadmeError(f"there is no table {name!r}; there are: {', '.join(tables)}")
        return f"<!-- begin: {name} -->\n\n{tables[name].strip()}\n\n<!-- end: {name} -->"

    filled, count = MARKED.subn(replaced, text)
    if count != text.count("<!-- begin:") or count != text.count("<!-- end:"):
        raise ReadmeError("a mark has no partner")
    return filled


def untold(texts: Iterable[str], tables: Iterable[str]) -> list[str]:
    """Names of the tables that no text has marks for."""
    marks = {match["name"] for text in texts for match in MARKED.finditer(text)}
    return [name for name in tables if name not in marks]


def first_line(thing: Any) -> str:
    """First line of a docstring.

    Raises:
        ReadmeError: If there is none.
    """
    doc = inspect.getdoc(thing)
    if not doc:
        raise ReadmeError(f"{thing!r} has no docstring")
    return doc.splitlines()[0]


# What is told


def client() -> str:
    """The shortest client without its first line and docstring."""
    source = CLIENT.read_text(encoding="utf-8")
    first = ast.parse(source).body[1].lineno
    return "```python\n" + "\n".join(source.splitlines()[first - 1 :]) + "\n```"


def launch_arguments(file: Path) -> str:
    """Arguments of a launch file."""
    args = ElementTree.parse(file).getroot().findall("arg")
    rows = [(code(a.get("name", "")), launch_default(a.get("default", "")), a.get("doc", "")) for a in args]
    return table(("argument", "default", "meaning"), rows)


def launch_default(text: str) -> str:
    """A default of a launch file in words: what is computed is said to be so."""
    environment = re.fullmatch(r"\$\(optenv \w+ ?(.*)\)", text)
    if environment:
        return code(environment[1])
    if text.startswith("$(eval"):
        return "depends on " + ", ".join(code(name) for name in re.findall(r"arg\('(\w+)'\)", text))
    return code(text)


def find_servers() -> list[Server]:
    """The servers of all modules of the library, by name."""
    servers = []
    for found in offline_servers():
        description = Description(found.table, found.kind, found.action)
        described = description.functions()
        own, shared = ({each.name: each for each in described if each.shared == of_all} for of_all in (False, True))
        message = description.message.rpartition("/")[2]
        action = found.action()
        answers = {"result": type(action.action_result.result), "feedback": type(action.action_feedback.feedback)}
        servers.append(Server(found.name, found.action.__name__, message, found.kind, own, shared, answers))
    return servers


def servers_table(servers: Sequence[Server]) -> str:
    """Names and types of the servers."""
    names = [(s.name, s.action, s.message, s.module.__name__) for s in servers]
    rows = [(*map(code, row), first_line(s.module)) for row, s in zip(names, servers)]
    return table(("server", "action", "function message", "class", "what it does"), rows)


def functions_table(functions: Mapping[str, Described]) -> str:
    """Functions of a server, the fields that each takes from its message, and what it does."""
    rows = [
        (code(name), ", ".join(code(argument.name) for argument in each.arguments) or code(""), each.help)
        for name, each in functions.items()
    ]
    return table(("function", "fields", "what it does"), rows)


def fields_table(functions: Mapping[str, Described]) -> str:
    """What the fields of a server's message mean to its functions; a row for each meaning of a field."""
    read: dict[str, dict[tuple[str, str], list[str]]] = {}
    for function in functions.values():
        for field in function.arguments:
            units = [field.unit] if field.unit not in ("", NO_UNIT, *field.allowed.split()) else []
            holds = ", ".join([*filter(None, [field.allowed]), *units])
            read.setdefault(field.name, {}).setdefault((field.help, holds), []).append(function.name)
    rows = [
        (code(name), ", ".join(map(code, of)) if len(meanings) > 1 or len(of) < FEW else "all", meaning, holds)
        for name, meanings in sorted(read.items())
        for (meaning, holds), of in meanings.items()
    ]
    return table(("field", "functions that read it", "meaning", "what it holds"), rows)


def answers_table(answers: Mapping[str, Any]) -> str:
    """Fields of a server's result and feedback, as the comments in the action's definition tell of them."""
    rows = [
        (where, code(field.name), field_type(field.type), field.comment)
        for where, message in answers.items()
        for field in read_fields(message._full_text).values()
    ]
    return table(("in the", "field", "type", "meaning"), rows)


def field_type(kind: str) -> str:
    """A type of a message's field; one of our own leads to its definition."""
    package, _, name = kind.rpartition("/")
    text = code(name if package == OUR_MESSAGES else kind)
    return f"[{text}](../{package}/msg/{name.partition('[')[0]}.msg)" if package == OUR_MESSAGES else text


def wrapped(servers: Sequence[Server]) -> str:
    """What of NAOqi's modules the functions of the servers do, and why they do not do the rest.

    Raises:
        ReadmeError: A method is neither a function nor told why not, or both.
    """
    api = json.loads(NAOQI.read_text(encoding="utf-8"))
    tables: dict[str, Mapping[str, Any]] = {server.name: server.functions for server in servers}
    tables["every server"] = servers[0].shared
    rows = []
    for server, modules in yaml.safe_load(NOT_WRAPPED.read_text(encoding="utf-8")).items():
        for module, told in modules.items():
            methods = {name: facts for name, facts in api[module].items() if not name.startswith("_")}
            rows.append((code(server), code(module), *_of_module(module, methods, tables[server], dict(told))))
    return table(("server", "module of NAOqi", "its methods as functions", "not, and why"), rows)


def _of_module(
    module: str, methods: Mapping[str, Any], functions: Mapping[str, Any], told: dict[str, Any]
) -> tuple[str, str]:
    """Which methods of a module are functions, and why others are not."""
    others = told.pop("as", {})
    done = {name: name for name in methods if name in functions}
    done.update({name: function for name, function in others.items() if function in functions})
    reasons = {name: reason for reason, names in told.items() for name in names if name != "*"}
    rest = next((reason for reason, names in told.items() if "*" in names), None)
    left: dict[str, list[str]] = {}
    for name, facts in methods.items():
        if name in done:
            continue
        reason = "deprecated" if facts.get("deprecated") else reasons.get(name, rest)
        if reason is None:
            raise ReadmeError(f"{NOT_WRAPPED.name}: {module}.{name} is no function, and nothing says why")
        left.setdefault(reason, []).append(code(name))
    odd = [name for name in (*reasons, *others) if name not in methods or (name in reasons and name in done)]
    if odd or len(done) < len(others):
        raise ReadmeError(f"{NOT_WRAPPED.name}: {module}: {', '.join(odd) or 'as'} does not fit")
    told_done = ", ".join(code(name) if name == by else f"{code(name)} as {code(by)}" for name, by in done.items())
    return told_done or "–", "; ".join(f"{', '.join(names)}: {reason}" for reason, names in left.items()) or "–"


def simulator_options() -> str:
    """Options of the simulator's command line."""
    # argparse has no public list of its options; its help text differs between versions of Python.
    options = [o for o in simulator_parser("nao_sim")._actions if o.option_strings and o.dest != "help"]
    rows = []
    for option in options:
        choices = f"; one of {', '.join(map(code, option.choices))}" if option.choices else ""
        default = "off" if option.nargs == 0 else code(option.default)
        rows.append((code(option.option_strings[-1]), default, f"{option.help}{choices}"))
    return table(("option", "default", "meaning"), rows)


def simulator_only() -> str:
    """Methods of the service that a robot does not have."""
    rows = []
    for name, method in vars(NaoSimulation).items():
        if inspect.isfunction(method) and not name.startswith("_"):
            parameters = list(inspect.signature(method).parameters)[1:]
            name = method.__qi_name__ or name
            rows.append((code(f"{name}({', '.join(parameters)})"), first_line(method)))
    return table(("method", "what it does"), rows)


def robot_files() -> str:
    """The robot's places, where they are in `record_dir`, and what comes along in them."""
    rows = []
    for place in load_places():
        folder = robot_files_directory() / place.path.lstrip("/")
        ours = sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file())
        there = "" if place.folder == "." else f"/{place.folder}"
        names = places(place.other_names) if place.other_names else ""
        rows.append((code(place.path), names, code(f"record_dir{there}"), places(ours) if ours else ""))
    return table(("on the robot", "also called", "on this computer", "comes along"), rows)


def of_naoqi() -> dict[str, str]:
    """What the simulator answers of NAOqi: how many methods of each module, and the tables of docs/compatibility.md."""
    server = SimulatorServer(ServerOptions(port=0))
    try:
        rows = []
        for module, parts in sorted(server.modules().items()):
            answered, open_ = offered(module, parts)
            rows.append((code(module), str(len(answered)), str(len(answered) + len(open_))))
        tables = compatibility(server.modules())
    finally:
        server.simulation.close()
    return {"naoqi": table(("module", "methods answered", "methods of the robot"), rows), **tables}


def limits() -> str:
    """Bounds of the numbers that come in from outside, by kind."""
    sides = (("servers, driver, behaviours", limits_of_modules()), ("simulator", limits_of_simulator()))
    rows = [
        (side, row.kind, bound(row.lowest), bound(row.highest), usual_of(row), row.unit, places(row.where))
        for side, declared in sides
        for row in declared
    ]
    return table(("of", "kind", "lowest", "highest", "usual", "unit", "where"), rows)


def usual_of(row: Any) -> str:
    """What is usual of a kind of number, where checks look at that."""
    found = getattr(row, "usual", None)
    return "" if found is None else f"{bound(found[0])} to {bound(found[1])}"


def sizes() -> str:
    """How large what comes in from outside may be, and how much of it waits."""
    sides = (("servers", sizes_of_pictures()), ("simulator", sizes_of_simulator()))
    rows = [(side, what, bound(most), unit, where) for side, declared in sides for what, most, unit, where in declared]
    return table(("of", "what", "bound", "unit", "where"), rows)


def animations() -> str:
    """Folders of NAOqi 2.8's animations: how many there are, of which families, with which tags."""
    rows = []
    folders: dict[str, list[str]] = {}
    for name in (name for name, naming in animation_names().items() if naming.tags):
        folders.setdefault(name.rsplit("/", 1)[0], []).append(name)
    for folder, members in sorted(folders.items()):
        named = [animation_names()[name] for name in members]
        families = sorted({each.family.rsplit("/", 1)[-1] for each in named})
        tags = sorted({tag for each in named for tag in each.tags})
        shown = [code(tag) for tag in tags[:MOST_TAGS]] + (["..."] if len(tags) > MOST_TAGS else [])
        rows.append((code(folder), str(len(members)), ", ".join(families), ", ".join(shown)))
    return table(("folder", "animations", "families", "tags"), rows)


def bound(number: float | None) -> str:
    """A bound as people read it; a dash for none."""
    return "–" if number is None or abs(number) == float("inf") else f"{number:.10g}"


def places(where: str | Sequence[str]) -> str:
    """Where a bound holds: words, or names of parameters."""
    return where if isinstance(where, str) else ", ".join(map(code, where)) or "all others"


def all_tables() -> dict[str, str]:
    """Every table by the name in its marks."""
    servers = find_servers()
    return {
        "client": client(),
        "launch nao_sim": launch_arguments(LAUNCH_FILES / "nao_sim.launch"),
        "launch console": launch_arguments(LAUNCH_FILES / "console.launch"),
        "launch nao": launch_arguments(LAUNCH_FILES / "nao.launch"),
        "servers": servers_table(servers),
        **{f"functions {server.name}": functions_table(server.functions) for server in servers},
        **{f"fields {server.name}": fields_table(server.functions) for server in servers},
        **{f"answers {server.name}": answers_table(server.answers) for server in servers},
        "memory functions": functions_table(servers[0].shared),
        "wrapped": wrapped(servers),
        "limits": limits(),
        "sizes": sizes(),
        "animations": animations(),
        "simulator options": simulator_options(),
        "simulator only": simulator_only(),
        "robot files": robot_files(),
        **of_naoqi(),
    }


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the documents anew, or with --check only look; the exit status tells whether all is well."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--check", action="store_true", help="write nothing; fail when one is out of date")
    options.add_argument("files", nargs="*", type=Path, default=DOCUMENTS, help="the files with the marks")
    parsed = options.parse_args(arguments)
    texts = {file: file.read_text(encoding="utf-8") for file in parsed.files}
    tables = all_tables()
    missing = untold(texts.values(), tables)
    problems = [f"nobody has marks for {', '.join(missing)}"] if missing else []
    for file, text in texts.items():
        try:
            filled = fill(text, tables)
        except ReadmeError as error:
            problems.append(f"{file}: {error}")
            continue
        if filled == text:
            continue
        if parsed.check:
            problems.append(f"{file} is out of date; run 'make docs'")
            continue
        file.write_text(filled, encoding="utf-8")
        print(f"{file} is up to date again")
    for problem in problems:
        print(problem, file=sys.stderr)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
