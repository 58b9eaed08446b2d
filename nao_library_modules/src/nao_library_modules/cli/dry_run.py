"""Whether a server could carry out goals: it is asked, and told what it answers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import click

from ..functions.check_service import CHECK, NotValidated, check_request, read_response
from ..functions.goal_checks import GoalCheck
from .errors import CommandFailed
from .goals import message_class
from .output import say_json
from .settings import CliSettings
from .stack import Stack


def ask(stack: Stack, server: str, goals: Sequence[Any]) -> GoalCheck:
    """Have a server check goals.

    `goals`: in the order in which they would be sent. Raises NotValidated if it is not there, or cannot tell.
    """
    from nao_library_msgs.srv import CheckGoals

    try:
        return read_response(stack.graph.call(stack.server(server) + CHECK, CheckGoals, check_request(goals)))
    except click.ClickException as error:
        raise NotValidated(error.message) from None


def tell_dry_run(settings: CliSettings, server: str, functions: Sequence[Any]) -> None:
    """Print what a server says of a goal.

    Raises CommandFailed if it could not be carried out, or the server does not say.
    """
    goal = message_class(f"{settings.stack.describe(server, brief=True).action}Goal")
    try:
        check = ask(settings.stack, server, [goal(list(functions))])
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
