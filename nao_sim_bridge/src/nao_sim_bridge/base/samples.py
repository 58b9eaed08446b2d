"""Sound as numbers: samples, their rate, and changes of rate."""

from __future__ import annotations

import math

import numpy as np

from nao_sim_bridge.base.errors import BadValue

RATE = 48000
"""Frames per second in which everything is played and heard."""
LONGEST = 3600.0
"""Longest sound, s: an hour of two channels takes 1.4 GB."""


class Sound:
    """Samples of one or more channels; immutable.

    Attributes:
        samples: (frames, channels) float32, -1..1, read-only.
        rate: Frames per second.

    Args:
        samples: (frames,) or (frames, channels); floats are taken as they are, 16 bit integers are scaled to -1..1.

    Raises:
        BadValue: The samples have no such shape or are not finite, or the rate is none.
    """

    def __init__(self, samples: np.ndarray, rate: int = RATE) -> None:
        values = np.asarray(samples)
        if values.dtype == np.int16:
            values = values.astype(np.float32) / np.float32(32768.0)
        values = np.array(values, dtype=np.float32, copy=values is samples)
        if values.ndim == 1:
            values = values[:, None]
        if values.ndim != 2 or values.shape[1] == 0:
            raise BadValue("samples", f"an array of shape {values.shape}", "(frames,) or (frames, channels)")
        if not 1 <= rate <= 768000:
            raise BadValue("rate", rate, "1 to 768000 frames per second")
        if len(values) > LONGEST * rate:
            raise BadValue("samples", f"{len(values) / rate:.0f} s of sound", f"at most {LONGEST:.0f} s")
        if not np.all(np.isfinite(values)):
            raise BadValue("samples", "not finite at places", "finite numbers")
        values.flags.writeable = False
        self.samples = values
        self.rate = int(rate)

    @property
    def frames(self) -> int:
        return len(self.samples)

    @property
    def channels(self) -> int:
        return self.samples.shape[1]

    @property
    def duration(self) -> float:
        """Length in s."""
        return self.frames / self.rate

    def mono(self) -> Sound:
        if self.channels == 1:
            return self
        return Sound(self.samples.mean(axis=1, dtype=np.float32), self.rate)

    def at_rate(self, rate: int) -> Sound:
        """The same sound with another number of frames per second; takes about 1 ms for each second of sound."""
        if rate == self.rate:
            return self
        if not 1 <= rate <= 768000:
            raise BadValue("rate", rate, "1 to 768000 frames per second")
        import soxr  # only who has other rates needs it

        changed = soxr.resample(self.samples, self.rate, rate) if self.frames else self.samples
        return Sound(changed, rate)

    def part(self, start: float, end: float = math.inf) -> Sound:
        """What sounds from `start` to `end`, s."""
        first = max(0, round(start * self.rate))
        last = self.frames if end == math.inf else max(first, round(end * self.rate))
        return Sound(self.samples[first:last], self.rate)

    def pcm16(self) -> np.ndarray:
        """(frames, channels) int16 as a converter makes them; what is beyond full scale is cut."""
        return pcm16(self.samples)


def pcm16(samples: np.ndarray) -> np.ndarray:
    """int16 of floats -1..1 of any shape; what is beyond full scale is cut."""
    scaled = samples * np.float32(32768.0)
    np.rint(scaled, out=scaled)
    np.clip(scaled, -32768.0, 32767.0, out=scaled)
    return scaled.astype(np.int16)


def frame_at(seconds: float) -> int:
    """Number of the frame at a simulated time in s."""
    return round(seconds * RATE)


def sine(frequency: float, seconds: float, amplitude: float = 1.0, rate: int = RATE) -> Sound:
    """A tone of `frequency` Hz."""
    steps = np.arange(round(seconds * rate)) * (2.0 * math.pi * frequency / rate)
    return Sound((amplitude * np.sin(steps)).astype(np.float32), rate)
