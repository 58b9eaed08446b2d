#!/usr/bin/env python3
"""A user's program that sends goals of every kind at once, round after round, and prints how they end.

Run with the port of the simulator. For each line read it sends the goals and prints the kinds that are under way; then
it reads a second line, `touch` for the touch that is waited for, and prints each end. A line `over` closes each list.
"""

import itertools
import sys

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from goal_functions import audio_in, audio_out, behavior, led, motion, vision
from trajectory_msgs.msg import JointTrajectoryPoint

from nao_library_actions.msg import (
    JointTrajectoryAction,
    JointTrajectoryGoal,
    NaoAudioInAction,
    NaoAudioOutAction,
    NaoBehaviorAction,
    NaoLedAction,
    NaoMotionAction,
    NaoVisionAction,
)
from nao_sim_bridge.testing import send
from naoqi import ALProxy

LIMIT = 60.0
BEGUN = 1.5
"""s after which all of them are in their midst."""
TEXT = "I count to ten: one, two, three, four, five, six, seven, eight, nine, ten."
STEPS = """
help: Waits for a touch.
do:
  - wait: 1.0
  - NaoTactile.waitForTouch: {sensors: [head], timeout: 60.0}
  - wait: 0.5
"""


def scenes(number):
    """Kind, action, server and functions; each second round moves the robot back."""
    name, sign = f"silent{number}", (1.0, -1.0)[number % 2]
    fade = led("fade", lights=["RightFaceLeds"], i_values=[0.5 + 0.3 * sign], duration=4.0)
    walk = motion("moveTo", values=[0.12 * sign, 0.0, 0.0])
    nod = motion("angleInterpolation", names=["HeadPitch"], angles=[0.2 * sign], times=[2.0])
    look = vision("takePictures", str_param=name, count=8, interval=0.5, timeout=LIMIT)
    yield "lights", NaoLedAction, "NaoLights", [fade]
    yield "audio out", NaoAudioOutAction, "nao_audio_out", [audio_out("say", TEXT)]
    yield "audio in", NaoAudioInAction, "nao_audio_in", [audio_in("record", str_param=f"{name}.wav", duration=4.0)]
    yield "motion", NaoMotionAction, "NaoMotion", [walk, nod]
    yield "vision", NaoVisionAction, "NaoVision", [look]
    yield "behaviour and touch", NaoBehaviorAction, "NaoBehavior", [behavior("runBehavior", text=STEPS)]


def goal(kind, functions):
    made = kind().action_goal.goal
    setattr(made, made.__slots__[0], functions)
    return made


def trajectory(angle):
    made = JointTrajectoryGoal()
    made.trajectory.joint_names = ["RShoulderPitch"]
    made.trajectory.points = [JointTrajectoryPoint(time_from_start=rospy.Duration(4.0), positions=[1.0 + 0.4 * angle])]
    return made


class Goals:
    """Clients of all servers, and of the driver's joints."""

    def __init__(self):
        self._clients = {name: self._client(name, kind) for _, kind, name, _ in scenes(0)}
        self._joints = self._client("joint_trajectory", JointTrajectoryAction)

    def _client(self, name, kind):
        client = actionlib.SimpleActionClient(name, kind)
        assert client.wait_for_server(rospy.Duration(LIMIT)), name
        return client

    def begin(self, number):
        """Send them all; kind -> run."""
        runs = {what: send(self._clients[name], goal(kind, each)) for what, kind, name, each in scenes(number)}
        return {**runs, "joints": send(self._joints, trajectory(number % 2))}


def say(*lines):
    print(*lines, "over", sep="\n", flush=True)


def main():
    rospy.init_node("user", anonymous=True, disable_signals=True)
    address = "127.0.0.1", int(sys.argv[1])
    simulation, goals = ALProxy("NaoSimulation", *address), Goals()
    ALProxy("ALMotion", *address).wakeUp()
    say()
    for number in itertools.count():
        if not sys.stdin.readline():
            return
        simulation.press([])
        runs = goals.begin(number)
        rospy.sleep(BEGUN)
        say(*(what for what, run in runs.items() if run.running))
        if sys.stdin.readline() == "touch\n":
            simulation.press(["Head/Touch/Front"])
        ends = {what: run.wait(LIMIT) for what, run in runs.items()}
        say(*(f"{what}: {GoalStatus.to_string(run.state)} {run.text}" for what, run in ends.items()))


if __name__ == "__main__":
    main()
