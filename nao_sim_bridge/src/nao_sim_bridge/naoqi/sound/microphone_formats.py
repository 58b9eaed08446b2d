"""The ways in which ALAudioDevice hands out what the microphones hear."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from nao_sim_bridge.base.errors import BadValue

CHANNELS = ("left", "right", "front", "rear")
ALL = 0
HIGH, LOW = 48000, 16000
ALLOWED = "48000 Hz with channels 0 (all four), or 16000 Hz with 1 (left), 2 (right), 3 (front) or 4 (rear)"


@dataclass(frozen=True)
class MicrophoneFormat:
    """What a client gets."""

    rate: int = HIGH  # samples a second
    channel: int = ALL  # 0 for all four, else 1 left, 2 right, 3 front, 4 rear
    deinterleaved: bool = False  # one channel after the other, instead of one frame after the other

    @property
    def wants(self) -> str:
        return "48k4" if self.channel == ALL else "16k1"

    @property
    def channel_name(self) -> str:
        """Name of the channel for the ears; means nothing for all four."""
        return CHANNELS[max(self.channel - 1, 0)]

    def packed(self, samples: np.ndarray) -> bytes:
        """(frames, channels) int16 as bytes, little end first."""
        ordered = samples.T if self.deinterleaved else samples
        return np.ascontiguousarray(ordered, dtype="<i2").tobytes()


def microphone_format(rate: int, channels: Any, deinterleaved: int) -> MicrophoneFormat:
    """The format of a client's wishes: channels are 0 to 4 as above, or four flags for left, right, front, rear.

    A BadValue when the microphones cannot be had like this.
    """
    if deinterleaved not in (0, 1):
        raise BadValue("deinterleaved", deinterleaved, "0 or 1")
    channel = flags_to_channel(channels) if isinstance(channels, (list, tuple)) else channels
    if isinstance(channel, bool) or (rate, channel) not in {(HIGH, ALL), (LOW, 1), (LOW, 2), (LOW, 3), (LOW, 4)}:
        raise BadValue("sampleRate and channels", (rate, channels), ALLOWED)
    return MicrophoneFormat(rate, channel, bool(deinterleaved))


def flags_to_channel(flags: Any) -> int:
    """0 for four flags that are set, 1 to 4 for the one that is; a BadValue for anything else."""
    right = isinstance(flags, (list, tuple)) and len(flags) == 4 and all(flag in (0, 1) for flag in flags)
    if not right or sum(flags) not in (1, 4):
        raise BadValue("channels", flags, "flags [left, right, front, rear] of 0 or 1: one of them set, or all four")
    return ALL if sum(flags) == 4 else list(flags).index(1) + 1
