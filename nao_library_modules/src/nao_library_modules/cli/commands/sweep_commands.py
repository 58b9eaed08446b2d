"""`nao sweep`: how often a behaviour or a plan falls."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import click

from .. import completion
from ..chain_text import Number
from ..errors import CommandFailed
from ..files import overwrite_option, wanted_file
from ..output import plain, say_json
from ..settings import CliSettings, SignedCommand, settings_of
from ..value_ranges import Seeds, Values
from .behaviors_commands import SUFFIX, assigned, problems_of, text_of

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

    from ..offline_check import check_offline

    for values in itertools.product(*parameters.values()):
        given = [f"{name}={value}" for name, value in zip(parameters, values)]
        request = ListBehaviorsRequest(name=goal.name, text=goal.text, file=goal.file, parameters=given, validate=True)
        (checked,) = plain(check_offline(settings.stack, request))["behaviors"]
        problems = problems_of(checked)
        if problems:
            raise CommandFailed("\n".join(problems))
