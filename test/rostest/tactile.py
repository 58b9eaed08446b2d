#!/usr/bin/env python3
"""Goals of NaoTactile on the simulated robot: what it feels, waiting for it, and behaviours that a touch starts."""

import csv
import math
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoAudioOutAction, NaoBehaviorAction, NaoTactileAction, NaoTactileGoal
from nao_library_msgs.msg import TactileFunction
from nao_sim_bridge.testing import SimulatedRobot, send, wait_until

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))  # not beside its relay
from examples_fixture import EXAMPLES, start  # noqa: E402

WALL = "{name: tactile_wall, box: [0.1, 2.0, 2.0], position: [%g, 0.0, 1.0]}"
HEAD = "Device/SubDeviceList/HeadPitch/Position/Sensor/Value"


def f(function, **fields):
    return TactileFunction(function=function, **fields)


class Tactile(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.client = cls.robot.action_client("NaoTactile", NaoTactileAction)
        for name, action in (("NaoBehavior", NaoBehaviorAction), ("nao_audio_out", NaoAudioOutAction)):
            cls.robot.action_client(name, action)  # what a touch starts takes goals

    def setUp(self):
        self.robot.resume()
        self.robot.press([])
        self.robot.reset()

    def send(self, *functions):
        return send(self.client, NaoTactileGoal(list(functions)))

    def feel(self, *functions):
        run = self.send(*functions).wait()
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
        return run.result

    def waiting(self, *functions):
        """Send a goal, and come back when it waits."""
        run = self.send(*functions)
        wait_until(lambda: any(each.status == "waiting" for _, each in run.feedback), 30.0, "a goal that waits")
        return run

    def test_what_is_pressed_is_read(self):
        self.robot.press(["Head/Touch/Rear", "LFoot/Bumper/Right", "RHand/Touch/Back"])
        wait_until(lambda: self.feel(f("getTouched")).touched, 30.0, "touch")
        result = self.feel(f("getTouched"), f("getBumpers"), f("getTouched", sensors=["head"]))
        self.assertEqual(result.results[0].values, ["rear head", "right hand back", "left bumper"])
        self.assertEqual(result.results[1].values, ["left bumper"])
        self.assertEqual(result.results[2].values, ["rear head"])

    def test_a_wait_ends_with_its_touch_and_with_no_other(self):
        run = self.waiting(f("waitForTouch", sensors=["head", "chest"], timeout=60.0))
        self.robot.press(["LFoot/Bumper/Left"])
        self.robot.advance(0.5)
        self.robot.press(["Head/Touch/Middle"])
        self.assertEqual(run.wait().result.touched, ["middle head"])

    def test_a_hold_takes_its_time(self):
        with self.robot.at_speed(0.5):
            run = self.waiting(f("waitForTouch", sensors=["right hand"], touch="hold", duration=1.5, timeout=60.0))
            began = self.robot.advance(0.0)
            self.robot.press(["RHand/Touch/Left"])
            self.assertEqual(run.wait().result.touched, ["right hand left"])
            ended = self.robot.advance(0.0)
        self.assertGreaterEqual(ended - began, 1.45)

    def test_two_clicks_of_the_chest_button(self):
        run = self.waiting(f("waitForChestButton", count=2, timeout=60.0))
        self.robot.pause()  # a click takes its time, however busy the computer is
        for _ in range(2):
            self.robot.press(["ChestBoard/Button"])
            self.robot.advance(0.1)
            self.robot.press([])
            self.robot.advance(0.1)
        self.robot.resume()
        self.assertEqual(run.wait().result.touched, ["chest"])

    def test_nothing_in_time_is_an_answer(self):
        self.assertEqual(self.feel(f("waitForTouch", timeout=0.5), f("waitForFall", timeout=0.5)).touched, [])

    def test_a_wall_is_heard_and_waited_for(self):
        world = self.robot.module("NaoSimulation")
        nothing = self.feel(f("getSonar"))
        self.assertEqual((nothing.sonar_names, list(nothing.sonar)), (["left", "right"], [math.inf, math.inf]))
        run = self.waiting(f("waitForObstacle", distance=0.8, timeout=60.0))
        world.placeObject(WALL % 0.7)
        near = run.wait().result
        self.assertTrue(near.sonar_names)
        for distance in (*near.sonar, *self.feel(f("getSonar")).sonar):
            self.assertTrue(0.3 < distance < 0.8, distance)
        self.assertEqual(self.robot.module("ALSonar").getSubscribersInfo(), [])

    def test_weight_battery_and_temperatures(self):
        self.robot.advance(1.0)  # it has just been put on its feet
        result = self.feel(f("getFsr"), f("getBattery"), f("getTemperatures", sensors=["LLeg", "head", "battery"]))
        weights = dict(zip(result.fsr_names, result.fsr))
        self.assertAlmostEqual(weights["left foot"] + weights["right foot"], 5.4, delta=0.5)
        corners = sum(weight for name, weight in weights.items() if name.count(" ") > 1)
        self.assertAlmostEqual(corners, weights["left foot"] + weights["right foot"], delta=0.1)
        (battery,) = result.battery
        self.assertTrue(0.5 < battery.percentage <= 1.0 and battery.present, battery)
        self.assertTrue(15.0 < battery.voltage < 30.0, battery.voltage)
        self.assertEqual(result.devices[-2:], ["head", "battery"])
        self.assertTrue(all(15.0 < warmth < 90.0 for warmth in result.temperatures), result.temperatures)

    def test_a_touch_runs_a_stored_behaviour_until_it_is_removed(self):
        bind = f("onTouch", sensors=["front head"], behavior="nod", parameters=["times=1"])
        self.assertEqual(self.feel(bind).bindings[0].name, "nod")
        before = self.robot.value(HEAD)
        self.robot.press(["Head/Touch/Front"])
        wait_until(lambda: self.feel(f("listOnTouch")).bindings[0].last, 60.0, "end of the behaviour")
        (binding,) = self.feel(f("listOnTouch")).bindings
        self.assertEqual((binding.last, binding.runs), ("succeeded", 1), binding.text)
        self.assertNotAlmostEqual(self.robot.value(HEAD), before, delta=0.05)
        self.feel(f("removeOnTouch", str_param="nod"))
        self.assertEqual(self.feel(f("listOnTouch")).bindings, [])

    def test_a_behaviour_that_is_not_there_is_told(self):
        self.feel(f("onTouch", sensors=["chest"], behavior="fly"))
        self.robot.press(["ChestBoard/Button"])
        wait_until(lambda: self.feel(f("listOnTouch")).bindings[0].last, 60.0, "end of the behaviour")
        (binding,) = self.feel(f("listOnTouch"), f("removeOnTouch")).bindings
        self.assertEqual(binding.last, "aborted")
        self.assertIn("fly", binding.text)

    def test_the_example_reacts_to_a_touch(self):
        options = ("--sensor", "left hand", "--behavior", "nod", "--times", "1")
        with start("react_to_touch.py", *options, "times=1") as example:
            said = next((line for line in example.stdout if "waiting for a touch: left hand" in line), "")
            self.assertTrue(said, "it ended before it waited")
            self.robot.press(["LHand/Touch/Back"])
            output, _ = example.communicate(timeout=90)
        self.assertEqual(example.returncode, 0, output)
        self.assertIn("nod: succeeded", output)
        self.assertEqual(self.feel(f("listOnTouch")).bindings, [])

    def test_the_study_writes_a_line_a_trial(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "study.csv"
            command = [sys.executable, str(EXAMPLES / "touch_study.py"), "--trials", "2", "--simulated-hand"]
            command += ["--question", "Touch me.", "--output", str(path)]
            done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            with path.open(encoding="utf-8") as file:
                rows = list(csv.DictReader(file))
        self.assertEqual([row["trial"] for row in rows], ["1", "2"])
        for row in rows:
            self.assertEqual((row["touched"], row["end"], row["problem"]), ("middle head", "succeeded", ""))
            self.assertGreater(float(row["reaction_s"]), 0.3)
            self.assertGreater(float(row["behavior_s"]), 0.5)


if __name__ == "__main__":
    rospy.init_node("tactile")
    rostest.rosrun("nao_library_tests", "tactile", Tactile)
