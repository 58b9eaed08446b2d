#!/usr/bin/env python3
"""A small study: in each trial the robot asks for a touch of its head, waits for it, and answers with a behaviour.

Writes a line a trial to a CSV file: what was touched, how long that took from the end of the question (s), which
behaviour answered, how it ended and how long it took (s). Behaviours come in random order; equal seeds, equal orders.

    touch_study.py --trials 12 --output study.csv                     # somebody touches the robot
    touch_study.py --trials 12 --output study.csv --simulated-hand    # a simulated robot is touched by itself

Needs a running server, for example `roslaunch nao_library nao_sim.launch`.
"""

from __future__ import annotations

import argparse
import csv
import random
import sys
import threading
from pathlib import Path
from typing import Any

import rospy
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import (
    NaoAudioOutAction,
    NaoAudioOutGoal,
    NaoBehaviorAction,
    NaoBehaviorGoal,
    NaoTactileAction,
    NaoTactileGoal,
)
from nao_library_modules.simple_action_client import SimpleActionClient
from nao_library_msgs.msg import AudioOutFunction, BehaviorFunction, TactileFunction
from nao_library_msgs.srv import TouchSensors

COLUMNS = ("trial", "touched", "reaction_s", "behavior", "end", "behavior_s", "problem")
BEHAVIORS = ("nod", "shake_head", "bow")
SERVER_LIMIT = rospy.Duration(30)
HAND_DELAY = (0.5, 2.0)
"""s after which the simulated hand comes, at least and at most."""
TOUCH_TIME = 0.2


class Study:
    """Clients of the servers, and the trials."""

    def __init__(self, question: str, timeout: float, seed: int, simulated_hand: bool) -> None:
        """Connect.

        Args:
            question: What the robot says before it waits.
            timeout: s of ROS time that it waits for a touch.
            seed: Of the order of the behaviours.
            simulated_hand: Whether a simulated hand touches the robot.

        Raises:
            RuntimeError: A server is not there.
        """
        self._question, self._timeout = question, timeout
        self._random = random.Random(seed)
        self._speech = self._client("nao_audio_out", NaoAudioOutAction)
        self._touch = self._client("NaoTactile", NaoTactileAction)
        self._behaviors = self._client("NaoBehavior", NaoBehaviorAction)
        self._hand = rospy.ServiceProxy("nao_sim/touch", TouchSensors) if simulated_hand else None

    @staticmethod
    def _client(name: str, action: type) -> SimpleActionClient:
        client = SimpleActionClient(name, action)
        if not client.wait_for_server(SERVER_LIMIT):
            raise RuntimeError(f"there is no server {name}: start one with roslaunch nao_library nao_sim.launch")
        return client

    def trial(self, number: int) -> dict[str, Any]:
        """One trial; what goes wrong in it is a column, and the study goes on."""
        behavior = self._random.choice(BEHAVIORS)
        row: dict[str, Any] = {"trial": number, "behavior": behavior}
        ask = NaoAudioOutGoal([AudioOutFunction(function="say", str_param=self._question)])
        if self._speech.send_goal_and_wait(ask) != GoalStatus.SUCCEEDED:
            return {**row, "problem": self._speech.get_goal_status_text()}
        waiting = threading.Event()
        self._touch.send_goal(
            NaoTactileGoal([TactileFunction(function="waitForTouch", sensors=["head"], timeout=self._timeout)]),
            feedback_cb=lambda feedback: feedback.status == "waiting" and waiting.set(),
        )
        if self._hand is not None:
            threading.Thread(target=self._touch_the_head, args=(waiting,), daemon=True).start()
        self._touch.wait_for_result()
        felt = self._touch.get_result()
        if self._touch.get_state() != GoalStatus.SUCCEEDED or not felt.touched:
            return {**row, "problem": self._touch.get_goal_status_text() or f"no touch within {self._timeout:g} s"}
        row.update(touched=felt.touched[0], reaction_s=f"{felt.results[0].elapsed.to_sec():.2f}")
        answer = NaoBehaviorGoal([BehaviorFunction(function="runBehavior", str_param=behavior)])
        end = self._behaviors.send_goal_and_wait(answer)
        taken = self._behaviors.get_result().results
        row.update(
            end=GoalStatus.to_string(end).lower(), behavior_s=f"{taken[0].elapsed.to_sec():.2f}" if taken else ""
        )
        return {**row, "problem": self._behaviors.get_goal_status_text()}

    def _touch_the_head(self, waiting: threading.Event) -> None:
        """Touch it a while after the robot has begun to wait, as a person would."""
        waiting.wait()
        rospy.sleep(self._random.uniform(*HAND_DELAY))
        self._hand(sensors=["Head/Touch/Middle"], time=rospy.Duration.from_sec(TOUCH_TIME), wait=False)


def main() -> int:
    """Run the study; the exit status tells whether all trials went well."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--trials", type=int, default=12, help="how many (default: %(default)s)")
    parser.add_argument("--question", default="Please touch my head.", help="what the robot says")
    parser.add_argument("--timeout", type=float, default=10.0, help="s to wait for a touch (default: %(default)g)")
    parser.add_argument("--seed", type=int, default=1, help="of the order of the behaviours")
    parser.add_argument("--output", type=Path, default=Path("study.csv"), help="the file (default: %(default)s)")
    parser.add_argument("--simulated-hand", action="store_true", help="a simulated robot is touched by itself")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("touch_study", anonymous=True)
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    try:
        study = Study(options.question, options.timeout, options.seed, options.simulated_hand)
    except RuntimeError as error:
        print(error)
        return 1
    good = True
    with options.output.open("w", newline="", encoding="utf-8") as file:
        lines = csv.DictWriter(file, COLUMNS)
        lines.writeheader()
        for number in range(1, options.trials + 1):
            row = study.trial(number)
            lines.writerow(row)
            file.flush()  # what was measured is kept, whatever comes
            print(", ".join(f"{name} {row[name]}" for name in COLUMNS if row.get(name)), flush=True)
            good = good and not row["problem"]
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
