#!/usr/bin/env python3
"""Tells where the movable things of the simulated world are, and draws the room.

Needs a simulator at `--ip` and `--port`, for example `python3 -m nao_sim_bridge --world lab`; no ROS.
"""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path

from nao_library_modules.whole_file import require_new, write_whole
from naoqi import ALProxy
from naoqi.errors import NaoError


def main() -> int:
    """Look once."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--ip", default="127.0.0.1", help="address of the simulator (127.0.0.1)")
    parser.add_argument("--port", type=int, default=9559, help="port of its NAOqi (9559)")
    parser.add_argument("--output", type=Path, default=Path("lab.png"), help="picture to write (lab.png)")
    parser.add_argument("--overwrite", action="store_true", help="replace a file of that name")
    options = parser.parse_args()
    try:
        output = require_new(options.output, options.overwrite)
        simulation = ALProxy("NaoSimulation", options.ip, options.port)
        robot_x, robot_y = simulation.torsoPose()[:2]
        for name, (x, y, z, *_) in sorted(simulation.objectPoses().items()):
            away = math.hypot(x - robot_x, y - robot_y)
            print(f"{name}: x {x:.2f} m, y {y:.2f} m, z {z:.2f} m, {away:.2f} m from the robot")
        write_whole(output, bytes(simulation.picture("room", 960, 600)))
    except (NaoError, OSError) as error:
        print(error)
        return 1
    print(f"written: {output}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
