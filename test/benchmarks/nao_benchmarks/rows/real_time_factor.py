"""How fast the simulator runs when nothing holds it back."""

from __future__ import annotations

from ..row import Figures, Row, at_least
from ..simulator import Simulator
from ..stack import Stack
from ..stats import interleave

SIMULATED_S = 10.0
ROUNDS = 7


class RealTimeFactor(Row):
    """Simulated seconds per second of wall time, robot standing awake, no window. Absolute: mind the machine."""

    name = "real_time_factor"
    subject = "simulated s per s, headless, standing awake"
    unit = "x"
    bound = at_least(12.0)

    def measure(self, stack: Stack) -> Figures:
        """Let time pass in the running simulator, several times over."""
        with Simulator.plain("--posture", "Stand", "--speed", "max") as simulator:
            simulator.wake_up()

            def advance() -> None:
                simulator.ask("NaoSimulation", "advance", SIMULATED_S)

            (sample,) = interleave([advance], ROUNDS, warm_up=1)
        first, third = sample.quartiles
        details = {"first quartile": SIMULATED_S / third, "third quartile": SIMULATED_S / first}
        return Figures(SIMULATED_S / sample.median, details=details)
