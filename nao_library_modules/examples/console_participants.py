#!/usr/bin/env python3
"""Runs a study with simulated participants, who touch the robot's head and answer its questions; then writes the table.

    console_participants.py --participants 10                            # the study praise_2x2, four trials each
    console_participants.py --protocol mine.yaml --studies ~/studies --output mine.csv

Trials are those of `nao study run` and of the page "Study" of `nao console`, which shows them as well. Participants who
have done all their trials are left out, so that a study that was interrupted goes on. Equal seeds, equal participants.
A trial that is held because a step failed is aborted, and ends the program with status 1, without a table.

Needs a running simulation, for example `roslaunch nao_library nao_sim.launch`.
"""

from __future__ import annotations

import argparse
import queue
import random
import sys
import threading
from pathlib import Path
from typing import Any

import rospy
from geometry_msgs.msg import Point

from nao_library_actions.msg import NaoAudioInActionFeedback
from nao_library_modules.console.watched_studies import studies_alone
from nao_library_modules.core.errors import NaoError
from nao_library_modules.core.nao_facts import sensors_of
from nao_library_modules.studies.protocol import ChoiceStep, SenseStep, StudyError, WhileStep
from nao_library_modules.studies.protocol_reader import read_protocol_file
from nao_library_modules.studies.study_files import StudyFiles
from nao_library_modules.studies.study_table import summaries_of, table_of
from nao_library_modules.studies.trial_log import FAILED, FINISHED, HELD
from nao_library_modules.whole_file import require_new, write_whole
from nao_library_msgs.srv import PersonSays, TouchSensors

LISTENS, LISTEN_LIMIT = "ListenOn", 30.0
MOUTH = Point(1.0, 0.2, 0.6)
REACTIONS = {"animated": (0.4, 1.2), "": (0.6, 2.0)}
"""s that a participant takes, at least and at most; the level of a factor that is named here has its own."""
TOUCH_TIME = rospy.Duration.from_sec(0.2)


class SimulatedParticipant:
    """Does what a step asks a participant for.

    `chance`: decides how long that takes, and what is said and chosen.
    """

    def __init__(self, chance: random.Random) -> None:
        self._chance = chance
        self._listens = threading.Event()
        self._touch = rospy.ServiceProxy("nao_sim/touch", TouchSensors)
        self._say = rospy.ServiceProxy("nao_sim/person_says", PersonSays)
        self._feedback = rospy.Subscriber("nao_audio_in/feedback", NaoAudioInActionFeedback, self._hear)
        for service in (self._touch, self._say):
            service.wait_for_service(30.0)

    def play(self, runner: Any, changes: queue.SimpleQueue[Any]) -> str:
        """Take part in a trial until it is over; how it ended. A step that fails and is held aborts it."""
        done, trouble = None, ""
        while not runner.wait(0):
            changes.get()
            if runner.trouble and not trouble:
                say(f"{runner.id}: {runner.trouble}")
            trouble = runner.trouble
            outcome, held = runner.outcome, runner.state.status == HELD
            place = (outcome.path, outcome.attempt, held) if outcome is not None else None
            if place is None or place == done:
                continue
            done = place
            if held:  # there is nobody who could decide how it goes on
                say(f"{runner.id} is held: step {outcome.path} ({outcome.text}) failed: {outcome.error}")
                runner.abort("participants")
            else:
                self._do(runner)
        return str(runner.state.status)

    def _do(self, runner: Any) -> None:
        step = runner.step
        if isinstance(step, WhileStep):
            step = step.waits[0]
        if isinstance(step, ChoiceStep):
            runner.choose(self._chance.choice(step.choices), "participant")
        elif isinstance(step, SenseStep) and step.sense == "touch":
            self._react(runner)
            self._touch([sensors_of(step.names)[0].devices[0]], TOUCH_TIME, True)
        elif isinstance(step, SenseStep) and step.sense == "word":
            if self._listens.wait(LISTEN_LIMIT):  # it may listen already during the steps before
                self._react(runner)
                self._say(self._chance.choice(step.names), MOUTH, "", 0.0)
                self._listens.clear()

    def _react(self, runner: Any) -> None:
        levels = [level for level in runner.state.about["condition"].values() if level in REACTIONS]
        rospy.sleep(self._chance.uniform(*REACTIONS[levels[0] if levels else ""]))

    def _hear(self, told: Any) -> None:
        if told.feedback.status == LISTENS:
            self._listens.set()


def say(text: str) -> None:
    """Tell it on the standard error, at once."""
    print(text, file=sys.stderr, flush=True)


def main() -> int:
    """Run the study; the exit status tells whether all trials were finished."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--protocol", default="praise_2x2", help="name or FILE.yaml (default: %(default)s)")
    parser.add_argument("--participants", type=int, default=10, help="how many (default: %(default)s)")
    parser.add_argument(
        "--studies", type=Path, default=Path("~/.ros/nao_studies"), help="folder (default: %(default)s)"
    )
    parser.add_argument("--seed", type=int, default=1, help="of what participants do (default: %(default)s)")
    parser.add_argument("--output", type=Path, default=Path("table.csv"), help="the table (default: %(default)s)")
    parser.add_argument("--overwrite", action="store_true", help="replace a file of that name")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("console_participants", anonymous=True, disable_signals=True)  # Ctrl-C ends what waits
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    try:
        return run(options)
    except (NaoError, OSError, rospy.ROSException, rospy.ServiceException) as error:
        say(f"Error: {error}")
        return 1
    except KeyboardInterrupt:
        return 130


def run(options: argparse.Namespace) -> int:
    """Run all trials and write the table; the exit status."""
    output = require_new(options.output, options.overwrite)
    files = StudyFiles(options.studies)
    path = files.protocols().get(options.protocol, Path(options.protocol))
    protocol = read_protocol_file(path)
    studies, robot = studies_alone(files)
    for number in range(1, options.participants + 1):
        pseudonym = f"P{number:02d}"
        participant = SimulatedParticipant(random.Random(f"{options.seed}:{pseudonym}"))
        while True:
            try:
                studies.position_of(protocol, pseudonym)
            except StudyError:  # all are done
                break
            changes: queue.SimpleQueue[Any] = queue.SimpleQueue()
            runner = studies.begin(protocol, pseudonym, robot, "participants", listener=changes.put)
            try:
                ended = participant.play(runner, changes)
            except BaseException:  # whatever it is: the trial is not left open
                runner.abort()
                runner.wait(10.0)
                raise
            print(f"{runner.id} {ended}: {runner.state.about['condition']}", flush=True)
            if ended != FINISHED:
                return fail(runner)
    table = table_of(files, protocol.name)
    write_whole(output, table.csv())
    for each in summaries_of(table):
        mean = "" if each.mean is None else f", mean reaction {each.mean:.2f} s"
        print(f"{each.label} ({each.condition}): {each.count} times{mean}, {dict(each.answers)}")
    print(f"written: {output}, {len(table.rows)} rows")
    return 0


def fail(runner: Any) -> int:
    """Tell why a trial was not finished; the exit status."""
    failed = [each for each in runner.state.outcomes if each.outcome == FAILED]
    why = f": step {failed[-1].path} failed: {failed[-1].error}" if failed else ""
    say(f"Error: trial {runner.id} is {runner.state.status}{why}; once that is mended, the same command goes on")
    return 1


if __name__ == "__main__":
    sys.exit(main())
