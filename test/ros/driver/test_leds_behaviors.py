"""Lights that fade and blink, behaviours of the robot by name, and its autonomous life, under nao_robot's names."""

import unittest

import rospy
from actionlib_msgs.msg import GoalStatus
from cases import case
from news import LIMIT, News
from rospy import Duration
from services import action_client, answer, service
from std_msgs.msg import ColorRGBA, String
from std_srvs.srv import Empty, SetBool, Trigger

from nao_library_actions.msg import BlinkAction, BlinkGoal, RunBehaviorAction, RunBehaviorGoal
from nao_library_msgs.msg import FadeRGB, LedStates
from nao_library_msgs.srv import GetInstalledBehaviors
from nao_sim_bridge.testing import SimulatedRobot, send, wait_until

RED, GREEN, BLUE = ColorRGBA(1.0, 0.0, 0.0, 1.0), ColorRGBA(0.0, 1.0, 0.0, 1.0), ColorRGBA(0.0, 0.0, 1.0, 1.0)
EYE = "Face/Led/{}/Left/45Deg"
CHEST = "ChestBoard/Led/{}"
HELLO, ENDLESS, HEY = "nao_library/hello", "nao_library/breathe", "animations/Stand/Gestures/Hey_1"


def rgb(pattern, color):
    """LED devices of a light in a colour."""
    return {pattern.format(part): value for part, value in zip(("Red", "Green", "Blue"), (color.r, color.g, color.b))}


def blinks(**changes):
    fields = {
        "colors": [RED, GREEN],
        "bg_color": BLUE,
        "blink_duration": Duration(0.3),
        "blink_rate_mean": 0.2,
        "blink_rate_sd": 0.05,
    }
    return BlinkGoal(**{**fields, **changes})


class DriverLedsBehaviors(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.news = News()
        cls.fade = rospy.Publisher("fade_rgb", FadeRGB, queue_size=10)
        cls.blink = action_client("blink", BlinkAction)
        cls.run_behavior = action_client("run_behavior", RunBehaviorAction)
        cls.installed = service("get_installed_behaviors", GetInstalledBehaviors)
        cls.states = []
        cls.news.subscribe("nao_alife/state", String, lambda message: cls.states.append(message.data))
        cls.manager = cls.robot.module("ALBehaviorManager")
        wait_until(lambda: answer(cls.installed) == "", LIMIT, "nao_behaviors and the robot")
        wait_until(lambda: cls.fade.get_num_connections() == 1 and cls.manager.ping(), LIMIT, "nao_leds")
        cls.news.wait(lambda: cls.states, "nao_alife and the robot")

    def setUp(self):
        self.robot.reset()

    # --- lights ---------------------------------------------------------------------------------------------------

    def test_fades_follow_each_other(self):
        # Red stays for long enough to be seen by a test that looks now and then.
        for color, duration in ((RED, 0.5), (RED, 20.0), (GREEN, 0.5)):
            self.fade.publish(FadeRGB("ChestLeds", color, Duration(duration)))
        self.robot.wait_for_leds(rgb(CHEST, RED), LIMIT)
        self.robot.advance(20.0)
        self.robot.wait_for_leds(rgb(CHEST, GREEN), LIMIT)

    def test_states_tell_what_each_light_shows(self):
        self.fade.publish(FadeRGB("ChestLeds", RED, Duration(0.0)))
        self.robot.wait_for_leds(rgb(CHEST, RED), LIMIT)
        told = rospy.wait_for_message("led_states", LedStates, timeout=LIMIT)
        shown = dict(zip(told.lights, told.colors))
        self.assertEqual((shown["ChestLeds"].r, shown["ChestLeds"].g, shown["ChestLeds"].b), (1.0, 0.0, 0.0))
        self.assertEqual({shown["LeftEarLed1"].r, shown["LeftEarLed1"].g}, {0.0})

    def test_eyes_blink_until_they_are_told_to_stop(self):
        began = self.robot.advance(0.0)
        run = send(self.blink, blinks())
        wait_until(lambda: len(run.feedback) >= 4 and self.manager.ping(), LIMIT, "blinks")
        took, count = self.robot.advance(0.0) - began, len(run.feedback)
        colors = {(message.last_color.r, message.last_color.g, message.last_color.b) for _, message in run.feedback}
        self.assertLessEqual(colors, {(1.0, 0.0, 0.0), (0.0, 1.0, 0.0)})
        self.assertGreater(took, 0.35 * (min(count, 4) - 1) - 0.05)  # a blink and a pause: 0.3 s and 0.05 to 0.35 s
        run.cancel()
        run.wait(LIMIT)
        self.assertEqual((run.state, run.result.still_blinking), (GoalStatus.PREEMPTED, False))
        self.robot.wait_for_leds(rgb(EYE, BLUE), LIMIT)

    def test_what_cannot_be_blinked_is_aborted_and_says_why(self):
        wrong = {
            "colors": {"colors": []},
            "blink_duration": {"blink_duration": Duration(0)},
            "blink_rate_mean": {"blink_rate_mean": 0.0},
            "blink_rate_sd": {"blink_rate_sd": -1.0},
        }
        for field, change in wrong.items():
            with case(field):
                run = send(self.blink, blinks(**change)).wait(LIMIT)
                self.assertEqual(run.state, GoalStatus.ABORTED)
                self.assertIn(field, run.text)

    # --- behaviours -----------------------------------------------------------------------------------------------

    def test_behaviours_are_listed_and_run_to_their_end(self):
        self.robot.module("ALMotion").wakeUp()
        names = self.installed().behaviors
        self.assertEqual(sorted(names), sorted(self.manager.getInstalledBehaviors()))
        self.assertIn(HELLO, names)
        run = send(self.run_behavior, RunBehaviorGoal(HELLO)).wait(LIMIT)
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
        self.assertGreater(run.ended - run.sent, 1.0)
        self.assertEqual(self.manager.getRunningBehaviors(), [])

    def test_cancelling_stops_the_behaviour(self):
        self.robot.module("ALMotion").wakeUp()
        run = send(self.run_behavior, RunBehaviorGoal(ENDLESS))
        wait_until(lambda: self.manager.isBehaviorRunning(ENDLESS), LIMIT, ENDLESS)
        run.cancel()
        run.wait(LIMIT)
        self.assertEqual(run.state, GoalStatus.PREEMPTED)
        self.assertEqual(self.manager.getRunningBehaviors(), [])

    def test_what_is_not_installed_or_cannot_run_is_told(self):
        run = send(self.run_behavior, RunBehaviorGoal("nao_library/helo")).wait(LIMIT)
        self.assertEqual(run.state, GoalStatus.ABORTED)
        self.assertIn("did you mean 'nao_library/hello'", run.text)
        limp = send(self.run_behavior, RunBehaviorGoal(HEY)).wait(LIMIT)
        self.assertEqual(limp.state, GoalStatus.ABORTED)
        self.assertIn("limp", limp.text)

    # --- autonomous life ------------------------------------------------------------------------------------------

    def test_life_goes_to_its_states_and_tells_them(self):
        life = self.robot.module("ALAutonomousLife")
        for state in ("solitary", "disabled"):
            self.states.clear()
            self.assertEqual(answer(service(f"nao_alife/{state}", Empty)), "")
            self.assertEqual(life.getState(), state)
            self.news.wait(lambda state=state: state in self.states, f"the state {state}")

    def test_abilities_are_switched(self):
        for name in ("background_movement", "listening_movement", "speaking_movement", "basic_awareness"):
            with case(name):
                switch, ask = service(f"{name}/set_enabled", SetBool), service(f"{name}/is_enabled", Trigger)
                for enabled in (False, True):
                    changed = switch(enabled)
                    self.assertTrue(changed.success, changed.message)
                    self.assertEqual(ask().success, enabled)
