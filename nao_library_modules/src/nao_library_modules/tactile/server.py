"""The module for touch: what the robot feels, waiting for it, and behaviours that begin when it is touched."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from typing import Any

from nao_library_actions.msg import NaoTactileAction
from nao_library_msgs.msg import TouchBinding
from naoqi.errors import NaoError

from .answers import Outcome
from .extractor_use import subscriber_name
from .function_chain import checked_by
from .launcher import LaunchPath
from .memory_functions import MEMORY
from .nao_basic import NaoBasic
from .tactile_bindings import Binding, BindingState, TouchBindings
from .tactile_checks import check_binding, check_removal, wanted_of
from .tactile_felt import Felt
from .tactile_names import names_of, sensors_of
from .tactile_reading import ReadingFunctions
from .tactile_waiting import WaitingFunctions

log = logging.getLogger(__name__)


class NaoTactile(NaoBasic, WaitingFunctions, ReadingFunctions):
    """Touch goals: what the robot feels, sonars, feet, battery, temperatures, and behaviours that a touch starts.

    A link between a touch and a behaviour outlives its goal: it ends when it is removed, or with the server.

    Attributes:
        felt: What the chain has felt so far.
        bindings: Which touch starts which behaviour.
        sonar_on: Whether a goal has switched the sonars on for longer.
        subscriber: What NAOqi knows this server by.

    ROS API:
        Action `NaoTactile` (nao_library_actions/NaoTactileAction) and what NaoBasic offers. Client of the action
        `NaoBehavior`, as soon as a touch is to start a behaviour.
    """

    typed_answers = frozenset({"getSonar", "getFsr", "getTemperatures"})

    def __init__(
        self,
        ip: str,
        port: int,
        autostart: bool = False,
        launchpath: LaunchPath | None = None,
        runner: Any = None,
        **options: Any,
    ) -> None:
        """Start the server.

        Args:
            ip: Address of the robot.
            port: Port of its NAOqi.
            autostart: As NaoBasic takes it.
            launchpath: As NaoBasic takes it.
            runner: Runs behaviours, where not the server NaoBehavior.
            options: As NaoBasic takes them.
        """
        if runner is None:
            from .tactile_runner import BehaviorClient

            runner = BehaviorClient()
        super().__init__(ip, port, autostart, launchpath, **options)
        self.felt = Felt()
        self.sonar_on = False
        self.subscriber = subscriber_name("NaoTactile", str(self._edge.namespace))
        self.bindings = TouchBindings(lambda: self.robot.proxy(MEMORY), runner, self.clock)
        self.function_table.update(self.reading_functions())
        self.function_table.update(self.waiting_functions())
        self.function_table.update(
            onTouch=self.on_touch, listOnTouch=self.list_on_touch, removeOnTouch=self.remove_on_touch
        )
        self.serve("NaoTactile", NaoTactileAction)

    @checked_by(check_binding)
    def on_touch(
        self,
        str_param: str,
        sensors: Sequence[str],
        touch: str,
        count: int,
        duration: float,
        behavior: str,
        parameters: Sequence[str],
        cooldown: float,
    ) -> str:
        """Run a stored behaviour at each such touch from now on; answers the name of the link."""
        wanted = sensors_of(sensors)
        name = str_param.strip() or behavior.strip()
        binding = Binding(
            name, wanted, wanted_of(touch, count, duration), behavior.strip(), tuple(parameters), cooldown
        )
        self.bindings.bind(binding, self.pressed(wanted))
        self.felt.bindings += [_message(*each) for each in self.bindings.states() if each[0].name == name]
        return name

    def list_on_touch(self) -> list[str]:
        """Names of the links between touches and behaviours; what they are is in the result."""
        self.felt.bindings += [_message(*each) for each in self.bindings.states()]
        return self.bindings.names

    @checked_by(check_removal)
    def remove_on_touch(self, str_param: str) -> None:
        """Start the behaviour of a link, or of all of them, no more; what runs goes on."""
        self.bindings.remove(str_param.strip())

    # The life of a goal

    def begin_chain(self) -> None:
        """Forget what the last chain felt."""
        self.felt = Felt()

    def tell(self, status: str, touched: Sequence[str] = (), sonar: Sequence[float] = ()) -> None:
        """Publish what is felt meanwhile. Called from the thread that executes goals.

        Args:
            status: What the function does.
            touched: What is pressed.
            sonar: m, left and right.
        """
        self.publish_feedback(status=status, touched=list(touched), sonar=list(sonar))

    def fill_result(self, result: Any, outcomes: Sequence[Outcome]) -> None:
        """Add what was felt."""
        super().fill_result(result, outcomes)
        self.felt.fill(result)

    def argument_choices(self, function: str, field: str) -> Sequence[str]:
        """Names of the links that can be removed, for the description of the functions."""
        return self.bindings.names if (function, field) == ("removeOnTouch", "str_param") else ()

    def shut_down(self) -> None:
        """As NaoBasic does; touches start nothing any more, and the sonars are let go."""
        super().shut_down()
        self.bindings.close()
        if self.robot.connection.state == "connected":
            try:
                self.drop_sonar()
            except NaoError as error:
                log.debug("the sonars may go on for nobody: %s", error)

    def _connection_changed(self, *args: Any) -> None:
        super()._connection_changed(*args)
        if self.robot.connection.state == "connected" and self.robot.connection.generation > 1:
            self.bindings.renew()
            try:
                self.renew_sonar()
            except NaoError as error:
                log.warning("the sonars of the robot that came back stay silent: %s", error)


def _message(binding: Binding, state: BindingState) -> TouchBinding:
    return TouchBinding(
        name=binding.name,
        sensors=names_of(binding.sensors),
        touch=binding.wanted.kind,
        count=binding.wanted.count if binding.wanted.kind == "count" else 0,
        duration=binding.wanted.duration,
        behavior=binding.behavior,
        parameters=list(binding.parameters),
        cooldown=binding.cooldown,
        running=state.running,
        runs=state.runs,
        last=state.last,
        text=state.text,
    )
