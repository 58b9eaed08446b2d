"""What walking costs, as a whole and the walk's own part."""

from __future__ import annotations

from ..row import Figures, Row, at_most
from ..stack import Stack
from ..timings import run_timings

ROUNDS = 3000


class WalkingTick(Row):
    """A tick of a robot that walks, next to one that stands still.

    Besides the walk itself: motors told anew at every tick, feet that meet the ground, the watch for falls.
    """

    name = "walking_tick"
    subject = "tick while walking"
    against = "the same, standing still"
    unit = "us"
    bound = at_most(1.4)

    def measure(self, stack: Stack) -> Figures:
        """Measure in a process of its own."""
        return Figures.compared(*run_timings("walking_ticks", ROUNDS), scale=1e6)


class WalkController(Row):
    """What the walk computes in a tick, next to the physics steps of the same tick."""

    name = "walk_controller"
    subject = "the walk's part of a tick"
    against = "physics steps of the same tick"
    unit = "us"
    bound = at_most(0.2)

    def measure(self, stack: Stack) -> Figures:
        """Measure in a process of its own."""
        ours, reference = run_timings("walking_ticks", ROUNDS, "--controller")
        return Figures.compared(ours, reference, scale=1e6, note=f"it takes {ours.median * 1e6:.0f} us a tick")
