"""Finds where speech begins and ends in what a microphone hears. It knows levels only, so a bang is speech as well."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import Deque, Iterator

import numpy as np

from nao_sim_bridge.hearing.settings import RecognitionSettings

RATE = 16000
# Where speech is louder than most noises, Hz.
SPEECH_BAND = (200.0, 5000.0)
# The background is what the quietest tenth of the last second or so is like, percent: speech has that many gaps, and
# a steady noise is all of it.
FLOOR_SHARE = 10.0


@dataclass(frozen=True)
class SpeechChange:
    """Speech began or ended at a time, s: whether it is present from then on."""

    time: float
    present: bool


@dataclass(frozen=True)
class Utterance:
    """A stretch of speech with a little silence around it: (n,) float32 samples, -1..1, 16 kHz, from `origin` on.

    The speech itself began at `start` and ended at `end`, s. The background, (m,), is what it sounded like before,
    without speech; it may be empty.
    """

    start: float
    end: float
    origin: float
    samples: np.ndarray
    background: np.ndarray


class VoiceActivity:
    """Cuts a stream into utterances; at a high sensitivity, 0..1, speech may be quieter beside the background."""

    def __init__(self, settings: RecognitionSettings, sensitivity: float = 0.5) -> None:
        self._settings = settings.voice_activity
        self.sensitivity = sensitivity
        self._frame = round(self._settings.frame_s * RATE)
        self._window = np.hanning(self._frame).astype(np.float32)
        self._power = float(self._frame * np.sum(self._window**2))
        low, high = (round(edge * self._settings.frame_s) for edge in SPEECH_BAND)
        self._band = slice(low, high + 1)
        self._quiet_frames = round(settings.noise_reduction.background_s / self._settings.frame_s)
        self.reset()

    def reset(self) -> None:
        """Forget everything that was heard."""
        s = self._settings
        self._rest = np.zeros(0, np.float32)
        self._time: float | None = None
        self._levels: Deque[float] = deque(maxlen=round(s.background_s / s.frame_s))
        self._loud: Deque[bool] = deque(maxlen=s.window_frames)
        # Frames before speech: those that will open an utterance, then those that are surely background.
        self._before: Deque[np.ndarray] = deque()
        self._background: Deque[np.ndarray] = deque(maxlen=self._quiet_frames)
        self._speech: list[np.ndarray] = []
        self._loud_frames = 0
        self._silent_frames = 0
        self._start = 0.0
        self._present = False

    def get_used_to(self, samples: np.ndarray) -> None:
        """Start anew, with the background of samples heard before; speech in it is left out. See `hear`."""
        self.reset()
        frames = _scaled(samples)
        frames = frames[: len(frames) // self._frame * self._frame].reshape(-1, self._frame)
        self._levels.extend(self._level(frame) for frame in frames)
        loud = [self._stands_out(self._level(frame)) for frame in frames]
        near = np.convolve(loud, np.ones(2 * self._settings.window_frames + 1), "same") if loud else ()
        for frame, speech in zip(frames, near):
            if not speech:
                self._keep(frame)

    def hear(self, time: float, samples: np.ndarray) -> Iterator[SpeechChange | Utterance]:
        """Take the next block, (n,) int16 or float samples in -1..1, 16 kHz; what began or ended in it, in order.

        A gap before its time, s, makes everything start anew.
        """
        heard = _scaled(samples)
        if self._time is not None and abs(self._time + len(self._rest) / RATE - time) > self._settings.frame_s:
            yield from self.finish()
            self.reset()
        if self._time is None:
            self._time = time
        stream = np.concatenate([self._rest, heard])
        whole = len(stream) // self._frame * self._frame
        self._rest = stream[whole:]
        for frame in stream[:whole].reshape(-1, self._frame):
            self._time += self._settings.frame_s
            yield from self._take(frame)

    def finish(self) -> Iterator[SpeechChange | Utterance]:
        """What is left when nothing more comes."""
        if self._present:
            yield from self._end()

    def _take(self, frame: np.ndarray) -> Iterator[SpeechChange | Utterance]:
        s = self._settings
        level = self._level(frame)
        self._levels.append(level)
        loud = self._stands_out(level)
        self._loud.append(loud)
        if not self._present:
            self._keep(frame)
            if sum(self._loud) >= s.begin_frames:
                yield self._begin()
            return
        self._speech.append(frame)
        self._loud_frames += loud
        self._silent_frames = 0 if loud else self._silent_frames + 1
        if self._silent_frames * s.frame_s >= s.pause_s or len(self._speech) * s.frame_s >= s.longest_s:
            yield from self._end()

    def _stands_out(self, level: float) -> bool:
        floor = float(np.percentile(self._levels, FLOOR_SHARE))
        return level > max(floor + self._settings.margin(self.sensitivity), self._settings.least_level_db)

    def _level(self, frame: np.ndarray) -> float:
        """Level of a frame in the band of speech, dB below full scale."""
        power = np.abs(np.fft.rfft(frame * self._window)[self._band]) ** 2
        return float(10.0 * np.log10(2.0 * np.sum(power) / self._power + 1e-12))

    def _keep(self, frame: np.ndarray) -> None:
        self._before.append(frame)
        s = self._settings
        if len(self._before) * s.frame_s > s.before_s + s.window_frames * s.frame_s:
            self._background.append(self._before.popleft())

    def _begin(self) -> SpeechChange:
        s = self._settings
        self._speech = list(self._before)
        self._before.clear()
        self._loud_frames, self._silent_frames, self._present = sum(self._loud), 0, True
        self._start = self._time - s.frame_s * s.window_frames
        return SpeechChange(self._start, True)

    def _end(self) -> Iterator[SpeechChange | Utterance]:
        s = self._settings
        silence = self._silent_frames
        end = self._time - silence * s.frame_s
        unused = max(silence - round(s.after_s / s.frame_s), 0)
        origin = self._time - len(self._speech) * s.frame_s
        frames = self._speech[: len(self._speech) - unused]
        self._present, self._speech = False, []
        self._loud.clear()
        yield SpeechChange(end, False)
        if self._loud_frames * s.frame_s >= s.least_speech_s:
            background = np.concatenate(self._background) if self._background else np.zeros(0, np.float32)
            yield Utterance(self._start, end, origin, np.concatenate(frames), background)


def _scaled(samples: np.ndarray) -> np.ndarray:
    """int16 or float samples as float32, -1..1."""
    return samples.astype(np.float32) / (32768.0 if samples.dtype == np.int16 else 1.0)
