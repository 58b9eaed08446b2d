"""What sound costs: the robot speaks, and somebody listens to its microphones."""

from __future__ import annotations

from ..row import Figures, Row, at_most
from ..stack import Stack
from ..timings import run_timings

ROUNDS = 60


class HearingTick(Row):
    """A tick of a robot that speaks and whose four microphones are heard, next to one in silence.

    What the microphones hear is worked out beside the ticks; on two cores that costs them little.
    """

    name = "hearing_tick"
    subject = "tick while speaking with open ears"
    against = "the same in silence"
    unit = "us"
    bound = at_most(1.2)

    def measure(self, stack: Stack) -> Figures:
        """Measure in a process of its own."""
        return Figures.compared(*run_timings("hearing_ticks", ROUNDS), scale=1e6)
