"""ALTouch, ALChestButton and ALFsr of the simulated robot."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.model.touch_names import SENSORS
from nao_sim_bridge.naoqi.body.touch_events import TouchEvents


class ALTouch:
    """ALTouch as the simulated robot offers it. Only NAOqi methods live here.

    Args:
        events: Which look at the robot at every tick.
    """

    def __init__(self, events: TouchEvents) -> None:
        self._events = events

    def getSensorList(self) -> list[str]:
        return list(SENSORS)

    def getStatus(self) -> list[list[Any]]:
        return self._events.status()


class EventsOnly:
    """A module whose work is to raise events, such as ALChestButton and ALFsr: it has no methods of its own."""
