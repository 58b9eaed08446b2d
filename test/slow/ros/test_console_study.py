"""A trial in a browser: a touch, a word and a choice; its console is killed, and the network lost."""

import shutil
import subprocess
import tempfile
from pathlib import Path

import pytest
import rospy
from console_browser import ConsoleBrowser, ConsoleProgram
from geometry_msgs.msg import Point
from selenium.webdriver.common.keys import Keys

from nao_library_actions.msg import NaoAudioInAction
from nao_library_modules.core.files import config_file
from nao_library_modules.studies.studies import Studies
from nao_library_modules.studies.study_files import StudyFiles
from nao_library_modules.studies.trial_log import EVENTS
from nao_library_msgs.srv import PersonSays
from nao_sim_bridge.testing import RobotTestCase, wait_until

STUDY = "patient_steps"
"""The ten steps that come along, with more time for a computer that is busy."""
TRIAL = f"{STUDY}/P01-1"
LIMIT = 300.0
"""s that a step may take until it begins: its trial hangs then."""


@pytest.mark.timeout(1800)
class ConsoleStudy(RobotTestCase):
    server = ("nao_audio_in", NaoAudioInAction)

    def setUp(self):
        super().setUp()
        self.folder = Path(tempfile.mkdtemp(prefix="console_study"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        protocols = self.folder / "studies" / "protocols"
        protocols.mkdir(parents=True)
        text = config_file("console/protocols/ten_steps.yaml").read_text()
        text = text.replace("name: ten_steps", f"name: {STUDY}").replace("timeout: 30", "timeout: 300")
        (protocols / f"{STUDY}.yaml").write_text(text)
        self.files = StudyFiles(self.folder / "studies")
        self.addCleanup(self.end_recordings)
        self.program = ConsoleProgram(self.folder)
        self.addCleanup(self.program.close)
        self.browser = self.browse()

    def browse(self):
        browser = ConsoleBrowser(self.program).enter()
        self.addCleanup(browser.close)
        browser.open("/study")
        return browser

    def end_recordings(self):
        """Of a trial that a failure of this test has left: a rosbag outlives its console."""
        for trial in self.files.trials(STUDY):
            if not trial.state().over:
                Studies(self.files).abort(trial.id)

    def at(self, path):
        """Wait until a step has begun: it may be over before anybody looks."""

        def begun():
            trials = [trial for trial in self.files.trials(STUDY) if trial.id == TRIAL]  # none yet, at first
            return any(each.path == path for trial in trials for each in trial.state().outcomes)

        def so_far():
            lines = (self.files.trial(TRIAL).path / EVENTS).read_text().splitlines()
            return f"step {path}; last events of the trial:\n" + "\n".join(lines[-10:])

        wait_until(begun, LIMIT, so_far)

    def begin(self):
        self.browser.open("/study", protocol=STUDY, participant="P01")
        self.browser.reads("One trial of ten steps")
        for recording in ("Rosbag", "Video", "Sound"):
            self.browser.click(".q-checkbox", recording)
        self.browser.click("button", "Start trial")

    def say(self, text):
        answer = rospy.ServiceProxy("nao_sim/person_says", PersonSays)(text, Point(1.0, 0.2, 0.6), "", 0.0)
        self.assertTrue(answer.success, answer.message)

    def test_a_trial_survives_the_end_of_its_console_and_of_the_network(self):
        self.begin()
        self.browser.reads("wait for a touch", "records bag", "records video", "records sound")
        self.at("1.3")
        self.robot.press(["Head/Touch/Front"])
        self.at("2.1")
        self.robot.press([])
        self.program.kill()
        self.browser.reads("The console does not answer")
        self.program.start()
        self.browser.click("button", "Resume")  # the page has come back by itself
        self.at("2.2")
        other = self.browse()
        other.reads("wait for a word", "records bag", "records video", "records sound")
        while getattr(self.files.trial(TRIAL).state().current, "path", "") == "2.2":
            self.say("yes")
        self.browser.online(False)
        other.click(".nao-holder")
        other.click("button", "pleased")
        self.browser.online(True)
        other.reads("is finished")
        self.browser.reads("is finished")
        folder = self.files.trial(TRIAL)
        state = folder.state()
        self.assertEqual((state.values["head"], state.values["answer"], state.values["mood"]),
                         ("front head", "yes", "pleased"))  # fmt: skip
        self.assertEqual(
            {each["recording"] for each in state.files if not each.get("error")}, {"bag", "video", "sound"}
        )
        files = {path.name for path in folder.path.iterdir()}
        self.assertLessEqual({"events.csv", "trial.yaml", "trial.bag", "video.mp4", "sound.wav"}, files)
        other.open("/study/results")
        other.click("a", "replay")
        other.click("button", "Play")
        other.until(lambda: other.script("return (document.querySelector('video') || {}).currentTime > 0"), "the video")

    def test_pseudonym_conditions_and_notes_are_seen_on_the_pages(self):
        protocols = self.folder / "studies" / "protocols"
        (protocols / "two.yaml").write_text(
            "name: two\nfactors: {voice: {levels: [low, high]}}\n"
            "phases: [{steps: [{wizard: Well, choices: [good]}, {say: Hi}]}]\n"
        )
        self.browser.open("/study", protocol="two", participant="P02")
        self.browser.reads("Participant 2 (new), 2 trials in this order", "1. voice: high (next)")
        self.browser.click("button", "Start trial")
        self.browser.reads("trial 1")
        self.browser.open("/wizard")
        self.browser.type("input[aria-label='Note to the trial']", "looks away")
        self.browser.keys(Keys.ENTER)
        trial = self.files.trial("two/P02-1")
        wait_until(lambda: trial.state().note_texts == ["looks away"], LIMIT, "the note")
        self.browser.open("/study", protocol="two")
        self.browser.click("button", "Abort")
        self.browser.click("button", "Abort the trial")
        self.browser.reads("is aborted; 1 step: 1 stopped")
        self.browser.reads("P02: number 2, 1 trial")
        self.browser.type("input[aria-label='Right pseudonym of P02']", "P12")
        self.browser.click("[aria-label='Correct P02']")
        self.browser.click(".q-dialog button", "Correct")
        self.browser.reads("P12: number 2, 1 trial")
        self.assertEqual(self.files.participants("two"), {"P12": 2})
        self.browser.open("/study/results")
        self.browser.reads("Left out: two/P12-1 (aborted)")

    def test_a_stop_in_a_shell_pauses_the_trial(self):
        self.browser.open("/study", protocol=STUDY, participant="P01")
        self.browser.reads("One trial of ten steps")
        self.browser.click("button", "Start trial")
        self.at("1.3")
        stopped = subprocess.run(["nao", "stop"], capture_output=True, text=True, timeout=LIMIT, check=False)
        self.assertEqual(stopped.returncode, 0, stopped.stderr)
        self.browser.reads("paused")
        wait_until(lambda: self.files.trial(TRIAL).state().status == "paused", LIMIT, "the pause")

    def test_a_log_that_cannot_be_written_is_told_until_somebody_has_seen_that(self):
        self.browser.open("/study", protocol=STUDY, participant="P01")
        self.browser.reads("One trial of ten steps")
        self.browser.click("button", "Start trial")
        self.browser.reads("wait for a touch")
        self.at("1.3")
        folder = self.files.trial(TRIAL).path
        self.browser.type("input[aria-label='Note']", "looks away")
        self.program.limit_files((folder / EVENTS).stat().st_size)  # as a disk that is full
        self.browser.keys(Keys.ENTER)  # what is said of the disk moves buttons
        self.browser.reads("events wait in memory", "looks away")  # the note among them
        self.assertNotIn("looks away", (folder / EVENTS).read_text())
        self.program.limit_files(None)
        self.browser.reads("waited in memory, and were written then")
        self.assertIn("looks away", (folder / EVENTS).read_text())
        self.browser.click("button", "Seen")
        self.browser.until(lambda: not self.browser.all("[role=alert]", "waited in memory"), "what was seen to go")

    def test_who_looks_on_begins_no_trial(self):
        observer = ConsoleBrowser(self.program).enter(self.program.observer)
        self.addCleanup(observer.close)
        observer.open("/study")
        observer.type("input[aria-label='Participant (pseudonym)']", "P01")
        observer.click("button", "Start trial")
        observer.reads("observers look on")
        self.assertEqual(self.files.studies(), [])
