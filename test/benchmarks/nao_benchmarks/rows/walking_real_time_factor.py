"""How fast the simulator runs while its robot walks."""

from __future__ import annotations

import time

from ..errors import BenchmarkError
from ..row import Figures, Row, at_least
from ..simulator import Simulator
from ..stack import Stack
from .real_time_factor import ROUNDS, SIMULATED_S, processor_time

# A circle, m/s, m/s, rad/s.
VELOCITY = (0.07, 0.0, 0.2)


class WalkingRealTimeFactor(Row):
    """Simulated seconds per second of processor time, walking, no window. Absolute: mind the machine."""

    name = "walking_real_time_factor"
    subject = "simulated s per s of processor time, walking"
    unit = "x"
    bound = at_least(12.0)

    def measure(self, stack: Stack) -> Figures:
        """Let time pass in the running simulator while the robot walks a circle."""
        with Simulator.plain("--posture", "Stand", "--speed", "max") as simulator:
            simulator.wake_up()
            simulator.ask("NaoSimulation", "pause")
            simulator.ask("ALMotion", "move", *VELOCITY)
            simulator.ask("NaoSimulation", "advance", SIMULATED_S)
            pid = simulator.program.pid
            began, used = time.perf_counter(), processor_time(pid)
            for _ in range(ROUNDS):
                simulator.ask("NaoSimulation", "advance", SIMULATED_S)
            wall, used = time.perf_counter() - began, processor_time(pid) - used
            # A walk that nobody stopped ends only with a fall or another failure.
            if not simulator.ask("ALMotion", "moveIsActive"):
                raise BenchmarkError("the robot did not walk on to the end")
        simulated = ROUNDS * SIMULATED_S
        details = {"simulated s per wall s": simulated / wall, "processors": used / wall}
        return Figures(simulated / used, details=details, note=f"it had {used / wall:.2f} processors")
