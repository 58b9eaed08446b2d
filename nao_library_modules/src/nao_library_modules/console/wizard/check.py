"""What a robot that runs says about the buttons of a file: functions, fields and behaviours that it does not have."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

from naoqi.errors import NaoError

from ...base.suggestion import of_those
from ...behaviors.language.errors import Problem
from ...behaviors.language.servers import FunctionTables
from ..robots.commands import BEHAVIORS, RUN, RobotCommand, command_problems, type_of
from ..timeline.command_check import CommandCheck, value_problems
from .model import WizardButton, WizardLayout


def doubts(layout: WizardLayout, robot: Any, behaviors: Collection[str] | None) -> list[Problem]:
    """What the servers of a robot would refuse, in the order of the file; buttons for other robots are left out.

    Takes a call of a service for each server that is used; not for the event loop.

    Args:
        layout: The file.
        robot: A `robots.robot.RobotClient`.
        behaviors: Names of the stored behaviours; None: not known.
    """
    found = []
    tables = FunctionTables()
    for group, button in layout.buttons():
        if button.robot and button.robot.strip("/") != robot.namespace.strip("/"):
            continue
        where = f"{group.title}: {button.label}"
        found += [Problem(where, text, button.line) for text in _problems(button, robot, behaviors, tables)]
    return found


def layout_problems(layout: WizardLayout, check: CommandCheck) -> list[Problem]:
    """What robots would refuse of all buttons, in the order of the file; plans are not looked at."""
    return [
        Problem(f"{group.title}: {button.label}", text, button.line)
        for group, button in layout.buttons()
        if isinstance(button.action, RobotCommand)
        for text in check.problems(button.action)
    ]


def stored_behaviors(robot: Any) -> list[str] | None:
    """Names of the behaviours that a robot has stored; None if nobody tells."""
    from nao_library_msgs.srv import ListBehaviors

    try:
        return [each.name for each in robot.call(f"{BEHAVIORS}/list", ListBehaviors).behaviors]
    except NaoError:
        return None


def _problems(button: WizardButton, robot: Any, behaviors: Collection[str] | None, tables: FunctionTables) -> list[str]:
    command = button.action
    if not isinstance(command, RobotCommand) or command.stops:
        return []
    problems = command_problems(command, robot.describe)
    if not problems and command.server == BEHAVIORS and behaviors is not None:
        name, fields = command.chain[0]
        wanted = str(fields.get("str_param", ""))
        if name == RUN and wanted and wanted not in behaviors and not button.names:
            problems.append(f"there is no behavior {wanted!r}{of_those(wanted, behaviors)}")
    if not problems and command.server != BEHAVIORS:
        problems += value_problems(command, type_of(command.server, robot.describe), tables)
    return problems
