"""How commands fail, and the exit status that tells. A mistake in the command itself is click's UsageError: 2."""

from __future__ import annotations

import click

INTERRUPTED = 130


class CommandFailed(click.ClickException):
    """The robot could not do it, or a goal failed."""

    exit_code = 1


class StackMissing(click.ClickException):
    """There is nobody to ask: no master, no server, no robot."""

    exit_code = 3


class CommandInterrupted(click.ClickException):
    """Somebody pressed Ctrl-C; what ran is over."""

    exit_code = INTERRUPTED
