"""The events of ALTouch and ALChestButton: what is touched, pressed and clicked."""

from __future__ import annotations

from typing import Any, Dict, FrozenSet

from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.body.touch_gestures import ClickCounter
from nao_sim_bridge.body.touch_parts import LIMBS, LimbTouch
from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.model.touch_names import CHEST_BUTTON, EVENTS, HANDS, HEAD, SENSORS
from nao_sim_bridge.naoqi.memory.store import MemoryStore

TOUCH, CHEST = "ALTouch", "ALChestButton"
CHANGED = "TouchChanged"
CLICKED = {clicks: f"{CHEST}/{word}ClickOccurred" for clicks, word in ((1, "Simple"), (2, "Double"), (3, "Triple"))}
GROUPS = {"Head": HEAD, **HANDS}
"""Parts of the body that are touched when one of their sensors is."""
PARTS = ("Head", *LIMBS, "LHand", "RHand")
"""In the order of a real robot."""


class TouchEvents:
    """Raises the events when what they are about changes; called after every tick, in the simulation thread.

    Args:
        model: The robot.
        memory: Where events go.
    """

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

    @property
    def touched(self) -> FrozenSet[str]:
        """Parts and sensors that are touched; any thread may ask."""
        return self._touched

    def status(self) -> list[list[Any]]:
        """[name, whether it is touched] of all parts and sensors."""
        touched = self._touched
        return [[name, name in touched] for name in (*PARTS, *SENSORS)]

    def forget(self) -> None:
        """The robot is another one: what its button was pressed by counts for nothing."""
        self._clicks = ClickCounter()

    def __call__(self, snapshot: Snapshot) -> None:
        """Look at the robot."""
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
