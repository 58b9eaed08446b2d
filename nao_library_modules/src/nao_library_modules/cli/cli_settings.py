"""Options that commands have, and what they are for this run of the program; the kinds of commands.

`--qi-url` is of commands that reach the robot past the servers.
"""

from __future__ import annotations

import difflib
import functools
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import click

from ..core.errors import did_you_mean, of_those
from .chain_text import Number
from .stack import Stack

QUICK = 1.0
"""s that completion waits for an answer at most; a server that is not busy takes a hundredth of it."""


@dataclass
class CliSettings:
    """Of one run."""

    json: bool = False  # whether answers are JSON
    namespace: str | None = None  # of the robot; None: none was chosen
    timeout: float | None = None  # s of this computer that a goal may take; None for ever
    completing: bool = False  # whether the shell asks how a word can go on
    described_offline: bool = False  # whether it was told that the answers come from the code
    _stack: Stack | None = field(default=None, repr=False)

    @property
    def stack(self) -> Stack:
        """The servers of the robot."""
        if self._stack is None:
            self._stack = Stack(self.namespace, QUICK) if self.completing else Stack(self.namespace)
        return self._stack


def settings_of(context: click.Context) -> CliSettings:
    """The settings of a run, made when they are asked for first."""
    return context.ensure_object(CliSettings)


def quietly(offer: Callable[..., Iterable[str]]) -> Callable[..., list[str]]:
    """An offer of words, as click asks for it, that fails in silence and is narrowed to what was begun.

    `offer`: takes the settings, what was begun, and the arguments of the command that are there.
    """

    @functools.wraps(offer)
    def run(context: click.Context, _parameter: click.Parameter | None, start: str) -> list[str]:
        settings = settings_of(context)
        settings.completing = True
        try:
            words = list(offer(settings, start, context.params))
        except Exception:  # an error text would end up in the line that is being typed
            return []
        return [word for word in words if word.startswith(start)]

    return run


@quietly
def robots(settings: CliSettings, *_: Any) -> list[str]:
    return [name.strip("/") or "/" for name in settings.stack.robots()]


def _keep(context: click.Context, parameter: click.Parameter, value: Any) -> None:
    # Standing behind the command as well as before it; what is not given here must not hide what was given there.
    if value is not None and value is not False:
        setattr(settings_of(context), parameter.human_readable_name, value)


def common_options() -> list[click.Option]:
    """The options, made anew for each command."""
    return [
        click.Option(
            ["--robot", "-n", "namespace"],
            metavar="NAME",
            help="Namespace of the robot, where there are several.",
            callback=_keep,
            expose_value=False,
            shell_complete=robots,
        ),
        click.Option(["--json"], is_flag=True, help="Answer in JSON.", callback=_keep, expose_value=False),
        click.Option(
            ["--timeout"],
            type=Number("duration"),
            metavar="S",
            help="Give up after so many seconds; a goal is cancelled then.",
            callback=_keep,
            expose_value=False,
        ),
    ]


class OneOf(click.Choice):
    """One of several words; another one is told with those that look like it."""

    def convert(self, value: Any, parameter: click.Parameter | None, context: click.Context | None) -> Any:
        if value not in self.choices:
            self.fail(f"there is no {value!r}{of_those(str(value), map(str, self.choices))}", parameter, context)
        return super().convert(value, parameter, context)


LENGTHS = ("--duration", "--time", "--seconds")
ELSEWHERE = {**dict.fromkeys(LENGTHS, "--for"), "--fps": "--rate", "--frequency": "--rate", "--force": "--overwrite"}
"""Options that other programs have -> what they are called here."""


class NaoCommand(click.Command):
    """A command with the options that every command has."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self.params.extend(common_options())

    def parse_args(self, context: click.Context, args: list[str]) -> list[str]:
        """As click does; an option that there is not is told with what it may be called here."""
        try:
            return super().parse_args(context, args)
        except click.NoSuchOption as error:
            known = [name for parameter in self.get_params(context) for name in parameter.opts]
            error.possibilities = self.instead_of(error.option_name, known)
            raise

    def instead_of(self, option: str, known: Sequence[str]) -> list[str]:
        """What an option that there is not may be called here."""
        here = ELSEWHERE.get(option)
        return [here] if here in known else difflib.get_close_matches(option, known, cutoff=0.7)


class SignedCommand(NaoCommand):
    """A command whose arguments may begin with a minus sign, as numbers do; with two it is an option all the same."""

    ignore_unknown_options = True
    words: tuple[str, ...] = ()
    """Arguments that look like options."""

    def parse_args(self, context: click.Context, args: list[str]) -> list[str]:
        """As click does, but for options that there are not."""
        known = {name for parameter in self.get_params(context) for name in parameter.opts}
        options = args[: args.index("--")] if "--" in args else args
        for word in options:
            name = word.partition("=")[0]
            if name.startswith("--") and name not in known and name not in self.words:
                raise click.NoSuchOption(name, possibilities=self.instead_of(name, list(known)), ctx=context)
        return super().parse_args(context, args)


class NaoGroup(click.Group):
    """Commands that are told apart from options by their first letter alone."""

    command_class = NaoCommand

    def instead_of(self, word: str) -> str:
        """Text to append to "there is no command ...": what does what the word says; empty if nothing is known."""
        return ""

    def resolve_command(self, context: click.Context, arguments: list[str]) -> Any:
        """As click does; a word that is no command is told with those that look like it."""
        word, known = arguments[0], self.list_commands(context)
        # Click takes "*" for an option, too, and shows the help as if it had been asked for.
        if word not in known and (word == "-" or not word.startswith("-")):
            context.fail(f"there is no command {word!r}{self.instead_of(word) or did_you_mean(word, known)}")
        return super().resolve_command(context, arguments)


# --- past the servers -------------------------------------------------------------------------------------------------

URL = re.compile(r"(?:tcp://)?(?P<ip>[^:/]+)(?::(?P<port>\d+))?")
PORT = 9559

url_option = click.option(
    "--qi-url", "url", metavar="URL", help="tcp://IP:PORT of the robot, without ROS; else that of the servers."
)


def address_of(settings: CliSettings, url: str | None) -> tuple[str, int]:
    """IP and port of the robot; a UsageError when the URL is none."""
    if url is None:
        return settings.stack.robot_address()
    found = URL.fullmatch(url)
    if found is None:
        raise click.UsageError(f"--qi-url is {url!r}, allowed is tcp://IP:PORT")
    return found["ip"], int(found["port"] or PORT)
