"""How much memory the simulator takes."""

from __future__ import annotations

import sys
from pathlib import Path

from ..errors import BenchmarkError
from ..places import SIMULATOR_NODE
from ..row import Figures, Row, at_most
from ..simulator import Simulator
from ..stack import Stack

MIB = 1024.0  # kB
SIMULATED_S = 20.0


def resident_kib(pid: int, field: str) -> float:
    """A line of a process's memory account in KiB: VmRSS (now) or VmHWM (the most so far)."""
    for line in Path(f"/proc/{pid}/status").read_text(encoding="ascii", errors="replace").splitlines():
        name, _, value = line.partition(":")
        if name == field:
            return float(value.split()[0])
    raise BenchmarkError(f"the system does not tell {field} of process {pid}")


class Memory(Row):
    """Resident memory of the node after some work: wake-up, time, a picture.

    The process that draws is one of its own, and not in it.
    """

    name = "memory"
    subject = "resident memory of nao_sim, standing awake"
    unit = "MiB"
    bound = at_most(400.0)

    def measure(self, stack: Stack) -> Figures:
        """Start the node on the stack's ROS master, let it work, and read its account."""
        stack.start_ros()
        command = [sys.executable, str(SIMULATOR_NODE), "--port", "0", "--posture", "Stand"]
        with Simulator.started("nao_sim", command) as simulator:
            simulator.wake_up()
            simulator.ask("NaoSimulation", "advance", SIMULATED_S)
            picture = simulator.ask("NaoSimulation", "picture", "front", 640, 480)
            if not bytes(picture).startswith(b"\x89PNG"):
                raise BenchmarkError("the simulator gave no picture")
            pid = simulator.program.pid
            now, most = resident_kib(pid, "VmRSS"), resident_kib(pid, "VmHWM")
        return Figures(now / MIB, details={"most": most / MIB}, note=f"at most {most / MIB:.1f} MiB so far")
