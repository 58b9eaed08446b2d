#!/usr/bin/env python3
"""A plan that goes and looks: it walks to the table, looks for the ball, points at it, and says where it is.

Needs a running robot in the lab: `roslaunch nao_library nao_sim.launch world:=lab`. Ctrl-C ends it: the robot stops.
"""

from __future__ import annotations

import argparse
import math
import sys

import rospy

from nao_library_modules.process_modules.control import do, par, seq, try_in_order
from nao_library_modules.process_modules.designators.designator import Designator, a, action, an, location, object_, the
from nao_library_modules.process_modules.designators.objects_and_locations import BELIEFS
from nao_library_modules.process_modules.failures import (
    CompositeFailure,
    ObjectNowhereToBeFound,
    PtuGoalUnreachable,
    fail,
)
from nao_library_modules.process_modules.handling import give, with_failure_handling
from nao_library_modules.process_modules.low_level import this_robot
from nao_library_modules.process_modules.perception import go_to, perceive
from nao_library_modules.process_modules.plan_runner import run_and_tell, wake_up
from nao_library_modules.process_modules.plans import def_plan
from nao_library_modules.process_modules.registry import perform
from nao_library_modules.process_modules.space import Point3

BALL_RADIUS = 0.05
"""m, of the ball in the lab."""
AHEAD = math.radians(30.0)
"""What is nearer to straight ahead than that is in front of the robot."""


def know_the_lab() -> None:
    """What the robot knows of the lab before it looks: where the table is."""
    BELIEFS.know("table", position=Point3(0.95, 0.0, 0.15, "odom"), size=(0.70, 1.10, 0.30))


@def_plan
def find_ball(ball: Designator) -> Designator:
    """Look for the ball: ahead, on the floor to the right, to the left, then all around for what is farther away."""
    return try_in_order(
        do(perceive, ball, timeout=2.0),
        lambda: seq(
            do(perform, an(action, type="saying", text="Where is the ball?")),
            do(turn_and_look, ball, -math.pi / 2.0),
        ),
        do(turn_and_look, ball, math.pi),
        do(perceive, ball, timeout=20.0, search=True, camera="top"),
    )


@def_plan
def turn_and_look(ball: Designator, turn: float) -> Designator:
    """Turn, rad to the left, and look at the floor: its shoulders hide what lies beside the robot, however it looks."""
    perform(an(action, type="going", target=[0.0, 0.0, turn, "base_footprint"]))
    return perceive(ball, timeout=8.0, search=True, camera="bottom")


@def_plan
def look_at(thing: Designator) -> None:
    """Look at a thing, or, if it is too near to the feet for that, as far down as the head turns."""

    def as_far_as_it_goes(failure: PtuGoalUnreachable) -> None:
        give(perform(an(action, type="moving-joints", angles=dict(zip(("HeadYaw", "HeadPitch"), failure.nearest)))))

    looking = do(perform, an(action, type="looking", target=thing))
    with_failure_handling(looking, {PtuGoalUnreachable: as_far_as_it_goes})


def fetch() -> str:
    """Go to the table, find the ball, point at it, and say where it is."""
    table, ball = the(object_, type="table"), a(object_, type="ball", size=BALL_RADIUS)
    par(
        do(go_to, a(location, near=table, distance=0.1)),
        do(perform, an(action, type="saying", text="I am going to the table.")),
    )
    try:
        seen = find_ball(ball)
    except CompositeFailure as failure:
        fail(ObjectNowhereToBeFound, f"no ball: {failure}")
    par(do(perform, an(action, type="pointing", at=seen)), do(look_at, seen))
    place = this_robot().point_in(seen.reference().position, "base_footprint")
    if abs(place.y) < place.x * math.tan(AHEAD):
        where = "in front of me"
    else:
        where = "on my left" if place.y > 0.0 else "on my right"
    words = f"There is the ball, {math.hypot(place.x, place.y):.1f} metres away, {where}."
    seq(do(perform, an(action, type="saying", text=words)), do(perform, an(action, type="standing")))
    return words


def main() -> int:
    """Run the plan; the exit status tells whether it succeeded."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--trace", default="", help="file for the trace of the plan, as JSON")
    parser.add_argument("--picture", default="", help="file for its picture, as PNG")
    parser.add_argument("--overwrite", action="store_true", help="replace files of these names")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("fetch_plan", anonymous=True)
    know_the_lab()
    wake_up()
    return run_and_tell(fetch, trace=options.trace, picture=options.picture, overwrite=options.overwrite)


if __name__ == "__main__":
    sys.exit(main())
