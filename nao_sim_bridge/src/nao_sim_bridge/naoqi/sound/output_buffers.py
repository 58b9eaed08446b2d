"""Sound that clients send piece by piece: the pieces are played one after the other without a gap."""

from __future__ import annotations

from collections import deque
from typing import Any

import numpy as np
import soxr

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.samples import RATE, Sound
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.naoqi.binding.arguments import number

LARGEST = 16384
RATES = (16000, 22050, 44100, 48000)
CHANNELS = 2
FRAME = 2 * CHANNELS
# A sender waits while more than this is still to be played, s; of one that does not wait, no more is taken.
AHEAD, TOO_MUCH = 1.0, 30.0
# What the change of rate still holds back is played when nothing has followed this long before the end of a piece, s.
LAST_CALL = 0.05


class OutputBuffers:
    """The queue of pieces; simulation thread only, but for `checked`."""

    def __init__(self, simulation: Any) -> None:
        self._simulation = simulation
        self.rate = 22050
        self._stream: soxr.ResampleStream | None = None
        self._last: Any = None
        self._queued: deque[Any] = deque()
        self._waiting: deque[tuple[float, Task]] = deque()

    def add(self, samples: np.ndarray) -> Any:
        """Play a piece, (frames, 2) float32 at `rate`, after those before it.

        Returns True, False when far too much is waiting already, or a task that ends with True once the sender may go
        on.
        """
        if not self._queued:
            self._stream = None
        if self._ahead > TOO_MUCH or len(self._queued) >= load_sizes().lists.pieces:
            return False
        self._play(self._at_rate_of_the_world(samples))
        if self._ahead <= AHEAD:
            return True
        task = self._simulation.task_ids.make("sendRemoteBufferToOutput")
        self._waiting.append((self._simulation.time + self._ahead - AHEAD, task))
        return task

    def set_rate(self, rate: int) -> None:
        """Samples a second of the pieces to come."""
        if rate != self.rate:
            self._flush()
            self.rate = rate

    def drop(self) -> None:
        """Be silent; who waits may go on."""
        queued, self._queued = list(self._queued), deque()
        for playing in queued:
            playing.stop()
        self._stream = None
        self._let_go(len(self._waiting))

    @property
    def _ahead(self) -> float:
        """How long the queue will last, s."""
        end = self._last.end_frame if self._last is not None else None
        return 0.0 if end is None else end / RATE - self._simulation.time

    def _at_rate_of_the_world(self, samples: np.ndarray) -> np.ndarray:
        if self.rate == RATE:
            return samples
        if self._stream is None:
            self._stream = soxr.ResampleStream(self.rate, RATE, CHANNELS, dtype="float32")
        return self._stream.resample_chunk(samples)

    def _flush(self) -> None:
        """Play what the change of rate still holds back."""
        stream, self._stream = self._stream, None
        if stream is not None:
            self._play(stream.resample_chunk(np.zeros((0, CHANNELS), dtype=np.float32), last=True))

    def _play(self, samples: np.ndarray) -> None:
        if len(samples) == 0:
            return
        marks = [(max(0.0, len(samples) / RATE - LAST_CALL), lambda: self._last_call(playing))]
        playing = self._last = self._simulation.sound.loudspeakers.play(
            Sound(samples, RATE), "output buffer", marks=marks, after=self._last
        )
        self._queued.append(playing)
        playing.task.add_done_callback(lambda _: self._played(playing))

    def _last_call(self, playing: Any) -> None:
        if playing is self._last:
            self._flush()

    def _played(self, playing: Any) -> None:
        if playing in self._queued:
            self._queued.remove(playing)
        now = self._simulation.time
        self._let_go(sum(1 for due, _ in self._waiting if due <= now or not self._queued))

    def _let_go(self, count: int) -> None:
        for _ in range(count):
            self._waiting.popleft()[1].finish(True)


def samples_of(frames: int, buffer: Any) -> np.ndarray:
    """What a client sent, bytes of 16 bit stereo frames or as many numbers, as (frames, 2) float32 in -1 to 1.

    A BadValue when that is no sound of so many frames.
    """
    number(frames, "nbOfFrames", 1, LARGEST)
    if isinstance(buffer, (bytes, bytearray)):
        if len(buffer) != frames * FRAME:
            raise BadValue("length of pBuffer", len(buffer), f"{FRAME} bytes a frame, {frames * FRAME} in all")
        values = np.frombuffer(bytes(buffer), dtype="<i2")
    elif isinstance(buffer, (list, tuple)) and len(buffer) == frames * CHANNELS:
        values = np.array([number(value, f"pBuffer[{i}]", -32768, 32767) for i, value in enumerate(buffer)])
    else:
        raise BadValue("pBuffer", type(buffer).__name__, f"bytes of {frames} frames of two channels of 16 bits")
    return (values.astype(np.float32) / 32768.0).reshape(frames, CHANNELS)
