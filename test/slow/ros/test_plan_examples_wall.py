"""The example of a plan that is stopped by a wall, started as users start it."""

import math

import pytest
from plan_examples_fixture import PlanExampleTest

GOAL = (1.6, -0.1)
NEAR = 0.15


@pytest.mark.long
class PlanExamplesAtTheWall(PlanExampleTest):
    world = "wall"

    def test_the_robot_gets_around_the_wall(self):
        output, trace = self.run_plan("detour_plan.py", *map(str, GOAL))
        place = self.robot.true_pose().position
        self.assertLess(math.hypot(place.x - GOAL[0], place.y - GOAL[1]), NEAR, output)
        walks = trace.named("walk")
        self.assertEqual(walks[0].state, "failed", output)
        self.assertRegex(walks[0].failure, r"the robot stopped: an obstacle 0\.\d+ m ahead")
        self.assertGreaterEqual(len([walk for walk in walks if walk.state == "succeeded"]), 3, output)
        self.assertIn("Something is in my way.", output)
        self.assert_stands()

    def test_a_way_that_is_free_needs_no_detour(self):
        _, trace = self.run_plan("detour_plan.py", "0.3", "0.0")
        self.assertEqual([walk.state for walk in trace.named("walk")], ["succeeded"])
        self.assertAlmostEqual(self.robot.true_pose().position.x, 0.3, delta=0.06)
