"""Whether the robot can do what a protocol asks of it, in all its conditions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial
from typing import Any

from ...behaviors.language.errors import Problem
from ...behaviors.language.expressions import text_of
from ..timeline.command_check import CommandCheck
from ..timeline.stored import SERVICE
from .course import all_steps
from .order import conditions_of
from .protocol import CommandStep, StudyProtocol


class ProtocolCheck:
    """Checks protocols. `check`: of their commands."""

    def __init__(self, check: CommandCheck) -> None:
        self._check = check

    def problems(self, protocol: StudyProtocol) -> list[Problem]:
        """What the robot would refuse, in the order of the file; each step in all conditions."""
        found: dict[Problem, None] = {}
        for path, step in all_steps(protocol):
            if isinstance(step, CommandStep):
                for values in _all_values(protocol):
                    for text in self._check.problems(step.command.filled(values)):
                        found[Problem(f"step {path}", text, step.line)] = None
        return list(found)


def checked_for(robot: Any, protocol: StudyProtocol) -> list[Problem]:
    """What a robot would refuse; calls services, so not for the event loop. `robot`: a `RobotClient`."""
    from nao_library_msgs.srv import ListBehaviors

    ask = partial(robot.call, SERVICE, ListBehaviors)
    return ProtocolCheck(CommandCheck(robot.describe, robot.servers, ask)).problems(protocol)


def _all_values(protocol: StudyProtocol) -> Iterator[Mapping[str, str]]:
    """Values of texts in each condition that there is."""
    for between in conditions_of(protocol, within=False):
        for within in conditions_of(protocol, within=True):
            values = protocol.values_in({**between, **within})
            yield {name: text_of(value) for name, value in values.items()}
