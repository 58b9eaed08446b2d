"""The examples for hearing do what they show."""

from __future__ import annotations

import importlib.util
import math
from pathlib import Path
from types import SimpleNamespace

import pytest
from actionlib_msgs.msg import GoalStatus
from fake_hearing import Ears, HearingClock

from nao_library_actions.msg import NaoAudioInGoal
from nao_library_msgs.msg import HeardSound

EXAMPLES = Path(__file__).parents[3] / "nao_library_modules" / "examples"


def load(name):
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class FakeClients:
    """Servers that are there or not; what they answer, by name; what they were asked."""

    def __init__(self):
        self.there = True
        self.state = GoalStatus.SUCCEEDED
        self.text = ""
        self.answers = {}
        self.played = []
        self.interrupted = False
        self.canceled = []

    def client(self, name, action):
        def play(goal, timeout=None):
            self.played += [(name, function) for function in goal.functions]
            return self.state

        def wait(timeout):
            if self.interrupted and not self.canceled:
                raise KeyboardInterrupt
            return True

        def result():
            answers = self.answers.get(name, [])
            return answers.pop(0) if answers else None

        return SimpleNamespace(
            wait_for_server=lambda limit: self.there,
            send_goal_and_wait=play,
            send_goal=play,
            wait_for_result=wait,
            get_state=lambda: self.state,
            get_goal_status_text=lambda: self.text,
            get_result=result,
            cancel_goal=lambda: self.canceled.append(name),
        )


@pytest.fixture
def clients(monkeypatch):
    made = FakeClients()
    monkeypatch.setattr("nao_library_modules.simple_action_client.SimpleActionClient", made.client)
    monkeypatch.setattr("rospy.init_node", lambda *args, **options: None)
    monkeypatch.setattr("rospy.sleep", lambda duration: None)
    monkeypatch.setattr("rospy.get_time", lambda: 100.0)
    monkeypatch.setattr("rospy.on_shutdown", lambda action: None)
    monkeypatch.setattr("rospy.myargv", lambda: ["example.py"])
    return made


def heard(*words):
    return SimpleNamespace(words=list(words), confidences=[0.8] * len(words))


def test_what_is_recorded_is_a_chain_that_the_server_takes(robot, edge):
    from nao_library_modules.audio_in import NaoAudioInput

    ears = Ears(robot)
    edge.clock = HearingClock()
    hearing = NaoAudioInput("10.0.0.7", 9559, robot=robot, edge=edge)
    for everything, rate in ((False, 16000), (True, 48000)):
        server = hearing.server.play(NaoAudioInGoal(load("record_sound").chain("a.wav", 2.0, everything)))
        assert server.end == "succeeded", server.text
        assert (server.result.files[0].rate, server.result.files[0].duration) == (rate, 2.0)
        assert len(server.result.energies) == 4 and ears.idle()


@pytest.mark.parametrize("state", [GoalStatus.PENDING, GoalStatus.ACTIVE])
def test_ctrl_c_ends_a_recording_whatever_is_known_of_its_goal(clients, monkeypatch, capsys, state):
    monkeypatch.setattr("rospy.myargv", lambda: ["record_sound.py", "a.wav"])
    clients.interrupted, clients.state = True, state
    assert load("record_sound").main() == 1
    assert clients.canceled == ["nao_audio_in"]


@pytest.mark.parametrize("azimuth, elevation", [(0.0, 0.0), (1.2, 0.3), (-2.5, -0.2)])
def test_the_point_to_look_at_lies_where_the_sound_came_from(azimuth, elevation):
    sound = HeardSound(base_azimuth=azimuth, base_elevation=elevation)
    sound.head.x, sound.head.y, sound.head.z = 0.1, 0.2, 0.45
    function = load("turn_to_sound").look_there(sound)
    x, y, z = (part - start for part, start in zip(function.values, (0.1, 0.2, 0.45)))
    assert math.hypot(x, y, z) == pytest.approx(2.0)
    assert (math.atan2(y, x), math.atan2(z, math.hypot(x, y))) == pytest.approx((azimuth, elevation))


def test_the_head_turns_to_each_sound_and_tells_what_it_cannot_reach(clients, monkeypatch, capsys):
    monkeypatch.setattr("rospy.myargv", lambda: ["turn_to_sound.py", "--times", "2"])
    sound = SimpleNamespace(sounds=[HeardSound(base_azimuth=math.pi / 2, confidence=0.7)])
    clients.answers = {
        "nao_audio_in": [sound] * 2,
        "NaoMotion": [SimpleNamespace(memList=["1.5", "0.0", missing]) for missing in ("0.01", "0.6")],
    }
    assert load("turn_to_sound").main() == 0
    assert [(name, f.function) for name, f in clients.played] == [
        ("nao_audio_in", "localizeSound"),
        ("NaoMotion", "lookAt"),
    ] * 2
    output = capsys.readouterr().out
    assert output.count("a sound at 90 degrees, confidence 0.70") == 2
    assert output.count("34 degrees are missing") == 1


@pytest.mark.parametrize("word, reply, joint", [("yes", "Great!", "HeadPitch"), ("no", "What a pity.", "HeadYaw")])
def test_the_dialogue_asks_until_it_is_answered(clients, capsys, word, reply, joint):
    clients.answers = {"nao_audio_in": [heard(), heard(word)]}
    assert load("dialogue").main() == 0
    said = [f.str_param for name, f in clients.played if name == "nao_audio_out"]
    assert said == ["Shall we play?"] * 2 + [reply]
    assert [f.names for name, f in clients.played if name == "NaoMotion"] == [[joint]]
    assert f"heard: {word} (0.80)" in capsys.readouterr().out


def test_a_dialogue_that_nobody_answers_ends(clients):
    clients.answers = {"nao_audio_in": [heard()] * 3}
    assert load("dialogue").main() == 1
    assert [f.str_param for name, f in clients.played if name == "nao_audio_out"][-1] == "I did not hear you."
    assert "NaoMotion" not in [name for name, _ in clients.played]


@pytest.mark.parametrize("name, server", [("record_sound", "in"), ("turn_to_sound", "in"), ("dialogue", "out")])
def test_what_goes_wrong_is_told_in_a_line_and_in_the_exit_status(clients, monkeypatch, capsys, name, server):
    monkeypatch.setattr("rospy.myargv", lambda: [name, "a.wav"] if name == "record_sound" else [name])
    example = load(name)
    clients.there = False
    assert example.main() == 1
    assert f"there is no server nao_audio_{server}" in capsys.readouterr().out
    clients.there, clients.state, clients.text = True, GoalStatus.ABORTED, "the robot is gone"
    assert example.main() == 1
    assert "the robot is gone" in capsys.readouterr().out
