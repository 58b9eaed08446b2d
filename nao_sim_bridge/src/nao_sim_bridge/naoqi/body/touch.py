"""ALTouch, ALChestButton and ALFsr of the simulated robot, and their events."""

from __future__ import annotations

from typing import Any, Dict, FrozenSet

from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.body.touch_gestures import ClickCounter
from nao_sim_bridge.body.touch_parts import LIMBS, LimbTouch
from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.model.touch_names import CHEST_BUTTON, EVENTS, HANDS, HEAD, SENSORS
from nao_sim_bridge.naoqi.memory.live_keys import CONTACT_LOAD
from nao_sim_bridge.naoqi.memory.store import MemoryStore

TOUCH, CHEST, FEET = "ALTouch", "ALChestButton", "ALFsr"
CHANGED, CONTACT = "TouchChanged", "footContactChanged"
CLICKED = {clicks: f"{CHEST}/{word}ClickOccurred" for clicks, word in ((1, "Simple"), (2, "Double"), (3, "Triple"))}
GROUPS = {"Head": HEAD, **HANDS}
"""Parts of the body that are touched when one of their sensors is."""
PARTS = ("Head", *LIMBS, "LHand", "RHand")
"""In the order of a real robot."""
STEADY_TIME = 0.1
"""Contact of the feet is won or lost when it has been so for this time, s: feet bounce."""


class ALTouch:
    """ALTouch as the simulated robot offers it; called after every tick for its events and those of ALChestButton."""

    def __init__(self, model: RobotModel, memory: MemoryStore) -> None:
        self._memory = memory
        self._limbs = LimbTouch(model)
        self._clicks = ClickCounter()
        self._sensors: FrozenSet[str] = frozenset()
        self._held: FrozenSet[str] = frozenset()
        self._touched: FrozenSet[str] = frozenset()
        self._values: Dict[str, float] = {}
        memory.declare_event(CHANGED, TOUCH)
        memory.put_quietly(CHANGED, [])
        for event, sensors in EVENTS.items():
            memory.declare_event(event, CHEST if sensors == (CHEST_BUTTON,) else TOUCH)
            memory.put_quietly(event, 0.0)  # who begins to listen can ask for the state
            self._values[event] = 0.0
        for event in CLICKED.values():
            memory.declare_event(event, CHEST)

    def getSensorList(self) -> list[str]:
        return list(SENSORS)

    def getStatus(self) -> list[list[Any]]:
        """Name, whether it is touched, and a list that is empty when it is not, of each: robots answer three items."""
        touched = self._touched
        return [[name, name in touched, [1] if name in touched else []] for name in (*PARTS, *SENSORS)]

    def forget(self) -> None:
        """The robot is another one: what its button was pressed by counts for nothing."""
        self._clicks = ClickCounter()

    def __call__(self, snapshot: Snapshot) -> None:
        sensors, held = snapshot.touched, self._limbs.look(snapshot)
        if sensors != self._sensors or held is not self._held:
            self._sensors, self._held = sensors, held
            self._tell(sensors, held)
        clicks = self._clicks.feed(CHEST_BUTTON in sensors, snapshot.time)
        if clicks:
            self._memory.raise_event(CLICKED[clicks], None)

    def _tell(self, sensors: FrozenSet[str], held: FrozenSet[str]) -> None:
        groups = {part for part, members in GROUPS.items() if not sensors.isdisjoint(members)}
        before, self._touched = self._touched, frozenset((*sensors, *held, *groups))
        for event, members in EVENTS.items():
            value = 0.0 if sensors.isdisjoint(members) else 1.0
            if value != self._values[event]:
                self._values[event] = value
                self._memory.raise_event(event, value)
        changed = (before ^ self._touched) - {CHEST_BUTTON}
        if changed:
            news = [[name, name in self._touched] for name in (*PARTS, *SENSORS) if name in changed]
            self._memory.raise_event(CHANGED, news)


class FootEvents:
    """Raises `footContactChanged`; called after every tick, in the simulation thread."""

    def __init__(self, memory: MemoryStore) -> None:
        self._memory = memory
        self._touches: bool | None = None
        self._differs_since: float | None = None
        memory.declare_event(CONTACT, FEET)

    def __call__(self, snapshot: Snapshot) -> None:
        touches = max(snapshot.foot_loads) > CONTACT_LOAD
        if touches == self._touches:
            self._differs_since = None
            return
        if self._differs_since is None:
            self._differs_since = snapshot.time
        if self._touches is None or snapshot.time - self._differs_since >= STEADY_TIME:
            self._touches, self._differs_since = touches, None
            self._memory.raise_event(CONTACT, touches)


class EventsOnly:
    """A module whose work is to raise events, such as ALChestButton and ALFsr: it has no methods of its own."""
