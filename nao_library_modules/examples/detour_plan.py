#!/usr/bin/env python3
"""A plan that gets around what is in its way.

It walks straight to a place; when it is stopped it steps back and tries a way around, first on the right, then on the
left.

Needs a running robot, for example `roslaunch nao_library nao_sim.launch world:=wall`: a low wall stands between it
and the place. Ctrl-C ends it: the robot stops.
"""

from __future__ import annotations

import argparse
import math
import sys

import rospy

from nao_library_modules.places import Place
from nao_library_modules.process_modules.control import do, seq, try_each_in_order
from nao_library_modules.process_modules.designators.designator import action, an
from nao_library_modules.process_modules.failures import (
    CompositeFailure,
    NavigationHighLevelFailure,
    NavigationLowLevelFailure,
    fail,
)
from nao_library_modules.process_modules.handling import give, with_failure_handling
from nao_library_modules.process_modules.low_level import this_robot
from nao_library_modules.process_modules.plan_runner import run_and_tell, wake_up
from nao_library_modules.process_modules.plans import def_plan
from nao_library_modules.process_modules.registry import perform

BACK = 0.15
"""m that it steps back from what stopped it."""
ASIDE = 0.6
"""m that it goes around on each side of the straight way."""
PAST = 0.9
"""m that it goes past the place where it was stopped."""


@def_plan
def walk(x: float, y: float, yaw: float) -> None:
    """Walk to a place in odom."""
    perform(an(action, type="going", target=[x, y, yaw]))


@def_plan
def step_back() -> None:
    """Get away from what is in the way."""
    perform(an(action, type="going", target=[-BACK, 0.0, 0.0, "base_footprint"]))


def around(goal: Place, stopped: Place, side: float) -> None:
    """Walk to a place around where the straight way was blocked, on the left (1) or on the right (-1)."""
    heading = math.atan2(goal.y - stopped.y, goal.x - stopped.x)
    way = Place(stopped.x, stopped.y, heading)
    beside, past = way.then(Place(0.0, side * ASIDE, 0.0)), way.then(Place(PAST, side * ASIDE, 0.0))
    seq(do(walk, *beside), do(walk, *past), do(walk, *goal))


def get_there(goal: Place) -> None:
    """Walk to a place, around what is in the way if there is something."""

    def blocked(failure: NavigationLowLevelFailure) -> None:
        stopped = this_robot().place("odom")
        perform(an(action, type="saying", text="Something is in my way."))
        step_back()
        try:
            try_each_in_order(lambda side: around(goal, stopped, side), [-1.0, 1.0])
        except CompositeFailure as failures:
            fail(NavigationHighLevelFailure, f"there is no way: {failure}; {failures}")
        give()

    with_failure_handling(do(walk, *goal), {NavigationLowLevelFailure: blocked})


def main() -> int:
    """Run the plan; the exit status tells whether the robot is there."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("x", type=float, nargs="?", default=1.6, help="m ahead of where odometry began (1.6)")
    parser.add_argument("y", type=float, nargs="?", default=-0.1, help="m to the left (-0.1)")
    parser.add_argument("--trace", default="", help="file for the trace of the plan, as JSON")
    parser.add_argument("--picture", default="", help="file for its picture, as PNG")
    parser.add_argument("--overwrite", action="store_true", help="replace files of these names")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("detour_plan", anonymous=True)
    wake_up()
    plan = do(get_there, Place(options.x, options.y, 0.0))
    return run_and_tell(plan, trace=options.trace, picture=options.picture, overwrite=options.overwrite)


if __name__ == "__main__":
    sys.exit(main())
