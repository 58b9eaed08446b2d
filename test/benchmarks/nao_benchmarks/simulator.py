"""A simulated robot in a process of its own, asked over libqi as everybody asks it."""

from __future__ import annotations

import sys
import time
from typing import Any, Sequence

import qi

from naoqi.session import QUIET_LIBQI

from .program import Program

START_LIMIT = 40.0
ANSWER_LIMIT = 40.0
# Without ROS and as a node.
READY = r"(?:listens on 127\.0\.0\.1:|ready on port )(\d+)"


class Simulator:
    """A simulator program and a libqi session to it.

    Attributes:
        program: The process.
        port: Where it listens.
        session: A connected `qi.Session`.

    Args:
        program: A program that tells its port in its log.
    """

    def __init__(self, program: Program) -> None:
        self.program = program
        self.port = int(program.wait_for(READY, START_LIMIT)[1])
        qi.logging.setFilters(QUIET_LIBQI)
        self.session = qi.Session()
        self.session.connect(f"tcp://127.0.0.1:{self.port}", _async=True).value(int(1000 * ANSWER_LIMIT))

    @classmethod
    def plain(cls, *options: str) -> Simulator:
        """The simulator without ROS on a free port.

        Args:
            options: Further options of the command line.
        """
        return cls.started("simulator", [sys.executable, "-m", "nao_sim_bridge", "--port", "0", *options])

    @classmethod
    def started(cls, name: str, command: Sequence[str]) -> Simulator:
        """Start a program and connect to it; nothing is left running if that fails."""
        program = Program(name, command)
        try:
            return cls(program)
        except BaseException:
            program.stop()
            raise

    def __enter__(self) -> Simulator:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def ask(self, module: str, method: str, *arguments: Any) -> Any:
        """Call a method and wait for the answer, not for ever."""
        service = self.session.service(module)
        return service.call(method, *arguments, _async=True).value(int(1000 * ANSWER_LIMIT))

    def wake_up(self) -> None:
        """Stiffen the robot and let it stand; returns when it does."""
        self.ask("ALMotion", "wakeUp")

    def pace(self, seconds: float) -> float:
        """Simulated s that pass in a s, looked at for a while (s of wall time)."""
        began, at = time.perf_counter(), self.ask("NaoSimulation", "time")
        time.sleep(seconds)
        return (self.ask("NaoSimulation", "time") - at) / (time.perf_counter() - began)

    def close(self) -> None:
        """Leave, and end the process."""
        self.session.close()
        self.program.stop()
