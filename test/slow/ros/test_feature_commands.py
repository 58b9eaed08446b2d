"""The tables of features in docs/features.md: commands without a star run, and do what they say."""

import os
import re
import shutil
import tempfile
import unittest
from pathlib import Path

import rospy
from amount import part_of
from feature_runner import run, run_all
from feature_table import PAGE, features

from nao_library_actions.msg import (
    NaoAudioInAction,
    NaoAudioOutAction,
    NaoBehaviorAction,
    NaoLedAction,
    NaoMotionAction,
    NaoTactileAction,
    NaoVisionAction,
)
from nao_sim_bridge.testing import SimulatedRobot

SERVERS = {
    "NaoLights": NaoLedAction,
    "nao_audio_out": NaoAudioOutAction,
    "nao_audio_in": NaoAudioInAction,
    "NaoMotion": NaoMotionAction,
    "NaoVision": NaoVisionAction,
    "NaoTactile": NaoTactileAction,
    "NaoBehavior": NaoBehaviorAction,
}
ONE_IN = 5
"""One in so many commands runs in the short form."""
LIMIT = 90.0
"""s of wall time for one command."""
AT_ONCE, SPEED = 3, 4.0
"""Commands side by side, and times real time: they mostly wait for speech, lights and legs."""
ANSWERS = {
    "getColor": r"LeftFaceLed1 ",
    "--person yes": r"(?i)heard: yes",
    "localizeSound": r"\d\.\d",
    "getAngles names": r"(?s)HeadYaw .*LHand ",
    "moveIsActive": r"(?i)false",
    "/nao_alife/state": r"solitary",
    "lookFor": r"kind ball",
    "detectLandmarks": r"kind landmark, name 68",
    "detectFaces": r"name Anna",
    "readBarcodes": r"hello",
    "detectMovement": r"kind movement",
    "getTouched": r"front head",
    "getBumpers": r"left bumper",
    "/tactile_touch": r"button: 2",
    "getPosture": r"Stand",
    "get Mine/Answer": r"42",
    "files list music": r"bip_gentle\.wav",
    "setColour": r"did you mean 'setColor'",
    "dry_run": r"2\.",
}
"""Part of a command -> what it has to print: these could find nothing and still end well."""


class FeatureCommands(unittest.TestCase):
    def test_commands_do_what_they_say(self):
        robot = SimulatedRobot()
        for name, action in SERVERS.items():
            robot.action_client(name, action)
        folder = Path(tempfile.mkdtemp(prefix="nao_features_"))
        self.addCleanup(shutil.rmtree, folder, ignore_errors=True)
        # An example has a test of its own, which looks at what it does.
        tested = "".join(path.read_text(encoding="utf-8") for path in Path(__file__).parent.glob("test_*_examples*.py"))
        rows = [row for row in features(PAGE.read_text(encoding="utf-8")) if not row.starred]
        rows = [row for row in rows if not any(example in tested for example in re.findall(r"\w+\.py\b", row.command))]
        self.assertGreater(len(rows), 50)

        rows = part_of(rows, ONE_IN)

        def run_one(row):
            outcome = run(row, folder, os.environ, robot.port, LIMIT)
            rospy.loginfo("%5.1f s, status %s: %s", outcome.ended.seconds, outcome.ended.status, row.command)
            return outcome

        with robot.at_speed(SPEED):
            outcomes = run_all(rows, run_one, AT_ONCE)
        self.assertEqual(len(outcomes), len(rows))
        failed = [outcome for outcome in outcomes if outcome.refused or not answers(outcome)]
        self.assertEqual(failed, [], "\n\n".join(map(str, failed)))


def answers(outcome):
    """Whether a command has printed what it has to."""
    wanted = [answer for part, answer in ANSWERS.items() if part in outcome.feature.command]
    return all(re.search(answer, outcome.ended.output) for answer in wanted)
