"""ALTracker's work: listens to the modules that see and hear, and has the robot follow what they tell.

Calls of clients and events come in threads of their own; what they are about is done in the simulation thread.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from typing import Any, Callable, Sequence

from nao_sim_bridge.base.errors import SimulationStopped
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.binding.background import ModuleCalls
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.tracker.targets import TARGETS, Parameters, Sighting, read_place
from nao_sim_bridge.tracking import geometry
from nao_sim_bridge.tracking.follower import Follower
from nao_sim_bridge.tracking.geometry import Point

NAME = "ALTracker"
CHANGED, DETECTED, LOST, REACHED = (
    f"{NAME}/{event}" for event in ("ActiveTargetChanged", "TargetDetected", "TargetLost", "TargetReached")
)
DEFAULT_TIMEOUT, DEFAULT_DISTANCE = 2.0, 3.5
Look = Callable[[Any], Sequence[Sighting]]


@dataclass
class _Active:
    """What is tracked."""

    name: str
    module: str
    look: Look


class Tracking:
    """Tracks one target at a time.

    Attributes:
        follower: Moves the robot.
        timeout: How long after the last sighting a target counts as lost, s.
        max_distance: Sightings further away do not count, m.
        searches: Whether it looks around for a target that is lost.
        new: Whether the target was seen since somebody asked for its place.
        periods: Of the modules, ms, by name of the target.
        sightings: What was seen last.
    """

    def __init__(self, runner: RobotRunner, memory: MemoryStore, calls: ModuleCalls) -> None:
        self.follower = Follower(runner.simulation)
        self.timeout, self.max_distance = DEFAULT_TIMEOUT, DEFAULT_DISTANCE
        self.searches = False
        self.periods = {name: target.period for name, target in TARGETS.items()}
        self._simulation = runner.simulation
        self._runner = runner
        self._memory = memory
        self._calls = calls
        self._active: _Active | None = None
        self._forget()
        self._listening: set[str] = set()
        for event in (CHANGED, DETECTED, LOST, REACHED):
            memory.declare_event(event, NAME)
        self.follower.approach.reached.append(lambda: self._tell(REACHED))
        runner.simulation.after_tick.append(self._tick)
        runner.simulation.after_reset.append(self._after_reset)

    # --- any thread -----------------------------------------------------------------------------------------------

    @property
    def active(self) -> str:
        """Name of what is tracked, empty when nothing is."""
        return "" if self._active is None else self._active.name

    @property
    def lost(self) -> bool:
        return self._active is None or self._lost

    def place_in(self, frame: int) -> list[float]:
        """Where the target was seen last in one of ALMotion's frames, m; empty when it is lost."""
        place, self.new = self._place, False
        if place is None or self.lost:
            return []
        model, placed = self._simulation.model, geometry.placement(self._simulation.model, self._runner.snapshot)
        return list(geometry.in_frame(model, placed, place, frame))

    # --- simulation thread ----------------------------------------------------------------------------------------

    def start(self, name: str, parameters: Parameters) -> None:
        """Track a kind of target."""
        target = TARGETS[name]
        self._begin(_Active(name, target.module, lambda value: target.read(value, parameters)), target.event)
        self._calls.tell(target.module, "subscribe", NAME, self.periods[name], 0.0)

    def start_event(self, event: str) -> None:
        """Track places that an event tells."""
        self._begin(_Active(event, "", read_place), event)

    def stop(self) -> None:
        """Track nothing any more."""
        active, self._active = self._active, None
        self.follower.stop()
        self._forget()
        if active is not None:
            if active.module:
                self._calls.tell(active.module, "unsubscribe", NAME)
            self._memory.raise_event(CHANGED, "")

    def set_period(self, name: str, period: int) -> None:
        """Change the period of a target's module, ms."""
        self.periods[name] = period
        if self._active is not None and self._active.name == name:
            self._calls.tell(self._active.module, "updatePeriod", NAME, period)

    def _forget(self) -> None:
        self._seen: float | None = None
        self._lost, self.new = True, False
        self._place: Point | None = None
        self.sightings: Sequence[Sighting] = ()

    def _begin(self, active: _Active, event: str) -> None:
        if event not in self._listening:
            self._memory.listen(event, lambda value: self._hear(event, value))  # before it counts: there may be no room
            self._listening.add(event)
        self.stop()
        self._active = active
        self._seen = self._simulation.time
        self._memory.raise_event(CHANGED, active.name)

    def _hear(self, event: str, value: Any) -> None:
        """Any thread: an event was raised."""
        active = self._active
        if active is None or event not in (active.name, TARGETS[active.name].event if active.module else ""):
            return
        with suppress(SimulationStopped):
            self._runner.execute(lambda: self._see(active, value), "track")

    def _see(self, active: _Active, value: Any) -> None:
        if active is not self._active:
            return
        near = [sighting for sighting in active.look(value) if sighting.distance <= self.max_distance]
        self.sightings = near
        if not near:
            return
        model, placed = self._simulation.model, geometry.placement(self._simulation.model, self._simulation.snapshot)
        self._place = geometry.in_world(model, placed, near[0].place, near[0].frame)
        self._seen, self.new = self._simulation.time, True
        if self._lost:
            self._lost = False
            self._tell(DETECTED)
        self.follower.follow(self._place)

    def _tick(self, now: Any) -> None:
        if self._active is None or self._seen is None or now.time - self._seen <= self.timeout:
            return
        if not self._lost:
            self._lost, self.sightings = True, ()
            self._tell(LOST)
            self.follower.lose()
        if self.searches:
            self.follower.search()

    def _tell(self, event: str) -> None:
        if self._active is not None:
            self._memory.raise_event(event, self._active.name)

    def _after_reset(self) -> None:
        if self._active is not None:
            self.stop()
