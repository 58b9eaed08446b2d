#!/usr/bin/env python3
"""Walks a little, or watches a robot that walks, and draws its footprints, centre of mass and centre of pressure.

Needs a robot or a simulator at `--ip` and `--port`, for example `python3 -m nao_sim_bridge`; no ROS. All comes from
what the robot itself tells over NAOqi. Ctrl-C stops the robot.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

# In the devel space rosrun starts a relay from another folder.
sys.path.insert(0, str(Path(__file__).resolve().parent))
from example_parts.walk_picture import draw
from example_parts.walk_record import LEFT, OTHER, RIGHT, Place, Sample, load, moved, save
from nao_library_modules.whole_file import WholeFile, require_new
from naoqi import ALProxy
from naoqi.errors import NaoError

FRAME_WORLD = 1
FEET = {"LLeg": LEFT, "RLeg": RIGHT}
READINGS = ("TotalWeight", "CenterOfPressure/X", "CenterOfPressure/Y")
KEYS = [f"Device/SubDeviceList/{side}Foot/FSR/{name}/Sensor/Value" for side in "LR" for name in READINGS]
GOAL = (0.6, 0.15, 0.6)
# Enough for a drawing, and a small file.
COLORS = 64
# Between two looks, ms; a step takes 420 ms at least.
PERIOD = 20


def look(body: ALProxy, memory: ALProxy) -> Sample:
    """One sample of a robot."""
    (feet, fixed, _), readings = body.getFootSteps(), memory.getListData(KEYS)
    mass = body.getCOM("Body", FRAME_WORLD, True)
    left, right = (tuple(foot) for foot in feet)
    planned: tuple[str, Place] = ("", (0.0, 0.0, 0.0))
    if fixed:
        foot = FEET[fixed[0][0]]
        x, y, turn = fixed[0][2]
        other = {LEFT: left, RIGHT: right}[OTHER[foot]]
        planned = (foot, (*moved(other, x, y), other[2] + turn))
    loads, pressures = (readings[0], readings[3]), (tuple(readings[1:3]), tuple(readings[4:6]))
    return Sample(left, right, (mass[0], mass[1]), loads, pressures, planned)


def walk(body: ALProxy, memory: ALProxy, goal: tuple[float, float, float]) -> list[Sample]:
    """Let a robot walk to a place and look until it stands there."""
    body.wakeUp()
    body.moveInit()
    samples = [look(body, memory)]
    try:
        task = body.post.moveTo(*goal)
        while body.wait(task, PERIOD):  # true as long as it still walks after this time
            samples.append(look(body, memory))
    finally:
        body.stopMove()
    return [*samples, look(body, memory)]


def watch(body: ALProxy, memory: ALProxy, seconds: float) -> list[Sample]:
    """Look for so long, s, whatever the robot does."""
    samples = []
    end = robot_time(memory) + seconds
    while robot_time(memory) < end or not samples:
        samples.append(look(body, memory))
        time.sleep(PERIOD / 1000.0)  # the pace of looking; there is nothing to wait for
    return samples


def robot_time(memory: ALProxy) -> float:
    """The robot's own clock, s: a simulated one may go slower than this computer's."""
    return memory.getData("DCM/Time") / 1000.0


def main() -> int:
    """Record and draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--ip", default="127.0.0.1", help="address of the robot (127.0.0.1)")
    parser.add_argument("--port", type=int, default=9559, help="port of its NAOqi (9559)")
    parser.add_argument("--goal", nargs=3, type=float, default=GOAL, metavar=("X", "Y", "THETA"), help="m, m, rad")
    parser.add_argument(
        "--watch", type=float, metavar="SECONDS", help="do not move the robot: look so long, in its time"
    )
    parser.add_argument("--from", type=Path, dest="old", metavar="FILE", help="draw this record, without a robot")
    parser.add_argument("--record", type=Path, metavar="FILE", help="keep the record there (JSON)")
    parser.add_argument("--output", type=Path, default=Path("walk.png"), help="picture to write (walk.png)")
    parser.add_argument("--overwrite", action="store_true", help="replace files of these names")
    options = parser.parse_args()
    try:
        output = require_new(options.output, options.overwrite)
        record = require_new(options.record, options.overwrite) if options.record else None
        if options.old:
            samples = load(options.old)
        else:
            body, memory = (ALProxy(name, options.ip, options.port) for name in ("ALMotion", "ALMemory"))
            if options.watch is None:
                samples = walk(body, memory, options.goal)
            else:
                samples = watch(body, memory, options.watch)
        if record:
            save(samples, record)
            print(f"written: {record}")
        with WholeFile(output) as file:
            draw(samples).quantize(COLORS).save(file, "PNG", optimize=True)
    except (NaoError, OSError) as error:
        print(error)
        return 1
    except KeyboardInterrupt:
        return 130
    print(f"written: {output}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
