"""Hearing functions that measure how loud it is at the microphones."""

from __future__ import annotations

import logging
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from naoqi.errors import NaoError

from ..audio.sound_card import DEVICE, NaoAudio
from ..functions.parts import Part
from .fields import MICROPHONES, MeanTime
from .hearing import Hearing, LeftGoing

log = logging.getLogger(__name__)

BLOCK = 0.17
"""s of sound behind each energy, which is also how often it changes."""
NEXT_VALUE, FIRST_VALUE = 3, 6
"""So many blocks it takes at most until energies change that are computed, and until the first one is there."""


class EnergyFunctions(Part):
    """Energies of the microphones, 0..32768. Parameters are fields of AudioInFunction.

    The robot computes them on demand only; what a function switches on for itself, it switches off again.
    """

    def __init__(self, module: NaoAudio, hearing: Hearing, left: LeftGoing) -> None:
        self._module = module
        self._hearing = hearing
        self._left = left

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
        self._hearing.begin(DEVICE, "enableEnergyComputation", [], "disableEnergyComputation")
        self._left.computing = True
        self._left.keep()

    def disable_energy_computation(self) -> None:
        """Have energies computed no longer."""
        self._left.computing = False
        self._left.keep()
        self._module.device("disableEnergyComputation")

    def renew(self) -> None:
        """Have energies computed again. Raises NaoError if the robot does not answer."""
        self._call_now("enableEnergyComputation")
        self._left.computing = True

    def drop(self) -> None:
        """Switch off what a goal has left on; raises nothing."""
        if not self._left.computing:
            return
        self._left.computing = False
        try:
            self._call_now("disableEnergyComputation")
        except NaoError as error:
            log.warning("energies may be computed for nobody: %s", error)

    def _energies(self, microphones: Sequence[str], duration: float) -> list[float]:
        with self._computed():
            end = self._module.clock.now() + duration
            rows = [self._read(microphones)]
            while self._module.clock.now() + BLOCK <= end:
                self._module.wait(BLOCK)
                rows.append(self._read(microphones))
        means = [sum(values) / len(rows) for values in zip(*rows)]
        self._hearing.heard.microphones += microphones
        self._hearing.heard.energies += means
        return means

    @contextmanager
    def _computed(self) -> Iterator[None]:
        """Energies are computed in a block, the first one is there.

        The robot does not report whether another program has them computed; but noise is never the same twice.
        """
        before = [] if self._left.computing else self._read(MICROPHONES)
        if self._left.computing or self._changes(before, NEXT_VALUE):
            yield
            return
        self._hearing.begin(DEVICE, "enableEnergyComputation", [], "disableEnergyComputation")
        with self._hearing.ended_by(lambda: self._call_now("disableEnergyComputation"), "energies may go on"):
            self._changes(before, FIRST_VALUE)  # where there is no sound at all they never change
            yield

    def _changes(self, before: Sequence[float], blocks: int) -> bool:
        """Wait until energies are others than before, so many blocks at most; returns whether they are."""
        for _ in range(blocks):
            self._module.wait(BLOCK)
            if self._read(MICROPHONES) != before:
                return True
        return False

    def _read(self, microphones: Sequence[str]) -> list[float]:
        return [float(self._module.device(f"get{name.capitalize()}MicEnergy")) for name in microphones]

    def _call_now(self, method: str) -> None:
        self._module.call_now(self._module.robot.proxy(DEVICE), method)

    functions = {
        "getEnergy": get_energy,
        "getLeftMicEnergy": get_left_mic_energy,
        "getRightMicEnergy": get_right_mic_energy,
        "getFrontMicEnergy": get_front_mic_energy,
        "getRearMicEnergy": get_rear_mic_energy,
        "enableEnergyComputation": enable_energy_computation,
        "disableEnergyComputation": disable_energy_computation,
    }
