"""The examples that listen, turn and talk do what they show, and leave nothing behind; servers are made up here."""

from __future__ import annotations

import importlib.util
import math
import threading
import wave
from array import array
from pathlib import Path
from types import SimpleNamespace

import pytest
import rospy
from actionlib_msgs.msg import GoalStatus

from nao_library_modules.dialogue_record import load as load_turns
from nao_library_msgs.msg import AudioBuffer, HeardSound

EXAMPLES = Path(__file__).parents[3] / "nao_library_modules" / "examples"
IN, OUT, MOTION = "nao_audio_in", "nao_audio_out", "NaoMotion"


def load(name):
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class World:
    """Servers whose hearing ends when the person has spoken, a person, and a clock that both move on.

    Attributes:
        happened: (server or "person", function or text, message or place) in order.
        hears: Word that is heard for each question, "" for none.
        missed: So many first words are not heard, and the robot goes on listening.
    """

    def __init__(self, monkeypatch):
        self.happened, self.hears, self.options = [], ["", "yes"], []
        self.silent = self.interrupted = False
        self.missing_rad, self.missed, self.there, self.person_is_there, self.refused = 0.01, 0, True, True, ""
        self.state, self.text, self.now, self.listener = GoalStatus.SUCCEEDED, "", 100.0, None
        services = {"nao_sim/person_says": self, "nao_sim/advance": self.advance}
        client = "nao_library_modules.simple_action_client.SimpleActionClient"
        monkeypatch.setattr(client, lambda name, action: Client(self, name))
        monkeypatch.setattr("rospy.ServiceProxy", lambda name, service: services[name])
        monkeypatch.setattr("rospy.init_node", lambda *args, **options: None)
        monkeypatch.setattr("rospy.on_shutdown", lambda action: None)
        monkeypatch.setattr("rospy.sleep", self.sleep)
        monkeypatch.setattr("rospy.get_time", lambda: 5000.0 + 2.0 * self.now)  # the simulator is slower than ROS time
        monkeypatch.setattr("rospy.myargv", lambda: ["example.py", *self.options])

    def run(self, name, *options):
        self.options = options
        return load(name).main()

    def functions(self, server):
        return [what for name, what, _ in self.happened if name == server]

    def texts(self):
        return [message.str_param for name, _, message in self.happened if name == OUT]

    def sleep(self, duration):
        self.now += duration.to_sec() if isinstance(duration, rospy.Duration) else duration

    def advance(self, duration):
        assert duration.to_sec() == 0.0
        return SimpleNamespace(now=rospy.Time.from_sec(self.now))

    def wait_for_service(self, limit):
        if not self.person_is_there:
            raise rospy.ROSException("timeout exceeded")

    def __call__(self, text, place, voice, level_db):
        """The person says something."""
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
        sounds = [] if self.silent else [HeardSound(base_azimuth=0.4, confidence=0.9)]
        words = [word for word in [self.hears.pop(0)] if word] if function.function == "listen" else []
        memory = ["1.5", "0.0", str(self.missing_rad)]
        return SimpleNamespace(sounds=sounds, words=words, confidences=[0.8] * len(words), memList=memory)


class Client:
    """Tells its feedback from a thread of its own, as actionlib does."""

    def __init__(self, world, name):
        self.world, self.name = world, name
        self.state, self.result = GoalStatus.PENDING, None

    def wait_for_server(self, limit):
        return self.world.there

    def send_goal_and_wait(self, goal, limit=None):
        self._begin(goal)
        self.world.now += 1.0
        self.done = lambda: None
        self.end()
        return self.state

    def send_goal(self, goal, done_cb=lambda: None, feedback_cb=lambda told: None):
        self._begin(goal)
        name = self.function.function
        told = [SimpleNamespace(function=name, status=s) for s in (["", "ListenOn"] if name == "listen" else [""])]
        self.done = done_cb
        threading.Thread(target=lambda: [feedback_cb(each) for each in told], daemon=True).start()

    def wait_for_result(self, timeout=None):
        if self.world.interrupted and (self.name, "cancel", None) not in self.world.happened:
            raise KeyboardInterrupt
        return True

    def cancel_goal(self):
        self.state = GoalStatus.PREEMPTED
        self.world.happened.append((self.name, "cancel", None))

    def get_state(self):
        return self.state

    def get_result(self):
        return self.result

    def get_goal_status_text(self):
        return self.world.text

    def _begin(self, goal):
        self.state, self.function = GoalStatus.ACTIVE, goal.functions[0]
        self.world.happened.append((self.name, self.function.function, self.function))
        self.world.listener = self

    def end(self):
        self.result, self.state = self.world.answer(self.function), self.world.state
        self.done()


@pytest.fixture
def world(monkeypatch):
    return World(monkeypatch)


# --- the dialogue -----------------------------------------------------------------------------------------------------


def test_a_person_calls_is_turned_to_and_answers_each_question(world, capsys):
    assert world.run("dialogue", "--person", "yes", "--place", "0.5", "-0.5", "1.2") == 0
    turn, say, listen = (MOTION, "angleInterpolation"), (OUT, "say"), (IN, "listen")
    asked = [say, listen, ("person", "yes")]
    called = [(IN, "localizeSound"), ("person", "Hello, robot!"), turn]
    assert [event[:2] for event in world.happened] == [*called, *asked, *asked, say, turn]
    assert {place for name, _, place in world.happened if name == "person"} == {(0.5, -0.5, 1.2)}
    assert world.texts() == ["Shall we play?"] * 2 + ["Great!"] and "heard: yes (0.80)" in capsys.readouterr().out
    assert list(world.happened[-1][2].names) == ["HeadPitch"]


def test_the_head_shakes_around_the_direction_that_it_turned_to(world):
    world.hears = ["no"]
    assert world.run("dialogue", "--person", "no") == 0
    first, second = (function for name, _, function in world.happened if name == MOTION)
    assert (list(first.names), list(first.angles)) == (["HeadYaw"], pytest.approx([0.4]))
    assert (list(second.names), list(second.angles)) == (["HeadYaw"], pytest.approx([0.8, 0.0, 0.8, 0.4]))
    assert world.texts()[-1] == "What a pity."


def test_a_person_calls_until_the_robot_notices_and_one_that_nobody_hears_is_asked_all_the_same(world, capsys):
    world.missed, world.hears = 2, ["yes", "yes"]
    assert world.run("dialogue", "--person", "yes") == 0
    assert world.functions("person") == ["Hello, robot!"] * 3 + ["yes"]
    world.silent, world.happened = True, []
    assert world.run("dialogue", "--person", "yes") == 0
    assert "nobody calls" in capsys.readouterr().out and len(world.functions(MOTION)) == 1  # the nod


def test_the_log_tells_who_said_and_heard_what_when(world, tmp_path):
    world.hears = ["yes"]
    assert world.run("dialogue", "--person", "yes", "--record", "a.wav", "--log", str(tmp_path / "a.json")) == 0
    turns = load_turns(tmp_path / "a.json")
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
    assert times[:2] == [pytest.approx((0.8, 1.3)), pytest.approx((1.05, 1.05))]  # heard in the middle of it
    assert times[4:6] == [pytest.approx((4.1, 4.6)), pytest.approx((4.35, 4.35))]
    assert world.functions(IN)[0] == "startRecording" and world.happened[-1][1] == "stopRecording"
    assert world.happened[0][2].str_param == "a.wav"


def test_without_a_person_nothing_is_asked_of_a_simulator_and_with_none_there_nothing_begins(world, capsys):
    world.person_is_there = False
    assert world.run("dialogue") == 0
    assert world.functions("person") == [] and "localizeSound" not in world.functions(IN)
    world.happened, world.hears = [], ["", "", ""]
    assert world.run("dialogue") == 1 and world.texts()[-1] == "I did not hear you." and not world.functions(MOTION)
    world.happened = []
    assert world.run("dialogue", "--person", "yes", "--record", "a.wav") == 1
    output = capsys.readouterr().out
    assert "there is no simulator" in output and "leave out --person" in output and world.happened == []


def test_a_dialogue_that_breaks_off_leaves_a_log_and_no_recording_that_runs(world, tmp_path, capsys):
    world.refused = "there is no voice rms"
    assert world.run("dialogue", "--person", "yes", "--record", "a.wav", "--log", str(tmp_path / "a.json")) == 1
    assert "the person cannot speak: there is no voice rms" in capsys.readouterr().out
    assert world.functions(IN) == ["startRecording", "localizeSound", "cancel", "stopRecording"]
    assert load_turns(tmp_path / "a.json") == []


# --- other examples ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("state", [GoalStatus.PENDING, GoalStatus.ACTIVE])
def test_ctrl_c_ends_a_recording_whatever_is_known_of_its_goal(world, state):
    world.interrupted, world.state = True, state
    assert world.run("record_sound", "a.wav") == 1
    assert world.functions(IN)[-1] == "cancel"


@pytest.mark.parametrize("azimuth, elevation", [(0.0, 0.0), (1.2, 0.3), (-2.5, -0.2)])
def test_the_point_to_look_at_lies_where_the_sound_came_from(azimuth, elevation):
    sound = HeardSound(base_azimuth=azimuth, base_elevation=elevation)
    sound.head.x, sound.head.y, sound.head.z = 0.1, 0.2, 0.45
    function = load("turn_to_sound").look_there(sound)
    x, y, z = (part - start for part, start in zip(function.values, (0.1, 0.2, 0.45)))
    assert math.hypot(x, y, z) == pytest.approx(2.0)
    assert (math.atan2(y, x), math.atan2(z, math.hypot(x, y))) == pytest.approx((azimuth, elevation))


@pytest.mark.parametrize("missing, told", [(0.01, 0), (0.6, 2)])
def test_the_head_turns_to_each_sound_and_tells_what_it_cannot_reach(world, capsys, missing, told):
    world.missing_rad = missing
    assert world.run("turn_to_sound", "--times", "2") == 0
    assert [event[:2] for event in world.happened] == [(IN, "localizeSound"), (MOTION, "lookAt")] * 2
    output = capsys.readouterr().out
    assert output.count("a sound at 23 degrees, confidence 0.90") == 2
    assert output.count("34 degrees are missing") == told


@pytest.mark.parametrize("name, server", [("record_sound", IN), ("turn_to_sound", IN), ("dialogue", OUT)])
def test_what_goes_wrong_is_told_in_a_line_and_in_the_exit_status(world, capsys, name, server):
    options = ["a.wav"] if name == "record_sound" else []
    world.there = False
    assert world.run(name, *options) == 1
    assert f"there is no server {server}" in capsys.readouterr().out
    world.there, world.state, world.text = True, GoalStatus.ABORTED, "the robot is gone"
    assert world.run(name, *options) == 1
    assert "the robot is gone" in capsys.readouterr().out


def test_blocks_of_the_microphones_become_a_file_with_silence_where_some_are_missing(tmp_path):
    frames, recording = 1600, load("microphone_to_file").Recording(0.5, 16000)

    def take(number, channels=4, frequency=16000, value=None):
        samples = [number if value is None else value] * frames * channels
        message = AudioBuffer(frequency=frequency, channelMap=bytes(channels), data=samples)
        message.header.stamp = rospy.Time.from_sec(100.0 + 0.1 * number)
        recording.take(message)

    take(0, frequency=48000)  # from before the change of frequency
    assert recording.channels == 0
    for number in (1, 2, 5):
        assert not recording.complete.is_set()
        take(number, value=-3 if number == 2 else None)
    assert recording.complete.is_set()
    recording.write(str(tmp_path / "a.wav"))
    with wave.open(str(tmp_path / "a.wav")) as file:
        assert (file.getnchannels(), file.getframerate(), file.getnframes()) == (4, 16000, 8000)
        samples = list(array("h", file.readframes(8000)))
    part = 4 * frames
    assert samples == [1] * part + [-3] * part + [0] * 2 * part + [5] * part
