#!/usr/bin/env python3
"""Makes the sounds that programs expect on a robot, in `robot_files/usr/share/naoqi/wav`: all computed, none recorded.

    PYTHONPATH=nao_sim_bridge/src python3 nao_sim_bridge/tools/make_robot_sounds.py

Each sound is a function below; the name of the function is that of the sound, which is what public programs for NAOqi
play. They are told apart and fit their names, and sound no more like the robot's than that. Digits need flite.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import soundfile
import soxr
from make_sounds import PEAK, RATE, Make, at, bell, faded, in_turn, note, put_into, seconds, silence

from nao_sim_bridge.base.config import robot_files_directory
from nao_sim_bridge.speech.flite import Flite

FOLDER = "usr/share/naoqi/wav"
FILE_RATE = 16000
VOICE, QUIET = "slt", 0.01
SAID = {
    **{str(digit): word for digit, word in enumerate("zero one two three four five six seven eight nine".split())},
    "point": "point",
    "my_internet_address_is": "my internet address is",
}
"""Name of a spoken sound -> what is said."""
SOUNDS: dict[str, Make] = {}
sound = put_into(SOUNDS)


@sound
def begin_reco(_: np.random.Generator) -> np.ndarray:
    """Two tones upwards: the robot begins to listen."""
    return in_turn(note(660.0, 0.09), silence(0.03), note(990.0, 0.12))


@sound
def end_reco(_: np.random.Generator) -> np.ndarray:
    """The same downwards: it has listened."""
    return in_turn(note(990.0, 0.09), silence(0.03), note(660.0, 0.12))


@sound
def bip_gentle(_: np.random.Generator) -> np.ndarray:
    """A soft bell."""
    return bell(784.0, 0.45)


@sound
def bip_power_off(_: np.random.Generator) -> np.ndarray:
    """Three soft bells downwards."""
    return at({0.0: bell(784.0, 0.4), 0.2: bell(587.3, 0.4), 0.4: bell(392.0, 0.6)})


@sound
def shortbip(_: np.random.Generator) -> np.ndarray:
    """A very short tone."""
    return note(1200.0, 0.07)


@sound
def chimes_short(_: np.random.Generator) -> np.ndarray:
    """Four small bells."""
    return at({0.12 * k: bell(pitch, 0.6) for k, pitch in enumerate((1046.5, 1318.5, 1568.0, 2093.0))})


@sound
def fall_jpj(_: np.random.Generator) -> np.ndarray:
    """A tone that falls."""
    return glide(900.0, 150.0, 0.7)


@sound
def buggy(random: np.random.Generator) -> np.ndarray:
    """A rattle: something is wrong."""
    return in_turn(*(part for _ in range(4) for part in (note(random.uniform(110.0, 180.0), 0.08, 9), silence(0.03))))


@sound
def module_cnx(_: np.random.Generator) -> np.ndarray:
    """A tone that rises: a module has come."""
    return glide(500.0, 1000.0, 0.18)


@sound
def start_jingle(_: np.random.Generator) -> np.ndarray:
    """A broken chord upwards."""
    return at({0.16 * k: bell(pitch, 0.7) for k, pitch in enumerate((392.0, 523.3, 659.3, 784.0))})


@sound
def stop_jingle(_: np.random.Generator) -> np.ndarray:
    """The same downwards."""
    return at({0.16 * k: bell(pitch, 0.7) for k, pitch in enumerate((784.0, 659.3, 523.3, 392.0))})


@sound
def shutdown(_: np.random.Generator) -> np.ndarray:
    """A slow chord that ends."""
    return at({0.0: bell(523.3, 1.2), 0.3: bell(392.0, 1.2), 0.6: bell(261.6, 1.4)})


@sound
def random(random: np.random.Generator) -> np.ndarray:
    """Chatter of a robot for 8 s: programs look at it 5 s after its beginning."""
    return chatter(random, 8.0, 0.02)


@sound
def random_waiting(random: np.random.Generator) -> np.ndarray:
    """Slower chatter for 4 s."""
    return chatter(random, 4.0, 0.25)


def chatter(random: np.random.Generator, duration: float, pause: float) -> np.ndarray:
    """Short tones and glides of random pitch, `pause` s apart at least, for `duration` s."""
    parts: list[np.ndarray] = []
    while sum(map(len, parts)) < duration * RATE:
        first, last = 440.0 * 2.0 ** (random.integers(-7, 13, 2) / 12.0)
        parts += [glide(first, random.choice((first, last)), random.uniform(0.06, 0.2))]
        parts += [silence(pause + random.uniform(0.0, 0.12))]
    return np.concatenate(parts)[: round(duration * RATE)]


def glide(first: float, last: float, duration: float) -> np.ndarray:
    """A tone from one pitch to another, Hz."""
    pitch = first * (last / first) ** (seconds(duration) / duration)
    phase = 2.0 * np.pi * np.cumsum(pitch) / RATE
    return faded(np.sin(phase) + 0.3 * np.sin(2.0 * phase), 0.008)


def spoken(flite: Flite, text: str) -> np.ndarray:
    """A text in the voice of these sounds, at `FILE_RATE`, without the silence around it."""
    rate, content, _ = flite.synthesise(VOICE, text, 1.0)
    samples = soxr.resample(np.frombuffer(content, "<i2") / 32768.0, rate, FILE_RATE)
    heard = np.flatnonzero(np.abs(samples) > QUIET)
    return samples[heard[0] : heard[-1] + 1]


def made(name: str) -> np.ndarray:
    """A sound of the table, at `FILE_RATE`; the same at every call."""
    return soxr.resample(SOUNDS[name](np.random.default_rng(0)), RATE, FILE_RATE)


def main() -> None:
    """Write all sounds."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--folder", type=Path, default=robot_files_directory() / FOLDER, help="where they go")
    folder = options.parse_args().folder
    folder.mkdir(parents=True, exist_ok=True)
    flite = Flite()
    sounds = {**{name: made(name) for name in SOUNDS}, **{name: spoken(flite, text) for name, text in SAID.items()}}
    for name, samples in sounds.items():
        level = (PEAK * samples / np.abs(samples).max()).astype(np.float32)
        soundfile.write(str(folder / f"{name}.wav"), level, FILE_RATE, subtype="PCM_16")


if __name__ == "__main__":
    main()
