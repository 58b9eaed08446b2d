#!/usr/bin/env python3
"""Places a ball, a landmark and a person before the simulated robot, lets the person walk by, and draws it all.

Needs a simulator at `--ip` and `--port`, for example `python3 -m nao_sim_bridge`; no ROS.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from pathlib import Path

from nao_library_modules.whole_file import require_new, write_whole
from naoqi import ALProxy
from naoqi.errors import NaoError

FACING_ROBOT = math.pi
THINGS = (
    {"name": "red_ball", "ball": 0.03, "position": [0.50, -0.12, 0.03]},
    {"name": "mark", "landmark": 119, "position": [0.80, 0.20, 0.45], "heading": FACING_ROBOT, "stand": True},
    {"name": "clara", "person": "clara", "height": 1.5, "position": [1.5, 1.0, 0.0], "heading": FACING_ROBOT},
)
WALK_TO, WALK_TIME = [1.5, -0.4, 0.0], 2.0


def main() -> int:
    """Place, move, draw, and clear up."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--ip", default="127.0.0.1", help="address of the simulator (127.0.0.1)")
    parser.add_argument("--port", type=int, default=9559, help="port of its NAOqi (9559)")
    parser.add_argument("--output", type=Path, default=Path("things.png"), help="picture to write (things.png)")
    parser.add_argument("--keep", action="store_true", help="leave the things where they are")
    parser.add_argument("--overwrite", action="store_true", help="replace a file of that name")
    options = parser.parse_args()
    try:
        output = require_new(options.output, options.overwrite)
        simulation = ALProxy("NaoSimulation", options.ip, options.port)
        for thing in THINGS:
            simulation.placeObject(json.dumps(thing))
        # Ends when she is there; simulation.post.moveObject(...) would not wait.
        simulation.moveObject("clara", WALK_TO, [], WALK_TIME)
        write_whole(output, bytes(simulation.picture("far", 960, 600)))
        there = simulation.objects()
        for thing in THINGS:
            x, y, z = there[thing["name"]][:3]
            print(f"{thing['name']}: x {x:.2f} m, y {y:.2f} m, z {z:.2f} m")
            if not options.keep:
                simulation.removeObject(thing["name"])
    except (NaoError, OSError) as error:
        print(error)
        return 1
    print(f"written: {output}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
