"""How fast the simulator runs when nothing holds it back."""

from __future__ import annotations

import os
import time
from pathlib import Path

from ..errors import BenchmarkError
from ..row import Figures, Row, at_least
from ..simulator import Simulator
from ..stack import Stack
from ..stats import Sample, interleave

SIMULATED_S = 8.0
ROUNDS = 5
# A circle, m/s, m/s, rad/s.
VELOCITY = (0.07, 0.0, 0.2)
OPTIONS = ("--posture", "Stand", "--speed", "max")


def processor_time(pid: int) -> float:
    """Time that a process has had on processors, all its threads together, in s."""
    text = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8", errors="replace")
    # The name, in brackets, may hold blanks; the fields after it are numbered from 3.
    fields = text.rpartition(")")[2].split()
    user, system = int(fields[14 - 3]), int(fields[15 - 3])
    return (user + system) / os.sysconf("SC_CLK_TCK")


def advance(simulator: Simulator) -> tuple[Sample, float, float]:
    """Let time pass, several times over: how long each took, and the wall and processor time of all, s."""
    run = lambda: simulator.ask("NaoSimulation", "advance", SIMULATED_S)  # noqa: E731
    run()
    began, used = time.perf_counter(), processor_time(simulator.program.pid)
    (sample,) = interleave([run], ROUNDS)
    return sample, time.perf_counter() - began, processor_time(simulator.program.pid) - used


class RealTimeFactor(Row):
    """Simulated seconds per wall second, standing awake, no window. Absolute: mind the machine."""

    name = "real_time_factor"
    subject = "simulated s per s, headless, standing awake"
    unit = "x"
    bound = at_least(12.0)

    def measure(self, stack: Stack) -> Figures:
        """Let time pass in the running simulator."""
        with Simulator.plain(*OPTIONS) as simulator:
            simulator.wake_up()
            sample, wall, used = advance(simulator)
        slow, fast = (SIMULATED_S / seconds for seconds in reversed(sample.quartiles))
        per_processor = ROUNDS * SIMULATED_S / used
        details = {"first quartile": slow, "third quartile": fast, "processors": used / wall}
        note = f"it had {used / wall:.2f} processors: {per_processor:.1f} simulated s per s of processor time"
        return Figures(SIMULATED_S / sample.median, details=details, note=note)


class WalkingRealTimeFactor(Row):
    """Simulated seconds per second of processor time, walking, no window. Absolute: mind the machine."""

    name = "walking_real_time_factor"
    subject = "simulated s per s of processor time, walking"
    unit = "x"
    bound = at_least(12.0)

    def measure(self, stack: Stack) -> Figures:
        """Let time pass in the simulator, which stands still otherwise, while the robot walks a circle."""
        with Simulator.plain(*OPTIONS) as simulator:
            simulator.wake_up()
            simulator.ask("NaoSimulation", "pause")
            simulator.ask("ALMotion", "move", *VELOCITY)
            _, wall, used = advance(simulator)
            # A walk that nobody stopped ends only with a fall or another failure.
            if not simulator.ask("ALMotion", "moveIsActive"):
                raise BenchmarkError("the robot did not walk on to the end")
        simulated = ROUNDS * SIMULATED_S
        details = {"simulated s per wall s": simulated / wall, "processors": used / wall}
        return Figures(simulated / used, details=details, note=f"it had {used / wall:.2f} processors")
