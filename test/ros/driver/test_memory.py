"""Keys and events of the robot's memory as topics, read only while somebody listens; and written from ROS."""

import json
import subprocess
import unittest

import rospy
from news import LIMIT, News
from rospy import get_published_topics

from nao_library_msgs.msg import (
    BoolStamped,
    FloatArrayStamped,
    FloatStamped,
    IntArrayStamped,
    IntStamped,
    StringArrayStamped,
    StringStamped,
)
from nao_library_msgs.srv import GetMemory, ListMemory, SetMemory, UnwatchMemory, WatchMemory
from nao_sim_bridge.testing import SimulatedRobot, wait_until

CHARGE = "Device/SubDeviceList/Battery/Charge/Sensor/Value"
ANGLE = "Device/SubDeviceList/InertialSensor/AngleX/Sensor/Value"
CLICK = "ALChestButton/SimpleClickOccurred"
FRONT = "FrontTactilTouched"


class DriverMemory(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.memory = cls.robot.module("ALMemory")
        cls.news = News()
        kinds = {"watch": WatchMemory, "unwatch": UnwatchMemory, "get": GetMemory, "set": SetMemory, "list": ListMemory}
        for name, kind in kinds.items():
            rospy.wait_for_service(f"nao_memory/{name}", LIMIT)
            setattr(cls, name, staticmethod(rospy.ServiceProxy(f"nao_memory/{name}", kind)))
        wait_until(lambda: "/nao_memory/" + CHARGE in cls.topics(), LIMIT, "the topics of the parameter ~keys")

    @staticmethod
    def topics():
        return {name: kind for name, kind in get_published_topics("/nao_memory")}

    def setUp(self):
        self.robot.press([])
        self.robot.reset()

    def listen(self, key, kind):
        return self.news.messages(f"/nao_memory/{key}", kind)

    def watch_and_end(self, pattern, rate=0.0, kind=""):
        answer = self.watch(pattern, rate, kind)
        self.addCleanup(self.unwatch, pattern)
        self.assertTrue(answer.success, answer.message)
        return answer

    # --- topics ---------------------------------------------------------------------------------------------------

    def test_what_the_parameter_names_is_there_with_its_type(self):
        topics = self.topics()
        self.assertEqual(topics["/nao_memory/" + CHARGE], "nao_library_msgs/FloatStamped")
        self.assertEqual(topics["/nao_memory/" + CLICK], "nao_library_msgs/StringStamped")
        capacity = "/nao_memory/Device/SubDeviceList/Battery/Charge/Sensor/FullChargeCapacity"
        self.assertEqual(topics[capacity], "nao_library_msgs/IntStamped")

    def test_data_comes_at_its_rate_in_simulated_time(self):
        with self.listen(ANGLE, FloatStamped) as found:
            self.news.wait(lambda: len(found) >= 20, "angles of the torso")
        stamps = [message.header.stamp.to_sec() for message in found[2:20]]
        spans = [later - stamp for stamp, later in zip(stamps, stamps[1:])]
        self.assertGreater(sum(spans) / len(spans), 0.045)
        self.assertLess(min(spans), 0.075)  # a busy computer leaves out some of the others
        self.assertLess(abs(found[-1].data), 0.2)

    def test_an_event_says_how_it_stands_and_then_what_changes(self):
        self.watch_and_end(FRONT)
        with self.listen(FRONT, FloatStamped) as first:
            self.news.wait(lambda: [each.data for each in first] == [0.0], lambda: f"one 0.0, not {first}")
            self.robot.press(["Head/Touch/Front"])
            self.news.wait(lambda: [each.data for each in first] == [0.0, 1.0], "a touch")
            command = ["rostopic", "echo", "-n1", f"/nao_memory/{FRONT}/data"]
            second = subprocess.run(command, stdout=subprocess.PIPE, text=True, timeout=LIMIT)
            self.assertEqual(second.stdout.split()[0], "1.0", "a second listener learns how it stands as well")

    # --- both ways ------------------------------------------------------------------------------------------------

    def test_what_is_set_appears_with_its_type(self):
        cases = [
            ("Mine/flag", "true", "bool", BoolStamped, True),
            ("Mine/count", "3", "int", IntStamped, 3),
            ("Mine/share", "0.25", "float", FloatStamped, 0.25),
            ("Mine/word", "hello", "string", StringStamped, "hello"),
            ("Mine/numbers", "[1, 2]", "int[]", IntArrayStamped, (1, 2)),
            ("Mine/shares", "[0.5, 2]", "float[]", FloatArrayStamped, (0.5, 2.0)),
            ("Mine/words", '["a", "b"]', "string[]", StringArrayStamped, ["a", "b"]),
            ("Mine/nested", '[["a", 1]]', "list", StringStamped, '[["a", 1]]'),
        ]
        for key, value, kind, message, data in cases:
            answer = self.set(key, value, False)
            self.assertTrue(answer.success, answer.message)
            answer = self.get(key)
            self.assertEqual((answer.message, answer.keys, answer.types), ("", [key], [kind]))
            self.assertEqual(json.loads(answer.values[0]), self.memory.getData(key))
            wait_until(lambda key=key: f"/nao_memory/{key}" in self.topics(), LIMIT, f"the topic of {key}")
            with self.listen(key, message) as found:
                self.news.wait(lambda found=found: found, f"the value of {key}")
            self.assertEqual(found[0].data, data, key)
        self.assertLessEqual({key for key, *_ in cases}, set(self.get("Mine/*").keys))

    def test_an_event_is_raised_for_those_who_wait_for_it(self):
        heard = []
        subscriber = self.memory.subscriber("Mine/Call")
        link = subscriber.signal.connect(heard.append)
        self.addCleanup(subscriber.signal.disconnect, link)
        self.assertTrue(self.set("Mine/Call", '{"from": "ROS"}', True).success)
        wait_until(lambda: heard or not self.memory.ping(), LIMIT, "the event")
        self.assertEqual(heard, [{"from": "ROS"}])

    # --- errors and ends ------------------------------------------------------------------------------------------

    def test_what_is_wrong_is_told(self):
        self.assertIn("did you mean 'FrontTactilTouched'", self.get("FrontTactileTouched").message)
        self.assertIn("is a sensor of the robot", self.set(CHARGE, "1", False).message)
        self.assertIn("it is empty", self.set(" ", "1", False).message)
        self.assertIn("0.001..100 Hz, or 0", self.watch(FRONT, 1000.0, "").message)
        self.assertIn("one of bool", self.watch(FRONT, 0.0, "double").message)
        late = self.watch("FrontTactileTouched", 0.0, "")
        self.addCleanup(self.unwatch, "FrontTactileTouched")
        self.assertIn("did you mean 'FrontTactilTouched'", late.message)
        self.assertTrue(late.success)

    def test_what_is_ended_has_no_topic_any_more(self):
        self.watch_and_end("Device/SubDeviceList/Head/*")
        name = "/nao_memory/Device/SubDeviceList/Head/Touch/Front/Sensor/Value"
        self.assertIn(name, self.topics())
        self.assertEqual(len(self.unwatch("Device/SubDeviceList/Head/Touch/*").keys), 3)
        wait_until(lambda: name not in self.topics(), LIMIT, "the end of the topic")
        self.assertIn("/nao_memory/Device/SubDeviceList/Head/Temperature/Sensor/Value", self.topics())
