"""AutonomousBlinking: the eyes close for a moment now and then. Simulation thread only."""

from __future__ import annotations

import random
from typing import Any

from nao_sim_bridge.body.leds import LedKeyframe

EYES = "FaceLeds"
# Pauses between two blinks, s; how long eyes take to close, stay closed, and take to open, s.
PAUSES = (2.0, 6.0)
CLOSE, CLOSED, OPEN = 0.06, 0.05, 0.1


class Blinking:
    """Blinks while it is switched on, and not while somebody else changes the LEDs of the eyes."""

    def __init__(self, simulation: Any) -> None:
        self._simulation = simulation
        self._chance = random.Random(simulation.scene.seed)
        self._next: float | None = None
        self._devices = simulation.led_layout.devices_of(EYES)
        simulation.after_tick.append(self._tick)

    def start(self) -> None:
        self._next = self._simulation.time + self._chance.uniform(*PAUSES)

    def stop(self) -> None:
        self._next = None

    def _tick(self, now: Any) -> None:
        if self._next is None or now.time < self._next:
            return
        self._next = now.time + self._chance.uniform(*PAUSES)
        robot = self._simulation.robot
        if robot.leds.busy(self._devices):
            return
        shown = {i: robot.leds.values[i] for i in self._devices}
        dark = dict.fromkeys(self._devices, 0.0)
        times = (CLOSE, CLOSE + CLOSED, CLOSE + CLOSED + OPEN)
        frames = [LedKeyframe(time, values) for time, values in zip(times, (dark, dark, shown))]
        robot.leds.animate("blink", frames, robot.time)
