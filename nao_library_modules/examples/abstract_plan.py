#!/usr/bin/env python3
"""A plan of three goals at once: both hands open, and the head looks at a place. Prints what became of it.

Needs a running robot, for example `roslaunch nao_library nao_sim.launch`. Ctrl-C ends it: the robot stops.
"""

from __future__ import annotations

import argparse
import sys

import rospy

from nao_library_modules.process_modules.control import do, par
from nao_library_modules.process_modules.designators.designator import action, an
from nao_library_modules.process_modules.goals import achieve, declare_goal, def_goal
from nao_library_modules.process_modules.low_level import this_robot
from nao_library_modules.process_modules.plan_runner import run_and_tell, wake_up
from nao_library_modules.process_modules.registry import perform

OPEN = 0.9


@declare_goal
def gripper_open(side: str) -> bool:
    """Whether a hand is open."""
    return this_robot().angles()[f"{side[0].upper()}Hand"] > OPEN


@declare_goal
def looking_at(x: float, y: float) -> None:
    """The head looks at a place: nobody can tell before it has turned."""


@def_goal(gripper_open)
def open_gripper(side: str) -> None:
    """Open a hand."""
    perform(an(action, type="opening", gripper=side))


@def_goal(looking_at)
def move_head(x: float, y: float) -> None:
    """Look at a place."""
    perform(an(action, type="looking", target=[x, y]))


def abstract_plan(x: float, y: float) -> None:
    """Both hands open, and the head looks at a place, all at once."""
    par(
        do(achieve, gripper_open("left")),
        do(achieve, gripper_open("right")),
        do(achieve, looking_at(x, y)),
    )


def main() -> int:
    """Run the plan; the exit status tells whether it succeeded."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("x", type=float, nargs="?", default=2.0, help="m ahead that the head looks at (2)")
    parser.add_argument("y", type=float, nargs="?", default=3.0, help="m to the left that the head looks at (3)")
    parser.add_argument("--trace", default="", help="file for the trace of the plan, as JSON")
    parser.add_argument("--picture", default="", help="file for its picture, as PNG")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("abstract_plan", anonymous=True)
    wake_up()
    return run_and_tell(do(abstract_plan, options.x, options.y), trace=options.trace, picture=options.picture)


if __name__ == "__main__":
    sys.exit(main())
