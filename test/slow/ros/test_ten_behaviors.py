"""The behaviours that come with the library, from several postures, with the sensors of a real robot."""

import unittest

from actionlib_msgs.msg import GoalStatus
from amount import part_of

from nao_library_actions.msg import NaoBehaviorAction, NaoBehaviorGoal, NaoMotionAction, NaoMotionGoal
from nao_library_msgs.msg import BehaviorFunction, MotionFunction
from nao_sim_bridge.testing import SimulatedRobot, send

# Behaviour -> where the robot is before it, and parameters that keep it short.
RUNS = {
    "hello": ("Crouch", ["text=Hi"]),
    "introduce_yourself": ("StandInit", ["name=Anna", "place=here"]),
    "nod": ("Crouch", ["times=1", "speed=1.5"]),
    "shake_head": ("Sit", ["times=1"]),
    "look_around": ("Stand", ["speed=1.3", "text=Hi"]),
    "count_to_ten": ("StandInit", ["pause=0"]),
    "tai_chi": ("Crouch", ["speed=1.2"]),
    "dance": ("Stand", ["tempo=120"]),
    "bow": ("StandInit", ["depth=small"]),
    "sit_and_rest": ("Stand", ["text=Hi"]),
}
ONE_IN = 4
"""One in so many is played in the short form."""
STANDING, SITTING = 0.3, 0.2
SEATED = ("sit_and_rest", "shake_head")
# How far the robot may get from where it was, m, and how late a step may be, s.
STRAY, LATE = 0.08, 0.5
# From there the robot gets up first.
AWAY = ("Sit",)


class TenBehaviors(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.behaviors = cls.robot.action_client("NaoBehavior", NaoBehaviorAction)
        cls.motion = cls.robot.action_client("NaoMotion", NaoMotionAction)

    def play(self, name, parameters):
        function = BehaviorFunction(function="runBehavior", str_param=name, parameters=parameters)
        return send(self.behaviors, NaoBehaviorGoal([function])).wait(120.0)

    def test_they_are_listed_and_explained(self):
        run = send(self.behaviors, NaoBehaviorGoal([BehaviorFunction(function="listBehaviors")])).wait()
        there = {each.name: each for each in run.result.behaviors if each.shipped}
        self.assertEqual(sorted(there), sorted(RUNS))
        for each in there.values():
            self.assertEqual(each.problem, "")
            self.assertTrue(each.help and each.parameters and each.tags, each.name)

    def test_each_ends_well_and_the_robot_does_not_fall(self):
        wrong = [f"{name}: {text}" for name, run in part_of(RUNS.items(), ONE_IN) for text in self.faults(name, *run)]
        self.assertEqual(wrong, [])

    def faults(self, name, posture, parameters):
        """Play one from a posture; what is wrong with it afterwards."""
        goal = NaoMotionGoal([MotionFunction(function="goToPosture", str_param=posture, speed=0.9)])
        begin = send(self.motion, goal).wait(60.0)
        if begin.state != GoalStatus.SUCCEEDED:
            return [f"{posture} cannot be had: {begin.text}"]
        before = self.robot.true_pose().position
        with self.robot.at_speed(1.5):  # the faster, the more simulated time a busy computer is late
            run = self.play(name, parameters)
        after = self.robot.true_pose().position
        stray = max(abs(after.x - before.x), abs(after.y - before.y))
        lowest, highest = (0.0, SITTING) if name in SEATED else (0.0 if name == "nod" else STANDING, 1.0)
        late = max((step.late for step in run.result.steps), default=0.0)
        return [
            text
            for text, holds in (
                (run.text, run.state == GoalStatus.SUCCEEDED),
                (f"a step is {late:.3f} s late", late < LATE),
                (f"its torso is at {after.z:.3f} m", lowest < after.z < highest),
                (f"it has strayed by {stray:.3f} m", stray < STRAY or name in SEATED or posture in AWAY),
            )
            if not holds
        ]
