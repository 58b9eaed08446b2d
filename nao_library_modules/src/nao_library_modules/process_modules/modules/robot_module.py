"""The base of the robot's process modules: a table of commands."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

from ...base.suggestion import of_those
from ..core.process_module import AsynchronousProcessModule
from ..designators.rules import Command
from ..language.failures import PlanError
from ..robot.robot_link import RobotLink


class RobotModule(AsynchronousProcessModule):
    """A module whose commands are functions; one more is one key-value pair in `commands`.

    `methods`: those of its methods that are commands from the beginning.
    """

    methods: tuple[str, ...] = ()

    def __init__(self, robot: RobotLink, name: str = "") -> None:
        super().__init__(name)
        self.robot = robot
        self.clock = robot.clock
        self.commands: dict[str, Callable[..., Any]] = {each: getattr(self, each) for each in self.methods}

    def execute(self, command: Command) -> Any:
        function = self.commands.get(command.name)
        if function is None:
            known = of_those(command.name, sorted(self.commands))
            raise PlanError(f"the process module {self.name} knows no command {command.name!r}{known}")
        try:
            inspect.signature(function).bind(**command.arguments)
        except TypeError as error:
            raise PlanError(f"{command}: {error}") from error
        return function(**command.arguments)

    def resources(self, command: Command) -> frozenset[str]:
        """One command at a time, unless a module knows better."""
        return frozenset({self.name})
