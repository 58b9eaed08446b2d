"""What the simulator as a library costs beside the bare engine."""

from __future__ import annotations

from ..row import Bound, Figures, Row, at_most
from ..stack import Stack
from ..timings import run_timings


class LibraryTime(Row):
    """Something that a script does, timed in a process of its own.

    Args:
        name: See `Row`.
        subject: See `Row`.
        against: See `Row`.
        bound: Of the ratio.
        what: Of the program.
        rounds: How many times it measures each kind.
    """

    unit = "ms"

    def __init__(self, name: str, subject: str, against: str, bound: Bound, what: str, rounds: int) -> None:
        self.name, self.subject, self.against, self.bound = name, subject, against, bound
        self._what, self._rounds = what, rounds

    def measure(self, stack: Stack) -> Figures:
        """Measure in a process of its own."""
        ours, reference = run_timings("library_times", self._rounds, self._what)
        return Figures.compared(ours, reference, scale=1e3)


LIBRARY = (
    LibraryTime("library_import", "import nao_sim_bridge", "import pybullet, numpy", at_most(1.5), "imports", 15),
    # Processor time, with what it imports besides PyBullet and NumPy.
    LibraryTime("library_first", "first NaoSim of a program", "its robot in a bare engine", at_most(4.0), "first", 9),
    LibraryTime("library_reset", "reset with a new seed", "40 bare steps", at_most(1.0), "resets", 100),
    LibraryTime("library_reset_things", "the same with things that roll", "40 bare steps", at_most(1.0),
                "resets_with_things", 40),
    LibraryTime("library_drive", "3 ticks of joints driven directly", "6 bare steps", at_most(1.15), "driven", 600),
    # 1.9 times the steps of one: both take at most 2 / 1.9 of the time that one takes.
    LibraryTime("two_simulations", "two simulations at once", "one after the other", at_most(1.0 / 1.9),
                "two_processes", 3),
)  # fmt: skip
