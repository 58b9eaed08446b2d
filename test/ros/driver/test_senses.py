"""Touch, feet, sonars, temperatures and battery of the robot, as topics and on /diagnostics."""

import itertools
import json
import math
import os
import subprocess
import unittest

import rospy
from cases import case
from diagnostic_msgs.msg import DiagnosticStatus
from news import LIMIT, News, Reports
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState, Range
from services import publisher
from std_msgs.msg import Bool

from nao_library_msgs.msg import (
    Bumper,
    ChestButton,
    ConnectionState,
    Fsr,
    HandTouch,
    HeadTouch,
    StringStamped,
    TactileTouch,
)
from nao_library_msgs.srv import GetRobotInfo
from nao_sim_bridge.testing import SimulatedRobot, wait_until

HEAD = {"Head/Touch/Front": 1, "Head/Touch/Middle": 2, "Head/Touch/Rear": 3}
HANDS = {
    "RHand/Touch/Back": HandTouch.RIGHT_BACK,
    "RHand/Touch/Left": HandTouch.RIGHT_LEFT,
    "RHand/Touch/Right": HandTouch.RIGHT_RIGHT,
    "LHand/Touch/Back": HandTouch.LEFT_BACK,
    "LHand/Touch/Left": HandTouch.LEFT_LEFT,
    "LHand/Touch/Right": HandTouch.LEFT_RIGHT,
}
BUMPERS = {
    "LFoot/Bumper/Left": Bumper.left,
    "LFoot/Bumper/Right": Bumper.left,
    "RFoot/Bumper/Left": Bumper.right,
    "RFoot/Bumper/Right": Bumper.right,
}
BUTTON = "ChestBoard/Button"
WEIGHT = (4.9 * 9.81, 6.0 * 9.81)
"""N, that the soles of a standing robot feel together."""
WALL = "{name: wall, box: [0.1, 3.0, 2.0], position: [%g, 0.0, 1.0]}"


class DriverSenses(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.simulation = cls.robot.module("NaoSimulation")
        cls.news = News()
        cls.reports = Reports()
        cls.latest = {}
        topics = {
            "foot_contact": Bool,
            "other/foot_contact": Bool,
            "connection": ConnectionState,
            "info": StringStamped,
        }
        for name, kind in topics.items():
            cls.news.subscribe(name, kind, lambda message, name=name: cls.latest.update({name: message}))
        for node in ("nao_tactile", "other/nao_tactile"):
            cls.reports.wait(f"{node}: touch", lambda status: status.level == DiagnosticStatus.OK)

    def setUp(self):
        self.robot.press([])
        self.robot.reset()

    def press_each(self, sensors, found):
        for sensor in sensors:
            for pressed in ([sensor], []):
                count = len(found)
                self.robot.press(pressed)
                self.news.wait(lambda count=count: len(found) > count, f"a message of {sensor}")

    # --- touch ----------------------------------------------------------------------------------------------------

    def test_head_hands_and_bumpers_say_what_is_touched(self):
        cases = [
            ("tactile_touch", TactileTouch, HEAD, "button"),
            ("head_touch", HeadTouch, HEAD, "button"),
            ("hand_touch", HandTouch, HANDS, "hand"),
            ("bumper", Bumper, BUMPERS, "bumper"),
            ("other/hand_touch", HandTouch, HANDS, "hand"),
        ]
        for topic, kind, sensors, field in cases:
            with case(topic), self.news.messages(topic, kind) as found:
                self.press_each(sensors, found)
                expected = [(number, state) for number in sensors.values() for state in (1, 0)]
                self.assertEqual([(getattr(each, field), each.state) for each in found], expected)

    def test_the_chest_button_counts_clicks(self):
        with self.news.messages("chest_button", ChestButton) as found:
            self.robot.pause()  # a click takes its time, however busy the computer is
            self.addCleanup(self.robot.resume)
            for sensors in ([BUTTON], []) * 2:
                count = len(found)
                self.robot.press(sensors)
                self.robot.advance(0.1)
                self.news.wait(lambda count=count: len(found) > count, "a message of the button")
                self.robot.advance(0.1)
            self.robot.advance(1.0)
            self.news.wait(lambda: found and found[-1].clicks, "the clicks")
        self.assertEqual([(each.state, each.clicks) for each in found], [(1, 0), (0, 0), (1, 0), (0, 0), (0, 2)])

    def test_one_who_comes_late_learns_whether_the_feet_touch_the_ground(self):
        for topic in ("foot_contact", "other/foot_contact"):
            self.news.wait(lambda topic=topic: self.latest.get(topic) is not None, topic)
            self.assertTrue(self.latest[topic].data)

    # --- feet -----------------------------------------------------------------------------------------------------

    def test_the_feet_carry_the_robot(self):
        self.robot.module("ALMotion").wakeUp()
        with self.news.messages("nao_robot/fsr/left", Fsr) as left, self.news.messages(
            "nao_robot/fsr/right", Fsr
        ) as right:
            self.news.wait(lambda: len(left) > 5 and len(right) > 5, "forces under the feet")
        for side, foot in (("l", left[-1]), ("r", right[-1])):
            self.assertEqual(foot.header.frame_id, f"{side}_sole")
            self.assertTrue(foot.contact)
            corners = foot.front_left + foot.front_right + foot.rear_left + foot.rear_right
            self.assertAlmostEqual(corners, foot.total, delta=0.5)
            self.assertLess(abs(foot.center_of_pressure.x), 0.1)
        self.assertTrue(WEIGHT[0] < left[-1].total + right[-1].total < WEIGHT[1], (left[-1], right[-1]))

    def test_frames_carry_the_prefix_of_the_robot(self):
        with self.news.messages("other/nao_robot/fsr/left", Fsr) as found:
            self.news.wait(lambda: found, "forces under the left foot")
        self.assertEqual(found[0].header.frame_id, "other/l_sole")

    # --- joints ---------------------------------------------------------------------------------------------------

    def test_joint_states_go_on_when_the_clock_was_set_back(self):
        node = subprocess.Popen(
            ["rosrun", "nao_library_modules", "nao_joint_states", "--pport", os.environ["NAO_PORT"]]
            + ["__ns:=second", "/clock:=/second/clock", "/tf:=/second/tf"]
        )
        self.addCleanup(node.wait, LIMIT)
        self.addCleanup(node.terminate)
        clock = publisher(self, "second/clock", Clock)
        with self.news.messages("second/joint_states", JointState) as found:
            for begin, end in ((1e6, 2e6), (5.0, 1e6)):
                steps = (rospy.Time.from_sec(begin + 0.1 * step) for step in itertools.count())

                def there(begin=begin, end=end, steps=steps):
                    clock.publish(Clock(next(steps)))
                    return found and begin <= found[-1].header.stamp.to_sec() < end

                wait_until(there, LIMIT, f"joint states of a clock that began at {begin:g} s")

    # --- sonars ---------------------------------------------------------------------------------------------------

    def test_sonars_measure_while_somebody_listens(self):
        sonar = self.robot.module("ALSonar")
        wait_until(lambda: not sonar.getSubscribersInfo(), LIMIT, "sonars that nobody needs")
        with self.news.messages("nao_robot/sonar/left", Range) as left:
            self.news.wait(lambda: any(math.isinf(each.range) for each in left), "a free view")
            self.assertEqual([name for name, *_ in sonar.getSubscribersInfo()], ["ros_nao_sonar"])
            self.simulation.placeObject(WALL % 0.95)
            self.addCleanup(self.simulation.removeObject, "wall")
            self.news.wait(lambda: left[-1].range < 2.0, "the wall on the left")
            with self.news.messages("nao_robot/sonar/right/sonar", Range) as right:
                self.news.wait(lambda: right and right[-1].range < 2.0, "the wall on the right")
        for message, side in ((left[-1], "L"), (right[-1], "R")):
            self.assertEqual(message.header.frame_id, f"{side}Sonar_frame")
            # The wall's face is 0.9 m from where the robot stands; the chest is some cm before that.
            self.assertAlmostEqual(message.range, 0.85, delta=0.08)
            self.assertEqual(message.radiation_type, Range.ULTRASOUND)
            self.assertAlmostEqual(message.max_range, 2.55, delta=1e-6)
        wait_until(lambda: not sonar.getSubscribersInfo(), LIMIT, "the end of the subscription")

    # --- diagnostics ----------------------------------------------------------------------------------------------

    def test_a_hot_joint_is_told(self):
        for celsius, level, word in ((70.0, DiagnosticStatus.WARN, "Hot"), (78.0, DiagnosticStatus.ERROR, "Too hot")):
            self.simulation.setTemperature("LKneePitch", celsius)
            self.reports.wait(
                "nao_joint: LKneePitch",
                lambda status, level=level, word=word: status.level == level and status.message.startswith(f"{word}: "),
            )

    def test_the_battery_is_told_with_its_flags(self):
        self.simulation.setBatteryCharge(0.2)
        report = self.reports.wait("nao_power: Battery", lambda status: status.level == DiagnosticStatus.WARN)
        self.assertTrue(report.message.startswith("Low ("), report.message)
        values = {entry.key: entry.value for entry in report.values}
        self.assertEqual(len(values), 18)
        self.assertEqual(values["Discharging flag"], "True")
        self.assertAlmostEqual(float(values["Percentage"]), 20.0, delta=5.0)  # it is used meanwhile
        self.simulation.plugCharger(True)
        self.addCleanup(self.simulation.plugCharger, False)
        self.reports.wait("nao_power: Battery", lambda status: status.message.startswith("Charging ("))
        self.reports.wait("nao_power: Current", lambda status: status.message.endswith("(charging)"))
        self.reports.wait("nao_cpu: Head Temperature", lambda status: status.message.endswith(" C"))
        self.reports.wait("nao_ethernet: Status", lambda status: status.message.startswith("connected: "))
        self.reports.wait("nao_wlan: Status", lambda status: status.message == "not connected")

    def test_the_robot_says_what_it_is_and_that_it_is_there(self):
        rospy.wait_for_service("get_robot_config", LIMIT)
        info = rospy.ServiceProxy("get_robot_config", GetRobotInfo)().info
        version = self.robot.value("RobotConfig/Body/Version")
        self.assertEqual((info.type, info.model, info.body_version), (info.NAO, "nao_h25", version))
        self.news.wait(lambda: "info" in self.latest, "facts of the robot")
        self.assertEqual(json.loads(self.latest["info"].data)["body version"], version)
        self.news.wait(
            lambda: self.latest.get("connection", ConnectionState()).state == ConnectionState.CONNECTED,
            "the state of the connection",
        )
        self.assertTrue(self.latest["connection"].address.endswith(f":{self.robot.port}"))
