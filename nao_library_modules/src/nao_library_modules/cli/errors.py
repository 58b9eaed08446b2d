"""How commands fail, and the exit status that tells. A mistake in the command itself is click's UsageError: status 2.

click.ClickException
    CommandFailed        the robot or a goal failed: 1
    StackMissing         there is no master, server or robot to ask: 3
    Interrupted          Ctrl-C; what ran has been cancelled: 130
"""

from __future__ import annotations

import click

FAILED = 1
MISSING = 3
INTERRUPTED = 130


class CommandFailed(click.ClickException):
    """The robot could not do it, or a goal failed."""

    exit_code = FAILED


class StackMissing(click.ClickException):
    """There is nobody to ask: no master, no server, no robot."""

    exit_code = MISSING


class CommandInterrupted(click.ClickException):
    """Somebody pressed Ctrl-C; the goal that ran is over."""

    exit_code = INTERRUPTED
