"""Speech as engines make it, and the handle of their process: starts it, also when it has died, and has it speak."""

from __future__ import annotations

import logging
import threading
from dataclasses import dataclass, replace
from typing import Any, Mapping, Sequence, Tuple

import numpy as np

from nao_sim_bridge.base.child_process import ChildProcess
from nao_sim_bridge.base.errors import SimulationError

log = logging.getLogger("nao_sim.speech")

START_TIMEOUT = 30.0
"""s; it is there within a fraction of one, but a busy machine may need long to start an interpreter."""
ANSWER_TIMEOUT = 30.0
CLOSING = 1.0
"""s; at the end, a process that still speaks after this is ended by force."""
# What is less than this, as part of full scale, is a pause.
QUIET = 0.003
MODULE = "nao_sim_bridge.speech.worker"


class SpeechError(SimulationError):
    """Something cannot be said; the text says why."""


@dataclass(frozen=True)
class Utterance:
    """A text without tags that is spoken in one go, voice by the engine's name, `speed` times as fast as its own."""

    engine: str
    voice: str
    text: str
    speed: float = 1.0


@dataclass(frozen=True)
class Word:
    """A word that is spoken: its first character in the text and how many it has; its start and end in the sound, s."""

    first: int
    length: int
    start: float
    end: float


@dataclass(frozen=True, eq=False)
class Speech:
    """An utterance as sound, (frames,) float32 in -1..1, read-only, `rate` a second, and its words."""

    samples: np.ndarray
    rate: int
    words: Tuple[Word, ...]

    @property
    def duration(self) -> float:
        """How long it sounds, s."""
        return len(self.samples) / self.rate


def silence(seconds: float, rate: int) -> np.ndarray:
    """(frames,) samples of nothing."""
    return np.zeros(max(round(seconds * rate), 0), dtype=np.float32)


def listed(names: Sequence[str]) -> str:
    """Names as an error text lists them."""
    return ", ".join(names) if names else "none"


class Engines:
    """All engines of this machine, in one process. Any thread may ask; one text is spoken at a time."""

    def __init__(self) -> None:
        self.answer_timeout = ANSWER_TIMEOUT
        """Longest time to wait for a text to be spoken, s."""
        self._lock = threading.Lock()
        self._child: ChildProcess | None = None
        self._found: Mapping[str, Any] | None = None

    @property
    def pid(self) -> int | None:
        """Process id of the speech process; None while there is none."""
        child = self._child
        return child.process.pid if child is not None else None

    def warm_up(self) -> None:
        """Start the process without waiting for it; else the first text does."""
        with self._lock:
            if self._child is None:
                self._start()

    def missing(self, engine: str, voice: str) -> str | None:
        """Why a voice cannot speak, None when it can."""
        found = self._found  # what is installed stays so: nobody waits here for a text that is being spoken
        if found is None:
            with self._lock:
                found = self._engines()
        if engine not in found:
            return f"unknown engine {engine!r}, there are {listed(sorted(found))}"
        voices = found[engine]
        if isinstance(voices, str):
            return f"the engine {engine} is not installed (Debian package {engine}): {voices}"
        if voices is not None and voice not in voices:
            return f"the engine {engine} has no voice {voice!r}, it has {listed(voices)}"
        return None

    def synthesise(self, utterance: Utterance) -> Speech:
        """Make the sound of a text; blocks until it is there.

        Raises:
            SpeechError: The engine or the voice is missing, it cannot say this, or the process died of it.
        """
        problem = self.missing(utterance.engine, utterance.voice)
        if problem is not None:
            raise SpeechError(problem)
        what = f"speaking {utterance.text[:60]!r}"
        request = (utterance.engine, utterance.voice, utterance.text, utterance.speed)
        with self._lock:
            self._engines()
            rate, words = self._child.ask("synthesise", request, self.answer_timeout, what)
            sound = self._child.receive_bytes(what)
        samples = np.frombuffer(sound, dtype=np.int16).astype(np.float32) / 32768.0
        samples.flags.writeable = False
        heard = (Word(*word) for word in words)
        return Speech(
            samples, rate, tuple(_without_pause(word, samples, rate) for word in heard if word.end > word.start)
        )

    def close(self) -> None:
        """End the process; a later text would start it again."""
        if not self._lock.acquire(timeout=CLOSING):
            child = self._child
            if child is not None:  # it speaks, or hangs, and nobody waits for that
                child.process.kill()
            self._lock.acquire()
        try:
            if self._child is not None:
                self._child.stop()
                self._child = self._found = None
        finally:
            self._lock.release()

    # --- inside, under the lock -----------------------------------------------------------------------------------

    def _engines(self) -> Mapping[str, Any]:
        """What the running process has found; it is started when it does not run."""
        child = self._child
        if child is not None and (child.over or child.process.poll() is not None):
            log.error("%s; it is started again", child.last_words())
            child.kill()
            self._child = None
        if self._child is None:
            self._start()
        if self._found is None:
            self._found = self._child.receive(START_TIMEOUT, "starting")
        return self._found

    def _start(self) -> None:
        self._child = ChildProcess(MODULE, (), "speech process", SpeechError, SpeechError)
        self._found = None


def _without_pause(word: Word, samples: np.ndarray, rate: int) -> Word:
    """A word that ends where its sound does: engines count the pause behind it in."""
    begin, end = round(word.start * rate), round(word.end * rate)
    loud = np.flatnonzero(np.abs(samples[begin:end]) > QUIET)
    if not len(loud):
        return word
    return replace(word, end=min(word.end, (begin + int(loud[-1]) + 1) / rate))
