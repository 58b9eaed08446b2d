"""Examples that speak, against the module on stand-ins."""

from __future__ import annotations

import importlib.util
from types import SimpleNamespace

import pytest
from actionlib_msgs.msg import GoalStatus
from audio_out_goals import EXAMPLES, played, spoken
from fake_audio_out import NoModule


def load(name):
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class FakeClient:
    """A client whose goals are played by a module at once."""

    def __init__(self, module):
        self._server = module.server

    def wait_for_server(self, timeout=None):
        return True

    def send_goal(self, goal, feedback_cb=None):
        self._server.play(goal)
        for feedback in self._server.feedback:
            feedback_cb(feedback)

    def wait_for_result(self):
        return True

    def send_goal_and_wait(self, goal):
        self._server.play(goal)
        return self.get_state()

    def cancel_goal(self):
        pass

    def get_state(self):
        return GoalStatus.SUCCEEDED if self._server.end == "succeeded" else GoalStatus.ABORTED

    def get_goal_status_text(self):
        return self._server.text

    def get_result(self):
        return self._server.result


@pytest.fixture
def run_example(audio, monkeypatch, capsys):
    """Run an example with arguments against the module; its status and what it prints."""

    def run(name, *arguments):
        example = load(name)
        ros = SimpleNamespace(**vars(example.rospy))
        ros.init_node = ros.sleep = ros.on_shutdown = lambda *_, **__: None
        ros.myargv = lambda: [name, *arguments]
        monkeypatch.setattr(example, "rospy", ros)
        monkeypatch.setattr(example, "SimpleActionClient", lambda *_: FakeClient(audio))
        return example.main(), capsys.readouterr().out

    return run


def test_the_shortest_client_says_what_it_is_given(run_example, speech):
    assert run_example("hello") == (0, "said\n")
    assert run_example("hello", "I", "am", "Nao.") == (0, "said\n")
    assert [text for text, *_ in speech.said] == [("Hello, world!",), ("I am Nao.",)]


def test_the_shortest_client_tells_why_nothing_was_said(run_example, robot):
    robot.add("ALTextToSpeech", NoModule("ALTextToSpeech"))
    status, output = run_example("hello")
    assert status == 1 and "has no module 'ALTextToSpeech'" in output


def test_singing_and_talking_is_one_goal(run_example, robot, speech, player):
    player.quick = False
    status, output = run_example("sing_and_talk", "Hear me")
    assert status == 0
    assert output.split("\n") == ["", "refrain.wav: 1.5 s", ""]
    assert [call for call in spoken(robot) if call[0] == "say"] == [("say", "Hear me")]
    assert ("playFileInLoop", "refrain.wav", 0.25, 0.0) in played(robot)
    assert player.pending[0].done()
