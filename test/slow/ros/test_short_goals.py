"""Goals that are over at once, through actionlib's own client, which loses ends that come too early."""

import unittest

import rospy
from actionlib import SimpleActionClient
from actionlib_msgs.msg import GoalStatusArray

from nao_library_actions.msg import NaoLedAction, NaoLedGoal
from nao_library_msgs.msg import LedFunction

GOALS, LIMIT = 2000, rospy.Duration(5)


class ShortGoals(unittest.TestCase):
    def test_their_ends_are_not_lost_and_the_status_stays_short(self):
        client, longest = SimpleActionClient("NaoLights", NaoLedAction), []
        self.assertTrue(client.wait_for_server(rospy.Duration(30)))
        status = rospy.Subscriber(
            "NaoLights/status", GoalStatusArray, lambda told: longest.append(len(told.status_list))
        )
        self.addCleanup(status.unregister)
        lost = 0
        for _ in range(GOALS):
            client.send_goal(NaoLedGoal([LedFunction(function="listGroups")]))
            lost += not client.wait_for_result(LIMIT)
        self.assertLessEqual(lost, 1)
        self.assertTrue(0 < max(longest) < 20, max(longest))
