#!/usr/bin/env python3
"""Three robots in one simulated world: they see, hear and touch each other, share things, and live in one time."""

import subprocess
import unittest

import numpy as np
import rosgraph
import rospy
import rostest
import yaml
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import Point, Pose
from nav_msgs.msg import Odometry
from PIL import Image

from nao_library_actions.msg import (
    NaoAudioInAction,
    NaoAudioInGoal,
    NaoAudioOutAction,
    NaoAudioOutGoal,
    NaoLedAction,
    NaoLedGoal,
)
from nao_library_msgs.msg import AudioInFunction, AudioOutFunction, LedFunction
from nao_library_msgs.srv import PlaceObject
from nao_sim_bridge.testing import SimulatedRobot, StackNotReady, send, wait_until

# NAOqi's ids: top camera, 640x480, RGB.
TOP, VGA, RGB = 0, 2, 11
WORDS = ["yes", "no", "hello", "goodbye"]
LIMIT = 60.0


class ThreeRobots(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robots = [SimulatedRobot(f"/nao{number}", world="") for number in (1, 2, 3)]

    def setUp(self):
        self.robots[0].reset()

    def play(self, client, goal):
        run = send(client, goal).wait(LIMIT)
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
        return run.result

    def test_each_has_its_port_its_true_pose_and_its_services_and_one_node_tells_the_time(self):
        ports = [robot.port for robot in self.robots]
        self.assertEqual(ports, [ports[0], ports[0] + 1, ports[0] + 2])
        places = [robot.true_pose().position for robot in self.robots]
        np.testing.assert_allclose([(p.x, p.y) for p in places], [(0, 0), (0.9, 0.35), (0.42, -0.12)], atol=0.03)
        message = rospy.wait_for_message("/nao3/ground_truth/odom", Odometry, timeout=LIMIT)
        self.assertEqual((message.header.frame_id, message.child_frame_id), ("world", "nao3/torso"))
        publishers, _, services = rosgraph.Master("/three_robots_test").getSystemState()
        clocks = [nodes for topic, nodes in publishers if topic == "/clock"]
        self.assertEqual(clocks, [["/nao_sim"]])
        names = {name for name, _ in services}
        self.assertLessEqual({"/nao_sim/place_object", "/nao_sim/reset", "/nao2/nao_sim/push"}, names)
        self.assertNotIn("/nao2/nao_sim/place_object", names)

    def test_the_launch_file_starts_the_whole_stack_for_each_robot(self):
        nodes = set(launched("--nodes", "robots:=3").split()) - {"/nao_sim"}
        stack = {node[len("/nao1") :] for node in nodes if node.startswith("/nao1/")}
        self.assertEqual(nodes, {f"/nao{number}{node}" for number in (1, 2, 3) for node in stack})
        self.assertLessEqual({"/nao_lights", "/nao_motion", "/nao_walker", "/robot_state_publisher"}, stack)
        parameters = yaml.safe_load(launched("--dump-params", "robots:=3", "nao_port:=4000"))
        for number in (1, 2, 3):
            ports = {v for n, v in parameters.items() if n.startswith(f"/nao{number}/") and n.endswith("/pport")}
            self.assertEqual(ports, {4000 + number - 1})
            self.assertEqual(parameters[f"/nao{number}/tf_prefix"], f"nao{number}")

    def test_a_robot_sees_the_eyes_of_another_turn_red(self):
        looks, shows = self.robots[0], self.robots[1]
        lights = shows.action_client("NaoLights", NaoLedAction)
        pictures = []
        for color in ("green", "red"):
            set_color = LedFunction(function="setColor", lights=["FaceLeds"], str_param=color)
            self.play(lights, NaoLedGoal([set_color]))
            pictures.append(self.look(looks))
        green, red = pictures
        turned = np.count_nonzero((redness(green) < -50) & (redness(red) > 50))
        print(f"pixels that turned from green to red: {turned}")
        self.assertGreater(turned, 20)

    def look(self, robot):
        """What the top camera of a robot sees now."""
        device = robot.module("ALVideoDevice")
        name = device.subscribeCamera("test", TOP, VGA, RGB, 30)
        try:
            robot.advance(0.1)
            picture = device.getImageRemote(name)
        finally:
            device.unsubscribe(name)
        return np.frombuffer(bytes(picture[6]), np.uint8).reshape(picture[1], picture[0], 3)

    def test_a_robot_understands_what_another_says(self):
        ears = self.robots[0].action_client("nao_audio_in", NaoAudioInAction)
        voice = self.robots[1].action_client("nao_audio_out", NaoAudioOutAction)
        recognition = self.robots[0].module("ALSpeechRecognition")
        # The first call reads a dictionary: a busy computer takes longer for it than the server would wait.
        recognition.pushContexts()
        recognition.popContexts()
        # At full speed a busy computer takes many simulated seconds to begin.
        listen = AudioInFunction(function="listen", vocabulary=WORDS, timeout=300.0)
        run = send(ears, NaoAudioInGoal([listen]))
        wait_until(lambda: recognition.getSubscribersInfo() or over(run), LIMIT, "a subscriber of ALSpeechRecognition")
        self.assertFalse(over(run), "it listens")
        self.robots[0].advance(0.5)
        self.play(voice, NaoAudioOutGoal([AudioOutFunction(function="say", str_param="goodbye")]))
        run.wait(LIMIT)
        self.assertEqual((run.state, run.result.words[:1]), (GoalStatus.SUCCEEDED, ["goodbye"]), run.text)

    def test_a_robot_walks_into_another(self):
        walks, stands = self.robots[0], self.robots[2]
        walks.pause()  # from here on each run is the same
        self.addCleanup(walks.resume)
        awake = [robot.module("ALMotion").wakeUp(_async=True) for robot in (walks, stands)]
        wait_until(lambda: walks.advance(0.5) and all(call.isFinished() for call in awake), LIMIT, "robots that stand")
        self.hear_with_sonars(walks, 0.2, 0.45)
        pressed, furthest = [], 0.0
        for event in ("LeftBumperPressed", "RightBumperPressed"):  # which may be short
            subscriber = walks.module("ALMemory").subscriber(event)
            link = subscriber.signal.connect(lambda value: value and pressed.append(value))
            self.addCleanup(subscriber.signal.disconnect, link)
        motion = walks.module("ALMotion")
        motion.setExternalCollisionProtectionEnabled("All", False)
        before = stands.true_pose().position
        motion.moveToward(0.8, 0.0, 0.0)
        for _ in range(80):
            walks.advance(0.1)
            now = stands.true_pose().position
            furthest = max(furthest, np.hypot(now.x - before.x, now.y - before.y))
            if pressed and furthest > 0.002:
                break
        print(f"the robot that stands was moved by {1000 * furthest:.1f} mm")
        self.assertTrue(pressed, "a bumper is pressed")
        self.assertGreater(furthest, 0.002, "and it was felt")

    def hear_with_sonars(self, robot, least, most):
        sonar = robot.module("ALSonar")
        sonar.subscribe("test")
        robot.advance(0.5)
        distance = robot.value("Device/SubDeviceList/US/Left/Sensor/Value")
        sonar.unsubscribe("test")
        self.assertTrue(least < distance < most, distance)

    def test_things_are_everybodys_and_a_reset_is_too(self):
        place = rospy.ServiceProxy("/nao_sim/place_object", PlaceObject)
        answer = place(name="ball", kind="ball", size=[0.05], pose=Pose(position=Point(0.0, 0.6, 0.05)))
        self.assertEqual((answer.success, answer.message), (True, ""))
        seen = [robot.module("NaoSimulation").objectPoses()["ball"] for robot in self.robots]
        np.testing.assert_allclose(seen, [seen[0]] * 3, atol=0.01)
        self.robots[1].push((0.0, 60.0, 0.0), 0.3)
        self.robots[1].advance(1.0)
        with Image.open(self.robots[1].picture("far", "three.png")) as picture:
            self.assertEqual(picture.size, (640, 480))
        self.robots[2].reset()
        self.assertAlmostEqual(self.robots[1].true_pose().position.y, 0.35, delta=0.03)
        self.assertNotIn("ball", self.robots[0].module("NaoSimulation").objectPoses())


def launched(question, *arguments):
    """What roslaunch answers about the launch file."""
    command = ["roslaunch", question, "nao_library", "nao_sim.launch", *arguments]
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, timeout=LIMIT).stdout


def over(run):
    """Whether a goal has ended; if it has failed, that is told."""
    try:
        failed = run.ended and run.state != GoalStatus.SUCCEEDED
    except StackNotReady:
        return False
    if failed:
        raise AssertionError(run.text)
    return True


def redness(picture):
    """How much more red than green there is, for each pixel."""
    return picture[..., 0].astype(int) - picture[..., 1]


if __name__ == "__main__":
    rospy.init_node("three_robots_test")
    rostest.rosrun("nao_library_tests", "three_robots", ThreeRobots)
