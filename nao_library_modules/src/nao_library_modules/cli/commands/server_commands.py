"""`nao status`, `list`, `help` and `call`: the robot's state, what its servers can do, and calls of functions."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import click

from ...core.errors import did_you_mean
from .. import completion
from ..chain_text import NEXT, TypedFunction, build_message, read_chain
from ..cli_settings import CliSettings, NaoCommand, SignedCommand, settings_of
from ..direct_robot import DirectRobot
from ..goals import carry_out, message_class, start_node
from ..output import CommandFailed, StackMissing, plain, say_json, say_lines, table
from ..stack import Stack, described_by_code, same_server

DIAGNOSTICS = "/diagnostics"
DIAGNOSTICS_TIME = 1.3
"""s to listen: every node reports once a second."""
LEVELS = ("ok", "warning", "error", "stale")


def read_status(stack: Stack) -> dict[str, Any]:
    """What there is to tell; what cannot be asked is None. Raises StackMissing if there are no servers."""
    names = stack.servers()
    reports = _Diagnostics()
    servers = {name: _server_state(stack, name) for name in names}
    ip, port = stack.robot_address()
    found: dict[str, Any] = {
        "robot": stack.namespace.strip("/") or "/",
        "address": f"{ip}:{port}",
        "master": stack.graph.uri,
        "connected": False,
        "silent": "",
        "battery": None,
        "awake": None,
        "posture": None,
        "stiffness": None,
        "servers": servers,
        "nodes": _driver_parts(stack),
        "diagnostics": None,
    }
    found.update(_robot_state((ip, port)))
    found["diagnostics"] = reports.result()
    found["silent"] = reports.silent(found["address"])
    return found


def _server_state(stack: Stack, name: str) -> dict[str, Any]:
    try:
        told = stack.describe(name, brief=True)
    except (StackMissing, CommandFailed) as error:
        return {"up": False, "connected": False, "running": [], "index": 0, "problem": error.message}
    running = list(told.running)
    return {"up": True, "connected": told.connected, "running": running, "index": told.index, "problem": ""}


def _driver_parts(stack: Stack) -> dict[str, list[str]]:
    """Node of the driver -> the nodes of nao_robot that are parts of it; relative names."""
    from ...driver.nao_driver import PARTS
    from ...ros.master_api import parts_among

    nodes, found = parts_among(stack.graph.services()), {}
    for part, _ in PARTS.values():
        node = nodes.get(stack.namespace + part)
        if node is not None:
            found.setdefault(node, []).append(part)
    return found


def _robot_state(address: tuple[str, int]) -> dict[str, Any]:
    from ...core.nao_facts import CHARGE

    try:
        with DirectRobot(address, limit=3.0) as robot:
            stiffnesses = list(robot.call("ALMotion", "getStiffnesses", "Body"))
            return {
                "connected": True,
                "battery": robot.memory("getListData", [CHARGE])[0],
                "awake": bool(robot.call("ALMotion", "robotIsWakeUp")),
                "posture": str(robot.call("ALRobotPosture", "getPosture")),
                "stiffness": {
                    "stiff": sum(value > 0.0 for value in stiffnesses),
                    "joints": len(stiffnesses),
                    "mean": sum(stiffnesses) / max(1, len(stiffnesses)),
                },
            }
    except StackMissing:
        return {}
    except CommandFailed as error:
        return {"connected": True, "problem": error.message}


class _Diagnostics:
    """The reports of all nodes, gathered while the rest is asked."""

    def __init__(self) -> None:
        from diagnostic_msgs.msg import DiagnosticArray

        start_node()
        import rospy

        self._lock = threading.Lock()
        self._reports: dict[str, Any] = {}
        self._began = time.monotonic()
        self._silent: dict[str, str] = {}
        self._subscriber = rospy.Subscriber(DIAGNOSTICS, DiagnosticArray, self._on_array)

    def _on_array(self, message: Any) -> None:
        """Called from a thread of ROS."""
        with self._lock:
            self._reports.update((status.name, status) for status in message.status)

    def silent(self, address: str) -> str:
        """What a node told, by the time of `result`, of a robot that does not answer for the moment; else empty."""
        return self._silent.get(address, "")

    def result(self) -> dict[str, Any]:
        """Counts by level, and the reports that are not ok."""
        threading.Event().wait(max(0.0, self._began + DIAGNOSTICS_TIME - time.monotonic()))
        self._subscriber.unregister()
        with self._lock:
            reports = list(self._reports.values())
        level = [LEVELS[_level_number(status.level) % len(LEVELS)] for status in reports]
        counts = {name: level.count(name) for name in LEVELS}
        problems = [
            {"name": status.name, "level": name, "message": status.message}
            for status, name in sorted(zip(reports, level), key=lambda pair: pair[0].name)
            if name != LEVELS[0]
        ]
        self._silent = silent_robots(reports)
        return {**counts, "problems": problems}


def silent_robots(reports: Iterable[Any]) -> dict[str, str]:
    """Address -> what a node reports of the robot there, of those that do not answer for the moment."""
    from ...core.health import SILENT

    told = [({each.key: each.value for each in status.values}, status.message) for status in reports]
    return {values["address"]: text for values, text in told if values.get("state") == SILENT and "address" in values}


def _level_number(level: Any) -> int:
    return level[0] if isinstance(level, bytes) else int(level)


def status_lines(found: Mapping[str, Any]) -> Iterator[str]:
    from ...ros.master_api import PART_OF

    stiffness = found["stiffness"]
    reached = "SILENT" if found["silent"] else "connected" if found["connected"] else "NOT REACHED"
    rows = [
        ("robot", f"{found['robot']} at {found['address']}, {reached}"),
        ("master", found["master"]),
    ]
    if found["battery"] is not None:
        rows.append(("battery", f"{found['battery']:.0%}"))
    if found["posture"] is not None:
        rows.append(("posture", f"{found['posture']}, {'awake' if found['awake'] else 'at rest'}"))
    if stiffness is not None:
        rows.append(
            ("stiffness", f"{stiffness['stiff']} of {stiffness['joints']} joints, mean {stiffness['mean']:.2f}")
        )
    if found["silent"]:
        rows.append(("", found["silent"]))
    if found.get("problem"):
        rows.append(("problem", found["problem"]))
    yield from table(rows)
    yield "servers"
    yield from table([(name, _does(server)) for name, server in found["servers"].items()], "  ")
    if found["nodes"]:
        yield f"driver (rosservice call PART{PART_OF}NODE tells what a part has in ROS)"
        yield from table([(node, ", ".join(parts)) for node, parts in found["nodes"].items()], "  ")
    reports = found["diagnostics"]
    yield "diagnostics: " + ", ".join(
        f"{reports[level]} {level}" for level in LEVELS if reports[level] or level == "ok"
    )
    alike: dict[tuple[str, str], list[str]] = {}
    for problem in reports["problems"]:
        alike.setdefault((problem["level"], problem["message"]), []).append(problem["name"])
    for (level, message), names in alike.items():
        yield f"  {level}: {names[0] if len(names) == 1 else f'{len(names)} reports'}: {message}"


def _does(server: Mapping[str, Any]) -> str:
    if not server["up"]:
        return f"DOWN: {server['problem']}"
    running = server["running"]
    text = f"{server['index'] + 1}/{len(running)} {running[server['index']]}" if running else "idle"
    return text if server["connected"] else f"{text}, without a robot"


# --- nao list and help ------------------------------------------------------------------------------------------------

INDENT = "  "


@click.command(cls=NaoCommand, name="status")
@click.pass_context
def status_command(context: click.Context) -> None:
    """Robot, battery, posture, servers, goals that run, and what is wrong.

    The exit status is 3 if the robot cannot be reached.
    """
    settings = settings_of(context)
    found = read_status(settings.stack)
    if settings.json:
        say_json(found)
    else:
        say_lines(status_lines(found))
    if not found["connected"]:
        raise StackMissing(f"the robot at {found['address']} cannot be reached")


@click.command(cls=NaoCommand, name="list")
@click.argument("server", default="", shell_complete=completion.servers)
@click.option("--all", "shared", is_flag=True, help="Also the functions that every server has.")
@click.pass_context
def list_command(context: click.Context, server: str, shared: bool) -> None:
    """The servers, or the functions of SERVER."""
    settings = settings_of(context)
    if not server:
        servers = described_servers(settings, brief=True)
        if settings.json:
            say_json([{"name": name, "help": told.help, "action": told.action} for name, told in servers])
        else:
            say_lines(table([(name, told.help) for name, told in servers]))
        return
    (_, told), *_ = described_servers(settings, server=server, names=not settings.json)
    functions = [function for function in told.functions if shared or not function.shared]
    if settings.json:
        say_json(functions)
    else:
        say_lines(table([(function.name, function.help) for function in functions]))


@click.command(cls=NaoCommand, name="help")
@click.argument("name", shell_complete=completion.all_functions)
@click.argument("function", default="")
@click.pass_context
def help_command(context: click.Context, name: str, function: str) -> None:
    """What the function NAME does and takes, in all servers; or the server NAME, or its FUNCTION.

    Without a running stack it tells what can be told from the code.
    """
    settings = settings_of(context)
    wanted = function or name
    found = _find(settings, wanted, name if function else "")
    if not found:
        _help_server(settings, name, function)
        return
    if all(described.shared for _, _, described in found):
        found = found[:1]  # every server has it
    if settings.json:
        say_json([{"server": server, **plain(described)} for server, _, described in found])
        return
    for number, (server, told, described) in enumerate(found):
        if number:
            click.echo()
        say_lines(function_lines(server, told, described))


def _find(settings: CliSettings, function: str, server: str) -> list[tuple[str, Any, Any]]:
    """Functions of a name: the server of each, what that says about itself, and the description."""
    found = []
    for name, told in described_servers(settings, server=server, names=True):
        for candidate in told.functions:
            if candidate.name.lower() == function.lower():
                found.append((name, candidate.name))
    told = {name: dict(described_servers(settings, name, functions=(exact,)))[name] for name, exact in found}
    return [(name, told[name], next(f for f in told[name].functions if f.name == exact)) for name, exact in found]


def described_servers(
    settings: CliSettings, server: str = "", functions: Sequence[str] = (), brief: bool = False, names: bool = False
) -> list[tuple[str, Any]]:
    """Servers with what they say about themselves, see `Stack.describe`; where none runs, what the code says.

    `server`: only this one; all without. Raises click.UsageError if there is no such server.
    """
    try:
        stack = settings.stack
        if server:
            name = stack.server(server)[len(stack.namespace) :]
            return [(name, stack.describe(name, functions, brief, names))]
        told_before, found = stack.silent, stack.described(functions, brief, names)
        if stack.silent != told_before:
            click.echo(f"does not answer: {', '.join(stack.silent)}", err=True)
        return found
    except StackMissing as missing:
        if settings.namespace is not None:
            raise
        if not settings.described_offline:
            click.echo(f"{missing.message}\nthis is what the code says:", err=True)
            settings.described_offline = True
        return described_by_code(server, functions, brief, names)


def _help_server(settings: CliSettings, name: str, function: str) -> None:
    """Help for a server; or what looks like a name that is not there.

    Raises click.UsageError if there is neither a function nor a server of that name.
    """
    servers = described_servers(settings, names=True)
    known = [name for name, _ in servers]
    functions = list(dict.fromkeys(f.name for _, told in servers for f in told.functions))
    wanted = function or name
    server = [(n, told) for n, told in servers if same_server(n, name)]
    if function or not server:
        hint = did_you_mean(wanted, [*functions, *known]) or ": `nao list` tells the servers"
        raise click.UsageError(f"there is no function {wanted!r}{hint}")
    (found, told), *_ = server
    if settings.json:
        (_, told), *_ = described_servers(settings, found)
        say_json({"server": found, "help": told.help, "functions": told.functions})
        return
    click.echo(f"{found}: {told.help}")
    rows = [(f.name, f.help) for f in told.functions if not f.shared]
    say_lines(table(rows, INDENT))
    click.echo(f"{INDENT}and those of the robot's memory: {', '.join(f.name for f in told.functions if f.shared)}")


def function_lines(server: str, told: Any, function: Any) -> Iterable[str]:
    """Help for one function."""
    yield f"{server} {function.name}: {function.help}"
    if function.answers != "nothing":
        yield f"{INDENT}answers: {function.answers}"
    for argument in [*function.arguments, *told.common]:
        unit = f" {argument.unit}" if argument.unit else ""
        yield f"{INDENT}{argument.name} ({argument.type}){unit}, {argument.default or '{}'}"
        yield f"{INDENT * 2}{argument.help}"
        if argument.allowed:
            yield f"{INDENT * 2}allowed: {argument.allowed}"
        if argument.choices and not all(word in argument.allowed for word in argument.choices):
            yield f"{INDENT * 2}here: {', '.join(argument.choices)}"
    yield f"{INDENT}nao call {server} {function.name}{''.join(f' {a.name}:=...' for a in function.arguments)}"


# --- nao call ---------------------------------------------------------------------------------------------------------


class _CallCommand(SignedCommand):
    words = NEXT

    def instead_of(self, option: str, known: Sequence[str]) -> list[str]:
        """As every command has it; what is no option may be meant for a field."""
        return super().instead_of(option, known) or [f"{option.lstrip('-')}:=VALUE"]


@click.command(cls=_CallCommand, name="call")
@click.argument("server", shell_complete=completion.servers)
@click.argument("chain", nargs=-1, required=True, shell_complete=completion.chain, metavar="FUNCTION [field:=value]...")
@click.option("--dry-run", is_flag=True, help="Only have the server check it: nothing is done, what runs goes on.")
@click.pass_context
def call_command(context: click.Context, server: str, chain: tuple[str, ...], dry_run: bool) -> None:
    """Call functions of SERVER as one goal.

    Several have a comma or --then between them. Lists are values with commas between them; `nao help FUNCTION` tells
    the fields.

    nao call NaoLights setIntensity lights:=Brain0,Brain1 i_values:=0.5 time:=2 , off lights:=Brain0
    """
    settings = settings_of(context)
    typed = read_chain(chain)
    told = settings.stack.describe(server, functions=[function.name for function in typed])
    _require_not_elsewhere(settings, server, told.unknown)
    kind = message_class(told.message)
    common = [argument.name for argument in told.common]
    taken = {each.name: [*(argument.name for argument in each.arguments), *common] for each in told.functions}
    functions = [build_message(function, kind, taken.get(function.name, ())) for function in typed]
    _tell_of_unread(typed, taken)
    if dry_run:
        _tell_dry_run(settings, server, functions)
    else:
        carry_out(settings, server, functions)


def _tell_dry_run(settings: CliSettings, server: str, functions: Sequence[Any]) -> None:
    """Print what a server says of a goal.

    Raises CommandFailed if it could not be carried out, or the server does not say.
    """
    from ...core.describe import NotValidated

    goal = message_class(f"{settings.stack.describe(server, brief=True).action}Goal")
    try:
        check = settings.stack.check(server, [goal(list(functions))])
    except NotValidated as error:
        raise CommandFailed(f"{server} did not check the goal: {error}") from None
    if settings.json:
        told = {"problems": check.problems, "unchecked": check.unchecked}
        say_json({name: [vars(each) for each in problems] for name, problems in told.items()})
    for problem in check.problems:
        click.echo(str(problem), err=True)
    if check.problems:
        raise CommandFailed("it cannot be done")
    if not settings.json:
        for each in check.unchecked:
            click.echo(f"not known: {each}")
        click.echo("nothing wrong was found" if check.unchecked else "it can be done")


def _tell_of_unread(typed: Sequence[TypedFunction], taken: Mapping[str, Sequence[str]]) -> None:
    """Warn of fields that a function does not read: what was meant by them is not done."""
    for function in typed:
        reads = taken.get(function.name, function.fields)
        unread = [field for field in function.fields if field not in reads]
        if unread:
            click.echo(f"{function.name} does not read {', '.join(unread)}; it reads {', '.join(reads)}", err=True)


def _require_not_elsewhere(settings: CliSettings, server: str, unknown: Sequence[str]) -> None:
    """See that no function that a server does not know is one of another; of what nobody knows, the server tells.

    Raises click.UsageError if it is; the text names the servers that have it.
    """
    for name in unknown:
        others = [other for other, told in described_by_code(functions=[name], names=True) if not told.unknown]
        if others:
            own = settings.stack.server(server).rpartition("/")[2]
            have = "has" if len(others) == 1 else "have"
            raise click.UsageError(f"{own} has no function {name}; {', '.join(others)} {have}")
