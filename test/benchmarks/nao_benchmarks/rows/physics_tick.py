"""What motors, LEDs, sensors and services cost on top of the physics."""

from __future__ import annotations

from ..row import Figures, Row, at_most
from ..stack import Stack
from ..timings import run_timings

ROUNDS = 3000


class PhysicsTick(Row):
    """A tick of the simulation, robot standing awake, services registered and idle."""

    name = "physics_tick"
    subject = "tick with services and sensors"
    against = "bare stepSimulation, same robot and state"
    unit = "us"
    bound = at_most(1.25)

    def measure(self, stack: Stack) -> Figures:
        """Measure in a process of its own."""
        return Figures.compared(*run_timings("standing_ticks", ROUNDS), scale=1e6)
