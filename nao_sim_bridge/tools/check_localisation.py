#!/usr/bin/env python3
"""Measures how well the simulated robot finds sounds, and prints each figure beside its bound. Needs no ROS master.

A robot stands in the empty world; sources sound all around it, at 1 to 3 m, with the level of a talking person, in the
background noise of a quiet room or with noise 20 dB below what arrives. Each block of 170 ms in which a sound is
located counts. The exit status is 1 when a figure misses its bound. It takes some minutes of processor time; parts can
be chosen by name:

  level      sources as high as the head
  room       sources 0.2 to 1.7 m above the floor
  turned     the same, with a head that looks anywhere
  mouths     persons who stand: mouths 1.2 to 1.6 m above the floor (no bound: two directions sound alike)
  quiet      minutes of steady noise of several kinds: nothing is detected or located
"""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass
from typing import Callable, Iterator, Optional, Sequence, Tuple

import numpy as np
from command_line import parse, parts_parser

from nao_sim_bridge.base.samples import RATE, Sound, pcm16
from nao_sim_bridge.core.scene import Scene
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.hearing.detection import SoundDetector
from nao_sim_bridge.hearing.localisation import microphone_array
from nao_sim_bridge.hearing.localiser import Localiser
from nao_sim_bridge.sound.ears import BLOCK
from nao_sim_bridge.sound.sources import SoundSource
from nao_sim_bridge.speech.clips import Style
from nao_sim_bridge.speech.studio import Studio
from nao_sim_bridge.speech.voices import load_voices
from nao_sim_bridge.world.sounds_made import noise

Off = Optional[Tuple[float, float]]
"""Errors of azimuth and elevation, degrees; None when nothing was located."""
NEAREST, FARTHEST = 1.0, 3.0
LENGTH = 0.6
SNR_DB = 20.0
TEXTS = ("Hello robot, can you hear me?", "What is on the table?", "Please come over here and look at this.")
VOICES = ("slt", "rms", "awb")
WITHIN = (3.0, 5.0, 10.0)
NINE_OF_TEN = 0.9
QUIET_KINDS = ("white", "pink")
QUIET_LEVELS = (30.0, 50.0, 70.0)
QUIET_TIME, LONGEST_QUIET = 60.0, 3600.0


@dataclass(frozen=True)
class Part:
    """A choice of places.

    Attributes:
        heights: Lowest and highest source above the floor, m; None for that of the microphones.
        turned: Whether the head looks anywhere.
        bounded: Whether nine of ten azimuths have to be right within 10 degrees.
    """

    heights: tuple[float, float] | None = None
    turned: bool = False
    bounded: bool = True


PARTS = {
    "level": Part(),
    "room": Part((0.2, 1.7)),
    "turned": Part((0.2, 1.7), turned=True),
    "mouths": Part((1.2, 1.6), bounded=False),
}


@dataclass(frozen=True)
class Line:
    """A line of the table: what was measured, what came out, and whether that is what must come out."""

    what: str
    figure: str
    kept: bool


class Bench:
    """A robot that listens, and sounds around it."""

    def __init__(self, seed: int) -> None:
        self.chance = np.random.default_rng(seed)
        self.simulation = Simulation(Scene(posture="Stand", seed=seed))
        self.model = self.simulation.model
        self.simulation.robot.motion.set_stiffness_now({joint: 1.0 for joint in range(len(self.model.joints))})
        self.simulation.run(0.5)
        self._speech: list[np.ndarray] = []

    @property
    def kinds(self) -> dict[str, Callable[[], np.ndarray]]:
        """What sounds, by name."""
        return {
            "speech": self._spoken,
            "white noise": lambda: self._noise("white"),
            "pink noise": lambda: self._noise("pink"),
            "harmonics": self._harmonics,
        }

    def look_anywhere(self) -> None:
        """Turn the head to a random place."""
        joints = [self.model.joint_index[name] for name in ("HeadYaw", "HeadPitch")]
        angles = (self.chance.uniform(-1.5, 1.5), self.chance.uniform(-0.4, 0.3))
        self.simulation.robot.motion.set_targets(dict(zip(joints, angles)), dict.fromkeys(joints, 3.0))
        self.simulation.run(1.5)

    def locate(self, wave: np.ndarray, part: Part, snr_db: float | None) -> Iterator[Off]:
        """How far off a (n,) sound at a random place is located, block by block.

        Args:
            snr_db: How far noise is below the sound, dB; None for that of the room alone.
        """
        simulation, sound = self.simulation, self.simulation.sound
        head = sound.microphones.poses.at(simulation.ticks, simulation.ticks)
        rotation, middle = head.rotations[0], head.place(sound.microphones.places)[0].mean(axis=0)
        toward = self._toward(part, middle)
        truth = rotation.T @ toward / np.linalg.norm(toward)
        sound.sources.add(SoundSource("source", tuple(middle + toward), Sound(wave.astype(np.float32), RATE)))
        begun = sound.time
        simulation.run(len(wave) / RATE + 0.1)
        arrives = begun + float(np.linalg.norm(toward)) / 343.0
        heard = sound.microphones.heard(arrives, arrives + len(wave) / RATE)
        if snr_db is not None:
            level = math.sqrt(float(np.mean(heard.astype(float) ** 2))) * 10.0 ** (-snr_db / 20.0)
            heard = heard + self.chance.normal(0.0, level, heard.shape).astype(np.float32)
        localiser = Localiser(microphone_array(sound.microphones.places), RATE)
        for start in range(0, len(heard) - BLOCK + 1, BLOCK):
            found = localiser.feed(pcm16(heard[start : start + BLOCK]), start / RATE, tuple(rotation[2]))
            if found is None:
                yield None
                continue
            azimuth = math.degrees(found.azimuth - math.atan2(truth[1], truth[0]))
            elevation = math.degrees(found.elevation - math.asin(truth[2]))
            yield abs((azimuth + 180.0) % 360.0 - 180.0), abs(elevation)

    def _toward(self, part: Part, middle: np.ndarray) -> np.ndarray:
        bearing, distance = self.chance.uniform(-math.pi, math.pi), self.chance.uniform(NEAREST, FARTHEST)
        height = 0.0 if part.heights is None else self.chance.uniform(*part.heights) - middle[2]
        return np.array([distance * math.cos(bearing), distance * math.sin(bearing), height])

    def _noise(self, kind: str) -> np.ndarray:
        return noise(kind, LENGTH, int(self.chance.integers(2**31))).samples[:, 0]

    def _harmonics(self) -> np.ndarray:
        steps = 2.0 * np.pi * self.chance.uniform(150.0, 500.0) * np.arange(round(LENGTH * RATE)) / RATE
        return sum(np.sin(k * steps + self.chance.uniform(0.0, 2.0 * np.pi)) / k for k in range(1, 9)) * 0.2

    def _spoken(self) -> np.ndarray:
        """Some words of a text; pauses are left out."""
        if not self._speech:
            self._speech = spoken_texts()
        text = self._speech[self.chance.integers(len(self._speech))]
        loudest = np.sqrt(np.mean(text**2))
        while True:
            start = self.chance.integers(len(text) - round(LENGTH * RATE))
            words = text[start : start + round(LENGTH * RATE)]
            if np.sqrt(np.mean(words**2)) > 0.5 * loudest:
                return words


def spoken_texts() -> list[np.ndarray]:
    """The texts in several voices."""
    studio = Studio()
    try:
        voices = load_voices().voices
        return [studio.sound(text, Style(voices[name])).samples[:, 0] for text in TEXTS for name in VOICES]
    finally:
        studio.close()


def summary(what: str, blocks: Sequence[Off], bounded: bool) -> Line:
    """One line about all blocks of one kind."""
    located = [block for block in blocks if block is not None]
    if not located:
        return Line(what, "nothing was located", not bounded)
    azimuths, elevations = np.array(located).T
    shares = [float(np.mean(azimuths < bound)) for bound in WITHIN]
    parts = [
        f"located {len(azimuths) / len(blocks):4.0%}",
        f"azimuth {np.median(azimuths):4.1f}",
        *(f"within {bound:g}: {share:4.0%}" for bound, share in zip(WITHIN, shares)),
        f"elevation {np.median(elevations):4.1f}",
    ]
    kept = shares[-1] >= NINE_OF_TEN and len(azimuths) >= NINE_OF_TEN * len(blocks)
    return Line(what, "  ".join(parts), kept or not bounded)


def measure_places(name: str, count: int, seed: int) -> Iterator[Line]:
    """Lines about sources at the places of one part."""
    part = PARTS[name]
    bench = Bench(seed)
    try:
        for kind, make in bench.kinds.items():
            for snr_db in (None, SNR_DB):
                blocks: list[Off] = []
                for number in range(count):
                    if part.turned and number % 5 == 0:
                        bench.look_anywhere()
                    blocks += bench.locate(make(), part, snr_db)
                where = "quiet room" if snr_db is None else f"{snr_db:g} dB SNR"
                yield summary(f"{name}, {kind}, {where}", blocks, part.bounded)
    finally:
        bench.simulation.close()


def measure_quiet(seconds: float, seed: int) -> Iterator[Line]:
    """Lines about steady noise."""
    chance = np.random.default_rng(seed)
    places = Bench(seed)
    array = microphone_array(places.simulation.sound.microphones.places)
    places.simulation.close()
    for kind in QUIET_KINDS:
        for level_db in QUIET_LEVELS:
            sides = [noise(kind, seconds, int(chance.integers(2**31))).samples[:, 0] for _ in range(4)]
            size = 10.0 ** ((level_db - 104.0) / 20.0) / math.sqrt(2.0)
            samples = pcm16(np.stack([side / np.sqrt(np.mean(side**2)) for side in sides], axis=1) * np.float32(size))
            detector, localiser = SoundDetector(RATE), Localiser(array, RATE)
            edges = located = 0
            for start in range(0, len(samples) - BLOCK + 1, BLOCK):
                block = samples[start : start + BLOCK]
                edges += len(detector.feed(block, start / RATE))
                located += localiser.feed(block, start / RATE) is not None
            figure = f"{edges} beginnings and ends detected, {located} sounds located in {seconds:g} s"
            yield Line(f"quiet, {kind}, {level_db:g} dB", figure, not edges and not located)


def main() -> int:
    """Measure what the command line asks for, and print a table."""
    names = (*PARTS, "quiet")
    parser = parts_parser(__doc__ or "", names)
    parser.add_argument("--sounds", type=int, default=40, help="sounds for each line")
    parser.add_argument("--seconds", type=float, default=QUIET_TIME, help="length of the steady noises")
    parser.add_argument("--seed", type=int, default=1, help="of all chance")
    chosen = parse(parser, names, None, sounds=1, seconds=1.0)
    if chosen.seconds > LONGEST_QUIET:
        parser.error(f"--seconds is {chosen.seconds:g}, allowed is 1 to {LONGEST_QUIET:g}")
    missed = 0
    for name in chosen.parts:
        quiet, seed = name == "quiet", chosen.seed
        for line in measure_quiet(chosen.seconds, seed) if quiet else measure_places(name, chosen.sounds, seed):
            missed += not line.kept
            mark, end = ("  ", "") if line.kept else ("X ", "   MISSED")
            print(f"{mark}{line.what:38} {line.figure}{end}", flush=True)
    print(f"{missed} missed" if missed else "all within their bounds")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
