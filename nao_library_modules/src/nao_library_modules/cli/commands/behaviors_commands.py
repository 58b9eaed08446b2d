"""`nao run`, `behaviors`, `check` and `sweep`: stored behaviours, checked, run once or many times.

Where no server for behaviours runs, one is checked in this process. Values of what is swept are typed as `0..2`,
`0..2:0.5`, `0,1,4`, or several of these with commas between.
"""

from __future__ import annotations

import itertools
import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Any

import click

from ...core.errors import did_you_mean
from .. import completion
from ..chain_text import Number
from ..cli_settings import CliSettings, NaoCommand, SignedCommand, settings_of
from ..goals import carry_out, function_message
from ..output import CommandFailed, StackMissing, overwrite_option, plain, say_json, say_lines, table, wanted_file
from ..stack import Stack

if TYPE_CHECKING:
    from nao_library_msgs.srv import DescribeFunctionsResponse


def check_offline(stack: Stack, request: Any) -> Any:
    """What `NaoBehavior/list` would answer; behaviours of the user are those in the usual folder."""
    from nao_library_msgs.srv import ListBehaviorsResponse

    from ...behaviors import BehaviorStore, read
    from ...behaviors.behavior_functions import info_message
    from ...behaviors.checking import preview_facts
    from ...behaviors.server import PARAMETERS, SHIPPED
    from ...behaviors.server_functions import FunctionTables
    from ...core.files import config_file

    store = BehaviorStore(Path(PARAMETERS["behavior_dir"]).expanduser(), config_file(SHIPPED))
    name = PurePath(request.file).stem if request.text else request.name
    load = (lambda: read(request.text, name, request.file)) if request.text else (lambda: store.load(name))
    tables = FunctionTables(partial(_describe, stack), partial(_running, stack))
    facts = preview_facts(name, load, store.load, tables, request.parameters, stack.check)
    return ListBehaviorsResponse([info_message(facts, shipped=False)])


def _describe(stack: Stack, server: str, functions: Sequence[str] | None) -> DescribeFunctionsResponse:
    from ...behaviors.server_functions import NotDescribed

    try:
        return stack.describe(server, functions or (), brief=functions is None, names=not functions)
    except click.ClickException as error:
        raise NotDescribed(error.message) from None


def _running(stack: Stack) -> list[str]:
    try:
        return stack.servers()
    except click.ClickException:
        return []


# --- nao run, behaviors and check -------------------------------------------------------------------------------------

SERVER = "NaoBehavior"
SUFFIX = ".yaml"


def _the_stored(settings: CliSettings, name: str) -> dict[str, Any]:
    """The stored behaviour of a name, as plain values. Raises CommandFailed if there is none."""
    found = settings.stack.behaviors(name)
    if not found:
        known = [behavior["name"] for behavior in settings.stack.behaviors()]
        hint = _file_of(name) or did_you_mean(name, known)
        raise CommandFailed(f"there is no behaviour {name!r}{hint}; there are {', '.join(known)}")
    return found[0]


def _file_of(name: str) -> str:
    """A hint to the file that is beside the user and called like a behaviour; nothing where there is none."""
    return f": did you mean the file {name + SUFFIX}?" if Path(name + SUFFIX).is_file() else ""


@click.command(cls=NaoCommand, name="run")
@click.argument("name", metavar="NAME|FILE", shell_complete=completion.behaviors)
@click.argument("parameters", nargs=-1, shell_complete=completion.parameters, metavar="[PARAMETER=VALUE]...")
@click.pass_context
def run_command(context: click.Context, name: str, parameters: tuple[str, ...]) -> None:
    """Run a behaviour, stored as NAME or in a FILE (.yaml). `nao behaviors NAME` tells its parameters.

    All of it is checked before anything moves, as `nao check` does.
    """
    assigned(parameters)  # one that is none is a mistake in the command, whatever the server says
    settings = settings_of(context)
    of_file = name.endswith(SUFFIX)
    if not of_file and _file_of(name):
        _the_stored(settings, name)
    which = {"text": text_of(name), "file": name} if of_file else {"str_param": name}
    message = function_message(settings, SERVER, function="runBehavior", parameters=list(parameters), **which)
    end = carry_out(settings, SERVER, [message], quiet=True)
    if not settings.json:
        from ...behaviors.behavior_errors import place

        # A behaviour goes on after steps that may fail; progress has told of the others.
        for step in end.result.get("steps", []):
            if step["error"]:
                told = f"{step['path']} {step['what']} {step['state']}: {step['error']}"
                click.echo(place(step["file"], step["line"]) + told, err=True)


@click.command(cls=NaoCommand, name="behaviors")
@click.argument("name", default="", shell_complete=completion.behaviors)
@click.pass_context
def behaviors_command(context: click.Context, name: str) -> None:
    """The stored behaviours; of one, all there is to know: its parameters, what it does, what it needs."""
    settings = settings_of(context)
    found = [_the_stored(settings, name)] if name else settings.stack.behaviors()
    if settings.json:
        say_json(found)
    elif name:
        say_lines(_lines_of(found[0], {}))
    else:
        say_lines(table([(each["name"], each["problem"] or each["help"].partition(". ")[0]) for each in found]))


@click.command(cls=NaoCommand, name="check")
@click.argument("what", metavar="NAME|FILE", shell_complete=completion.behaviors)
@click.argument("parameters", nargs=-1, metavar="[PARAMETER=VALUE]...")
@click.pass_context
def check_command(context: click.Context, what: str, parameters: tuple[str, ...]) -> None:
    """Whether a behaviour can be run, stored as NAME or in a FILE (.yaml), and what it would do.

    The servers check their goals, and carry none of them out; what runs goes on. Servers that are not there are told,
    and their goals compared with what every NAO has.
    """
    from nao_library_msgs.srv import ListBehaviorsRequest

    values = assigned(parameters)
    settings = settings_of(context)
    of_file = what.endswith(SUFFIX)
    which = {"text": text_of(what), "file": what} if of_file else {"name": what}
    request = ListBehaviorsRequest(parameters=list(parameters), validate=True, **which)
    try:
        # The servers of its goals are asked in turn, and have their time each.
        answer = settings.stack.list_behaviors(request, patient=True)
    except StackMissing:
        answer = check_offline(settings.stack, request)
    found = plain(answer)["behaviors"]
    checked = found[0] if found else _the_stored(settings, what)
    problems = problems_of(checked)
    if settings.json:
        say_json({**checked, "problems": problems})
    elif not problems:
        say_lines(_lines_of(checked, values))
    for problem in problems:
        click.echo(problem, err=True)
    if problems:
        raise CommandFailed(f"{what} cannot be run{'' if of_file else _file_of(what)}")
    if not settings.json:
        _tell_unvalidated(checked["unvalidated"])


def problems_of(checked: Mapping[str, Any]) -> list[str]:
    """What is wrong with a behaviour that was checked, a line each."""
    from ...behaviors.behavior_errors import Problem

    problems = [str(Problem(**problem)) for problem in checked["problems"]]
    return problems or list(filter(None, [checked["problem"]]))


def _tell_unvalidated(servers: Sequence[str]) -> None:
    if not servers:
        click.echo("it can be run")
        return
    click.echo("  not checked by their servers, only compared with what every NAO has")
    of_reason: dict[str, list[str]] = {}
    for server in servers:
        name, _, reason = server.partition(": ")
        of_reason.setdefault(reason, []).append(name)
    for reason, names in of_reason.items():
        click.echo(f"    {', '.join(names)}: {reason}")
    click.echo("nothing wrong was found")


def text_of(file: str) -> str:
    """What a file has. Raises click.UsageError if it cannot be read."""
    try:
        return Path(file).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is no text"
        raise click.UsageError(f"{file} cannot be read: {reason}") from None


def assigned(parameters: Sequence[str]) -> dict[str, str]:
    """Name -> value of `PARAMETER=VALUE`. Raises click.UsageError if one is no assignment."""
    values = {}
    for parameter in parameters:
        name, equals, value = parameter.partition("=")
        if not equals:
            raise click.UsageError(f"{parameter!r} is no PARAMETER=VALUE")
        values[name.strip()] = value
    return values


def _lines_of(behavior: dict[str, Any], values: Mapping[str, str]) -> Iterator[str]:
    """All there is to know about a behaviour. `values`: of parameters, where not their defaults."""
    yield f"{behavior['name']}: {behavior['problem'] or behavior['help']}"
    rows = []
    for parameter in behavior["parameters"]:
        unit = f" {parameter['unit']}" if parameter["unit"] else ""
        choices = f"; one of {', '.join(parameter['choices'])}" if parameter["choices"] else ""
        value = values.get(parameter["name"], parameter["default"])
        rows.append((f"{parameter['name']}={value}{unit}", parameter["help"] + choices))
    yield from table(rows, indent="  ")
    told = {
        "tags": ", ".join(behavior["tags"]),
        "servers": ", ".join(behavior["servers"]),
        "boxes": ", ".join(behavior["boxes"]),
        "waits": f"{behavior['waits']:g} s, besides what its goals take" if behavior["waits"] else "",
    }
    yield from table([(name, text) for name, text in told.items() if text], indent="  ")
    if behavior["steps"]:
        yield "  steps"
    yield from (f"    {step}" for step in behavior["steps"])
    if behavior["unchecked"]:
        yield "  not known until they run, as it depends on the robot then; or wrong, and skipped as on_error says"
    yield from (f"    {function}" for function in behavior["unchecked"])


# --- ranges of what is swept ------------------------------------------------------------------------------------------

MOST = 10000
"""Values of one range."""
ROUNDING = 10
"""Decimal places: 0..1:0.1 has 0.3, not 0.30000000000000004."""
FORMS = "numbers with commas between, FROM..TO, or FROM..TO:STEP"


def read_values(text: str) -> list[float]:
    """The numbers of a range, both ends with it where the steps meet the second. Raises ValueError if it is none."""
    values: list[float] = []
    for part in text.split(","):
        first, dots, rest = part.partition("..")
        last, colon, step = rest.partition(":")
        start = _number(first, part)
        values += _steps(start, _number(last, part), _number(step, part) if colon else 1.0, part) if dots else [start]
    again = next((value for value, count in Counter(values).items() if count > 1), None)
    if again is not None:
        raise ValueError(f"{again:g} is there twice")
    return values


def _steps(start: float, end: float, step: float, text: str) -> list[float]:
    if not step > 0.0 or end < start:
        raise ValueError(f"{text!r} goes nowhere: FROM is the lower end, and STEP is above 0")
    count = math.floor((end - start) / step + 1e-9) + 1
    if count > MOST:
        raise ValueError(f"{text!r} are {count} values, more than {MOST}")
    return [round(start + number * step, ROUNDING) for number in range(count)]


def _number(text: str, part: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise ValueError(f"{part!r} is no range: {FORMS}")
    return number


class Values(click.ParamType):
    """Numbers that are swept; [float]."""

    name = "values"

    def convert(self, value: Any, parameter: click.Parameter | None, context: click.Context | None) -> list[Any]:
        if not isinstance(value, str):
            return value
        try:
            return self.read(value)
        except ValueError as error:
            self.fail(str(error), parameter, context)

    def read(self, text: str) -> list[Any]:
        return read_values(text)


class Seeds(Values):
    """So many seeds from 0 on, or which ones as a range with `..` or a comma; [int]."""

    name = "seeds"

    def read(self, text: str) -> list[Any]:
        values = list(range(int(text))) if text.isdigit() else read_values(text)
        wrong = next((seed for seed in values if seed != int(seed) or seed < 0), None)
        if wrong is not None or not values:
            told = "no seeds" if wrong is None else f"{wrong:g} is no seed"
            raise ValueError(f"{told}: how many, 1 or more, or whole numbers from 0 on as 100..199")
        return list(map(int, values))


# --- nao sweep --------------------------------------------------------------------------------------------------------

PROGRAM = ".py"
SUCCEEDED = "succeeded"
FIGURES = ("png", "pdf", "svg")
VARIED = ("push", "noise", "payload", "delay")
RAY = ".venv/bin/python -m pip install 'ray>=2.10' tqdm matplotlib 'numpy<2'"
"""What brings what sweeps need and the stack does not."""


def _swept(name: str, text: str) -> Any:
    return click.option(f"--{name}", type=Values(), metavar="VALUES", help=text)


@click.command(cls=SignedCommand, name="sweep")
@click.argument("name", metavar="NAME|FILE", shell_complete=completion.behaviors)
@click.argument("words", nargs=-1, shell_complete=completion.parameters, metavar="[PARAMETER=VALUE]...")
@click.option("--seeds", type=Seeds(), default="20", show_default=True, metavar="N|A..B", help="How many, or which.")
@_swept("push", "N s on the torso, at a moment and into a direction that the seed says.")
@_swept("noise", "Errors of the sensors: 0 none, 1 as those of a real robot.")
@_swept("payload", "kg that the torso carries besides its own.")
@_swept("delay", "How late sensors arrive, s.")
@click.option("--world", default="empty", show_default=True, help="Of the simulated robot.")
@click.option("--posture", default="", metavar="NAME", help="It begins in.  [default: crouching, motors off]")
@click.option("--speed", type=float, default=0.0, show_default=True, help="Over real time; 0: as fast as possible.")
@click.option("--limit", type=Number("duration"), default=300.0, show_default=True, metavar="S", help="For one run.")
@click.option("--workers", type=click.IntRange(0), metavar="N", help="Without: as many as have a processor and memory.")
@click.option("--address", metavar="URL", help='Of a Ray cluster that does it: "auto", ray://HOST:10001.')
@click.option("--output", type=click.Path(), metavar="FILE.csv", help="A row for each run; there already: goes on.")
@click.option("--plot", default="", type=click.Path(), metavar="FILE.png", help="The rates as a picture.")
@overwrite_option
@click.pass_context
def sweep_command(
    context: click.Context, name: str, words: tuple[str, ...], plot: str, overwrite: bool, **options: Any
) -> None:
    """How often it falls: runs a behaviour, stored as NAME or in a FILE (.yaml), or the program of a plan (.py).

    Each worker has a simulated robot of its own. VALUES are 0,1,2 or 0..2 or 0..2:0.5; a PARAMETER that is there
    several times has each of its values in turn. What stands behind a program are its arguments.
    """
    settings = settings_of(context)
    picture = wanted_file(plot, overwrite, FIGURES)
    subject, parameters = _subject(settings, name, words)
    from nao_sim_bridge.base.errors import SimulationError

    from ...sweeps import sweep_stack

    launch = {key: str(options.pop(key)) for key in ("world", "speed")}
    options = {key: value or () if key in VARIED else value for key, value in options.items()}
    try:
        table = sweep_stack(subject, parameters=parameters, launch=launch, progress=not settings.json, **options)
        if picture is not None and _rates(table):
            table.plot(picture, "fell")
    except ImportError as error:
        raise CommandFailed(f"{error}: {RAY}") from None
    except (SimulationError, ValueError, ConnectionError) as error:
        raise CommandFailed(str(error)) from None
    if settings.json:
        say_json({"rates": [vars(rate) for rate in _rates(table)], "rows": table.rows})
    else:
        click.echo(table.text(*(["fell"] if _rates(table) else [])))
        ends = Counter(row["outcome"] for row in table.rows if row.get("outcome"))
        if set(ends) - {SUCCEEDED}:
            click.echo(", ".join(f"{count} {end}" for end, count in ends.most_common()))
    if not _rates(table):
        raise CommandFailed("no run came to an end")


def _rates(table: Any) -> Sequence[Any]:
    return table.rates("fell") if "fell" in table.results else ()


def _subject(settings: CliSettings, name: str, words: Sequence[str]) -> tuple[Any, Mapping[str, Sequence[str]]]:
    """What is swept, and values of its parameters. Raises CommandFailed if it cannot be run."""
    from ...sweeps import BehaviorGoal, PlanProgram

    if name.endswith(PROGRAM):
        if not Path(name).is_file():
            raise CommandFailed(f"there is no program {name}")
        return PlanProgram(Path(name).absolute(), words), {}
    parameters: dict[str, list[str]] = {}
    for word in words:
        for parameter, value in assigned([word]).items():
            parameters.setdefault(parameter, []).append(value)
    goal = BehaviorGoal(text=text_of(name), file=name) if name.endswith(SUFFIX) else BehaviorGoal(name)
    _check(settings, goal, parameters)
    return goal, parameters


def _check(settings: CliSettings, goal: Any, parameters: Mapping[str, Sequence[str]]) -> None:
    """Refuse a behaviour that could not be run, before there is a robot that tells so in each run."""
    from nao_library_msgs.srv import ListBehaviorsRequest

    for values in itertools.product(*parameters.values()):
        given = [f"{name}={value}" for name, value in zip(parameters, values)]
        request = ListBehaviorsRequest(name=goal.name, text=goal.text, file=goal.file, parameters=given, validate=True)
        (checked,) = plain(check_offline(settings.stack, request))["behaviors"]
        problems = problems_of(checked)
        if problems:
            raise CommandFailed("\n".join(problems))
