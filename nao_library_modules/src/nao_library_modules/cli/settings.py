"""Options that every command has, and what they are for this run of the program."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import click

from .stack import Stack

QUICK = 1.0
"""s that completion waits for an answer at most; a server that is not busy takes a hundredth of it."""


@dataclass
class Settings:
    """Of one run.

    Attributes:
        json: Whether answers are JSON.
        namespace: Of the robot; None: none was chosen.
        timeout: s of this computer that a goal may take; None for ever.
        completing: Whether the shell asks how a word can go on.
        told_offline: Whether it was told that the answers come from the code.
    """

    json: bool = False
    namespace: str | None = None
    timeout: float | None = None
    completing: bool = False
    told_offline: bool = False
    _stack: Stack | None = field(default=None, repr=False)

    @property
    def stack(self) -> Stack:
        """The servers of the robot."""
        if self._stack is None:
            self._stack = Stack(self.namespace, QUICK) if self.completing else Stack(self.namespace)
        return self._stack


def settings_of(context: click.Context) -> Settings:
    """The settings of a run, made when they are asked for first."""
    return context.ensure_object(Settings)


def _keep(context: click.Context, parameter: click.Parameter, value: Any) -> None:
    # Standing behind the command as well as before it; what is not given here must not hide what was given there.
    if value != value:  # what is no number is neither too small nor too great
        raise click.BadParameter(f"{value} is no time in s")
    if value is not None and value is not False:
        setattr(settings_of(context), parameter.human_readable_name, value)


def _complete_robot(context: click.Context, _parameter: click.Parameter, start: str) -> list[str]:
    from .completion import robots

    return robots(context, start)


def common_options() -> list[click.Option]:
    """The options, made anew for each command."""
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
            type=click.FloatRange(min=0.0, min_open=True),
            metavar="S",
            help="Give up after so many seconds; a goal is cancelled then.",
            callback=_keep,
            expose_value=False,
        ),
    ]


class NaoCommand(click.Command):
    """A command with the options that every command has."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self.params.extend(common_options())
        self.context_settings.setdefault("help_option_names", ["-h", "--help"])


class NaoGroup(click.Group):
    """Commands that are told apart from options by their first letter alone."""

    command_class = NaoCommand

    def resolve_command(self, context: click.Context, arguments: list[str]) -> Any:
        """As click does; a word that is no command is told with those that look like it."""
        from ..suggestion import did_you_mean

        word, known = arguments[0], self.list_commands(context)
        # Click takes "*" for an option, too, and shows the help as if it had been asked for.
        if word not in known and (word == "-" or not word.startswith("-")):
            context.fail(f"there is no command {word!r}{did_you_mean(word, known)}")
        return super().resolve_command(context, arguments)
