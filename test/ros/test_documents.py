"""The listings of the paper and the thesis, and the names that both use: all under the one launch of this level."""

import math
import os
import signal
import subprocess
import sys
import xmlrpc.client

import rosgraph
import rospy
from actionlib_msgs.msg import GoalStatus
from examples_fixture import ExampleTest
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from services import action_client
from std_srvs.srv import Trigger
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint
from waits import PATIENCE

import nao_library_actions.msg as actions
from nao_library_modules.check_client import check_goals
from nao_library_msgs.msg import AudioOutFunction, JointAnglesWithSpeed
from nao_library_msgs.srv import DescribeFunctions
from nao_sim_bridge.testing import send, wait_until

AUDIO_OUT = "nao_audio_out", "NaoAudioOut"
FRAME_TORSO = 0
LIMIT = 60.0


def trajectory(**angles):
    point = JointTrajectoryPoint(positions=list(angles.values()), time_from_start=rospy.Duration.from_sec(0.5))
    return JointTrajectory(joint_names=list(angles), points=[point])


LAST_WORDS = """
import os, threading
import rospy
from rospy.impl.tcpros_pubsub import QueuedConnection
from nao_library_modules.process_modules.algorithms import createROSnode
QueuedConnection._run = lambda _: threading.Event().wait()  # a thread that gets no time on a busy computer
rospy.init_node("last_words")
createROSnode().publish("Good night.", "/speech")
os._exit(0)
"""


class Documents(ExampleTest):
    """The names of both documents beside those of nao_robot, and process_modules.launch beside the stack."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.robot.module("ALMotion").wakeUp()
        cls.beside = subprocess.Popen(["roslaunch", "nao_library", "process_modules.launch"])
        cls.addClassCleanup(cls.beside.wait)
        cls.addClassCleanup(cls.beside.send_signal, signal.SIGINT)

    def setUp(self):
        super().setUp()
        self.robot.module("ALMotion").wakeUp()

    def told(self, name):
        """Lines of an example's own: actionlib logs as well."""
        return [line for line in self.run_example(f"paper/{name}.py").splitlines() if not line.startswith("[")]

    def succeed(self, name, kind, goal):
        """The result of a goal under a name that succeeds."""
        run = send(action_client(name, kind), goal).wait(LIMIT)
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, f"{name}: {run.text}")
        return run.result

    # --- the paper ----------------------------------------------------------------------------------------------------

    def test_green_eyes(self):
        green, white = "[0.0, 1.0, 0.0] [0.0, 1.0, 0.0]", "[1.0, 1.0, 1.0] [1.0, 1.0, 1.0]"
        expected = {
            "Brain0 by NAOqi": "0.5", "Brain0 by NaoLights": "0.5", "green by NAOqi": green,
            "green by NaoLights": green, "green and back": white,
        }  # fmt: skip
        self.assertEqual(self.told("green_eyes"), [f"{what}: {light}" for what, light in expected.items()])

    def test_linked_functions(self):
        self.assertEqual(self.told("linked_functions")[-2:], ["three goals: done", "one goal: done"])
        self.assertAlmostEqual(self.angle("RElbowRoll"), 0.4, delta=0.05)

    def test_animation(self):
        told = self.told("animation")
        self.assertIn("setPose: done", told)
        rows = [line.split() for line in told if "is at" in line]
        self.assertEqual(len(rows), 6)
        for name, _, wanted, _, _, reached in rows:
            self.assertAlmostEqual(float(reached), float(wanted), delta=0.05, msg=name)

    def test_several_servers(self):
        self.assertEqual(self.told("several_servers")[-3:], ["motion: done", "audio_out: done", "lights: done"])
        self.assertAlmostEqual(self.angle("HeadYaw"), 0.3, delta=0.05)

    # --- the thesis ---------------------------------------------------------------------------------------------------

    def test_algorithms_5_5_to_5_13(self):
        said = []
        subscriber = self.robot.module("ALMemory").subscriber("ALTextToSpeech/CurrentSentence")
        self.addCleanup(subscriber.signal.disconnect, subscriber.signal.connect(said.append))
        self.run_example("thesis/algorithms.py")
        self.assertAlmostEqual(self.robot.true_pose().position.x, 0.2, delta=0.06)
        self.assertLess(self.angle("LHand"), 0.1)
        self.assertGreater(self.angle("RHand"), 0.9)
        self.assertAlmostEqual(self.angle("HeadYaw"), math.atan2(1.0, 2.0), delta=0.05)
        hand = self.robot.module("ALMotion").getPosition("RArm", FRAME_TORSO, True)[:3]
        self.assertLess(math.dist(hand, (0.16, -0.13, 0.08)), 0.02, hand)
        wait_until(lambda: "This is the end." in said, LIMIT, lambda: f"the sentence among {said}")

    def test_the_last_sentence_of_a_program_is_said(self):
        said = []
        subscriber = self.robot.module("ALMemory").subscriber("ALTextToSpeech/CurrentSentence")
        self.addCleanup(subscriber.signal.disconnect, subscriber.signal.connect(said.append))
        subprocess.run([sys.executable, "-c", LAST_WORDS], check=True, timeout=PATIENCE)
        wait_until(lambda: "Good night." in said, LIMIT, lambda: f"the sentence among {said}")

    def test_algorithm_5_14(self):
        self.run_example("abstract_plan.py")
        self.assertGreater(min(self.angle("LHand"), self.angle("RHand")), 0.9)
        self.assertAlmostEqual(self.angle("HeadYaw"), math.atan2(3.0, 2.0), delta=0.05)

    def test_a_designator_of_the_process_modules_that_were_launched(self):
        goal = actions.PerformDesignatorGoal("(type: action(name:(to open)) (side :left))", "", [])
        self.succeed("perform_designator", actions.PerformDesignatorAction, goal)
        self.assertGreater(self.angle("LHand"), 0.9)

    # --- names --------------------------------------------------------------------------------------------------------

    def test_servers_have_the_names_of_the_documents_beside_their_own(self):
        for name in ("joint_trajectory", "/jointTrajectory"):
            goal = actions.JointTrajectoryGoal(trajectory(HeadYaw=0.3, HeadPitch=0.1), 0)
            result = self.succeed(name, actions.JointTrajectoryAction, goal)
            self.assertAlmostEqual(result.goal_position.position[0], 0.3, delta=0.03, msg=name)
            self.robot.module("ALMotion").setAngles("HeadYaw", 0.0, 0.5)
        stiff = actions.JointTrajectoryGoal(trajectory(RHand=0.6), 0)
        self.succeed("jointStiffness", actions.JointTrajectoryAction, stiff)
        self.assertAlmostEqual(self.robot.module("ALMotion").getStiffnesses("RHand")[0], 0.6, delta=0.01)
        angles = JointAnglesWithSpeed(joint_names=["HeadYaw"], joint_angles=[-0.3], speed=0.3)
        self.succeed("jointAngles", actions.JointAnglesWithSpeedAction, actions.JointAnglesWithSpeedGoal(angles))
        self.assertAlmostEqual(self.angle("HeadYaw"), -0.3, delta=0.05)
        target = MoveBaseGoal()
        target.target_pose.header.frame_id, target.target_pose.pose.position.x = "base_footprint", 0.2
        target.target_pose.pose.orientation.w = 1.0
        before = self.robot.true_pose().position.x
        self.succeed("/walkTarget", MoveBaseAction, target)
        self.assertAlmostEqual(self.robot.true_pose().position.x - before, 0.2, delta=0.06)

    def test_both_names_of_a_server_lead_to_one_server(self):
        says = actions.NaoAudioOutGoal([AudioOutFunction(function="say", str_param="one two three four five six")])
        clients = [
            self.robot.action_client(name, actions.NaoAudioOutAction) for name in ("nao_audio_out", "NaoAudioOut")
        ]
        first = send(clients[0], says)
        wait_until(lambda: first.feedback, LIMIT, "the first goal at work")
        second = send(clients[1], says)
        self.assertEqual(first.wait(LIMIT).state, GoalStatus.PREEMPTED)
        wait_until(lambda: second.feedback, LIMIT, "feedback under the other name")
        second.cancel()
        self.assertEqual(second.wait(LIMIT).state, GoalStatus.PREEMPTED)
        problems = check_goals("NaoAudioOut", actions.NaoAudioOutGoal([AudioOutFunction(function="shout")])).problems
        self.assertIn("shout", problems[0].text)
        described = rospy.ServiceProxy("NaoAudioIn/describe", DescribeFunctions)([], False, True)
        self.assertEqual(described.action, "nao_library_actions/NaoAudioIn")
        subprocess.run(["nao", "say", "Hello"], timeout=LIMIT, check=True)
        listed = subprocess.run(["nao", "list"], capture_output=True, text=True, timeout=LIMIT, check=True).stdout
        self.assertEqual((listed.count("nao_audio_out "), listed.count("NaoAudioOut ")), (1, 0))

    def test_nodes_of_nao_robot_are_found_in_the_process_that_has_them(self):
        master = rosgraph.Master(rospy.get_name())
        for part, node, kind, name in (
            ("nao_controller", "nao_driver", "actions", "/jointTrajectory"),
            ("nao_path_follower", "nao_driver", "actions", "/walk_target"),
            ("nao_speech", "nao_driver", "subscribes", "/speech"),
            ("nao_camera", "nao_driver_pictures", "publishes", "/nao_robot/camera/top/camera_info"),
        ):
            told = rospy.ServiceProxy(f"{part}/part_of_{node}", Trigger)().message
            offered = dict(each.split(": ") for each in told.split("; ")[1:])
            self.assertIn(name, offered[kind].split(", "), part)
            process = xmlrpc.client.ServerProxy(master.lookupNode(f"/{node}")).getPid("/test")[2]
            asked = xmlrpc.client.ServerProxy(master.lookupNode(f"/{part}"))
            self.assertEqual(asked.getPid("/test")[2], process)
        # As the master tells a node whose name another one takes: the other parts must not end with it.
        self.assertNotEqual(asked.shutdown("/master", "new node registered with same name")[0], 1)
        os.kill(process, 0)
        self.assertEqual(asked.getPid("/test")[2], process)
