"""Threads in which speech is made, so that nobody who asks for it waits."""

from __future__ import annotations

import logging
import queue
import threading
from dataclasses import dataclass
from typing import Any, Callable

import numpy as np

from nao_sim_bridge.base.errors import BadValue, SimulationError
from nao_sim_bridge.base.samples import RATE, Sound
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.tasks import Task, WorkThreads
from nao_sim_bridge.speech.clips import Clip, ClipMaker, Style
from nao_sim_bridge.speech.engines import Engines, SpeechError, silence
from nao_sim_bridge.speech.sentences import Item, Sentence, sentences
from nao_sim_bridge.speech.tags import Pause, Piece, TagReader

log = logging.getLogger("nao_sim.speech")


@dataclass(eq=False)
class Pending:
    """A sentence that is being made: when it is ready, there is a clip, or an error.

    One that nobody wants any more is left out.
    """

    sentence: Sentence
    style: Style
    ready: bool = False
    clip: Clip | None = None
    error: SpeechError | None = None
    wanted: bool = True


class Studio:
    """Reads texts and makes sentences of them, one after the other, in a thread of its own.

    Those who speak are the engines of this machine unless others are given; `released` is called when a sentence is
    there that may have been waited for.
    """

    def __init__(self, engines: Any = None) -> None:
        self.engines = engines or Engines()
        self.tags = TagReader()
        self.released: Callable[[], None] = lambda: None
        self._maker = ClipMaker(self.engines)
        self._orders: queue.SimpleQueue = queue.SimpleQueue()
        self._lock = threading.Lock()
        self._thread: threading.Thread | None = None
        self._working = WorkThreads("speech in files", load_sizes().clients.threads)

    def warm_up(self) -> None:
        """Have everything ready for the first text, without waiting for it; a missing engine is told when asked for."""
        self.in_background(self.engines.warm_up, "warm up")

    def read(self, text: str, style: Style) -> list[Item]:
        """The sentences of a text with tags.

        Raises:
            BadValue: It is too long, or its pauses are together.
        """
        self.check_length(text)
        return self.sentences_of(text, self.tags.read(text, style.prosody))

    def check_length(self, text: str) -> None:
        """Refuse a text that is too long with a BadValue, before it is read."""
        longest = load_sizes().speech.text_characters
        if len(text) > longest:
            raise BadValue("text", f"{text[:40]}... of {len(text)} characters", f"{longest} characters at most")

    def sentences_of(self, text: str, pieces: list[Piece]) -> list[Item]:
        """The sentences of what has been read of a text; a BadValue when its pauses are too long together."""
        longest = load_sizes().speech.pauses_s
        pauses = sum(piece.seconds for piece in pieces if isinstance(piece, Pause))
        if pauses > longest:
            raise BadValue("text", f"{text[:40]}... with {pauses:.0f} s of pauses", f"{longest:g} s at most")
        return sentences(pieces)

    def order(self, sentence: Sentence, style: Style) -> Pending:
        """Have a sentence made; at once back."""
        pending = Pending(sentence, style)
        with self._lock:
            if self._thread is None:
                self._thread = threading.Thread(target=self._run, name="speech", daemon=True)
                self._thread.start()
        self._orders.put(pending)
        return pending

    def sound(self, text: str, style: Style) -> Sound:
        """A whole text as sound, as it would be heard from the loudspeakers; blocks, one channel.

        Raises:
            SpeechError: It cannot be said.
        """
        longest, seconds = load_sizes().speech.file_s, 0.0
        samples = [silence(0.0, RATE)]
        for item in self.read(text, style):
            if isinstance(item, Sentence):
                sound = self._maker.make(item, style).sound
                seconds += sound.duration
                if seconds > longest:
                    raise SpeechError(f"the text takes more than {longest:g} s to say, which are allowed at once")
                samples.append(sound.samples[:, 0])
        return Sound(np.clip(np.concatenate(samples)[:, None] * np.float32(style.volume), -1.0, 1.0), RATE)

    def in_background(self, work: Callable[[], Any], name: str) -> Task:
        """Do something that may take a while in another thread; the task ends with what it returns or raises."""
        return self._working.work_out(name, work)

    def close(self) -> None:
        """End the threads and the engines."""
        with self._lock:
            if self._thread is not None:
                self._orders.put(None)
                self._thread = None
        self.engines.close()

    def _run(self) -> None:
        for pending in iter(self._orders.get, None):
            if pending.wanted:
                self._make(pending)

    def _make(self, pending: Pending) -> None:
        try:
            pending.clip = self._maker.make(pending.sentence, pending.style)
        except SimulationError as error:
            pending.error = error if isinstance(error, SpeechError) else SpeechError(str(error))
        except Exception as error:
            text = pending.sentence.text
            log.exception("%r cannot be spoken", text)
            pending.error = SpeechError(f"{text!r} cannot be spoken: {error}")
        pending.ready = True  # from here on the other thread reads it
        self.released()
