"""A simulation's thread as one of several robots has it: time and commands are those of all, what is sensed its own."""

from __future__ import annotations

from typing import Any, Callable

from nao_sim_bridge.sim.runner import SimulationRunner
from nao_sim_bridge.sim.simulation import Simulation
from nao_sim_bridge.sim.snapshot import Snapshot
from nao_sim_bridge.sim.tasks import Task


class RobotRunner:
    """As `SimulationRunner`, for a robot in a world whose thread belongs to all; see there. Any thread.

    Args:
        runner: Of the world.
        simulation: The robot.
    """

    def __init__(self, runner: SimulationRunner, simulation: Simulation) -> None:
        self._runner = runner
        self._simulation = simulation

    @property
    def snapshot(self) -> Snapshot:
        """What the robot sensed at the last tick."""
        return self._simulation.snapshot

    @property
    def speed(self) -> float:
        """Simulated seconds per wall second that are asked for."""
        return self._runner.speed

    @property
    def paused(self) -> bool:
        """True while time stands still but for `advance`."""
        return self._runner.paused

    @property
    def running(self) -> bool:
        """True until the thread has ended."""
        return self._runner.running

    def execute(self, command: Callable[[], Any], name: str = "command") -> Task:
        """Run `command()` in the simulation thread; the task ends with what it returns or raises."""
        return self._runner.execute(command, name)

    def call(self, command: Callable[[], Any], timeout: float = 5.0) -> Any:
        """Run `command()` in the simulation thread and wait for its result (wall time, s)."""
        return self._runner.call(command, timeout)

    def set_speed(self, speed: float) -> None:
        """Change the pace, for all robots."""
        self._runner.set_speed(speed)

    def pause(self) -> None:
        """Let time stand still, for all robots."""
        self._runner.pause()

    def resume(self) -> None:
        """Let time pass again, for all robots."""
        self._runner.resume()

    def advance(self, seconds: float) -> Task:
        """Let `seconds` pass as fast as possible, for all robots; the task ends with what this one senses then."""
        return self._runner.advance(seconds).then(lambda _: self.snapshot)

    def wait_for_tick(self, after: int, timeout: float) -> Snapshot | None:
        """The first snapshot with a tick number above `after`, None when none came within `timeout` (wall time, s)."""
        self._runner.wait_for_tick(after, timeout)
        snapshot = self.snapshot
        return snapshot if snapshot.tick > after else None
