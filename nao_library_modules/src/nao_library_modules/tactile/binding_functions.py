"""Links between touches and behaviours: made, listed and removed by goals, kept beyond the death of the node."""

from __future__ import annotations

import logging
import threading
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from genpy import Time

from nao_library_msgs.msg import TouchBinding
from naoqi.errors import NaoError

from ..base.field_checks import require_known
from ..base.kept import Kept
from ..functions.chain import checked_by
from ..functions.parts import Part
from ..nao.touch_names import names_of, sensors_of
from ..robot.robot import Robot
from .bindings import Binding, BindingState, TouchBindings
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
    require_touch,
    wanted_of,
)
from .reading import Senses
from .touch import WantedTouch

log = logging.getLogger(__name__)


class BindingFunctions(Part):
    """Parameters are fields of TactileFunction. `bindings`: which touch starts which behaviour."""

    left_by_goals = frozenset({"bindings"})

    def __init__(self, robot: Robot, senses: Senses, bindings: TouchBindings, kept: Kept) -> None:
        self._robot = robot
        self._senses = senses
        self.bindings = bindings
        self._kept = kept
        self._restoring = threading.Lock()
        self.unrestored: Sequence[dict[str, Any]] = kept.load(list) or ()  # links that are not made again yet

    def _check_link(
        self, str_param: str, touch: str, count: int, duration: float, behavior: str, context: dict[str, Any]
    ) -> None:
        """As waitForTouch; later functions of the chain may remove the link."""
        require_touch(touch, count, duration)
        context.setdefault("bindings", set(self.bindings.names)).add(str_param.strip() or behavior.strip())

    def _check_removal(self, str_param: str, context: dict[str, Any]) -> None:
        """A link that is there when it is to be removed."""
        names = context.setdefault("bindings", set(self.bindings.names))
        if not str_param.strip():
            names.clear()
            return
        names.remove(require_known("str_param", str_param, sorted(names), "link between a touch and a behaviour"))

    @checked_by(_check_link)
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
        self.restore()
        self.bindings.bind(binding, self._senses.contacts(wanted))
        self._keep()
        self._senses.measurements.bindings += [
            _message(*each) for each in self.bindings.states() if each[0].name == name
        ]
        return name

    def list_on_touch(self) -> list[str]:
        """Names of the links between touches and behaviours; what they are is in the result."""
        self.restore()
        self._senses.measurements.bindings += [_message(*each) for each in self.bindings.states()]
        return self.bindings.names

    @checked_by(_check_removal)
    def remove_on_touch(self, str_param: Link) -> None:
        """Start the behaviour of a link, or of all of them, no more; what runs goes on."""
        self.restore()
        self.bindings.remove(str_param.strip())
        self._keep()

    functions = {"onTouch": on_touch, "listOnTouch": list_on_touch, "removeOnTouch": remove_on_touch}

    def _keep(self) -> None:
        self._kept.save([_told(binding) for binding, _ in self.bindings.states()])

    def restore(self) -> None:
        """Make the links again that the node had before it died, as soon as the robot is there."""
        with self._restoring:
            if self._robot.connection.state != "connected":
                return
            unrestored, self.unrestored = self.unrestored, ()
            for told in unrestored:
                try:
                    self.bindings.bind(_binding(told), [])
                    log.info("the touch %s starts its behaviour again", told["name"])
                except (NaoError, KeyError, TypeError) as error:
                    log.warning("a link between a touch and a behaviour is not there again: %s: %s", told, error)


def _told(binding: Binding) -> dict[str, Any]:
    """A link in words of JSON."""
    told = asdict(binding)
    return {**told, "sensors": names_of(binding.sensors)}


def _binding(told: dict[str, Any]) -> Binding:
    """A link from words of JSON."""
    read = {"sensors": sensors_of(told["sensors"]), "wanted": WantedTouch(**told["wanted"])}
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
