"""How fast the simulator runs when nothing holds it back."""

from __future__ import annotations

import os
import time
from pathlib import Path

from ..row import Figures, Row, at_least
from ..simulator import Simulator
from ..stack import Stack
from ..stats import interleave

SIMULATED_S = 8.0
ROUNDS = 5


def processor_time(pid: int) -> float:
    """Time that a process has had on processors, all its threads together, in s."""
    text = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8", errors="replace")
    # The name, in brackets, may hold blanks; the fields after it are numbered from 3.
    fields = text.rpartition(")")[2].split()
    user, system = int(fields[14 - 3]), int(fields[15 - 3])
    return (user + system) / os.sysconf("SC_CLK_TCK")


class RealTimeFactor(Row):
    """Simulated seconds per wall second, standing awake, no window. Absolute: mind the machine."""

    name = "real_time_factor"
    subject = "simulated s per s, headless, standing awake"
    unit = "x"
    bound = at_least(12.0)

    def measure(self, stack: Stack) -> Figures:
        """Let time pass in the running simulator, several times over."""
        with Simulator.plain("--posture", "Stand", "--speed", "max") as simulator:
            simulator.wake_up()
            pid = simulator.program.pid

            def advance() -> None:
                simulator.ask("NaoSimulation", "advance", SIMULATED_S)

            advance()
            began, used = time.perf_counter(), processor_time(pid)
            (sample,) = interleave([advance], ROUNDS)
            wall, used = time.perf_counter() - began, processor_time(pid) - used
        slow, fast = (SIMULATED_S / seconds for seconds in reversed(sample.quartiles))
        per_processor = ROUNDS * SIMULATED_S / used
        details = {"first quartile": slow, "third quartile": fast, "processors": used / wall}
        note = f"it had {used / wall:.2f} processors: {per_processor:.1f} simulated s per s of processor time"
        return Figures(SIMULATED_S / sample.median, details=details, note=note)
