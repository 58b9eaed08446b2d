"""Sounds that are computed: the tones of ALAudioPlayer and ALAudioDevice."""

from __future__ import annotations

import numpy as np

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.samples import RATE, Sound
from nao_sim_bridge.naoqi.binding.arguments import number

HIGHEST = 20000.0
LONGEST = 600.0
# A tone swells and fades in this time, s: cut off hard it would click.
EDGE = 0.002


def sine(frequency: float, gain: float, duration: float) -> Sound:
    """A tone of one channel.

    Args:
        frequency: Hz, 1 to 20000.
        gain: Amplitude in percent of full scale, 0 to 100.
        duration: s, above 0 to 600.

    Raises:
        BadValue: An argument outside of this.
    """
    pitch = number(frequency, "frequence", 1.0, HIGHEST)
    amplitude = number(gain, "gain", 0.0, 100.0) / 100.0
    frames = round(number(duration, "duration", 0.0, LONGEST) * RATE)
    if frames == 0:
        raise BadValue("duration", duration, f"above 0 to {LONGEST:g}")
    # Cycles are reduced to their fraction in double precision: long tones keep their phase.
    cycles = (np.arange(frames) * (pitch / RATE)) % 1.0
    samples = (amplitude * np.sin(2.0 * np.pi * cycles)).astype(np.float32)
    edge = min(round(EDGE * RATE), frames // 2)
    ramp = np.sin(0.5 * np.pi * np.arange(edge) / max(edge, 1)) ** 2
    samples[:edge] *= ramp
    samples[frames - edge :] *= ramp[::-1]
    return Sound(samples[:, np.newaxis], RATE)


def side(pan: int) -> float:
    """Panorama of playSine: -1 left, 0 both, 1 right.

    Raises:
        BadValue: Something else.
    """
    if pan not in (-1, 0, 1):
        raise BadValue("pan", pan, "-1 (left), 0 (both) or 1 (right)")
    return float(pan)
