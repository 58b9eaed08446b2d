#!/usr/bin/env python3
"""Every function of NaoLights through the real stack, with its effect on the LEDs of the robot."""

import unittest

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoLedAction, NaoLedGoal
from nao_library_msgs.msg import LedFunction
from nao_sim_bridge.testing import SimulatedRobot, send

EYE_ANGLES = range(0, 360, 45)
BRAIN0, CHEST = "Head/Led/Front/Right/1", "ChestBoard/Led/{}"


def eyes(red, green, blue):
    colors = {"Red": red, "Green": green, "Blue": blue}
    return {
        f"Face/Led/{color}/{side}/{angle}Deg": float(value)
        for color, value in colors.items()
        for side in ("Left", "Right")
        for angle in EYE_ANGLES
    }


class LightsFunctions(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.client = cls.robot.action_client("NaoLights", NaoLedAction)

    def setUp(self):
        self.robot.reset()

    def play(self, function, **fields):
        run = send(self.client, NaoLedGoal([LedFunction(function=function, **fields)])).wait()
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
        return run.result

    def check(self, wanted):
        found = self.robot.leds(wanted)
        for device, value in wanted.items():
            self.assertAlmostEqual(found[device], value, delta=0.01, msg=device)

    def eye_colours(self):
        """The different colours that the 16 segments of the eyes have."""
        found = self.robot.leds(eyes(0, 0, 0))
        return {
            tuple(found[f"Face/Led/{color}/{side}/{angle}Deg"] for color in ("Red", "Green", "Blue"))
            for side in ("Left", "Right")
            for angle in EYE_ANGLES
        }

    def test_on_off_and_reset(self):
        self.play("off", lights=["AllLeds"])
        self.check({**eyes(0, 0, 0), BRAIN0: 0.0})
        self.play("on", lights=["FaceLeds", "Brain0"])
        self.check({**eyes(1, 1, 1), BRAIN0: 1.0, "Head/Led/Rear/Left/0": 0.0})
        self.play("reset", lights=["AllLeds"])
        self.check({**eyes(1, 1, 1), "Head/Led/Rear/Left/0": 1.0, CHEST.format("Red"): 0.0})

    def test_intensities_one_for_all_and_one_each(self):
        self.play("setIntensity", lights=["Brain0", "Brain1"], i_values=[0.25])
        self.check({BRAIN0: 0.25, "Head/Led/Front/Right/0": 0.25})
        self.play("setIntensity", lights=["Brain0", "ChestLedsBlue"], i_values=[0.5, 0.75])
        self.check({BRAIN0: 0.5, CHEST.format("Blue"): 0.75})
        result = self.play("getIntensity", lights=["Brain0", "ChestLedsBlue"])
        self.assertEqual([float(v) for v in result.results[0].values], [0.5, 0.75])

    def test_colours_by_value_name_and_each(self):
        self.play("setColor", lights=["FaceLeds"], str_param="yellow")
        self.check(eyes(1, 1, 0))
        self.play("setColor", lights=["LeftFaceLeds", "ChestLeds"], i_values=[1, 0, 0, 0, 0, 1])
        self.check({"Face/Led/Red/Left/0Deg": 1.0, "Face/Led/Green/Left/0Deg": 0.0, CHEST.format("Blue"): 1.0})
        result = self.play("getColor", lights=["ChestLeds"])
        self.assertIn("1.0", "".join(result.results[0].values))

    def test_fades_take_their_time_and_end_where_asked(self):
        for function, fields, wanted in (
            ("fade", {"lights": ["BrainLeds"], "i_values": [0.2]}, {BRAIN0: 0.2}),
            ("fadeRGB", {"lights": ["FaceLeds"], "i_values": [0, 0, 1]}, eyes(0, 0, 1)),
        ):
            with self.robot.at_speed(0.25):
                result = self.play(function, duration=0.5, **fields)
            self.assertAlmostEqual(result.results[0].elapsed.to_sec(), 0.5, delta=0.15, msg=function)
            self.check(wanted)

    def test_fade_list_ends_in_its_last_colour(self):
        self.play("fadeListRGB", lights=["FaceLeds"], str_param="red,green,#0000ff", times=[0.2, 0.4, 0.6])
        self.check(eyes(0, 0, 1))

    def test_animations_change_the_eyes_for_their_time(self):
        cyan, dark, rasta = (0, 1, 1), (0, 0, 0), {(0, 1, 0), (1, 1, 0), (1, 0, 0)}
        for function, fields, shown in (
            ("randomEyes", {"duration": 0.6}, lambda colours: len(colours) == 16),
            ("rasta", {"duration": 0.6}, lambda colours: len(colours) == 1 and colours < rasta),
            (
                "rotateEyes",
                {"str_param": "cyan", "rotation_time": 0.4, "duration": 0.6},
                lambda colours: colours == {cyan, dark},
            ),
        ):
            self.robot.reset()
            with self.robot.at_speed(0.25):
                result = self.play(function, **fields)
            self.assertAlmostEqual(result.results[0].elapsed.to_sec(), 0.6, delta=0.15, msg=function)
            colours = self.eye_colours()
            self.assertTrue(shown(colours), (function, colours))

    def test_animation_with_revert_leaves_no_trace(self):
        self.play("rasta", duration=0.5, revert=True)
        self.check(eyes(1, 1, 1))

    def test_ears_show_a_direction(self):
        self.play("earLedsSetAngle", angle=90, duration=0.2, leave_on=True)
        front = self.robot.leds(["Ears/Led/Left/72Deg", "Ears/Led/Left/252Deg"])
        self.assertGreater(front["Ears/Led/Left/72Deg"], 0.9)
        self.assertEqual(front["Ears/Led/Left/252Deg"], 0.0)

    def test_a_new_group_is_used_like_any_other(self):
        name = "TestGroup"
        chain = [
            LedFunction(function="createGroup", str_param=name, lights=["Brain0", "ChestLeds"]),
            LedFunction(function="setIntensity", lights=[name], i_values=[0.4]),
            LedFunction(function="listGroup", str_param=name),
            LedFunction(function="listGroups"),
            LedFunction(function="listLEDs"),
        ]
        run = send(self.client, NaoLedGoal(chain)).wait()
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
        self.check({BRAIN0: 0.4, CHEST.format("Red"): 0.4})
        self.assertIn("Brain0", run.result.results[2].values)
        self.assertIn(name, run.result.results[3].values)
        self.assertEqual(len(run.result.results[4].values), 57)


if __name__ == "__main__":
    rospy.init_node("lights_functions_test")
    rostest.rosrun("nao_library_tests", "lights_functions", LightsFunctions)
