"""How loud it is at the microphones: one figure each, for blocks of 170 ms."""

from __future__ import annotations

import threading
from typing import Any, Mapping, Sequence

import numpy as np

NAME = "microphone energy"


class MicrophoneEnergy:
    """Energy of the newest block; zero while it is not computed.

    Args:
        ears: `listen(name, callback, wants)` of the sound world.
        sides: For left, right, front and rear: the channels of a block that are on that side.
    """

    def __init__(self, ears: Any, sides: Mapping[str, Sequence[int]]) -> None:
        self._ears = ears
        self._sides = sides
        self._lock = threading.Lock()
        self._enabled, self._closed = False, False
        self._listener: Any = None
        self._energies = dict.fromkeys(sides, 0.0)

    def enable(self, enabled: bool) -> None:
        with self._lock:
            self._enabled = enabled
            self._update()

    def set_closed(self, closed: bool) -> None:
        """Whether the microphones are closed: then there is nothing to compute."""
        with self._lock:
            self._closed = closed
            self._update()

    def of(self, side: str) -> float:
        """Root mean square of the newest block on a side, 0 to 32768."""
        return self._energies[side]

    def _update(self) -> None:
        wanted = self._enabled and not self._closed
        if wanted and self._listener is None:
            self._listener = self._ears.listen(NAME, self._on_block, wants="48k4")
        elif not wanted and self._listener is not None:
            self._listener.close()
            self._listener = None
            self._energies = dict.fromkeys(self._sides, 0.0)

    def _on_block(self, block: Any) -> None:
        squares = np.mean(block.samples.astype(np.float64) ** 2, axis=0)
        self._energies = {
            side: float(np.sqrt(np.mean(squares[list(channels)]))) for side, channels in self._sides.items()
        }
