"""Hearing functions that tell how loud it is at the microphones."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from naoqi.errors import NaoError

from .base import AudioInBase
from .checks import MICROPHONES
from .fields import MeanTime

log = logging.getLogger(__name__)

DEVICE = "ALAudioDevice"
BLOCK = 0.17
"""s of sound behind each energy, which is also how often it changes."""
NEXT_VALUE, FIRST_VALUE = 3, 6
"""So many blocks it takes at most until energies change that are computed, and until the first one is there."""


class EnergyFunctions(AudioInBase):
    """Energies of the microphones, 0..32768. Parameters are fields of AudioInFunction.

    The robot computes them only when it is told to; what a function switches on for itself, it switches off again.
    """

    device: Callable[..., Any]  # of NaoAudio: a call of ALAudioDevice
    keep_left: Callable[[], None]  # of NaoAudioInput
    _computing = False  # since enableEnergyComputation of this server

    def get_energy(self, duration: MeanTime) -> list[float]:
        """How loud it is: left, right, front, rear."""
        return self._energies(MICROPHONES, duration)

    def get_left_mic_energy(self, duration: MeanTime) -> list[float]:
        """How loud it is on the left."""
        return self._energies(["left"], duration)

    def get_right_mic_energy(self, duration: MeanTime) -> list[float]:
        """How loud it is on the right."""
        return self._energies(["right"], duration)

    def get_front_mic_energy(self, duration: MeanTime) -> list[float]:
        """How loud it is in front."""
        return self._energies(["front"], duration)

    def get_rear_mic_energy(self, duration: MeanTime) -> list[float]:
        """How loud it is at the rear."""
        return self._energies(["rear"], duration)

    def enable_energy_computation(self) -> None:
        """Have energies computed all the time, also beyond the end of the goal: they are there without a wait."""
        self.begin(DEVICE, "enableEnergyComputation", [], "disableEnergyComputation")
        self._computing = True
        self.keep_left()

    def disable_energy_computation(self) -> None:
        """Have energies computed no longer."""
        self._computing = False
        self.keep_left()
        self.device("disableEnergyComputation")

    def renew_energy_computation(self) -> None:
        """Have energies computed again.

        Raises:
            NaoError: The robot does not answer.
        """
        self.call_now(self.robot.proxy(DEVICE), "enableEnergyComputation")
        self._computing = True

    def drop_energy_computation(self) -> None:
        """Switch off what a goal has left on; raises nothing."""
        if not self._computing:
            return
        self._computing = False
        try:
            self.call_now(self.robot.proxy(DEVICE), "disableEnergyComputation")
        except NaoError as error:
            log.warning("energies may be computed for nobody: %s", error)

    def _energies(self, microphones: Sequence[str], duration: float) -> list[float]:
        with self._computed():
            end = self.clock.now() + duration
            rows = [self._read(microphones)]
            while self.clock.now() + BLOCK <= end:
                self.wait(BLOCK)
                rows.append(self._read(microphones))
        means = [sum(values) / len(rows) for values in zip(*rows)]
        self.heard.add_energies(dict(zip(microphones, means)))
        return means

    @contextmanager
    def _computed(self) -> Iterator[None]:
        """Energies are computed in a block, the first one is there.

        The robot does not tell whether another program has them computed; but noise is never the same twice.
        """
        before = [] if self._computing else self._read(MICROPHONES)
        if self._computing or self._changes(before, NEXT_VALUE):
            yield
            return
        self.begin(DEVICE, "enableEnergyComputation", [], "disableEnergyComputation")
        card = self.robot.proxy(DEVICE)
        with self.ended_by(lambda: self.call_now(card, "disableEnergyComputation"), "energies may go on"):
            self._changes(before, FIRST_VALUE)  # where there is no sound at all they never change
            yield

    def _changes(self, before: Sequence[float], blocks: int) -> bool:
        """Wait until energies are others than before, so many blocks at most; tells whether they are."""
        for _ in range(blocks):
            self.wait(BLOCK)
            if self._read(MICROPHONES) != before:
                return True
        return False

    def _read(self, microphones: Sequence[str]) -> list[float]:
        return [float(self.device(f"get{name.capitalize()}MicEnergy")) for name in microphones]

    functions = {
        "getEnergy": get_energy,
        "getLeftMicEnergy": get_left_mic_energy,
        "getRightMicEnergy": get_right_mic_energy,
        "getFrontMicEnergy": get_front_mic_energy,
        "getRearMicEnergy": get_rear_mic_energy,
        "enableEnergyComputation": enable_energy_computation,
        "disableEnergyComputation": disable_energy_computation,
    }
