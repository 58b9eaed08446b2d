"""Where what the loudspeakers play goes besides the simulated air: a file, and the sound card of this computer."""

from __future__ import annotations

import logging
from pathlib import Path
from typing import Any

import numpy as np

from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.base.samples import RATE
from nao_sim_bridge.base.whole_file import FileTrouble
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.sound.files import WavFile
from nao_sim_bridge.sound.timeline import Follower

log = logging.getLogger("nao_sim.sound")

FILE_STEP = RATE // 2
CARD_STEP = RATE // 50
CARD_DELAY = 0.1
"""s between the simulated sound and the real one: what the machine may be late without a gap."""
CARD_LATEST = 0.5
"""s; when more is waiting for the card, it is left out."""
HOLD_LAG = 10.0
"""When the file is behind by more, s, time that runs faster than the wall clock waits for it."""


class SoundCardError(SimulationError):
    """The sound card cannot be used; the text says why."""


class SoundFile:
    """A WAV of everything that the loudspeakers play from now on, silence included; whole at any moment.

    While the disk is full, it is silent. What is at `path` is replaced in the end; a FileTrouble when it cannot be
    written.
    """

    def __init__(self, simulation: Simulation, path: Path) -> None:
        self._path = path
        self._file = WavFile(path, RATE, 2)
        self._lost = 0  # frames that the disk had no room for
        self._listen_to(simulation)

    def behind(self) -> bool:
        """Whether fast time should wait for the file."""
        return self._follower.lag > HOLD_LAG

    def follow(self, simulation: Simulation) -> None:
        """Write what another simulation plays from now on, behind what there is; in its thread."""
        self._follower.close()
        self._listen_to(simulation)

    def close(self) -> None:
        """Write what has been played, and end."""
        self._follower.close()
        self._file.close()

    def _listen_to(self, simulation: Simulation) -> None:
        self._loudspeakers = simulation.sound.loudspeakers
        self._follower = Follower("sound file", simulation.sound.timeline, self._write, FILE_STEP)
        simulation.holds.append(self.behind)

    def _write(self, first: int, last: int) -> None:
        samples = self._loudspeakers.pcm(first, last)
        try:
            self._file.write(samples, self._lost)
        except FileTrouble as error:
            if not self._lost:
                log.error("%s; there is silence in it until there is room", error)
            self._lost += last - first
            self._file.recover()
        else:
            if self._lost:
                log.warning("%.1f s are silent in %s", self._lost / RATE, self._path)
            self._lost = 0


class SoundCard:
    """The computer's own loudspeakers; time must run at speed 1.

    A SoundCardError when there is no library or no card.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._loudspeakers = simulation.sound.loudspeakers
        self._stream = _open_stream()
        self._stream.write(np.zeros((round(CARD_DELAY * RATE), 2), np.int16))
        self._timeline = simulation.sound.timeline
        self._follower = Follower("sound card", self._timeline, self._send, CARD_STEP)

    def follow(self, simulation: Simulation) -> None:
        """Have another simulation heard from now on; in its thread."""
        self._follower.close(timeout=1.0)
        self._loudspeakers, self._timeline = simulation.sound.loudspeakers, simulation.sound.timeline
        self._follower = Follower("sound card", self._timeline, self._send, CARD_STEP)

    def close(self) -> None:
        """Be silent."""
        self._follower.close(timeout=1.0)
        self._stream.abort()
        self._stream.close()

    def _send(self, first: int, last: int) -> None:
        if self._timeline.now - last > CARD_LATEST * RATE:
            return  # time went faster than the card plays
        if self._stream.write(self._loudspeakers.pcm(first, last)):  # it had run dry: time went slower for a moment
            self._stream.write(np.zeros((round(CARD_DELAY * RATE), 2), np.int16))


def _open_stream() -> Any:
    try:
        import sounddevice  # needs a library of the system that is not everywhere
    except (ImportError, OSError) as error:
        raise SoundCardError(f"sound card: {error}; install libportaudio2, or leave --sound-card out") from error
    try:
        stream = sounddevice.OutputStream(RATE, channels=2, dtype="int16")
        stream.start()
    except sounddevice.PortAudioError as error:
        raise SoundCardError(f"sound card: there is none to be had ({error}); leave --sound-card out") from error
    return stream
