"""The module for touch: what the robot feels, waiting for it, and behaviours that begin when it is touched."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from typing import Any

from nao_library_actions.msg import NaoTactileAction
from naoqi.errors import NaoError

from ..core.memory_functions import MEMORY, Outcome
from ..core.processes import LaunchPath
from ..core.robot_events import EventTimes
from ..nao_basic import NaoBasic
from .readings import Measurements, ReadingFunctions, Senses, WaitingFunctions
from .touch_bindings import BindingFunctions, TouchBindings

log = logging.getLogger(__name__)


class NaoTactile(NaoBasic):
    """Touch goals: what the robot feels, sonars, feet, battery, temperatures, and behaviours that a touch starts.

    A link between a touch and a behaviour outlives its goal: it ends when it is removed, or with the server. A
    server that is started again because it died makes its links again.

    Attributes:
        senses: What the robot feels, and what the chain has felt so far.
        binding_functions: Which touch starts which behaviour.

    ROS API:
        Action `NaoTactile` (nao_library_actions/NaoTactileAction) and what NaoBasic offers. Client of the action
        `NaoBehavior`, as soon as a touch is to start a behaviour.
    """

    typed_answers = frozenset({"getSonar", "getFsr", "getTemperatures"})
    part_types = (BindingFunctions, WaitingFunctions, ReadingFunctions)

    def __init__(
        self,
        ip: str,
        port: int,
        autostart: bool = False,
        launchpath: LaunchPath | None = None,
        runner: Any = None,
        **options: Any,
    ) -> None:
        """Start the server; arguments as NaoBasic takes them, but for one.

        `runner`: runs behaviours, where not the server NaoBehavior.
        """
        if runner is None:
            from ..ros.behavior_client import BehaviorClient

            runner = BehaviorClient()
        super().__init__(ip, port, autostart, launchpath, **options)
        self.senses = Senses(self, str(self._node.namespace))
        times = EventTimes(self.robot, self.robot_clock, self.call_now)
        bindings = TouchBindings(lambda: self.robot.proxy(MEMORY), runner, self.clock, times)
        self.binding_functions = BindingFunctions(self.robot, self.senses, bindings, self.kept)
        self.add_parts(self.senses, self.binding_functions)
        self.add_parts(WaitingFunctions(self, self.senses), ReadingFunctions(self, self.senses))
        self.at_end(bindings.close, self.with_robot(self.senses.drop_sonar))
        self.serve("NaoTactile", NaoTactileAction)
        if self.binding_functions.unrestored:
            self.robot.connection.in_background(self.binding_functions.restore)

    def begin_chain(self) -> None:
        self.senses.measurements = Measurements()

    def fill_result(self, result: Any, outcomes: Sequence[Outcome]) -> None:
        super().fill_result(result, outcomes)
        self.senses.measurements.fill(result)

    def argument_choices(self, function: str, field: str) -> Sequence[str]:
        """Names of the links that can be removed, for the description of the functions."""
        return self.binding_functions.bindings.names if (function, field) == ("removeOnTouch", "str_param") else ()

    def connected(self, again: bool) -> None:
        self.binding_functions.restore()
        if again:
            self.binding_functions.bindings.renew()
            try:
                self.senses.renew_sonar()
            except NaoError as error:
                log.warning("the sonars of the robot that came back stay silent: %s", error)
