#!/usr/bin/env python3
"""A plan of three goals at once: both hands open, and the head looks at a place. Prints what became of it.

Needs a running robot, for example `roslaunch nao_library nao_sim.launch`. Ctrl-C ends it: the robot stops.
"""

from __future__ import annotations

import argparse
import sys

import rospy

from nao_library_modules.process_modules import Position, achieve, do, par
from nao_library_modules.process_modules.low_level import moveHead, openGripper
from nao_library_modules.process_modules.plan_runner import run_and_tell, wake_up


def abstract_plan(x: float, y: float) -> None:
    """Both hands open, and the head looks at a position, all at once."""
    par(
        do(achieve, openGripper, "left"),
        do(achieve, openGripper, "right"),
        do(achieve, moveHead, Position(x, y)),
    )


def main() -> int:
    """Run the plan; the exit status tells whether it succeeded."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("x", type=float, nargs="?", default=2.0, help="m ahead that the head looks at (2)")
    parser.add_argument("y", type=float, nargs="?", default=3.0, help="m to the left that the head looks at (3)")
    parser.add_argument("--trace", default="", help="file for the trace of the plan, as JSON")
    parser.add_argument("--picture", default="", help="file for its picture, as PNG")
    parser.add_argument("--overwrite", action="store_true", help="replace files of these names")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("abstract_plan", anonymous=True)
    wake_up()
    return run_and_tell(
        do(abstract_plan, options.x, options.y),
        trace=options.trace,
        picture=options.picture,
        overwrite=options.overwrite,
    )


if __name__ == "__main__":
    sys.exit(main())
