"""The dialogue with a person who is in the simulated world, and what it leaves behind."""

from __future__ import annotations

import importlib.util
import threading
from pathlib import Path
from types import SimpleNamespace

import pytest
import rospy
from actionlib_msgs.msg import GoalStatus

from nao_library_modules.dialogue_record import load as load_turns
from nao_library_msgs.msg import HeardSound

EXAMPLE = Path(__file__).parents[3] / "nao_library_modules" / "examples" / "dialogue.py"


class FakeWorld:
    """Servers whose hearing ends when the person has spoken, a person, and a clock that both move on."""

    def __init__(self, monkeypatch):
        self.happened = []
        self.hears = ["", "yes"]  # one a question
        self.silent = False
        self.missed = 0  # so many first words are not heard, and the robot goes on listening
        self.person_is_there = True
        self.refused = ""
        self.now = 100.0
        self.options = []
        self.listener = None
        monkeypatch.setattr(
            "nao_library_modules.simple_action_client.SimpleActionClient", lambda name, action: FakeClient(self, name)
        )
        services = {"nao_sim/person_says": self, "nao_sim/advance": self.advance}
        monkeypatch.setattr("rospy.ServiceProxy", lambda name, service: services[name])
        monkeypatch.setattr("rospy.init_node", lambda *args, **options: None)
        monkeypatch.setattr("rospy.sleep", self.sleep)
        monkeypatch.setattr("rospy.get_time", lambda: 5000.0 + 2.0 * self.now)  # the simulator is slower than ROS time
        monkeypatch.setattr("rospy.myargv", lambda: ["dialogue.py", *self.options])

    def sleep(self, duration):
        self.now += duration.to_sec() if isinstance(duration, rospy.Duration) else duration

    def advance(self, duration):
        assert duration.to_sec() == 0.0
        return SimpleNamespace(now=rospy.Time.from_sec(self.now))

    def wait_for_service(self, limit):
        if not self.person_is_there:
            raise rospy.ROSException("timeout exceeded")

    def __call__(self, text, place, voice, level_db):
        if self.refused:
            return SimpleNamespace(success=False, message=self.refused)
        self.happened.append(("person", text, (place.x, place.y, place.z)))
        self.now += 0.25
        self.missed -= 1
        if self.missed < 0:
            self.listener.end()
        self.now += 0.25
        return SimpleNamespace(success=True, message="")

    def answer(self, function):
        if function.function == "localizeSound":
            sounds = [] if self.silent else [HeardSound(base_azimuth=0.4, confidence=0.9)]
            return SimpleNamespace(sounds=sounds)
        words = [word for word in [self.hears.pop(0)] if word] if function.function == "listen" else []
        return SimpleNamespace(words=words, confidences=[0.8] * len(words))

    def functions(self, server):
        return [what for name, what, _ in self.happened if name == server]


class FakeClient:
    """Tells its feedback from a thread of its own, as actionlib does."""

    def __init__(self, world, name):
        self.world, self.name = world, name
        self.state, self.result = GoalStatus.PENDING, None

    def wait_for_server(self, limit):
        return True

    def send_goal_and_wait(self, goal, limit):
        self._begin(goal)
        self.world.now += 1.0
        self.done = lambda: None
        self.end()

    def send_goal(self, goal, done_cb, feedback_cb):
        self._begin(goal)
        name = self.function.function
        status = ["", "Idle", "ListenOn"] if name == "listen" else [""]
        told = [SimpleNamespace(function=name, status=each) for each in status]
        self.done = done_cb
        threading.Thread(target=lambda: [feedback_cb(each) for each in told], daemon=True).start()

    def cancel_goal(self):
        self.state = GoalStatus.PREEMPTED
        self.world.happened.append((self.name, "cancel", None))

    def get_state(self):
        return self.state

    def get_result(self):
        return self.result

    def get_goal_status_text(self):
        return ""

    def _begin(self, goal):
        self.state, (self.function,) = GoalStatus.ACTIVE, goal.functions
        self.world.happened.append((self.name, self.function.function, self.function))
        self.world.listener = self

    def end(self):
        self.result, self.state = self.world.answer(self.function), GoalStatus.SUCCEEDED
        self.done()


@pytest.fixture
def world(monkeypatch):
    return FakeWorld(monkeypatch)


def run(world, *options):
    spec = importlib.util.spec_from_file_location("dialogue", EXAMPLE)
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    world.options = options
    return example.main()


def test_a_person_calls_is_turned_to_and_answers_each_question(world):
    assert run(world, "--person", "yes", "--place", "0.5", "-0.5", "1.2") == 0
    assert [(name, what) for name, what, _ in world.happened] == [
        ("nao_audio_in", "localizeSound"),
        ("person", "Hello, robot!"),
        ("NaoMotion", "angleInterpolation"),
        ("nao_audio_out", "say"),
        ("nao_audio_in", "listen"),
        ("person", "yes"),
        ("nao_audio_out", "say"),
        ("nao_audio_in", "listen"),
        ("person", "yes"),
        ("nao_audio_out", "say"),
        ("NaoMotion", "angleInterpolation"),
    ]
    assert {place for name, _, place in world.happened if name == "person"} == {(0.5, -0.5, 1.2)}


def test_the_head_shakes_around_the_direction_that_it_turned_to(world):
    world.hears = ["no"]
    assert run(world, "--person", "no") == 0
    first, second = (function for name, _, function in world.happened if name == "NaoMotion")
    assert (list(first.names), list(first.angles)) == (["HeadYaw"], pytest.approx([0.4]))
    assert (list(second.names), list(second.angles)) == (["HeadYaw"], pytest.approx([0.8, 0.0, 0.8, 0.4]))


def test_a_robot_that_hears_no_call_asks_all_the_same(world, capsys):
    world.silent, world.hears = True, ["yes"]
    assert run(world, "--person", "yes") == 0
    assert "nobody calls" in capsys.readouterr().out
    assert len(world.functions("NaoMotion")) == 1  # the nod


def test_a_person_calls_until_the_robot_notices(world):
    world.missed, world.hears = 2, ["yes"]
    assert run(world, "--person", "yes") == 0
    assert world.functions("person") == ["Hello, robot!"] * 3 + ["yes"]
    assert world.functions("nao_audio_in") == ["localizeSound", "listen"]


def test_the_log_tells_who_said_and_heard_what_when(world, tmp_path):
    path = tmp_path / "a.json"
    world.hears = ["yes"]
    assert run(world, "--person", "yes", "--record", "a.wav", "--log", str(path)) == 0
    turns = load_turns(path)
    assert [(turn.who, turn.what, turn.title) for turn in turns] == [
        ("person", "says", "Hello, robot!"),
        ("robot", "hears", "a voice at 23° (0.90)"),
        ("robot", "does", "turns its head"),
        ("robot", "says", "Shall we play?"),
        ("person", "says", "yes"),
        ("robot", "hears", "yes (0.80)"),
        ("robot", "says", "Great!"),
        ("robot", "does", "nods"),
    ]
    # A person takes 0.8 s before words of 0.5 s, the robot 1 s for everything; counted from the recording's begin.
    times = [(turn.began, turn.ended) for turn in turns]
    # What is heard is known in the middle of it.
    assert times[:2] == [pytest.approx((0.8, 1.3)), pytest.approx((1.05, 1.05))]
    assert times[4:6] == [pytest.approx((4.1, 4.6)), pytest.approx((4.35, 4.35))]
    assert world.functions("nao_audio_in")[0] == "startRecording" and world.happened[-1][1] == "stopRecording"
    assert world.happened[0][2].str_param == "a.wav"


def test_without_a_person_nothing_is_asked_of_a_simulator(world):
    world.person_is_there = False
    assert run(world) == 0
    assert world.functions("person") == [] and "localizeSound" not in world.functions("nao_audio_in")


def test_a_person_on_a_robot_is_refused_before_anything_begins(world, capsys):
    world.person_is_there = False
    assert run(world, "--person", "yes", "--record", "a.wav") == 1
    output = capsys.readouterr().out
    assert "there is no simulator" in output and "leave out --person" in output
    assert world.happened == []


def test_a_person_who_cannot_speak_ends_the_dialogue_and_the_listening(world, capsys):
    world.refused = "there is no voice rms"
    assert run(world, "--person", "yes") == 1
    assert "the person cannot speak: there is no voice rms" in capsys.readouterr().out
    assert world.functions("nao_audio_in") == ["localizeSound", "cancel"]


def test_a_dialogue_that_breaks_off_leaves_a_log_and_no_recording_that_runs(world, tmp_path):
    world.refused = "there is no voice rms"
    assert run(world, "--person", "yes", "--record", "a.wav", "--log", str(tmp_path / "a.json")) == 1
    assert world.functions("nao_audio_in") == ["startRecording", "localizeSound", "cancel", "stopRecording"]
    assert load_turns(tmp_path / "a.json") == []
