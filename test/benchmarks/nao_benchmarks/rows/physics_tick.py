"""What motors, LEDs, sensors and services cost on top of the physics."""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path

from ..errors import BenchmarkError
from ..places import PROGRAMS
from ..program import Program
from ..row import Figures, Row, at_most
from ..stack import Stack
from ..stats import Sample

LIMIT = 60.0
ROUNDS = 3000


class PhysicsTick(Row):
    """A tick of the simulation, robot standing awake, services registered and idle."""

    name = "physics_tick"
    subject = "tick with services and sensors"
    against = "bare stepSimulation, same robot and state"
    unit = "us"
    bound = at_most(1.25)

    def measure(self, stack: Stack) -> Figures:
        """Measure in a process of its own: threads of ours would take the interpreter from it."""
        package = str(Path(__file__).resolve().parents[2])
        path = os.pathsep.join([package, *filter(None, [os.environ.get("PYTHONPATH")])])
        command = [sys.executable, str(PROGRAMS / "standing_ticks.py"), "--rounds", str(ROUNDS)]
        with Program("standing_ticks", command, {"PYTHONPATH": path}) as program:
            lines = program.wait(LIMIT).splitlines()
        try:
            times = json.loads(next(line for line in reversed(lines) if line.startswith("{")))
        except (StopIteration, ValueError):
            raise BenchmarkError("standing_ticks printed no times") from None
        return Figures.compared(Sample(tuple(times["ours"])), Sample(tuple(times["bare"])), scale=1e6)
