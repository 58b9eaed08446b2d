#!/usr/bin/env python3
"""NaoTactile through actionlib, and what a touch starts in other servers."""

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoAudioOutAction, NaoBehaviorAction, NaoTactileAction
from nao_library_msgs.msg import TactileFunction
from nao_sim_bridge.testing import RobotTestCase, wait_until

HEAD = "Device/SubDeviceList/HeadPitch/Position/Sensor/Value"


def f(function, **fields):
    return TactileFunction(function=function, **fields)


class Tactile(RobotTestCase):
    server = ("NaoTactile", NaoTactileAction)

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        for name, action in (("NaoBehavior", NaoBehaviorAction), ("nao_audio_out", NaoAudioOutAction)):
            cls.robot.action_client(name, action)  # what a touch starts takes goals

    def setUp(self):
        super().setUp()
        self.addCleanup(self.play, f("removeOnTouch"))

    def waiting(self, *functions):
        """Send a goal, and come back when it waits."""
        run = self.send(*functions)
        wait_until(lambda: any(each.status == "waiting" for _, each in run.feedback), 60.0, "a goal that waits")
        return run

    def test_a_wait_ends_with_its_touch_and_with_no_other(self):
        run = self.waiting(f("waitForTouch", sensors=["head", "chest"], timeout=600.0))
        self.robot.press(["LFoot/Bumper/Left"])
        self.robot.advance(0.5)
        self.robot.press(["Head/Touch/Middle"])
        self.assertEqual(self.ends(run, GoalStatus.SUCCEEDED).result.touched, ["middle head"])

    def test_a_wait_is_cancelled(self):
        run = self.waiting(f("waitForTouch", timeout=1000.0))
        run.cancel()
        self.ends(run, GoalStatus.PREEMPTED)

    def test_a_touch_runs_a_stored_behaviour_and_a_missing_one_is_told(self):
        self.succeed(f("onTouch", sensors=["front head"], behavior="nod", parameters=["times=1"]))
        self.succeed(f("onTouch", sensors=["chest"], behavior="fly"))
        before = self.robot.value(HEAD)
        told = lambda: {each.behavior: each for each in self.succeed(f("listOnTouch")).bindings}  # noqa: E731
        for sensor, behavior in (("ChestBoard/Button", "fly"), ("Head/Touch/Front", "nod")):
            self.robot.press([sensor])
            wait_until(lambda name=behavior: told()[name].last, 60.0, f"the end of {behavior}")
        self.assertEqual({name: each.last for name, each in told().items()}, {"nod": "succeeded", "fly": "aborted"})
        self.assertIn("fly", told()["fly"].text)
        self.assertNotAlmostEqual(self.robot.value(HEAD), before, delta=0.05)


if __name__ == "__main__":
    rospy.init_node("tactile_test")
    rostest.rosrun("nao_library_tests", "tactile", Tactile)
