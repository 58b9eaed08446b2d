"""The module for touch: what the robot feels, waiting for it, and behaviours that begin when it is touched."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Sequence
from dataclasses import asdict
from typing import Any

from genpy import Time

from nao_library_actions.msg import NaoTactileAction
from nao_library_msgs.msg import TouchBinding
from naoqi.errors import NaoError

from ..base.answers import Outcome
from ..functions.chain import checked_by
from ..functions.memory_functions import MEMORY
from ..nao.touch_names import names_of, sensors_of
from ..processes.launcher import LaunchPath
from ..server.extractor_use import subscriber_name
from ..server.nao_basic import NaoBasic
from .bindings import Binding, BindingState, TouchBindings
from .checks import check_binding, check_removal
from .fields import (
    BehaviorName,
    Cooldown,
    Link,
    NewLink,
    Parameters,
    Presses,
    Sensors,
    Touch,
    TouchTime,
    wanted_of,
)
from .measurements import Measurements
from .reading import ReadingFunctions
from .touch import Wanted
from .waiting import WaitingFunctions

log = logging.getLogger(__name__)


class NaoTactile(NaoBasic, WaitingFunctions, ReadingFunctions):
    """Touch goals: what the robot feels, sonars, feet, battery, temperatures, and behaviours that a touch starts.

    A link between a touch and a behaviour outlives its goal: it ends when it is removed, or with the server. A
    server that is started again because it died makes its links again.

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

    left_by_goals = frozenset({"bindings"})

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
            from .runner import BehaviorClient

            runner = BehaviorClient()
        self._restoring = threading.Lock()
        super().__init__(ip, port, autostart, launchpath, **options)
        self.measurements = Measurements()
        self.sonar_on = False
        self.subscriber = subscriber_name("NaoTactile", str(self._node.namespace))
        event_time = lambda event: self.robot_clock.event_time(self.call_now, *event)  # noqa: E731
        self.bindings = TouchBindings(lambda: self.robot.proxy(MEMORY), runner, self.clock, event_time)
        self._unrestored = self.kept.load() or ()
        self.serve("NaoTactile", NaoTactileAction)
        if self._unrestored:
            self.robot.connection.in_background(self._restore)

    _unrestored: Sequence[dict[str, Any]] = ()  # links that are not made again yet

    @checked_by(check_binding)
    def on_touch(
        self,
        str_param: NewLink,
        sensors: Sensors,
        touch: Touch,
        count: Presses,
        duration: TouchTime,
        behavior: BehaviorName,
        parameters: Parameters,
        cooldown: Cooldown,
    ) -> str:
        """Run a stored behaviour at each such touch from now on; answers the name of the link."""
        wanted = sensors_of(sensors)
        name = str_param.strip() or behavior.strip()
        binding = Binding(
            name, wanted, wanted_of(touch, count, duration), behavior.strip(), tuple(parameters), cooldown
        )
        self._restore()
        self.bindings.bind(binding, self.contacts(wanted))
        self._keep()
        self.measurements.bindings += [_message(*each) for each in self.bindings.states() if each[0].name == name]
        return name

    def list_on_touch(self) -> list[str]:
        """Names of the links between touches and behaviours; what they are is in the result."""
        self._restore()
        self.measurements.bindings += [_message(*each) for each in self.bindings.states()]
        return self.bindings.names

    @checked_by(check_removal)
    def remove_on_touch(self, str_param: Link) -> None:
        """Start the behaviour of a link, or of all of them, no more; what runs goes on."""
        self._restore()
        self.bindings.remove(str_param.strip())
        self._keep()

    function_table = {"onTouch": on_touch, "listOnTouch": list_on_touch, "removeOnTouch": remove_on_touch}

    # The life of a goal

    def begin_chain(self) -> None:
        """Forget what the last chain felt."""
        self.measurements = Measurements()

    def tell(
        self, status: str, touched: Sequence[str] = (), sonar: Sequence[float] = (), stamp: float | None = None
    ) -> None:
        """Publish what is felt meanwhile. Called from the thread that executes goals.

        Args:
            status: What the function does.
            touched: What is pressed.
            sonar: m, left and right.
            stamp: ROS time of the change, s; None for now.
        """
        self.publish_feedback(stamp=stamp, status=status, touched=list(touched), sonar=list(sonar))

    def fill_result(self, result: Any, outcomes: Sequence[Outcome]) -> None:
        """Add what was felt."""
        super().fill_result(result, outcomes)
        self.measurements.fill(result)

    def argument_choices(self, function: str, field: str) -> Sequence[str]:
        """Names of the links that can be removed, for the description of the functions."""
        return self.bindings.names if (function, field) == ("removeOnTouch", "str_param") else ()

    def shutdown_steps(self) -> list[Callable[[], Any]]:
        """As NaoBasic has them; touches start nothing any more, and the sonars are let go."""
        return [*super().shutdown_steps(), self.bindings.close, self.with_robot(self.drop_sonar)]

    def _keep(self) -> None:
        """Keep the links as they are now."""
        self.kept.save([_told(binding) for binding, _ in self.bindings.states()])

    def _restore(self) -> None:
        """Make the links again that the node had before it died, as soon as the robot is there."""
        with self._restoring:
            if self.robot.connection.state != "connected":
                return
            unrestored, self._unrestored = self._unrestored, ()
            for told in unrestored:
                try:
                    self.bindings.bind(_binding(told), [])
                    log.info("the touch %s starts its behaviour again", told["name"])
                except (NaoError, KeyError, TypeError) as error:
                    log.warning("a link between a touch and a behaviour is not there again: %s: %s", told, error)

    def _connection_changed(self, *args: Any) -> None:
        super()._connection_changed(*args)
        self._restore()
        if self.robot.connection.state == "connected" and self.robot.connection.generation > 1:
            self.bindings.renew()
            try:
                self.renew_sonar()
            except NaoError as error:
                log.warning("the sonars of the robot that came back stay silent: %s", error)


def _told(binding: Binding) -> dict[str, Any]:
    """A link in words of JSON."""
    told = asdict(binding)
    return {**told, "sensors": names_of(binding.sensors)}


def _binding(told: dict[str, Any]) -> Binding:
    """A link from words of JSON."""
    read = {"sensors": sensors_of(told["sensors"]), "wanted": Wanted(**told["wanted"])}
    return Binding(**{**told, **read, "parameters": tuple(told["parameters"])})


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
        touched=Time.from_sec(state.touched),
    )
