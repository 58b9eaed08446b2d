"""How the robot shows that it listens: a bip, and LEDs of its face in blue."""

from __future__ import annotations

import logging
import threading

from nao_sim_bridge.base.samples import sine
from nao_sim_bridge.body.led_animations import colored
from nao_sim_bridge.core.robot_runner import RobotRunner

log = logging.getLogger("nao_sim.recognition")

BIP_S = 0.12
BIP_AMPLITUDE = 0.25
# Hz, when listening begins and when it ends.
BIPS = {True: 880.0, False: 587.0}
# How much later the own bip may begin than it is asked for, and how long it may still be in the air, s.
AFTER_BIP_S = 0.04
# What each mode lights up.
MODES = {0: (), 1: ("FaceLeds",), 2: ("EarLeds",), 3: ("FaceLeds", "EarLeds")}
BLUE = (0.0, 0.0, 1.0)


class ListeningExpression:
    """Bips and lights, those of a key of `MODES`. Any thread."""

    def __init__(self, runner: RobotRunner) -> None:
        self._simulation = runner.simulation
        self._runner = runner
        self._lock = threading.Lock()
        self.audio = True
        self.visual = True
        self.mode = 1
        # Intensities that the lights had before, and those that were set.
        self._before: dict[int, float] = {}
        self._set: dict[int, float] = {}

    def show(self, listens: bool) -> float:
        """Tell that listening begins or ends; returns for how long, in s, the own bip is heard."""
        bips = self.audio
        lights = MODES[self.mode] if listens and self.visual else ()
        self._runner.execute(lambda: self._act(listens, bips, lights), "listening")
        return BIP_S + AFTER_BIP_S if bips else 0.0

    def _act(self, listens: bool, bips: bool, lights: tuple[str, ...]) -> None:
        if bips:
            self._simulation.sound.loudspeakers.play(sine(BIPS[listens], BIP_S, BIP_AMPLITUDE), "bip")
        with self._lock:
            self._restore()
            if lights:
                self._light(lights)

    def _light(self, names: tuple[str, ...]) -> None:
        layout, leds = self._simulation.led_layout, self._simulation.robot.leds
        devices = tuple(index for name in names for index in layout.devices_of(name))
        wanted = colored(layout, devices, BLUE)
        self._before = {index: leds.values[index] for index in wanted}
        leds.set(wanted)
        self._set = {index: leds.values[index] for index in wanted}

    def _restore(self) -> None:
        """Put back the lights that nobody else has changed since."""
        leds = self._simulation.robot.leds
        leds.set({i: self._before[i] for i, value in self._set.items() if leds.values[i] == value})
        self._before, self._set = {}, {}
