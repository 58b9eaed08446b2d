#!/usr/bin/env python3
"""Behaviours, autonomous life and the tracker as a program for a robot uses them: through the SDK's proxies."""

import math
import queue
import sys
import unittest
from pathlib import Path

import numpy as np
import rospy
import rostest

from nao_sim_bridge.testing import SimulatedRobot
from naoqi import ALProxy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))  # not beside its relay
from things_fixture import ROBOT, Things  # noqa: E402

HELLO, BREATHE = "nao_library/hello", "nao_library/breathe"
BUTTON = "ChestBoard/Button"
FOLLOWED = math.radians(5.0)
PATIENCE = 20.0
"""Longest wait for an event, s of wall time."""


class Life(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.things = Things(cls.robot)
        cls.subscribers = []

    def setUp(self):
        self.robot.reset()
        self.addCleanup(self.robot.reset)

    def proxy(self, module):
        return ALProxy(module, "127.0.0.1", self.robot.port)

    def heard(self, event):
        """A queue of what an event says."""
        values = queue.Queue()
        subscriber = self.robot.module("ALMemory").subscriber(event)
        subscriber.signal.connect(values.put)
        self.subscribers.append(subscriber)
        return values

    def wait_for(self, values, wanted):
        """Wait until an event says something."""
        seen = []
        while not seen or seen[-1] != wanted:
            try:
                seen.append(values.get(timeout=PATIENCE))
            except queue.Empty:
                self.fail(f"{wanted!r} was not told within {PATIENCE:g} s, but {seen}")

    # --- behaviours -----------------------------------------------------------------------------------------------

    def test_a_behaviour_runs_to_its_end_and_is_told(self):
        self.proxy("ALMotion").wakeUp()
        manager, runs = self.proxy("ALBehaviorManager"), self.heard("BehaviorsRun")
        self.assertTrue(manager.isBehaviorInstalled(HELLO))
        begin = self.robot.module("NaoSimulation").time()
        manager.runBehavior(HELLO)
        self.assertGreater(self.robot.module("NaoSimulation").time() - begin, 2.0)
        self.assertEqual(manager.getRunningBehaviors(), [])
        self.wait_for(runs, [HELLO])
        self.wait_for(runs, [])

    def test_a_behaviour_that_is_posted_is_stopped(self):
        manager, runs = self.proxy("ALBehaviorManager"), self.heard("BehaviorsRun")
        number = manager.post.runBehavior(BREATHE)
        self.wait_for(runs, [BREATHE])
        self.assertTrue(manager.isBehaviorRunning(BREATHE))
        manager.stopBehavior(BREATHE)
        self.assertFalse(manager.wait(number, 10000), "the call did not end")
        self.wait_for(runs, [])

    def test_what_is_not_installed_is_told(self):
        with self.assertRaisesRegex(RuntimeError, "did you mean 'nao_library/hello'"):
            self.proxy("ALBehaviorManager").runBehavior("nao_library/helo")

    # --- tracker --------------------------------------------------------------------------------------------------

    def test_the_head_follows_a_ball_that_is_moved(self):
        self.proxy("ALMotion").setStiffnesses("Head", 1.0)
        tracker, detected = self.proxy("ALTracker"), self.heard("ALTracker/TargetDetected")
        self.things.place("tracked", [1.0, 0.0, 0.45], ball=0.03, mass=0.0)
        tracker.registerTarget("RedBall", 0.06)
        tracker.track("RedBall")
        self.addCleanup(tracker.stopTracker)
        self.wait_for(detected, "RedBall")
        self.robot.pause()
        self.addCleanup(self.robot.resume)
        moved, worst = self.things.move("tracked", [1.0, 0.35, 0.4], duration=1.2), 0.0
        for _ in range(15):
            self.robot.advance(0.1)
            x, y, z = self.things.in_camera(self.place("tracked"))
            worst = max(worst, math.atan2(math.hypot(y, z), x))
        moved.value(int(1000 * PATIENCE))
        self.assertLess(worst, FOLLOWED, f"{math.degrees(worst):.1f} degrees")
        seen, true = tracker.getTargetPosition(ROBOT), self.things.in_base(self.place("tracked"))
        self.assertLess(np.linalg.norm(np.subtract(seen, true)), 0.08, f"seen at {seen}, is at {true}")

    def place(self, name):
        return self.robot.module("NaoSimulation").objects()[name][:3]

    # --- life -----------------------------------------------------------------------------------------------------

    def test_it_lives_falls_gets_up_and_lives_on(self):
        life, states = self.proxy("ALAutonomousLife"), self.heard("AutonomousLife/State")
        life.setAutonomousAbilityEnabled("BasicAwareness", False)
        self.addCleanup(life.setAutonomousAbilityEnabled, "BasicAwareness", True)
        self.assertEqual(life.getState(), "disabled")
        life.setState("solitary")
        self.wait_for(states, "solitary")
        self.assertTrue(self.proxy("ALMotion").robotIsWakeUp())
        life.switchFocus(HELLO)
        self.wait_for(states, "interactive")
        self.wait_for(states, "solitary")
        self.robot.push([60.0, 0.0, 0.0], 0.2)
        self.wait_for(states, "safeguard")
        self.wait_for(states, "solitary")
        self.assertEqual(self.proxy("ALRobotPosture").getPostureFamily(), "Standing")

    def test_two_clicks_on_the_chest_begin_life(self):
        states, life = self.heard("AutonomousLife/State"), self.proxy("ALAutonomousLife")
        life.setAutonomousAbilityEnabled("BasicAwareness", False)
        self.addCleanup(life.setAutonomousAbilityEnabled, "BasicAwareness", True)
        self.robot.pause()
        for pressed in ([BUTTON], [], [BUTTON], []):
            self.robot.press(pressed)
            self.robot.advance(0.1)
        self.robot.resume()
        self.wait_for(states, "solitary")


if __name__ == "__main__":
    rospy.init_node("life_test")
    rostest.rosrun("nao_library_tests", "life", Life)
