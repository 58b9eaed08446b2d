"""The examples for NaoMotion, started as users start them."""

import signal

from examples_fixture import ExampleTest, start
from waits import PATIENCE

from nao_sim_bridge.testing import wait_until


class MotionExamples(ExampleTest):
    limit = 60

    def test_motion_client(self):
        text = self.run_example("motion_client.py")
        self.assertIn("setPose: succeeded", text)
        rows = [line.split() for line in text.splitlines() if "is at" in line]
        self.assertEqual(len(rows), 6)
        for name, _, _, _, wanted, _, _, reached in rows:
            self.assertAlmostEqual(float(reached), float(wanted), delta=0.05, msg=name)

    def test_nod_stand_wave(self):
        text = self.run_example("nod_stand_wave.py")
        self.assertIn("4 of 5: angleInterpolation", text)
        self.assertIn("succeeded", text)
        self.assertGreater(self.robot.true_pose().position.z, 0.28)

    def test_stand_walk_wave(self):
        start = self.robot.true_pose().position
        text = self.run_example("stand_walk_wave.py")
        self.assertIn("walked 0.30 m ahead, ", text)
        end = self.robot.true_pose().position
        self.assertAlmostEqual(end.x - start.x, 0.3, delta=0.04)
        self.assertGreater(end.z, 0.28)

    def test_walks_end_on_both_feet_when_their_example_is_interrupted(self):
        example = start("stand_walk_wave.py")
        try:
            motion = self.robot.module("ALMotion")
            wait_until(lambda: motion.getRobotVelocity()[0] > 0.01, 60.0, "the robot on its way")
            example.send_signal(signal.SIGINT)
            example.communicate(timeout=PATIENCE)
            wait_until(lambda: not motion.moveIsActive(), 60.0, "the robot on both feet")
            self.robot.advance(1.0)
            self.assertLess(self.robot.true_pose().position.x, 0.28)
            self.assertGreater(self.robot.true_pose().position.z, 0.28)
        finally:
            example.kill()
            example.communicate()

    def test_teach_by_hand(self):
        text = self.run_example("teach_by_hand.py", "rostest_sinking", "--seconds", "2")
        self.assertIn("rostest_sinking: succeeded", text)
        for joint, sign in (("ShoulderPitch", 1.0), ("ShoulderRoll", -1.0), ("ElbowRoll", -1.0)):
            left, right = self.angle(f"L{joint}"), self.angle(f"R{joint}")
            self.assertAlmostEqual(left, sign * right, delta=0.1, msg=joint)

    def test_get_up(self):
        text = self.run_example("get_up.py")
        self.assertRegex(text, "fallen: (Lying|Sitting)")
        self.assertIn("got up: Stand", text)
        self.assertGreater(self.robot.true_pose().position.z, 0.28)

    def test_walk_square(self):
        self.robot.module("ALMotion").wakeUp()
        text = self.run_example("walk_square.py", "--side", "0.3")
        self.assertEqual(text.count("corner"), 4)
        end = self.robot.true_pose().position
        self.assertAlmostEqual(end.x, 0.0, delta=0.08)
        self.assertAlmostEqual(end.y, 0.0, delta=0.08)

    def test_state_trajectories_and_poses(self):
        self.assertRegex(self.run_example("robot_state.py"), r"torso   x -?0.0\d m, y -?0.0\d m, z 0.[23]\d m")
        self.assertEqual(self.run_example("joint_trajectory_client.py").count("succeeded"), 3)
        mistyped = start("take_pose.py", "--speed", "0.5", "Crowch")
        text, _ = mistyped.communicate(timeout=PATIENCE)
        self.assertEqual(mistyped.returncode, 1)
        self.assertIn("did you mean 'Crouch'", text)
