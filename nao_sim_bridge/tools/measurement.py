"""What the programs that measure the robot's sight have in common."""

from __future__ import annotations

import argparse
from typing import Sequence

import cv2
import numpy as np
from camera_stage import Stage, Viewpoint
from command_line import parts_parser


class StageChecks:
    """Measurements on one stage; a method for each part comes from whoever inherits it.

    `count` is that of pictures of each kind, `frames` that of pictures of the part `lab`, `seed` that of all choices.
    """

    def __init__(self, stage: Stage, count: int, frames: int, seed: int) -> None:
        self._misses: list[str] = []
        self._stage = stage
        self._count = count
        self._frames = frames
        self._random = np.random.default_rng(seed)

    def measure(self, parts: Sequence[str]) -> int:
        """Measure parts; the exit status, 1 when a figure misses its bound."""
        cv2.setNumThreads(1)
        for part in parts:
            getattr(self, part)()
        for what in self._misses:
            print(f"misses its bound: {what}")
        return 1 if self._misses else 0

    def _tell(self, what: str, figures: str, good: bool | None) -> None:
        """Print figures and whether they keep their bound; None if they have none."""
        if good is not None and not good:  # a truth value of NumPy is never the same as False
            self._misses.append(what)
        print(f"{what:48s} {figures}{'' if good is None else '  ok' if good else '  MISSED'}", flush=True)

    def _seed(self) -> int:
        return int(self._random.integers(1 << 30))

    def _anywhere(self) -> Viewpoint:
        """On the floor in the middle of the room, looking anywhere, as with a head that turns."""
        place = (self._random.uniform(-1.2, 0.4), self._random.uniform(-1.6, 1.6), self._random.uniform(0.25, 0.5))
        return Viewpoint(place, self._random.uniform(-np.pi, np.pi), self._random.uniform(-0.3, 0.8))


def stage_parser(description: str, parts: Sequence[str], count: int) -> argparse.ArgumentParser:
    """A command line with parts, how much of each to measure (`count` pictures unless told otherwise), what draws."""
    parser = parts_parser(description, parts)
    parser.add_argument("--count", type=int, default=count, help="pictures of each kind")
    parser.add_argument("--frames", type=int, default=200, help="pictures of the lab")
    parser.add_argument("--engine", default="auto", help="auto, opengl or builtin")
    return parser
