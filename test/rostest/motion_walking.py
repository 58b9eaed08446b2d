#!/usr/bin/env python3
"""Goals that walk: where the robot really gets, what it does meanwhile, and that every end is on two feet."""

import math
import random
import sys
from pathlib import Path

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from rospy import Duration

from nao_library_actions.msg import NaoLedAction, NaoLedGoal
from nao_library_msgs.msg import LedFunction
from nao_sim_bridge.testing import send, wait_until

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))  # not beside its relay
from motion_fixture import LIMIT, MotionTest, f  # noqa: E402

STANDING_HEIGHT = 0.28
WEIGHINGS = 20
# m and rad: what odometry of the legs may be off after a short walk.
CLOSE, CLOSE_TURN = 0.03, 0.1


def walk(x, y=0.0, theta=0.0, **fields):
    return f("moveTo", values=[x, y, theta], **fields)


def heading(pose):
    turn = pose.orientation
    return math.atan2(2.0 * (turn.w * turn.z + turn.x * turn.y), 1.0 - 2.0 * (turn.y**2 + turn.z**2))


class MotionWalking(MotionTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.lights = cls.robot.action_client("NaoLights", NaoLedAction)

    def setUp(self):
        super().setUp()
        self.play(f("wakeUp"))
        self.start_pose = self.robot.true_pose()

    def way(self):
        """Where the torso really is by now, seen from where the test began: x, y in m, heading in rad."""
        start, now = self.start_pose, self.robot.true_pose()
        x, y = now.position.x - start.position.x, now.position.y - start.position.y
        c, s = math.cos(heading(start)), math.sin(heading(start))
        return c * x + s * y, c * y - s * x, math.remainder(heading(now) - heading(start), 2.0 * math.pi)

    def assert_walked(self, x, y=0.0, theta=0.0):
        at_x, at_y, at_theta = self.way()
        self.assertAlmostEqual(at_x, x, delta=CLOSE)
        self.assertAlmostEqual(at_y, y, delta=CLOSE)
        self.assertLess(abs(math.remainder(at_theta - theta, 2.0 * math.pi)), CLOSE_TURN)

    def on_its_way(self, distance=0.05):
        wait_until(lambda: math.hypot(*self.way()[:2]) > distance, 30.0, "the robot on its way")

    def assert_stands(self):
        """On both feet, and at rest."""
        self.assertFalse(self.robot.module("ALMotion").moveIsActive())
        self.robot.advance(0.5)
        before = self.robot.true_pose().position
        sums = [0.0, 0.0]  # the load of a foot jumps from one moment to the next
        for _ in range(WEIGHINGS):
            self.robot.advance(1.0 / WEIGHINGS)
            sums = [a + self.robot.value(f"{side}FootTotalWeight") for a, side in zip(sums, ("left", "right"))]
        weights = [total / WEIGHINGS for total in sums]
        self.assertGreater(min(weights), 2.0, weights)
        after = self.robot.true_pose().position
        self.assertGreater(after.z, STANDING_HEIGHT)
        self.assertLess(math.hypot(after.x - before.x, after.y - before.y), 0.003)

    # Where it gets

    def test_standing_walking_and_waving_are_one_goal(self):
        self.play(f("rest"))
        arm = f("setPose", names=["RArm"], angles=[-1.0, -0.3, 1.2, 0.8, 0.0, 1.0], duration=1.5)
        wave = f("angleInterpolation", names=["RElbowRoll"], angles=[0.4, 1.2, 0.8], times=[0.5, 1.0, 1.5])
        run = self.send(f("goToPosture", str_param="Stand"), walk(0.3), arm, wave).wait_for_function(1)
        self.start_pose = self.robot.true_pose()
        run.wait(LIMIT)
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
        self.assert_walked(0.3)
        self.assert_stands()
        self.assertAlmostEqual(self.angle("RElbowRoll"), 0.8, delta=0.1)
        x, y, theta = map(float, run.result.results[1].values)
        self.assertAlmostEqual(x, 0.3, delta=0.01)
        self.assertLess(abs(y) + abs(theta), 0.03)

    def test_a_walk_goes_anywhere_and_turns(self):
        self.play(walk(0.2, -0.15, 1.0))
        self.assert_walked(0.2, -0.15, 1.0)

    def test_places_on_the_way_and_a_gait(self):
        values = [0.2, 0.0, 0.0, 0.4, 0.1, 0.5]
        self.play(f("moveTo", values=values, gait=["MaxStepX", "StepHeight"], gait_values=[0.06, 0.025]))
        self.assert_walked(0.4, 0.1, 0.5)

    def test_targets_in_the_world_and_in_frames_of_tf(self):
        x, y, theta = (float(value) for value in self.play(f("getRobotPosition")).memList)
        self.play(walk(0.2, 0.0, 1.5))
        self.play(f("walkTarget", values=[x, y, theta], frame=1))
        self.assert_walked(0.0)
        self.play(f("walkTarget", values=[0.2, 0.1, 0.3], str_param="base_footprint"))
        self.assert_walked(0.2, 0.1, 0.3)
        self.play(f("walkPath", values=[x + 0.1, y, theta, x, y, theta], str_param="odom"))
        self.assert_walked(0.0)
        lost = self.send(f("walkTarget", values=[0.2, 0.1, 0.3], str_param="kitchen")).wait(LIMIT)
        self.assertEqual(lost.state, GoalStatus.ABORTED)
        self.assertIn("kitchen", lost.text)

    def test_footsteps_go_where_they_are_put(self):
        self.play(walk(0.05))  # feet side by side: a robot that has stood up has them turned outwards
        self.start_pose = self.robot.true_pose()
        legs = ["LLeg", "RLeg"] * 2
        steps = [0.04, 0.1, 0.0, 0.04, -0.1, 0.0, 0.04, 0.1, 0.0, 0.0, -0.1, 0.0]
        self.play(f("setFootStepsWithSpeed", names=legs, values=steps))
        # Each step goes ahead of the other foot, and the last one beside it.
        self.assert_walked(0.12)
        self.play(f("setFootSteps", names=legs, values=steps, times=[0.6, 1.2, 1.8, 2.4]), f("waitUntilMoveIsFinished"))
        self.assert_walked(0.24)
        self.assert_stands()

    # What else it does meanwhile

    def test_head_and_arms_move_while_it_walks(self):
        nod = f("angleInterpolation", names=["HeadYaw"], angles=[0.5, -0.5, 0.3], times=[1.0, 2.0, 3.0])
        arm = f("setPose", names=["LArm"], angles=[0.5, 0.3, -1.0, -0.8, 0.0, 0.5], duration=1.5)
        still = f("setMoveArmsEnabled", names=["LArm"], enable=False)
        walk_on = f("moveToward", values=[1.0, 0.0, 0.0])
        self.addCleanup(self.play, f("setMoveArmsEnabled", enable=True))
        result = self.play(still, walk_on, nod, arm, f("getRobotVelocity"), f("stopMove"))
        self.assertGreater(float(result.results[4].values[0]), 0.05)
        self.assertGreater(self.way()[0], 0.2)
        self.assertAlmostEqual(self.angle("HeadYaw"), 0.3, delta=0.05)
        self.assertAlmostEqual(self.angle("LShoulderPitch"), 0.5, delta=0.1)
        self.assert_stands()

    def test_lights_go_on_beside_a_walk(self):
        run = self.send(walk(0.5))
        fade = LedFunction(function="fade", lights=["Brain0"], i_values=[0.0], duration=1.0)
        lights = send(self.lights, NaoLedGoal([fade])).wait(LIMIT)
        run.wait(LIMIT)
        self.assertEqual((run.state, lights.state), (GoalStatus.SUCCEEDED,) * 2, run.text + lights.text)
        self.assertLess(lights.ended, run.ended)
        self.assert_walked(0.5)

    def test_a_goal_may_leave_it_walking_and_another_one_ends_it(self):
        self.play(f("move", values=[0.08, 0.0, 0.0]))
        self.on_its_way(0.1)
        legs = self.send(f("setPose", names=["LLeg"], angles=[0.0], duration=1.0)).wait(LIMIT)
        self.assertEqual(legs.state, GoalStatus.ABORTED)
        self.assertIn("the robot walks", legs.text)
        self.assertTrue(self.robot.module("ALMotion").moveIsActive())
        self.play(f("stopMove"))
        self.assert_stands()
        self.play(f("move", values=[0.0, 0.0, 0.5], duration=3.0))
        self.assertGreater(self.way()[2], 0.5)
        self.assert_stands()

    # How it ends

    def test_cancelled_at_any_moment_it_stands_on_both_feet(self):
        moments = random.Random(7)
        for function in (walk(2.0), walk(0.0, 0.0, 3.0), f("moveToward", values=[-1.0, 0.5, 0.2], time=Duration(60))):
            for _ in range(3):
                run = self.send(function).wait_for_function(0)
                self.robot.advance(moments.uniform(0.1, 4.0))
                run.cancel()
                run.wait(LIMIT)
                self.assertEqual(run.state, GoalStatus.PREEMPTED, run.text)
                self.assert_stands()

    def test_a_newer_goal_takes_over_on_two_feet(self):
        old = self.send(walk(2.0))
        self.on_its_way()
        new = self.send(walk(0.1))
        old.wait(LIMIT)
        new.wait(LIMIT)
        self.assertEqual((old.state, new.state), (GoalStatus.PREEMPTED, GoalStatus.SUCCEEDED), new.text)
        self.assertLess(self.way()[0], 0.6)
        self.assert_stands()

    def test_who_stops_it_on_the_way_is_not_taken_for_an_arrival(self):
        run = self.send(walk(2.0), f("setAngles", names=["HeadYaw"], angles=[1.0]))
        self.on_its_way(0.15)
        self.robot.module("ALMotion").stopMove()
        run.wait(LIMIT)
        self.assertEqual(run.state, GoalStatus.ABORTED)
        self.assertRegex(run.text, r"the walk was stopped .* got to x 0\.[1-9]\d* m.* instead of x 2\.000 m")
        self.assertLess(abs(self.angle("HeadYaw")), 0.1)
        self.assert_stands()

    def test_a_fall_on_the_way_ends_the_goal(self):
        run = self.send(walk(2.0))
        self.on_its_way(0.1)
        self.robot.push((0.0, 60.0, 0.0), 0.15)
        run.wait(LIMIT)
        self.assertEqual(run.state, GoalStatus.ABORTED)
        self.assertIn("the robot fell", run.text)
        wait_until(lambda: not self.robot.value("robotIsWakeUp"), 20.0, "the robot to notice that it has fallen")
        refused = self.send(walk(0.1)).wait(LIMIT)
        self.assertIn("the legs are limp: wakeUp first", refused.text)
        self.play(f("goToPosture", str_param="Stand"), walk(0.1))
        self.assert_stands()

    def test_what_cannot_walk_is_told_before_anything_moves(self):
        look = f("setAngles", names=["HeadYaw"], angles=[1.0])
        self.play(f("goToPosture", str_param="Sit"))
        for chain, text in (
            ([look, walk(0.1)], "does not stand on its feet"),
            ([look, f("goToPosture", str_param="Stand"), walk(math.nan)], "x cannot be nan"),
            ([look, f("rest"), walk(0.1)], "the legs are limp"),
        ):
            run = self.send(*chain).wait(LIMIT)
            self.assertEqual(run.state, GoalStatus.ABORTED)
            self.assertIn(text, run.text)
        self.robot.advance(0.5)
        self.assertLess(abs(self.angle("HeadYaw")), 0.1)


if __name__ == "__main__":
    rospy.init_node("motion_walking_test")
    rostest.rosrun("nao_library_tests", "motion_walking", MotionWalking)
