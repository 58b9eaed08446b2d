"""Options that every command has, and their values in this run."""

from __future__ import annotations

import difflib
import functools
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import click

from .chain_text import Number
from .stack import Stack

QUICK = 1.0
"""s that completion waits for an answer at most; a server that is not busy takes a hundredth of it."""


@dataclass
class CliSettings:
    """Options of one run.

    Attributes:
        namespace: Of the robot; None: none was chosen.
        timeout: s of this computer that a goal may take; None for ever.
        completing: The shell asks for completions.
        described_offline: The user has been told that the answers come from the code.
    """

    json: bool = False
    namespace: str | None = None
    timeout: float | None = None
    completing: bool = False
    described_offline: bool = False
    _stack: Stack | None = field(default=None, repr=False)

    @property
    def stack(self) -> Stack:
        if self._stack is None:
            self._stack = Stack(self.namespace, QUICK) if self.completing else Stack(self.namespace)
        return self._stack


def settings_of(context: click.Context) -> CliSettings:
    """The settings of a run, created on first use."""
    return context.ensure_object(CliSettings)


def quietly(offer: Callable[..., Iterable[str]]) -> Callable[..., list[str]]:
    """Decorate a completion: it fails silently and keeps only words that start with what was typed."""

    @functools.wraps(offer)
    def run(context: click.Context, start: str, *more: Any) -> list[str]:
        settings = settings_of(context)
        settings.completing = True
        try:
            words = list(offer(settings, start, *more))
        except Exception:  # an error text would appear in the line that is being typed
            return []
        return [word for word in words if word.startswith(start)]

    return run


@quietly
def robots(settings: CliSettings, start: str) -> list[str]:
    return [name.strip("/") or "/" for name in settings.stack.robots()]


def _keep(context: click.Context, parameter: click.Parameter, value: Any) -> None:
    # Accepted before and after the command; an option that is not given here must not hide one that was given there.
    if value is not None and value is not False:
        setattr(settings_of(context), parameter.human_readable_name, value)


def _complete_robot(context: click.Context, _parameter: click.Parameter, start: str) -> list[str]:
    return robots(context, start)


def common_options() -> list[click.Option]:
    """New option objects, for one command."""
    return [
        click.Option(
            ["--robot", "-n", "namespace"],
            metavar="NAME",
            help="Namespace of the robot, where there are several.",
            callback=_keep,
            expose_value=False,
            shell_complete=_complete_robot,
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
    """One of several words; the error for another word suggests similar ones."""

    def convert(self, value: Any, parameter: click.Parameter | None, context: click.Context | None) -> Any:
        from ..base.suggestion import of_those

        if value not in self.choices:
            self.fail(f"there is no {value!r}{of_those(str(value), map(str, self.choices))}", parameter, context)
        return super().convert(value, parameter, context)


LENGTHS = ("--duration", "--time", "--seconds")
ELSEWHERE = {**dict.fromkeys(LENGTHS, "--for"), "--fps": "--rate", "--frequency": "--rate", "--force": "--overwrite"}
"""Options that other programs have -> what they are called here."""


class NaoCommand(click.Command):
    """A command with the common options."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self.params.extend(common_options())
        self.context_settings.setdefault("help_option_names", ["-h", "--help"])

    def parse_args(self, context: click.Context, args: list[str]) -> list[str]:
        """Parse as click does; the error for an unknown option suggests known ones."""
        try:
            return super().parse_args(context, args)
        except click.NoSuchOption as error:
            known = [name for parameter in self.get_params(context) for name in parameter.opts]
            error.possibilities = self.instead_of(error.option_name, known)
            raise

    def instead_of(self, option: str, known: Sequence[str]) -> list[str]:
        """Known options that an unknown one may mean."""
        here = ELSEWHERE.get(option)
        return [here] if here in known else difflib.get_close_matches(option, known, cutoff=0.7)


class SignedCommand(NaoCommand):
    """A command whose arguments may start with one minus sign, as negative numbers do."""

    words: tuple[str, ...] = ()
    """Arguments that look like options."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self.context_settings["ignore_unknown_options"] = True

    def parse_args(self, context: click.Context, args: list[str]) -> list[str]:
        """Parse as click does, but pass unknown options on as arguments."""
        known = {name for parameter in self.get_params(context) for name in parameter.opts}
        options = args[: args.index("--")] if "--" in args else args
        for word in options:
            name = word.partition("=")[0]
            if name.startswith("--") and name not in known and name not in self.words:
                raise click.NoSuchOption(name, possibilities=self.instead_of(name, list(known)), ctx=context)
        return super().parse_args(context, args)


class NaoGroup(click.Group):
    """A command group that recognises options by their first letter alone."""

    command_class = NaoCommand

    def instead_of(self, word: str) -> str:
        """Text after "there is no command ...": the command that does what the word says; empty if none is known."""
        return ""

    def resolve_command(self, context: click.Context, arguments: list[str]) -> Any:
        """Resolve as click does; the error for an unknown command suggests similar ones."""
        from ..base.suggestion import did_you_mean

        word, known = arguments[0], self.list_commands(context)
        # Click also takes "*" for an option, and shows the help.
        if word not in known and (word == "-" or not word.startswith("-")):
            context.fail(f"there is no command {word!r}{self.instead_of(word) or did_you_mean(word, known)}")
        return super().resolve_command(context, arguments)
