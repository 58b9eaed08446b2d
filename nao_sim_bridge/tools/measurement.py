"""What the programs that measure the robot's sight have in common: their command line, and what they end with."""

from __future__ import annotations

import argparse
from typing import Any, Callable, ContextManager, Sequence

import cv2
import numpy as np
from camera_stage import Stage, Viewpoint


class StageChecks:
    """Measurements on one stage; a method for each part comes from whoever inherits it.

    Attributes:
        misses: Figures that miss their bounds.

    Args:
        stage: Where things stand.
        count: Pictures of each kind.
        frames: Pictures of the part `lab`.
        seed: Of all choices.
    """

    def __init__(self, stage: Stage, count: int, frames: int, seed: int) -> None:
        self.misses: list[str] = []
        self._stage = stage
        self._count = count
        self._frames = frames
        self._random = np.random.default_rng(seed)

    def _tell(self, what: str, figures: str, good: bool | None) -> None:
        """Print figures and whether they keep their bound; None if they have none."""
        if good is not None and not good:  # a truth value of NumPy is never the same as False
            self.misses.append(what)
        print(f"{what:48s} {figures}{'' if good is None else '  ok' if good else '  MISSED'}", flush=True)

    def _seed(self) -> int:
        return int(self._random.integers(1 << 30))

    def _anywhere(self) -> Viewpoint:
        """On the floor in the middle of the room, looking anywhere, as with a head that turns."""
        place = (self._random.uniform(-1.2, 0.4), self._random.uniform(-1.6, 1.6), self._random.uniform(0.25, 0.5))
        return Viewpoint(place, self._random.uniform(-np.pi, np.pi), self._random.uniform(-0.3, 0.8))


def command_line(description: str, parts: Sequence[str], count: int) -> argparse.ArgumentParser:
    """A command line with the parts to be measured, and how much of each.

    Args:
        description: What the program measures.
        parts: Names of its parts.
        count: Pictures of each kind, unless told otherwise.
    """
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", metavar="part", help=f"{', '.join(parts)}; all by default")
    parser.add_argument("--count", type=int, default=count, help="pictures of each kind")
    parser.add_argument("--frames", type=int, default=200, help="pictures of the lab")
    parser.add_argument("--engine", default="auto", help="auto, opengl or builtin")
    return parser


def parse(parser: argparse.ArgumentParser, parts: Sequence[str], arguments: Sequence[str] | None) -> argparse.Namespace:
    """What was asked for, checked; ends the program with what is wrong.

    Args:
        parser: From `command_line`.
        parts: Names of the parts that there are.
        arguments: Those of the program if None.
    """
    chosen = parser.parse_args(arguments)
    for part in chosen.parts:
        if part not in parts:
            parser.error(f"no part {part}; there are {', '.join(parts)}")
    for name in ("count", "frames"):
        if getattr(chosen, name) < 1:
            parser.error(f"--{name} is {getattr(chosen, name)}, allowed is 1 or more")
    chosen.parts = chosen.parts or list(parts)
    return chosen


def measure(stage: ContextManager[Any], checks_on: Callable[[Any], Any], parts: Sequence[str]) -> int:
    """Measure parts on one stage; the exit status, 1 when a figure misses its bound.

    Args:
        stage: Where things stand.
        checks_on: Makes the measurements of a stage: an object with a method for each part, and `misses`.
        parts: Names of the parts.
    """
    cv2.setNumThreads(1)
    with stage as entered:
        checks = checks_on(entered)
        for part in parts:
            getattr(checks, part)()
    for what in checks.misses:
        print(f"misses its bound: {what}")
    return 1 if checks.misses else 0
