"""The dialogue keeps what was said and leaves nothing behind; sounds are turned to; microphones go into a file."""

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
    """Servers that take 1 s for everything, hearing that ends when a person has spoken, and their clock.

    Attributes:
        happened: (server or "person", function or text, message or place) in order.
        hears: Word that is heard for each question, "" for none.
        missed: So many first words are not heard, and the robot goes on listening.
    """

    def __init__(self, monkeypatch):
        self.happened, self.hears, self.options = [], ["", "yes"], []
        self.missed, self.now, self.listener, self.wait_for_service = 0, 100.0, None, lambda limit: None
        services = {"nao_sim/person_says": self, "nao_sim/advance": self.advance}
        client = "nao_library_modules.simple_action_client.SimpleActionClient"
        monkeypatch.setattr(client, lambda name, action: Client(self, name))
        monkeypatch.setattr("rospy.ServiceProxy", lambda name, service: services[name])
        monkeypatch.setattr("rospy.init_node", lambda *args, **options: None)
        monkeypatch.setattr("rospy.sleep", self.sleep)
        monkeypatch.setattr("rospy.get_time", lambda: 5000.0 + 2.0 * self.now)  # the simulator is slower than ROS time
        monkeypatch.setattr("rospy.myargv", lambda: ["dialogue.py", *self.options])

    def run(self, *options):
        self.options = options
        return load("dialogue").main()

    def texts(self):
        return [message.str_param for name, _, message in self.happened if name == OUT]

    def sleep(self, duration):
        self.now += duration.to_sec() if isinstance(duration, rospy.Duration) else duration

    def advance(self, duration):
        assert duration.to_sec() == 0.0
        return SimpleNamespace(now=rospy.Time.from_sec(self.now))

    def __call__(self, text, place, voice, level_db):
        self.happened.append(("person", text, (place.x, place.y, place.z)))
        self.now += 0.25
        self.missed -= 1
        if self.missed < 0:
            self.listener.end()
        self.now += 0.25
        return SimpleNamespace(success=True, message="")


class Client:
    """Tells its feedback from a thread of its own, as actionlib does."""

    def __init__(self, world, name):
        self.world, self.name, self.state, self.result = world, name, GoalStatus.PENDING, None
        self.get_state, self.get_result, self.get_goal_status_text = lambda: self.state, lambda: self.result, str
        self.wait_for_server = lambda limit: True

    def send_goal_and_wait(self, goal, limit):
        self._begin(goal, lambda: None)
        self.world.now += 1.0
        self.end()

    def send_goal(self, goal, done_cb, feedback_cb):
        self._begin(goal, done_cb)
        told = [SimpleNamespace(status=status) for status in ("", "ListenOn")]
        threading.Thread(target=lambda: [feedback_cb(each) for each in told], daemon=True).start()

    def _begin(self, goal, done):
        self.state, (self.function,), self.done = GoalStatus.ACTIVE, goal.functions, done
        self.world.happened.append((self.name, self.function.function, self.function))
        self.world.listener = self

    def end(self):
        words = [word for word in [self.world.hears.pop(0)] if word] if self.function.function == "listen" else []
        sounds = [HeardSound(base_azimuth=0.4, confidence=0.9)]
        self.result = SimpleNamespace(sounds=sounds, words=words, confidences=[0.8] * len(words))
        self.state = GoalStatus.SUCCEEDED
        self.done()


@pytest.fixture
def world(monkeypatch):
    return World(monkeypatch)


def test_a_person_calls_until_it_is_noticed_and_answers_each_question_with_a_gesture(world):
    world.missed = 1
    assert world.run("--person", "yes", "--place", "0.5", "-0.5", "1.2") == 0
    turn, say, listen = (MOTION, "angleInterpolation"), (OUT, "say"), (IN, "listen")
    asked, called = [say, listen, ("person", "yes")], [(IN, "localizeSound"), *[("person", "Hello, robot!")] * 2, turn]
    assert [event[:2] for event in world.happened] == [*called, *asked, *asked, say, turn]
    assert {place for name, _, place in world.happened if name == "person"} == {(0.5, -0.5, 1.2)}
    assert world.texts() == ["Shall we play?"] * 2 + ["Great!"] and list(world.happened[-1][2].names) == ["HeadPitch"]
    world.happened, world.hears = [], ["no"]
    assert world.run("--person", "no") == 0 and world.texts()[-1] == "What a pity."
    first, second = (function for name, _, function in world.happened if name == MOTION)
    assert (list(first.names), list(first.angles)) == (["HeadYaw"], pytest.approx([0.4]))
    assert (list(second.names), list(second.angles)) == (["HeadYaw"], pytest.approx([0.8, 0.0, 0.8, 0.4]))


def test_the_log_tells_who_said_and_heard_what_when(world, tmp_path):
    world.hears = ["yes"]
    assert world.run("--person", "yes", "--record", "a.wav", "--log", str(tmp_path / "a.json")) == 0
    # A person takes 0.8 s before words of 0.5 s, the robot 1 s for everything; what is heard is known in their middle.
    assert [(turn.who, turn.what, turn.title, turn.began, turn.ended) for turn in load_turns(tmp_path / "a.json")] == [
        ("person", "says", "Hello, robot!", pytest.approx(0.8), pytest.approx(1.3)),
        ("robot", "hears", "a voice at 23° (0.90)", pytest.approx(1.05), pytest.approx(1.05)),
        ("robot", "does", "turns its head", pytest.approx(1.3), pytest.approx(2.3)),
        ("robot", "says", "Shall we play?", pytest.approx(2.3), pytest.approx(3.3)),
        ("person", "says", "yes", pytest.approx(4.1), pytest.approx(4.6)),
        ("robot", "hears", "yes (0.80)", pytest.approx(4.35), pytest.approx(4.35)),
        ("robot", "says", "Great!", pytest.approx(4.6), pytest.approx(5.6)),
        ("robot", "does", "nods", pytest.approx(5.6), pytest.approx(6.6)),
    ]
    assert world.happened[0][1] == "startRecording" and world.happened[-1][1] == "stopRecording"


@pytest.mark.parametrize("azimuth, elevation", [(0.0, 0.0), (1.2, 0.3), (-2.5, -0.2)])
def test_the_point_to_look_at_lies_where_the_sound_came_from(azimuth, elevation):
    sound = HeardSound(base_azimuth=azimuth, base_elevation=elevation)
    sound.head.x, sound.head.y, sound.head.z = 0.1, 0.2, 0.45
    function = load("turn_to_sound").look_there(sound)
    x, y, z = (part - start for part, start in zip(function.values, (0.1, 0.2, 0.45)))
    assert math.hypot(x, y, z) == pytest.approx(2.0)
    assert (math.atan2(y, x), math.atan2(z, math.hypot(x, y))) == pytest.approx((azimuth, elevation))


def test_blocks_of_the_microphones_become_a_file_with_silence_where_some_are_missing(tmp_path):
    frames, recording = 1600, load("microphone_to_file").Recording(0.5, 16000)

    def take(number, value, frequency=16000):
        message = AudioBuffer(frequency=frequency, channelMap=bytes(4), data=[value] * frames * 4)
        message.header.stamp = rospy.Time.from_sec(100.0 + 0.1 * number)
        recording.take(message)

    take(0, 9, frequency=48000)  # from before the change of frequency
    assert recording.channels == 0
    for number, value in ((1, 1), (2, -3), (5, 5)):
        assert not recording.complete.is_set()
        take(number, value)
    assert recording.complete.is_set()
    recording.write(str(tmp_path / "a.wav"))
    with wave.open(str(tmp_path / "a.wav")) as file:
        assert (file.getnchannels(), file.getframerate(), file.getnframes()) == (4, 16000, 8000)
        samples = list(array("h", file.readframes(8000)))
    assert samples == [1] * 4 * frames + [-3] * 4 * frames + [0] * 8 * frames + [5] * 4 * frames
