"""Errors of commands and their exit status. A mistake in the command itself is click's UsageError: status 2.

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
    exit_code = FAILED


class StackMissing(click.ClickException):
    exit_code = MISSING


class CommandInterrupted(click.ClickException):
    exit_code = INTERRUPTED
