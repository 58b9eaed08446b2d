"""Program that runs a behaviour on the stack of a projection. Reads a goal as JSON, prints what came of it as JSON."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from typing import Any

SERVER_LIMIT = 60.0
"""s of this computer until the server must be there."""
FIELDS = ("path", "what", "state", "began", "ended", "error")


def run(goal: Mapping[str, Any]) -> dict[str, Any]:
    """Run a behaviour; state, text, duration (s of ROS time), and its steps."""
    import actionlib
    import rospy
    from actionlib_msgs.msg import GoalStatus

    from nao_library_actions.msg import NaoBehaviorAction, NaoBehaviorGoal
    from nao_library_msgs.msg import BehaviorFunction

    rospy.init_node("projection", anonymous=True, disable_rosout=True)
    client = actionlib.SimpleActionClient("NaoBehavior", NaoBehaviorAction)
    # Simulated time passes faster than this computer's: the limit is counted in both.
    if not client.wait_for_server(rospy.Duration(100 * SERVER_LIMIT)):
        raise SystemExit("the server NaoBehavior does not come up")
    client.send_goal(NaoBehaviorGoal([BehaviorFunction(function="runBehavior", **goal)]))
    client.wait_for_result()
    result = client.get_result()
    steps = [] if result is None else [{name: getattr(step, name) for name in FIELDS} for step in result.steps]
    state = GoalStatus.to_string(client.get_state()).lower()
    duration = max((step["ended"] for step in steps), default=0.0)
    return {"state": state, "text": client.get_goal_status_text(), "duration": duration, "steps": steps}


if __name__ == "__main__":
    print(json.dumps(run(json.load(sys.stdin))))
