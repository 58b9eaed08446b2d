"""Plans on the simulated robot: what they do is measured on the robot, and when they end it stands."""

import math
import subprocess
import sys
import threading
import unittest

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from diagnostic_msgs.msg import KeyValue
from examples_fixture import start
from news import News
from std_msgs.msg import String

from nao_library_actions.msg import PerformDesignatorAction, PerformDesignatorActionFeedback, PerformDesignatorGoal
from nao_library_modules.core.geometry import Place
from nao_library_modules.process_modules import action_rules  # noqa: F401
from nao_library_modules.process_modules.control import do, par, pursue, seq, top_level, wait_for
from nao_library_modules.process_modules.designators.designator import action, an, designator
from nao_library_modules.process_modules.failures import (
    GripperClosedCompletely,
    ManipulationPoseUnreachable,
    NavigationGoalNotReached,
    TaskEvaporatedFailure,
    fail,
)
from nao_library_modules.process_modules.fluents import wait_until as wait_in_plan
from nao_library_modules.process_modules.low_level import (
    closeGripper,
    goStable,
    make_process_modules,
    moveArm,
    moveHead,
    openGripper,
    textToSpeech,
    this_robot,
    walkTo,
)
from nao_library_modules.process_modules.plan_runner import PlanTopic
from nao_library_modules.process_modules.process_module import get_process_module, perform, with_process_modules_running
from nao_library_modules.process_modules.tasks import TaskState
from nao_library_modules.process_modules.trace import trace_of
from nao_library_msgs.msg import PlanTree
from nao_sim_bridge.testing import SimulatedRobot, send, wait_until

PLAN = """
import rospy
from nao_library_modules.process_modules.control import do
from nao_library_modules.process_modules.designators.designator import action, an
from nao_library_modules.process_modules.plan_runner import run_and_tell
from nao_library_modules.process_modules.process_module import perform

rospy.init_node("mortal_plan")
run_and_tell(do(perform, an(action, type="going", target=[20.0, 0.0])))
"""
SENSOR = "Device/SubDeviceList/{}/Position/Sensor/Value"
FRAME_TORSO = 0
STANDING = 0.28
"""m that the torso is over the floor at least."""


class ProcessModules(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.motion = cls.robot.module("ALMotion")
        cls.link = this_robot()

    def setUp(self):
        self.robot.reset()
        self.motion.wakeUp()
        modules = with_process_modules_running(*make_process_modules())
        modules.__enter__()
        self.addCleanup(modules.__exit__, None, None, None)

    def run_plan(self, body, *observers):
        return top_level(body, clock=self.link.clock, observers=observers)

    def beside(self, body):
        """Run a plan in a thread; the thread, what came of it, and its root."""
        roots, outcome = [], []

        def run():
            try:
                outcome.append(self.run_plan(body, lambda task: roots or roots.append(task)))
            except Exception as error:
                outcome.append(error)

        thread = threading.Thread(target=run, daemon=True)
        thread.start()
        wait_until(lambda: roots, 60.0, "the plan")
        return thread, outcome, roots[0]

    def angle(self, joint):
        return self.robot.value(SENSOR.format(joint))

    def heard(self):
        """Sentences that the robot says from now on, in a list that grows."""
        sentences = []
        subscriber = self.robot.module("ALMemory").subscriber("ALTextToSpeech/CurrentSentence")
        link = subscriber.signal.connect(sentences.append)
        self.addCleanup(subscriber.signal.disconnect, link)
        return sentences

    def assert_stands(self):
        self.assertFalse(self.motion.moveIsActive())
        self.robot.advance(1.0)
        self.assertGreater(self.robot.true_pose().position.z, STANDING)

    # --- what plans of old do -----------------------------------------------------------------------------------------

    def test_the_abstract_plan(self):
        self.run_plan(
            do(
                par,
                do(perform, designator("{type: action, name: to open, side: left}")),
                do(perform, designator("{type: action, name: to open, side: right}")),
                do(perform, designator("{type: action, name: to look, position: [2, 3]}")),
            )
        )
        self.assertGreater(self.angle("LHand"), 0.9)
        self.assertGreater(self.angle("RHand"), 0.9)
        self.assertAlmostEqual(self.angle("HeadYaw"), math.atan2(3.0, 2.0), delta=0.03)
        self.assert_stands()

    def test_low_level_functions_by_name(self):
        openGripper("left")
        self.assertGreater(self.angle("LHand"), 0.9)
        closeGripper("left")
        self.assertLess(self.angle("LHand"), 0.1)
        moveHead(1.0, 0.5)
        self.assertAlmostEqual(self.angle("HeadYaw"), math.atan2(0.5, 1.0), delta=0.03)
        goStable()
        self.assertAlmostEqual(self.angle("LShoulderPitch"), 1.4, delta=0.05)
        with self.assertRaises(GripperClosedCompletely):
            closeGripper("right", grasp=True)

    def test_hands_get_to_their_targets(self):
        for side, y in (("left", 0.13), ("right", -0.13)):
            target = (0.16, y, 0.08)
            moveArm(target, side)
            hand = self.motion.getPosition(f"{side[0].upper()}Arm", FRAME_TORSO, True)[:3]
            self.assertLess(math.dist(hand, target), 0.02, f"{side} hand at {hand}")
        with self.assertRaises(ManipulationPoseUnreachable) as caught:
            moveArm((0.6, 0.13, 0.08), "left")
        nearest = caught.exception.nearest
        moveArm(nearest, "left")
        self.assertLess(math.dist(self.motion.getPosition("LArm", FRAME_TORSO, True)[:3], nearest[:3]), 0.02)

    def test_the_robot_walks_to_its_target(self):
        start = self.robot.true_pose().position
        reached = walkTo((0.3, 0.1, 0.3))
        end = self.robot.true_pose().position
        self.assertLess(math.hypot(end.x - start.x - 0.3, end.y - start.y - 0.1), 0.05)
        self.assertLess(reached.distance_to(Place(0.3, 0.1, 0.3)), 0.05)
        self.assert_stands()

    def test_positions_are_told_on_the_way(self):
        navigation = get_process_module("navigation")
        places = []

        def watch():
            def near():
                told = navigation.position.value
                if told is not None and told not in places:
                    places.append(told)
                return False

            wait_in_plan(near, [navigation.position])

        navigation.position.value = None
        with self.robot.at_speed(0.5):
            self.run_plan(do(pursue, do(perform, an(action, type="going", target=[0.2, 0.0])), watch))
        self.assertGreater(len(places), 1)
        self.assertGreater(places[-1][0].x, 0.12)

    def test_a_sentence_goes_to_the_topic(self):
        self.link.topic("speech", String)
        news, heard = News(), self.heard()
        with news.messages("speech", String) as said:
            textToSpeech("I am here.")
            news.wait(lambda: String("I am here.") in said, "the sentence on the topic")
        wait_until(lambda: "I am here." in heard, 60.0, "the sentence on the robot")

    # --- designators from elsewhere -----------------------------------------------------------------------------------

    def test_designators_come_by_an_action_and_by_a_topic(self):
        server = start("../nodes/process_modules")
        self.addCleanup(server.communicate)
        self.addCleanup(server.kill)
        client = actionlib.SimpleActionClient("perform_designator", PerformDesignatorAction)
        self.assertTrue(client.wait_for_server(rospy.Duration(60)))
        states = []
        feedback = rospy.Subscriber(
            "perform_designator/feedback",
            PerformDesignatorActionFeedback,
            lambda told: states.append(told.feedback.state),
        )
        wait_until(lambda: feedback.get_num_connections(), 60.0, "feedback")
        run = send(client, PerformDesignatorGoal("(an action (type opening) (gripper left))", "", [])).wait(60.0)
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
        self.assertGreater(float(run.result.result), 0.9)
        wait_until(lambda: "succeeded" in states, 60.0, "the last feedback, which a client may drop after the result")
        self.assertGreater(self.angle("LHand"), 0.9)
        pairs = [KeyValue("type", "reaching"), KeyValue("side", "left"), KeyValue("target", "[0.6, 0.13, 0.08]")]
        run = send(client, PerformDesignatorGoal("", "action", pairs)).wait(60.0)
        self.assertEqual((run.state, run.result.failure), (GoalStatus.ABORTED, "ManipulationPoseUnreachable"))
        self.assertRegex(run.result.text, "the left hand cannot get to")
        walk = send(client, PerformDesignatorGoal("{type: going, target: [20, 0]}", "", []))
        wait_until(self.motion.moveIsActive, 60.0, "the walk")
        walk.cancel()
        self.assertEqual(walk.wait(60.0).state, GoalStatus.PREEMPTED)
        self.assert_stands()
        topic = rospy.Publisher("designators", String, queue_size=1)
        wait_until(lambda: topic.get_num_connections(), 60.0, "process_modules")
        heard = self.heard()
        topic.publish("{type: saying, text: Here I am.}")
        wait_until(lambda: "Here I am." in heard, 60.0, "the sentence on the robot")

    def assert_stands_when_killed(self, program):
        wait_until(self.motion.moveIsActive, 60.0, "the walk")
        self.robot.advance(1.0)
        program.kill()
        wait_until(lambda: not self.motion.moveIsActive(), 60.0, "standstill")
        self.assertLess(self.robot.true_pose().position.x, 10.0)
        self.assert_stands()

    def test_the_walk_of_a_killed_server_of_designators_ends(self):
        server = start("../nodes/process_modules")
        self.addCleanup(server.communicate)
        self.addCleanup(server.kill)
        client = actionlib.SimpleActionClient("perform_designator", PerformDesignatorAction)
        self.assertTrue(client.wait_for_server(rospy.Duration(60)))
        client.send_goal(PerformDesignatorGoal("{type: going, target: [20, 0]}", "", []))
        self.assert_stands_when_killed(server)

    def test_the_walk_of_a_killed_plan_ends(self):
        plan = subprocess.Popen([sys.executable, "-c", PLAN])
        self.addCleanup(plan.wait)
        self.addCleanup(plan.kill)
        self.assert_stands_when_killed(plan)

    # --- ends ---------------------------------------------------------------------------------------------------------

    def test_a_plan_that_is_ended_leaves_the_robot_standing(self):
        walk = an(action, type="going", target=[20.0, 0.0])
        look = an(action, type="looking", target="left")
        thread, outcome, root = self.beside(do(par, do(perform, walk), do(perform, look)))
        wait_until(self.motion.moveIsActive, 60.0, "the walk")
        self.robot.advance(1.0)
        root.evaporate("enough")
        thread.join(60.0)
        self.assertIsInstance(outcome[0], TaskEvaporatedFailure)
        self.assertLess(self.robot.true_pose().position.x, 10.0)
        self.assert_stands()

    def test_a_branch_that_fails_stops_the_walk_beside_it(self):
        def fail_on_the_way():
            navigation = get_process_module("navigation")
            wait_for(navigation.position)
            fail("too dark")

        get_process_module("navigation").position.value = None
        with self.assertRaisesRegex(Exception, "too dark"):
            self.run_plan(do(par, do(perform, an(action, type="going", target=[20.0, 0.0])), fail_on_the_way))
        self.assertLess(self.robot.true_pose().position.x, 10.0)
        self.assert_stands()

    def test_a_suspended_walk_goes_on_when_it_is_woken(self):
        thread, outcome, root = self.beside(do(perform, an(action, type="going", target=[0.4, 0.0])))
        wait_until(self.motion.moveIsActive, 60.0, "the walk")
        root.suspend("a child runs by")
        wait_until(lambda: not self.motion.moveIsActive(), 60.0, "standstill")
        stopped = self.robot.true_pose().position.x
        self.robot.advance(2.0)
        self.assertAlmostEqual(self.robot.true_pose().position.x, stopped, delta=0.01)
        root.wake_up()
        thread.join(60.0)
        self.assertIsInstance(outcome[0], Place, outcome)
        self.assertAlmostEqual(self.robot.true_pose().position.x, 0.4, delta=0.06)

    def test_a_robot_that_falls_on_the_way_is_a_failure(self):
        thread, outcome, _ = self.beside(do(perform, an(action, type="going", target=[20.0, 0.0])))
        wait_until(self.motion.moveIsActive, 60.0, "the walk")
        self.robot.push((0.0, 150.0, 0.0), 0.1)
        thread.join(60.0)
        self.assertIsInstance(outcome[0], NavigationGoalNotReached, outcome)

    def test_the_tree_is_on_a_topic(self):
        trees, roots = [], []
        subscriber = rospy.Subscriber("plan_tree", PlanTree, trees.append)
        self.addCleanup(subscriber.unregister)
        topic = PlanTopic()
        plan = do(seq, do(perform, an(action, type="opening", gripper="left")), name="two steps")
        self.run_plan(plan, topic, roots.append)
        topic.close()
        wait_until(lambda: trees and trees[-1].tasks[0].state == "succeeded", 60.0, "the last tree")
        trace = trace_of(roots[0])
        self.assertEqual([task.name for task in trees[-1].tasks], [record.name for record in trace.records])
        self.assertEqual(trees[-1].plan, "two steps")
        self.assertEqual(roots[0].state, TaskState.SUCCEEDED)
