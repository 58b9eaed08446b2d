"""What several robots in one world cost."""

from __future__ import annotations

from nao_sim_bridge.sim.settings import load_settings

from ..row import Figures, Row, at_most
from ..stack import Stack
from ..timings import run_timings

ROUNDS = 800


class RobotsTick(Row):
    """A tick of a world with three robots, next to one of a robot that is alone: they should cost what they are."""

    unit = "us"
    against = "the same, one robot alone"
    bound = at_most(3.6)

    def __init__(self, name: str, subject: str, *options: str) -> None:
        self.name = name
        self.subject = subject
        self._options = options

    def measure(self, stack: Stack) -> Figures:
        """Measure in a process of its own."""
        ours, reference = run_timings("robots_ticks", ROUNDS, *self._options)
        tick = load_settings().tick_s
        note = f"{tick / ours.median:.1f} times real time, alone {tick / reference.median:.1f}"
        return Figures.compared(ours, reference, scale=1e6, note=note)
