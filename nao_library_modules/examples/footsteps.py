#!/usr/bin/env python3
"""Makes single footsteps: four ahead, then a turn on the spot, and shows which of them are made.

Needs a running driver, for example `roslaunch nao_library nao_sim.launch`. The robot has to stand: `rosservice call
wakeup`. Ctrl-C stops it.
"""

from __future__ import annotations

import sys

import rospy
from actionlib import SimpleActionClient
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import ExecFootstepsAction, ExecFootstepsFeedback, ExecFootstepsGoal
from nao_library_modules.ros.driver_types import spoken
from nao_library_msgs.msg import StepTarget

LIMIT = rospy.Duration(20)
WALK_LIMIT = rospy.Duration(60)
SIDES = {StepTarget.left: 1.0, StepTarget.right: -1.0}
APART = 0.1


def step(leg: int, ahead: float, turn: float) -> StepTarget:
    """A step beside the other foot, or before it.

    Args:
        leg: StepTarget.left or StepTarget.right: the foot that moves.
        ahead: m before the other foot.
        turn: rad to the left, against the other foot.
    """
    target = StepTarget(leg=leg)
    target.pose.x, target.pose.y, target.pose.theta = ahead, SIDES[leg] * APART, turn
    return target


def steps() -> list[StepTarget]:
    """Four steps ahead, the feet side by side, and a turn in which the left foot leads and the right one follows."""
    legs = [StepTarget.left, StepTarget.right]
    ahead = [step(leg, 0.04, 0.0) for leg in legs * 2]
    turn = [step(leg, 0.0, 0.3 if leg == StepTarget.left else 0.0) for leg in legs * 2]
    return [*ahead, step(StepTarget.left, 0.0, 0.0), step(StepTarget.right, 0.0, 0.0), *turn]


def main() -> int:
    """Make them; the exit status tells whether all are made."""
    rospy.init_node("footsteps", anonymous=True)
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    client = SimpleActionClient("footsteps_execution", spoken(ExecFootstepsAction))
    if not client.wait_for_server(LIMIT):
        print("there is no nao_footsteps: start it with roslaunch nao_library nao_sim.launch")
        return 1
    asked = steps()

    def show(feedback: ExecFootstepsFeedback) -> None:
        print(f"\r{len(feedback.executed_footsteps)} of {len(asked)} steps are made", end="", flush=True)

    rospy.on_shutdown(lambda: client.get_state() == GoalStatus.ACTIVE and client.cancel_goal())
    client.send_goal(ExecFootstepsGoal(asked, 5.0), feedback_cb=show)
    if not client.wait_for_result(WALK_LIMIT):
        client.cancel_goal()
        print(f"\nno result within {WALK_LIMIT.to_sec():g} s")
        return 1
    state = client.get_state()
    print(f"\n{GoalStatus.to_string(state).lower()} {client.get_goal_status_text()}".rstrip())
    return 0 if state == GoalStatus.SUCCEEDED else 1


if __name__ == "__main__":
    sys.exit(main())
