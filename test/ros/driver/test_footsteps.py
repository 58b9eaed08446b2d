"""Footsteps: single ones, sequences with feedback, those that are too long, and those that are taken back."""

import math

from actionlib_msgs.msg import GoalStatus
from services import action_client, answer, publisher, service
from walking_fixture import WalkingTest

from nao_library_actions.msg import ExecFootstepsAction, ExecFootstepsGoal
from nao_library_modules.core.geometry import Place
from nao_library_msgs.msg import StepTarget
from nao_library_msgs.srv import ClipFootstep, StepTargetService
from nao_sim_bridge.testing import send, wait_until

LEFT, RIGHT = StepTarget.left, StepTarget.right


def step(leg, x, y, theta=0.0):
    target = StepTarget(leg=leg)
    target.pose.x, target.pose.y, target.pose.theta = x, y, theta
    return target


def ahead(count, length=0.04):
    """Steps of left and right foot in turn, the last one beside the other foot."""
    steps = [step(LEFT, length, 0.1) if i % 2 == 0 else step(RIGHT, length, -0.1) for i in range(count - 1)]
    return [*steps, step(LEFT, 0.0, 0.1) if count % 2 else step(RIGHT, 0.0, -0.1)]


class DriverFootsteps(WalkingTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.client = action_client("footsteps_execution", ExecFootstepsAction)
        cls.step = service("footstep_srv", StepTargetService)
        cls.clip = service("clip_footstep_srv", ClipFootstep)
        cls.robot.reset()
        # It has reached the robot when it refuses what is wrong for the robot's own reasons.
        wait_until(lambda: "wakeUp" in answer(cls.step, step(LEFT, 0.0, 0.1)), 60.0, "nao_footsteps")

    def moved_since(self, before):
        return self.truth().seen_from(before)

    def feet(self):
        (left, right), _, _ = self.motion.getFootSteps()
        return Place(*left), Place(*right)

    def play(self, steps, frequency=10.0, end=GoalStatus.SUCCEEDED):
        run = send(self.client, ExecFootstepsGoal(steps, frequency)).wait(180.0)
        self.assertEqual(run.state, end, run.text)
        return run

    def test_a_sequence_is_made_and_told_of_step_by_step(self):
        before = self.truth()
        steps = ahead(9)
        with self.robot.at_speed(0.5):
            run = self.play(steps)
        self.assertEqual(run.result.executed_footsteps, steps)
        # Feedback and result come on different topics.
        wait_until(
            lambda: any(len(told.executed_footsteps) == 9 for _, told in run.feedback), 60.0, "the last feedback"
        )
        counts = [len(feedback.executed_footsteps) for _, feedback in run.feedback]
        self.assertEqual(counts, sorted(counts))
        self.assertEqual(counts[0], 0)
        self.assertGreaterEqual(len(set(counts)), 3, counts)
        self.assertEqual(counts[-1], 9)
        way = self.moved_since(before)
        print(f"9 steps: {1000 * way.x:.0f} mm ahead, {1000 * way.y:.0f} mm aside, {math.degrees(way.yaw):.1f} degrees")
        self.assertAlmostEqual(way.x, 8 * 0.04, delta=0.02)
        self.assertAlmostEqual(way.y, 0.0, delta=0.02)
        self.assertLess(abs(way.yaw), math.radians(3.0))
        left, right = self.feet()
        self.assertAlmostEqual(left.seen_from(right).y, 0.1, delta=0.01)
        self.assertAlmostEqual(left.seen_from(right).x, 0.0, delta=0.01)

    def test_steps_that_are_too_long_are_made_as_the_clipping_service_tells(self):
        long = step(LEFT, 0.3, 0.3, 1.0)
        clipped = self.clip(long).step
        self.assertLess(clipped.pose.x, 0.08)
        self.assertLess(clipped.pose.y, 0.16)
        self.assertEqual(self.play([long, step(RIGHT, 0.0, -0.1)]).result.executed_footsteps[0], clipped)
        fine = step(RIGHT, 0.02, -0.1, -0.1)
        self.assertEqual(self.clip(fine).step, fine)

    def test_a_cancelled_sequence_ends_on_two_feet_and_tells_what_was_made(self):
        before = self.truth()
        with self.robot.at_speed(0.5):
            run = send(self.client, ExecFootstepsGoal(ahead(30), 20.0))
            wait_until(lambda: self.moved_since(before).x > 0.08, 90.0, "some steps")
            run.cancel()
            run.wait()
        self.assertEqual(run.state, GoalStatus.PREEMPTED)
        self.assertFalse(self.motion.moveIsActive())
        made = len(run.result.executed_footsteps)
        self.assertGreater(made, 1)
        self.assertLess(made, 30)
        self.robot.advance(1.0)
        # The foot behind closes up, which is no step of the goal.
        self.assertAlmostEqual(self.moved_since(before).x, 0.04 * made, delta=0.05)
        self.assertGreater(self.robot.true_pose().position.z, 0.3)

    def test_single_steps_by_service_and_topic(self):
        before = self.truth()
        self.step(step(LEFT, 0.04, 0.1))
        self.assertFalse(self.motion.moveIsActive())
        left, right = self.feet()
        self.assertAlmostEqual(left.seen_from(right).x, 0.04, delta=0.01)
        single = publisher(self, "footstep", StepTarget)
        for target in (step(RIGHT, 0.04, -0.1), step(LEFT, 0.0, 0.1)):
            single.publish(target)
        wait_until(lambda: self.moved_since(before).x > 0.06, 90.0, "the steps")
        wait_until(lambda: not self.motion.moveIsActive(), 90.0, "the end of the steps")
        self.assertAlmostEqual(self.moved_since(before).x, 0.08, delta=0.025)

    def test_what_will_not_do_is_told_and_moves_nothing(self):
        before = self.truth()
        left = step(LEFT, 0.04, 0.1)
        for steps, frequency, words in (
            ([], 10.0, "one step at least"),
            ([left, left], 10.0, "footsteps[1].leg"),
            ([step(7, 0.0, 0.1)], 10.0, "footsteps[0].leg"),
            ([left, step(RIGHT, math.nan, -0.1)], 10.0, "footsteps[1].pose.x"),
            ([left], 0.0, "feedback_frequency"),
        ):
            self.assertIn(words, self.play(steps, frequency, GoalStatus.ABORTED).text)
        self.assertIn("leg", answer(self.step, step(3, 0.0, 0.1)))
        self.assertLess(self.truth().distance_to(before), 0.005)
        self.motion.rest()
        self.assertIn("wakeUp", self.play([left], 10.0, GoalStatus.ABORTED).text)
