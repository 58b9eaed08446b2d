"""Examples that speak and record, against the modules themselves."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import SimpleNamespace

import pytest
from actionlib_msgs.msg import GoalStatus
from sounds import loudness, played, tone, write

from nao_library_actions.msg import NaoAudioInGoal
from nao_library_modules.audio_in import NaoAudioInput

EXAMPLES = Path(__file__).parents[3] / "nao_library_modules" / "examples"


def load(name):
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class Client:
    """A client whose goals a module plays at once."""

    def __init__(self, goals):
        self._goals = goals
        self.wait_for_server = self.wait_for_result = lambda *_: True

    def send_goal(self, goal, feedback_cb=lambda told: None):
        self._goal = self._goals.play(*goal.functions)
        for told in self._goal.feedback:
            feedback_cb(told)

    def send_goal_and_wait(self, goal):
        self.send_goal(goal)
        return self.get_state()

    def get_state(self):
        return GoalStatus.SUCCEEDED if self._goal.state == "succeeded" else GoalStatus.ABORTED

    def get_goal_status_text(self):
        return self._goal.text

    def get_result(self):
        return self._goal.result


@pytest.fixture
def run_example(monkeypatch, capsys):
    """Run an example with arguments against a module; its status and what it prints."""

    def run(goals, name, *arguments):
        example = load(name)
        ros = SimpleNamespace(**vars(example.rospy))
        ros.init_node = ros.sleep = ros.on_shutdown = lambda *_, **__: None
        ros.myargv = lambda: [name, *arguments]
        monkeypatch.setattr(example, "rospy", ros)
        monkeypatch.setattr(example, "SimpleActionClient", lambda *_: Client(goals))
        return example.main(), capsys.readouterr().out

    return run


def test_the_shortest_client_says_what_it_is_given_or_why_it_cannot(robot, audio, bent_audio, run_example):
    said = []
    robot.server.memory.listen("ALTextToSpeech/CurrentSentence", said.append)
    assert run_example(audio, "hello") == run_example(audio, "hello", "I", "am", "Nao.") == (0, "said\n")
    assert [text for text in said if text] == ["Hello, world!", "I am Nao."]
    silent = bent_audio({("ALTextToSpeech", None): lambda *_: ("ALSilence", "ping", ())})
    status, output = run_example(silent, "hello")
    assert status == 1 and "has no module 'ALSilence'" in output


def test_singing_and_talking_is_one_goal(robot, audio, run_example):
    write(robot, "refrain.wav", tone(440.0, 0.5))
    begun = robot.now.time
    status, output = run_example(audio, "sing_and_talk", "Hear me")
    assert status == 0 and "refrain.wav: " in output
    ended = robot.now.time
    robot.advance(0.5)
    assert loudness(played(robot, begun + 0.3, ended - 0.2)) > 0.05 and not played(robot, ended + 0.05).any()


def test_what_is_recorded_is_a_chain_that_the_server_takes(robot, goals_to):
    robot.ALSpeechRecognition.setAudioExpression(False)
    ears = goals_to(NaoAudioInput, NaoAudioInGoal)
    for everything, rate in ((False, 16000), (True, 48000)):
        result = ears.succeed(*load("record_sound").chain("a.wav", 1.0, everything))
        assert (result.files[0].rate, len(result.energies)) == (rate, 4)
        assert result.files[0].duration == pytest.approx(1.0, abs=0.05)
