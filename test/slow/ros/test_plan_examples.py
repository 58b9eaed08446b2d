"""The examples of plans in the lab, started as users start them."""

import math
import re
import signal

from examples_fixture import start
from plan_examples_fixture import PlanExampleTest
from waits import PATIENCE

from nao_library_actions.msg import NaoVisionAction
from nao_sim_bridge.testing import wait_until

FETCH_LIMIT = 600.0
"""s of simulated time that fetching may take."""
FRAME_ROBOT = 2


class PlanExamples(PlanExampleTest):
    world = "lab"
    servers = {"NaoVision": NaoVisionAction}

    def test_the_abstract_plan(self):
        picture = self.folder / "tree.png"
        output, trace = self.run_plan("abstract_plan.py", "2", "-1", "--picture", str(picture))
        self.assertGreater(self.angle("LHand"), 0.9)
        self.assertGreater(self.angle("RHand"), 0.9)
        self.assertAlmostEqual(self.angle("HeadYaw"), math.atan2(-1.0, 2.0), delta=0.05)
        self.assertEqual(picture.read_bytes()[:4], b"\x89PNG")
        branches = trace.children(next(record for record in trace.records if record.name == "par").number)
        self.assertEqual(len(branches), 3, output)
        # In parallel: each begins before another one has ended.
        self.assertLess(max(each.began for each in branches), min(each.ended for each in branches), output)
        self.assert_stands()

    def test_the_ball_is_found_and_pointed_at(self):
        output, trace = self.run_plan("fetch_plan.py")
        self.assertLess(trace.records[0].ended, FETCH_LIMIT, output)
        told = re.search(r"There is the ball, ([0-9.]+) metres away, (in front of me|on my right)\.", output)
        self.assertIsNotNone(told, output)
        ball = self.robot.module("NaoSimulation").objectPoses()["ball"]
        base = self.robot.true_pose().position
        self.assertAlmostEqual(float(told.group(1)), math.hypot(ball[0] - base.x, ball[1] - base.y), delta=0.15)
        self.assertTrue([record for record in trace.records if "say" in record.name.lower()], output)
        self.assert_stands()

    def test_a_rule_and_a_module_of_ones_own(self):
        output = self.run_example("add_a_rule.py", "Anna")
        self.assertIn("Hello, Anna!", output)
        self.assertIn("waver: wave(", output)
        said = self.robot.value("ALTextToSpeech/CurrentSentence")
        self.assertIn(said, ("Hello, Anna!", ""), said)
        self.assert_stands()

    def test_a_plan_runs_in_a_simulator_before_it_runs_here(self):
        output = self.run_example("project_plan.py", "abstract_plan.py", "2", "1")
        self.assertIn("both runs came out alike", output)
        self.assertAlmostEqual(self.angle("HeadYaw"), math.atan2(1.0, 2.0), delta=0.05)
        self.assertGreater(self.angle("LHand"), 0.9)

    def test_a_plan_that_is_only_projected_does_not_move_the_robot(self):
        before = self.angle("HeadYaw"), self.angle("LHand")
        output = self.run_example("project_plan.py", "abstract_plan.py", "2", "1", "--only")
        self.assertIn("+ abstract_plan", output)
        self.assertNotIn("on the robot ...", output)
        self.assertAlmostEqual(self.angle("HeadYaw"), before[0], delta=0.02)
        self.assertAlmostEqual(self.angle("LHand"), before[1], delta=0.05)

    def test_an_interrupted_plan_stops_the_robot(self):
        example = start("fetch_plan.py")
        try:
            motion = self.robot.module("ALMotion")
            wait_until(motion.moveIsActive, 60.0, "the robot on its way")
            self.robot.advance(0.5)
            example.send_signal(signal.SIGINT)
            output, _ = example.communicate(timeout=PATIENCE)
            self.assertNotEqual(example.returncode, 0, output)
            wait_until(lambda: not motion.moveIsActive(), 60.0, "standstill")
            self.assert_stands()
        finally:
            example.kill()
            example.wait()
