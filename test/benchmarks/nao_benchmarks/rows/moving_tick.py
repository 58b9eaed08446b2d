"""What motion costs: every joint follows a curve."""

from __future__ import annotations

from ..row import Figures, Row, at_most
from ..stack import Stack
from ..timings import run_timings

ROUNDS = 3000


class MovingTick(Row):
    """A tick of a robot that moves all 26 joints, next to one that stands still.

    The motors are told anew at every tick, and while legs move the body is watched for falls.
    """

    name = "moving_tick"
    subject = "tick with 26 joints interpolated"
    against = "the same, standing still"
    unit = "us"
    bound = at_most(1.35)

    def measure(self, stack: Stack) -> Figures:
        """Measure in a process of its own."""
        return Figures.compared(*run_timings("moving_ticks", ROUNDS), scale=1e6)
