#!/usr/bin/env python3
"""Behaviours over the real stack: several servers at once, times, failures, preemption, recordings."""

import sys
import unittest
from pathlib import Path

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import (
    NaoAudioOutAction,
    NaoAudioOutGoal,
    NaoBehaviorAction,
    NaoBehaviorActionFeedback,
    NaoBehaviorGoal,
    NaoLedAction,
    NaoLedGoal,
    NaoMotionAction,
    NaoMotionGoal,
)
from nao_library_msgs.msg import AudioOutFunction, BehaviorFunction, LedFunction, MotionFunction
from nao_library_msgs.srv import ListBehaviors
from nao_sim_bridge.testing import SimulatedRobot, send, wait_until

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))  # not beside its relay
from examples_fixture import start  # noqa: E402
from news import News  # noqa: E402
from waits import PATIENCE  # noqa: E402

EYES = "FaceLeds"
HEAD = "HeadYaw"
TICK = 0.01
"""s of simulated time, a little more than a tick."""

THREE = """
help: Three servers at once.
parameters:
  colour: {default: green, help: of the eyes, choices: [green, red]}
do:
  - parallel:
      - NaoLights.fadeRGB: {lights: [FaceLeds], str_param: "${colour}", duration: 1.0}
      - NaoMotion.angleInterpolation: {names: [HeadYaw], angles: [0.5], times: [1.0], stiffness: 1.0}
      - [{wait: 0.2}, {nao_audio_out.playSine: {frequency: 400, volume: 0.1, duration: 0.5}}]
"""
TIMES = """
help: Things at their times.
do:
  - timeline:
      - {NaoLights.setColor: {lights: [FaceLeds], str_param: red}, at: 0.0, label: red}
      - NaoMotion.angleInterpolation: {names: [HeadYaw], angles: [0.3], times: [0.5], stiffness: 1.0}
        at: 0.4
        label: head
      - {NaoLights.setColor: {lights: [FaceLeds], str_param: blue}, at: 1.5}
      - {nao_audio_out.playSine: {frequency: 400, volume: 0.1, duration: 0.2}, at: head.end + 0.3}
"""
LONG = """
help: Keeps three servers busy.
do:
  - parallel:
      - NaoLights.fadeRGB: {lights: [FaceLeds], str_param: red, duration: 600.0}
      - NaoMotion.angleInterpolation: {names: [HeadYaw], angles: [1.0], times: [600.0], stiffness: 1.0}
      - nao_audio_out.playSine: {frequency: 400, volume: 0.1, duration: 240.0}
  - wait: 1.0
"""
FAILING = """
help: Goes on in spite of failures.
do:
  - {nao_audio_out.playFile: {str_param: no_such_file.wav}, on_error: retry 1 skip}
  - {NaoLights.setColor: {lights: [FaceLeds], str_param: blue}}
  - {NaoLights.setColor: {lights: [NoSuchLight], str_param: red}, on_error: skip}
  - {nao_audio_out.playFile: {str_param: no_such_file.wav}}
  - {wait: 1.0}
"""
BOX = """
help: Turns the head by a box, twice.
parameters: {angle: {default: 0.1, help: where to look, unit: rad, min: -1, max: 1}}
do:
  - {behavior: turn, parameters: {angle: "${angle}"}}
  - {repeat: 2, as: i, do: [{behavior: turn, parameters: {angle: "${angle * i / 2}"}}]}
"""
TURN = """
help: Turns the head.
parameters: {angle: {default: 0.2, help: where to look, unit: rad, min: -1, max: 1}}
do: [{NaoMotion.angleInterpolation: {names: [HeadYaw], angles: ["${angle}"], times: [0.4], stiffness: 1.0}}]
"""


def b(function, name="", **fields):
    return BehaviorFunction(function=function, str_param=name, **fields)


class Behaviors(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.client = cls.robot.action_client("NaoBehavior", NaoBehaviorAction)
        cls.lights = cls.robot.action_client("NaoLights", NaoLedAction)
        cls.motion = cls.robot.action_client("NaoMotion", NaoMotionAction)
        cls.audio = cls.robot.action_client("nao_audio_out", NaoAudioOutAction)
        cls.store("three", THREE)
        cls.store("times", TIMES)
        cls.store("long", LONG)
        cls.store("turn", TURN)
        cls.store("boxes", BOX)
        cls.store("failing", FAILING)

    @classmethod
    def store(cls, name, text):
        cls.do(b("storeBehavior", name, text=text, overwrite=True))

    @classmethod
    def do(cls, *functions, state=GoalStatus.SUCCEEDED):
        run = send(cls.client, NaoBehaviorGoal(list(functions))).wait(60.0)
        assert run.state == state, f"{GoalStatus.to_string(run.state)}: {run.text}"
        return run

    def setUp(self):
        self.robot.reset()

    def steps(self, run):
        return {step.path: step for step in run.result.steps}

    # --- running ------------------------------------------------------------------------------------------------------

    def play(self, name, *parameters):
        run = self.do(b("runBehavior", name, parameters=parameters))
        return run, self.steps(run)

    def test_three_servers_work_at_once(self):
        self.robot.pause()  # until all three have begun
        self.addCleanup(self.robot.resume)
        run = send(self.client, NaoBehaviorGoal([b("runBehavior", "three", parameters=["colour=red"])]))
        begun = lambda: {f.path for _, f in run.feedback if f.state == "began"}  # noqa: E731
        wait_until(lambda: {"1.1", "1.2", "1.3"} <= begun(), 60.0, lambda: f"all branches, not only {begun()}")
        self.robot.resume()
        self.assertEqual(run.wait(60.0).state, GoalStatus.SUCCEEDED, run.text)
        steps = self.steps(run)
        self.assertEqual({step.state for step in steps.values()}, {"ended"})
        self.assertEqual([steps[f"1.{i}"].what for i in (1, 2)], ["NaoLights.fadeRGB", "NaoMotion.angleInterpolation"])
        self.assertEqual(len({steps[f"1.{i}"].began for i in (1, 2, 3)}), 1)
        for path in ("1.1", "1.2"):
            self.assertGreater(steps[path].ended, steps[path].began)  # by the clock as it has come here
        self.assertGreater(steps["1.3.2"].began - steps["1.3.1"].began, 0.2 - TICK)
        self.assertGreater(float(run.result.memList[0]), steps["1"].ended - TICK)
        self.assertAlmostEqual(self.robot.module("ALMotion").getAngles(HEAD, True)[0], 0.5, delta=0.03)
        self.assertEqual(self.robot.led("Face/Led/Red/Left/0Deg"), 1.0)

    def test_no_entry_of_a_timeline_comes_before_its_time(self):
        run, steps = self.play("times")
        began = {path: step.began - steps["1"].began for path, step in steps.items()}
        for path, due in (("1.1", 0.0), ("1.2", 0.4), ("1.3", 1.5)):
            self.assertGreater(began[path], due - TICK, path)
        self.assertGreater(steps["1.4"].began - steps["1.2"].ended, 0.3 - TICK)
        told = {("1.2", "began"), ("1.2", "ended"), ("1", "ended")}
        # Feedback and result come on different topics.
        wait_until(lambda: told <= {(f.path, f.state) for _, f in run.feedback}, 60.0, "feedback of the steps")

    def test_a_box_has_its_own_parameters(self):
        run = self.do(b("runBehavior", "boxes", parameters=["angle=0.4"]))
        steps = self.steps(run)
        self.assertLessEqual({"1", "1/1", "2#1.1/1", "2#2.1/1"}, set(steps))
        self.assertEqual((steps["1/1"].behavior, steps["1"].behavior), ("turn", "boxes"))
        self.assertAlmostEqual(self.robot.module("ALMotion").getAngles(HEAD, True)[0], 0.4, delta=0.03)

    def test_failures_are_retried_skipped_or_end_it(self):
        run = self.do(b("runBehavior", "failing"), state=GoalStatus.ABORTED)
        steps = self.steps(run)
        self.assertEqual(
            [steps[path].state for path in "12345"], ["skipped", "ended", "skipped", "failed", "not run"], run.text
        )
        self.assertEqual(steps["1"].attempts, 2)
        self.assertIn("no_such_file", steps["1"].error)
        self.assertIn("NoSuchLight", steps["3"].error)
        self.assertIn("step 4 (nao_audio_out.playFile)", run.text)
        retried = lambda: ("1", "retried") in {(f.path, f.state) for _, f in run.feedback}  # noqa: E731
        wait_until(retried, 60.0, "feedback of the second try")

    def test_a_cancel_ends_all_servers_at_once(self):
        run = send(self.client, NaoBehaviorGoal([b("runBehavior", "long")]))
        proxy = self.robot.module("ALMotion")
        wait_until(lambda: proxy.getAngles(HEAD, True)[0] > 0.001, 60.0, "the head")
        self.robot.pause()
        self.addCleanup(self.robot.resume)
        cancelled = self.robot.advance(0.0)
        run.cancel()
        self.assertEqual(run.wait(60.0).state, GoalStatus.PREEMPTED)
        self.assertEqual(self.robot.advance(0.0), cancelled)
        steps = self.steps(run)
        self.assertEqual([steps[f"1.{i}"].state for i in (1, 2, 3)], ["preempted"] * 3)
        self.assertEqual(steps["2"].state, "not run")
        self.robot.advance(0.2)
        where = proxy.getAngles(HEAD, True)[0]
        self.robot.advance(1.0)
        self.assertAlmostEqual(proxy.getAngles(HEAD, True)[0], where, delta=0.01)
        for client, action in ((self.lights, NaoLedGoal), (self.motion, NaoMotionGoal)):
            self.assertEqual(send(client, action()).wait(60.0).state, GoalStatus.ABORTED)  # it takes goals again

    def test_stop_tells_what_it_ended(self):
        run = send(self.client, NaoBehaviorGoal([b("runBehavior", "long")]))
        wait_until(lambda: any(f.path == "1.3" for _, f in run.feedback), 60.0, "the last branch")
        self.assertEqual(self.do(b("stopBehavior")).result.memList, ["long"])
        self.assertEqual(run.wait(60.0).state, GoalStatus.PREEMPTED)
        self.assertEqual(self.do(b("stopBehavior")).result.memList, [])

    # --- what cannot run ----------------------------------------------------------------------------------------------

    def test_what_is_unknown_is_refused_before_anything_moves(self):
        led = self.robot.led("Face/Led/Red/Left/0Deg")
        turn = b("runBehavior", "turn")
        for functions, told in (
            ((turn, b("runBehavior", "turnn")), "did you mean 'turn'"),
            ((turn, b("runBehavior", "turn", parameters=["angel=1"])), "did you mean 'angle'"),
            ((turn, b("runBehavior", "turn", parameters=["angle=2"])), "-1 to 1 rad"),
            ((turn, b("storeBehavior", "bad", text="help: x\ndo: [{NaoLight.on: {}}]")), "did you mean 'NaoLights'"),
            ((turn, b("storeBehavior", "bad", text="help: x\ndo: [{NaoLights.onn: {}}]")), "did you mean 'on'"),
            ((turn, b("storeBehavior", "bad", text="help: x\ndo: [{NaoLights.on: {light: []}}]")), "'lights'"),
            ((turn, b("storeBehavior", "../bad", text=TURN)), "letters, digits"),
        ):
            run = self.do(*functions, state=GoalStatus.ABORTED)
            self.assertIn(told, run.text)
            self.assertEqual((len(run.result.results), len(run.result.steps)), (1, 0) if run.result.results else (0, 0))
            self.assertIn("function 2", run.text)
        self.assertAlmostEqual(self.robot.module("ALMotion").getAngles(HEAD, True)[0], 0.0, delta=0.02)
        self.assertEqual(self.robot.led("Face/Led/Red/Left/0Deg"), led)

    # --- recording ----------------------------------------------------------------------------------------------------

    def let_pass(self, seconds):
        """Let time pass, and wait until the server knows: /clock takes its way."""
        now = self.robot.advance(seconds)
        wait_until(lambda: self.do(b("ping")).server_time > now - TICK, 60.0, f"{now} s at the server")

    def test_a_recording_plays_the_same_again(self):
        blue = LedFunction(function="setColor", lights=[EYES], str_param="blue")
        turn = MotionFunction(function="angleInterpolation", names=[HEAD], angles=[0.5], times=[0.6], stiffness=1.0)
        tone = AudioOutFunction(function="playSine", frequency=300, volume=0.1, duration=120.0)
        self.robot.pause()  # but for what passes between two goals
        self.addCleanup(self.robot.resume)
        self.do(b("recordBehavior", "taken", overwrite=True))
        self.let_pass(0.0)
        self.assertEqual(send(self.lights, NaoLedGoal([blue])).wait(60.0).state, GoalStatus.SUCCEEDED)
        self.let_pass(0.5)
        sound = send(self.audio, NaoAudioOutGoal([tone])).wait_for_function(0)
        self.let_pass(0.3)
        self.robot.resume()
        send(self.motion, NaoMotionGoal([turn])).wait(60.0)
        sound.cancel()
        sound.wait(60.0)
        kept = self.do(b("stopRecording")).result.memList
        self.assertEqual(kept, ["taken", "3"])

        self.robot.reset()
        _, steps = self.play("taken")  # the tone is cut short again
        for path, due in (("1.1", 0.0), ("1.2", 0.5), ("1.3", 0.8)):
            self.assertGreater(steps[path].began - steps["1"].began, due - 2 * TICK, path)
        self.assertEqual({step.state for step in steps.values()}, {"ended"})
        self.assertLess(steps["1.2"].ended - steps["1.2"].began, tone.duration)
        self.assertAlmostEqual(self.robot.module("ALMotion").getAngles(HEAD, True)[0], 0.5, delta=0.03)

    def test_a_recording_that_is_preempted_keeps_what_came(self):
        run = send(self.client, NaoBehaviorGoal([b("recordBehavior", "cut", duration=600.0, overwrite=True)]))
        wait_until(lambda: any(f.state == "recording" for _, f in run.feedback), 60.0, "the recording")
        send(self.lights, NaoLedGoal([LedFunction(function="off", lights=[EYES])])).wait(60.0)
        wait_until(lambda: any(f.state == "recorded" for _, f in run.feedback), 60.0, "the goal in the recording")
        run.cancel()
        self.assertEqual(run.wait(60.0).state, GoalStatus.PREEMPTED)
        (text,) = self.do(b("describeBehavior", "cut")).result.memList
        self.assertIn("NaoLights.off", text)

    def test_the_last_goal_of_a_server_can_be_stored(self):
        half = LedFunction(function="setIntensity", lights=["Brain0"], i_values=[0.5])
        send(self.lights, NaoLedGoal([half, LedFunction(function="off", lights=["Brain1"])])).wait(60.0)
        self.do(b("storeBehavior", "half", server="NaoLights", overwrite=True))
        self.robot.reset()
        self.do(b("runBehavior", "half"))
        self.robot.wait_for_leds({"Head/Led/Front/Right/1": 0.5})

    # --- examples -----------------------------------------------------------------------------------------------------

    def test_the_examples_run_and_record(self):
        running = start("run_behavior.py", "three", "colour=red")
        told, _ = running.communicate(timeout=PATIENCE)
        self.assertEqual(running.returncode, 0, told)
        self.assertRegex(told, r"1\.3 +sequence +ended")
        self.assertIn("three: succeeded", told)

        with News().messages("NaoBehavior/feedback", NaoBehaviorActionFeedback) as news:
            recording = start("record_behavior.py", "watched", "--seconds", "10", "--overwrite")
            wait_until(lambda: any(m.feedback.state == "recording" for m in news), 60.0, "the recording")
            self.robot.pause()
            self.addCleanup(self.robot.resume)
            send(self.lights, NaoLedGoal([LedFunction(function="off", lights=[EYES])])).wait(60.0)
            wait_until(lambda: any(m.feedback.state == "recorded" for m in news), 60.0, "the goal in the recording")
            self.robot.resume()
            self.robot.advance(10.0)
        told, _ = recording.communicate(timeout=PATIENCE)
        self.assertIn("recording for 10 s", told)
        self.assertEqual(recording.returncode, 0, told)
        self.assertIn("NaoLights.off", told)

    # --- keeping ------------------------------------------------------------------------------------------------------

    def test_behaviours_are_listed_renamed_and_deleted(self):
        self.store("one", TURN)
        self.do(
            b("renameBehavior", "one", new_name="two", overwrite=True),
            b("copyBehavior", "two", new_name="three_of_it", overwrite=True),
        )
        rospy.wait_for_service("NaoBehavior/list", 60.0)
        listed = {info.name: info for info in rospy.ServiceProxy("NaoBehavior/list", ListBehaviors)(name="").behaviors}
        self.assertLessEqual({"two", "three_of_it", "boxes"}, set(listed))
        self.assertNotIn("one", listed)
        self.assertEqual([p.name for p in listed["two"].parameters], ["angle"])
        self.assertEqual(listed["boxes"].servers, ["NaoMotion"])
        self.assertFalse(listed["two"].shipped)
        self.do(b("deleteBehavior", "two"), b("deleteBehavior", "three_of_it"))
        self.assertNotIn("two", self.do(b("listBehaviors")).result.memList)
        self.do(b("deleteBehavior", "two"), state=GoalStatus.ABORTED)


if __name__ == "__main__":
    rospy.init_node("behaviors_test")
    rostest.rosrun("nao_library_tests", "behaviors", Behaviors)
