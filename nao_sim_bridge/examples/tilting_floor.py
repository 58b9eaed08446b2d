#!/usr/bin/env python3
"""A floor that tilts under the robot: it rides the waves of a plate, until one is too high. Draws what happens.

Needs `pip install ./nao_sim_bridge` and no ROS. Writes tilting_floor.png: the plate level, in its waves, at its
steepest, and what has become of the robot.
"""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import Sequence

import numpy as np
from PIL import Image

from nao_sim_bridge import NaoSim

PLATE = "plate"
"""The thing of the world "platform" that the robot stands on."""
WAVE_PERIOD = 2.5
"""s."""


def waves(height: float, middle: Sequence[float], seconds: float) -> tuple[float, ...]:
    """Where the plate is: it rolls and pitches by up to `height` rad, a quarter of a period apart, gently at first."""
    phase, grown = 2.0 * math.pi * seconds / WAVE_PERIOD, height * min(1.0, seconds / WAVE_PERIOD)
    return (*middle, grown * math.sin(phase), grown * math.cos(phase), 0.0)


def main() -> None:
    """Tilt, print, draw."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--height", type=float, default=0.06, help="of the waves, rad")
    options.add_argument("--last", type=float, default=0.35, help="tilt at the end, rad")
    options.add_argument("--output", type=Path, default=Path("tilting_floor.png"))
    chosen = options.parse_args()
    with NaoSim(world="platform", seed=1) as nao:
        pictures = [nao.picture("far", 320, 320)]
        middle = nao.things[PLATE][:3]
        nao.move_along(PLATE, lambda seconds: waves(chosen.height, middle, seconds))
        leans = []
        while nao.time < 2.25 * WAVE_PERIOD:  # it rolls most then
            nao.step(0.1)
            leans.append(nao.lean)
        pictures.append(nao.picture("far", 320, 320))
        print(f"waves of {chosen.height:.2f} rad: leans by up to {max(leans):.2f} rad, fallen: {nao.fallen}")
        nao.move(PLATE, rpy=(0.0, chosen.last, 0.0), duration=0.6)
        pictures.append(nao.picture("far", 320, 320))
        nao.step(2.0)
        pictures.append(nao.picture("far", 320, 320))
        print(f"a tilt of {chosen.last:.2f} rad in 0.6 s: leans by {nao.lean:.2f} rad, fallen: {nao.fallen}")
    Image.fromarray(np.hstack(pictures)).save(chosen.output)


if __name__ == "__main__":
    main()
