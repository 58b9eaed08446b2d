"""What goes wrong during the soak, and when: the simulator is killed, the network drops."""

from __future__ import annotations

import random
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from .machines import Machines
from .processes import Simulator

DEAD_FOR = 2.0
CABLE_OUT_FOR = 5.0
"""s; long enough for connections to be given up."""


@dataclass(frozen=True)
class Accident:
    """One accident.

    Attributes:
        at: When, s from the beginning.
        name: What it is.
        happen: Lets it happen, until it is over.
    """

    at: float
    name: str
    happen: Callable[[], None]


class Accidents:
    """Accidents spread over a time, with chance in it.

    Args:
        machines: Their cable is pulled.
        simulator: It is killed.
        kills: How often it is killed.
        drops: How often the network drops.
        length: Time that they are spread over, s.
        seed: Where chance comes from.
    """

    def __init__(
        self, machines: Machines, simulator: Simulator, kills: int, drops: int, length: float, seed: int
    ) -> None:
        self._machines, self._simulator = machines, simulator
        kinds = [("killed", self._kill)] * kills + [("cable", self._drop)] * drops
        chance = random.Random(f"accidents {seed}")
        chance.shuffle(kinds)
        share = length / (len(kinds) + 1) if kinds else 0.0
        times = [share * (i + 1 + chance.uniform(-0.2, 0.2)) for i in range(len(kinds))]
        self._accidents = [Accident(at, name, happen) for at, (name, happen) in zip(times, kinds)]

    def due(self, now: float) -> Iterator[Accident]:
        """Those that are due at a time, s from the beginning; each comes once."""
        while self._accidents and self._accidents[0].at <= now:
            yield self._accidents.pop(0)

    def _kill(self) -> None:
        self._simulator.kill()
        time.sleep(DEAD_FOR)
        self._simulator.start()

    def _drop(self) -> None:
        self._machines.pull_the_cable(self._simulator.pid)
        try:
            time.sleep(CABLE_OUT_FOR)
        finally:
            self._machines.plug_in(self._simulator.pid)
