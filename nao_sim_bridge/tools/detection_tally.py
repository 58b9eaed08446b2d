"""What came of many pictures: the figures that `check_detection.py` prints."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np


@dataclass
class Tally:
    """What came of many pictures of a kind.

    Attributes:
        wanted: Pictures.
        found: In how many the thing was found.
        wrong: Findings that were something else.
        bearings: By how much bearings were off, degrees.
        distances: By how much distances were off, as shares.
        times: Processor time of a picture, s.
    """

    wanted: int = 0
    found: int = 0
    wrong: int = 0
    bearings: list[float] = field(default_factory=list)
    distances: list[float] = field(default_factory=list)
    times: list[float] = field(default_factory=list)

    def text(self) -> str:
        """The figures in a line."""
        parts = [f"found {self.found:3d} of {self.wanted:3d}", f"wrong {self.wrong}"]
        if self.bearings:
            parts.append(f"bearing off {np.mean(self.bearings):.2f} mean, {max(self.bearings):.2f} most, deg")
        if self.distances:
            mean, most = 100 * np.mean(self.distances), 100 * max(self.distances)
            parts.append(f"distance off {mean:.1f} mean, {most:.1f} most, %")
        parts.append(f"{1000 * np.mean(self.times):.1f} ms")
        return ", ".join(parts)
