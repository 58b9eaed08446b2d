#!/usr/bin/env python3
"""The reference for goals: actionlib's server for the same action, with a callback that does nothing."""

from __future__ import annotations

import sys

import actionlib
import rospy

from nao_library_actions.msg import NaoLedAction


def main() -> int:
    """Serve the action that the command line names until the node ends."""
    name = rospy.myargv(sys.argv)[1]
    rospy.init_node(name)
    done = lambda _: server.set_succeeded()  # noqa: E731
    server = actionlib.SimpleActionServer(name, NaoLedAction, done, auto_start=False)
    server.start()
    rospy.spin()
    return 0


if __name__ == "__main__":
    sys.exit(main())
