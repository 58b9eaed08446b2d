#!/usr/bin/env python3
"""Makes the sounds that come with the simulator: `sounds/nao_library/*.ogg`, all of them computed.

    PYTHONPATH=nao_sim_bridge/src python3 nao_sim_bridge/tools/make_sounds.py

Each sound is a function below; the name of the function is the name of the sound.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Callable

import numpy as np
import soundfile
from dance_music import dance_music

from nao_sim_bridge.base.config import sounds_directory

RATE = 24000
SET = "nao_library"
PEAK = 0.7
Make = Callable[[np.random.Generator], np.ndarray]
SOUNDS: dict[str, Make] = {}


def put_into(table: dict[str, Make]) -> Callable[[Make], Make]:
    """What puts functions into a table of sounds, by their names."""
    return lambda make: table.setdefault(make.__name__, make)


sound = put_into(SOUNDS)


@sound
def bip(_: np.random.Generator) -> np.ndarray:
    """One short high tone: the robot begins to listen."""
    return note(880.0, 0.15)


@sound
def double_bip(_: np.random.Generator) -> np.ndarray:
    """Two short tones downwards: the robot has listened."""
    return in_turn(note(880.0, 0.1), silence(0.04), note(660.0, 0.1))


@sound
def chime(_: np.random.Generator) -> np.ndarray:
    """Two bells, a third apart."""
    return at({0.0: bell(659.3, 1.0), 0.25: bell(523.3, 1.2)})


@sound
def success(_: np.random.Generator) -> np.ndarray:
    """A broken chord upwards."""
    return at({0.0: bell(523.3, 0.6), 0.1: bell(659.3, 0.6), 0.2: bell(784.0, 0.6), 0.3: bell(1046.5, 0.9)})


@sound
def failure(_: np.random.Generator) -> np.ndarray:
    """Two low buzzing tones downwards."""
    return in_turn(note(220.0, 0.2, overtones=8), silence(0.05), note(165.0, 0.35, overtones=8))


@sound
def alarm(_: np.random.Generator) -> np.ndarray:
    """A siren: three times up and down."""
    time = seconds(1.5)
    pitch = 700.0 + 250.0 * np.sin(2.0 * np.pi * 2.0 * time)
    return faded(np.sin(2.0 * np.pi * np.cumsum(pitch) / RATE), 0.01)


@sound
def click(random: np.random.Generator) -> np.ndarray:
    """A shutter: two very short noises."""
    snap = random.standard_normal(round(0.012 * RATE)) * np.exp(-np.arange(round(0.012 * RATE)) / (0.002 * RATE))
    return in_turn(snap, silence(0.06), 0.7 * snap[::-1])


@sound
def applause(random: np.random.Generator) -> np.ndarray:
    """Many hands: short bursts of noise at random times, swelling and fading."""
    duration, claps = 2.0, 400
    total = np.zeros(round((duration + 0.1) * RATE))
    for begin in np.sort(random.beta(1.6, 2.0, claps)) * duration:
        length = round(random.uniform(0.01, 0.03) * RATE)
        burst = np.diff(random.standard_normal(length + 1)) * np.exp(-np.arange(length) / (0.25 * length))
        first = round(begin * RATE)
        total[first : first + length] += random.uniform(0.3, 1.0) * burst
    return total


@sound
def dance_100(random: np.random.Generator) -> np.ndarray:
    """Music for the dance, 100 beats a minute."""
    return dance_music(100.0, RATE, random)


@sound
def dance_120(random: np.random.Generator) -> np.ndarray:
    """Music for the dance, 120 beats a minute."""
    return dance_music(120.0, RATE, random)


def seconds(duration: float) -> np.ndarray:
    """The times of all samples, s."""
    return np.arange(round(duration * RATE)) / RATE


def silence(duration: float) -> np.ndarray:
    """Nothing for a while, s."""
    return np.zeros(round(duration * RATE))


def note(pitch: float, duration: float, overtones: int = 2) -> np.ndarray:
    """A steady tone of `pitch` Hz with soft edges."""
    time = seconds(duration)
    return faded(sum(np.sin(2.0 * np.pi * pitch * k * time) / k**1.5 for k in range(1, overtones + 1)), 0.008)


def bell(pitch: float, duration: float) -> np.ndarray:
    """A struck tone of `pitch` Hz: its overtones are not quite harmonic, and fade the sooner the higher they are."""
    time = seconds(duration)
    parts = ((1.0, 1.0, 5.0), (2.0, 0.5, 7.0), (2.76, 0.3, 9.0), (5.4, 0.12, 14.0))
    tone = sum(level * np.sin(2.0 * np.pi * pitch * k * time) * np.exp(-decay * time) for k, level, decay in parts)
    return faded(tone, 0.003)


def faded(samples: np.ndarray, edge: float) -> np.ndarray:
    """Soft edges of `edge` s, so that nothing clicks."""
    count = round(edge * RATE)
    ramp = np.sin(0.5 * np.pi * np.arange(count) / count) ** 2
    samples[:count] *= ramp
    samples[-count:] *= ramp[::-1]
    return samples


def in_turn(*parts: np.ndarray) -> np.ndarray:
    """One after the other."""
    return np.concatenate(parts)


def at(parts: dict[float, np.ndarray]) -> np.ndarray:
    """Each from its time (s) on, together."""
    total = np.zeros(max(round(begin * RATE) + len(part) for begin, part in parts.items()))
    for begin, part in parts.items():
        first = round(begin * RATE)
        total[first : first + len(part)] += part
    return total


def made(name: str) -> np.ndarray:
    """A sound of the table at its level; the same at every call."""
    samples = SOUNDS[name](np.random.default_rng(0))
    return (PEAK * samples / np.abs(samples).max()).astype(np.float32)


def main() -> None:
    """Write all sounds."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--folder", type=Path, default=sounds_directory() / SET, help="where they go")
    folder = options.parse_args().folder
    folder.mkdir(parents=True, exist_ok=True)
    for name in SOUNDS:
        soundfile.write(str(folder / f"{name}.ogg"), made(name), RATE, format="OGG", subtype="VORBIS")


if __name__ == "__main__":
    main()
