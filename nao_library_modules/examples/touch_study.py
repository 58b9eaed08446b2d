#!/usr/bin/env python3
"""A small study: in each trial the robot asks for a touch of its head, waits for it, and answers with a behaviour.

Writes a line a trial to a CSV file: what was touched, when the question ended and the touch began (ROS time, s), the
reaction time between them (s; below 0 for a touch during the question), which behaviour answered, how it ended and how
long it took (s). Of a simulated hand it has also when the physics had it touch. Behaviours come in random order; equal
seeds, equal orders.

    touch_study.py --trials 12 --output study.csv                     # somebody touches the robot
    touch_study.py --trials 12 --output study.csv --simulated-hand    # a simulated robot is touched by itself

Needs a running server, for example `roslaunch nao_library nao_sim.launch`.
"""

from __future__ import annotations

import argparse
import csv
import io
import random
import sys
import threading
from pathlib import Path
from typing import Any

import rospy
from actionlib import SimpleActionClient
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import (
    NaoAudioOutAction,
    NaoAudioOutGoal,
    NaoBehaviorAction,
    NaoBehaviorGoal,
    NaoTactileAction,
    NaoTactileGoal,
)
from nao_library_modules.whole_file import WholeFile, require_new
from nao_library_msgs.msg import AudioOutFunction, BehaviorFunction, TactileFunction
from nao_library_msgs.srv import TouchSensors

COLUMNS = (
    *("trial", "touched", "question_end", "onset", "hand_contact", "reaction_s"),
    *("behavior", "end", "behavior_s", "problem"),
)
BEHAVIORS = ("nod", "shake_head", "bow")
SERVER_LIMIT = rospy.Duration(30)
GOAL_LIMIT = rospy.Duration(60)
"""For a goal; the robot waits so long for a touch, beyond the time that somebody has for it after the question."""
HAND_DELAY = (0.5, 2.0)
"""s from the end of the question until the simulated hand comes, at least and at most."""
TOUCH_TIME = 0.2


class Study:
    """Clients of the servers, and the trials."""

    def __init__(self, question: str, timeout: float, seed: int, simulated_hand: bool) -> None:
        """Connect.

        Args:
            question: What the robot says before it waits.
            timeout: s of ROS time that it waits for a touch after the question.
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
        self._wait_for_touch()  # before the question, or a touch during it would be lost
        ask = NaoAudioOutGoal([AudioOutFunction(function="say", str_param=self._question)])
        self._speech.send_goal(ask)
        problem = self._end(self._speech, GOAL_LIMIT)
        if problem:
            self._stop(self._touch)
            return {**row, "problem": problem}
        question = self._speech.get_result().results[0]
        question_end = question.offset or question.end  # of the sound, where the robot tells it
        hand = None
        if self._hand is not None:
            hand = threading.Thread(target=self._touch_the_head, args=(row,), daemon=True)
            hand.start()
        self._touch.wait_for_result(rospy.Duration.from_sec(self._timeout))
        self._stop(self._touch)
        problem = self._end(self._touch, GOAL_LIMIT, GoalStatus.PREEMPTED)
        if problem:
            return {**row, "problem": problem}
        felt = self._touch.get_result()
        if not felt.touched:
            return {**row, "problem": f"no touch within {self._timeout:g} s"}
        row.update(touched=felt.touched[0], question_end=f"{question_end.to_sec():.3f}")
        onset, unknown = felt.touch_times[0], "when the touch began is not known"
        if onset:
            unknown = ""
            row.update(onset=f"{onset.to_sec():.3f}", reaction_s=f"{(onset - question_end).to_sec():.3f}")
        answer = NaoBehaviorGoal([BehaviorFunction(function="runBehavior", str_param=behavior)])
        self._behaviors.send_goal(answer)
        problem = self._end(self._behaviors, GOAL_LIMIT)
        row.update(end=GoalStatus.to_string(self._behaviors.get_state()).lower(), problem=problem or unknown)
        result = self._behaviors.get_result()
        if result is not None and result.results:
            row.update(behavior_s=f"{result.results[0].elapsed.to_sec():.2f}")
        if hand is not None:
            hand.join()
        return row

    def _wait_for_touch(self) -> None:
        """Have the robot wait for a touch from now on; if it does not, the end of that goal tells why."""
        waiting = threading.Event()
        timeout = GOAL_LIMIT.to_sec() + self._timeout
        self._touch.send_goal(
            NaoTactileGoal([TactileFunction(function="waitForTouch", sensors=["head"], timeout=timeout)]),
            done_cb=lambda *_: waiting.set(),
            feedback_cb=lambda feedback: feedback.status == "waiting" and waiting.set(),
        )
        waiting.wait(GOAL_LIMIT.to_sec())

    @staticmethod
    def _stop(client: SimpleActionClient) -> None:
        """End a goal. One that is over is not cancelled: actionlib's client would forget its end."""
        if client.get_state() in (GoalStatus.PENDING, GoalStatus.ACTIVE):
            client.cancel_goal()

    @staticmethod
    def _end(client: SimpleActionClient, limit: rospy.Duration, *also_good: int) -> str:
        """Wait for the end of a goal; what was wrong, empty if nothing was. States beside SUCCEEDED may be good."""
        if not client.wait_for_result(limit):
            client.cancel_goal()
            return f"no result within {limit.to_sec():g} s"
        state = client.get_state()
        good = state in (GoalStatus.SUCCEEDED, *also_good)
        return "" if good else client.get_goal_status_text() or GoalStatus.to_string(state).lower()

    def _touch_the_head(self, row: dict[str, Any]) -> None:
        """Touch it a while after the question, as a person would, and note when the hand was felt."""
        rospy.sleep(self._random.uniform(*HAND_DELAY))
        felt = self._hand(sensors=["Head/Touch/Middle"], time=rospy.Duration.from_sec(TOUCH_TIME), wait=True)
        row["hand_contact"] = f"{felt.contact.to_sec():.3f}"


def main() -> int:
    """Run the study; the exit status tells whether all trials went well."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--trials", type=int, default=12, help="how many (default: %(default)s)")
    parser.add_argument("--question", default="Please touch my head.", help="what the robot says")
    parser.add_argument(
        "--timeout", type=float, default=10.0, help="s to wait for a touch after the question (default: %(default)g)"
    )
    parser.add_argument("--seed", type=int, default=1, help="of the order of the behaviours")
    parser.add_argument("--output", type=Path, default=Path("study.csv"), help="the file (default: %(default)s)")
    parser.add_argument("--overwrite", action="store_true", help="replace a file of that name")
    parser.add_argument("--simulated-hand", action="store_true", help="a simulated robot is touched by itself")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("touch_study", anonymous=True)
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    try:
        output = require_new(options.output, options.overwrite)
        study = Study(options.question, options.timeout, options.seed, options.simulated_hand)
    except RuntimeError as error:
        print(error)
        return 1
    good = True
    with io.TextIOWrapper(WholeFile(output), "utf-8", newline="") as file:
        lines = csv.DictWriter(file, COLUMNS)
        lines.writeheader()
        for number in range(1, options.trials + 1):
            row = study.trial(number)
            lines.writerow(row)
            file.flush()  # what was measured is kept, whatever comes
            print(", ".join(f"{name} {row[name]}" for name in COLUMNS if row.get(name)), flush=True)
            good = good and not row["problem"]
    print(f"written: {output}")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
