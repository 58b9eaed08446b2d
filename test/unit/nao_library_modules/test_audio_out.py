"""The audio module on stand-ins: what is called, what goes back, what is silenced, what is told."""

from __future__ import annotations

import importlib.util
import threading
from pathlib import Path
from types import SimpleNamespace

import pytest
from actionlib_msgs.msg import GoalStatus
from fake_audio_out import FakeAnimatedSpeech, FakeAudioDevice, FakePlayer, FakeSpeech, NoModule
from genpy import Duration

from nao_library_actions.msg import NaoAudioOutGoal
from nao_library_modules.audio import NaoAudio
from nao_library_modules.nao_basic import NaoBasic
from nao_library_msgs.msg import AudioOutFunction
from naoqi.errors import RobotError

LIMIT = 5.0
EXAMPLES = Path(__file__).parents[3] / "nao_library_modules" / "examples"
WORD, SENTENCE = "ALTextToSpeech/CurrentWord", "ALTextToSpeech/CurrentSentence"


@pytest.fixture
def speech(robot, make_call):
    speech = FakeSpeech(make_call)
    robot.add("ALTextToSpeech", speech)
    robot.add("ALAnimatedSpeech", FakeAnimatedSpeech(speech))
    return speech


@pytest.fixture
def player(robot, make_call):
    player = FakePlayer(make_call)
    robot.add("ALAudioPlayer", player)
    return player


@pytest.fixture
def device(robot):
    device = FakeAudioDevice()
    robot.add("ALAudioDevice", device)
    return device


@pytest.fixture
def audio(robot, edge, speech, player, device):
    from nao_library_modules.audio_out import NaoAudioOutput

    return NaoAudioOutput("10.0.0.7", 9559, robot=robot, edge=edge)


def f(function, text="", **fields):
    return AudioOutFunction(function=function, str_param=text, **fields)


def play(audio, *functions):
    return audio.server.play(NaoAudioOutGoal(list(functions)))


def in_background(audio, sounding, *functions):
    """Play a chain in a thread until something sounds; the thread."""
    sounding.quick = False
    sounding.started.clear()
    thread = audio.server.play_in_background(NaoAudioOutGoal(list(functions)))
    assert sounding.started.wait(LIMIT)
    return thread


def ended(thread, audio):
    thread.join(LIMIT)
    assert not thread.is_alive(), "the goal goes on"
    return audio.server


def calls(robot, module):
    """Calls of a module that change something or sound, in order."""
    return [call for call in robot.proxy(module).calls if not call[0].startswith(("get", "is", "list"))]


def spoken(robot):
    return calls(robot, "ALTextToSpeech")


def played(robot):
    return calls(robot, "ALAudioPlayer")


# Speaking


def test_the_module_is_of_both_families(audio):
    assert isinstance(audio, NaoBasic) and isinstance(audio, NaoAudio)


def test_a_text_is_said_as_it_is(audio, robot, device):
    server = play(audio, f("say", "Hello, world!"))
    assert server.end == "succeeded", server.text
    assert spoken(robot) == [("say", "Hello, world!")]
    assert (server.result.volume, server.result.memList) == (60.0, [])


def test_a_goal_lasts_as_long_as_its_texts_which_follow_each_other(audio, speech):
    thread = in_background(audio, speech, f("say", "one"), f("say", "two"))
    assert [text for text, *_ in speech.said] == [("one",)]
    speech.started.clear()
    speech.pending[0].end()
    assert speech.started.wait(LIMIT)
    assert thread.is_alive()
    speech.pending[1].end()
    assert ended(thread, audio).end == "succeeded"
    assert [text for text, *_ in speech.said] == [("one",), ("two",)]


def test_speed_and_pitch_are_tags_and_a_language_goes_with_the_text(audio, robot):
    play(audio, f("say", "Bonjour", language="French", speed=80, pitch=120))
    assert spoken(robot) == [("say", "\\rspd=80\\\\vct=120\\ Bonjour", "French")]


def test_voice_and_volume_of_a_text_go_back_when_it_is_said(audio, speech, robot):
    play(audio, f("say", "Bonjour", voice="naofrf", volume=0.25))
    assert speech.said == [(("Bonjour",), "naofrf", 0.25)]
    assert (speech.voice, speech.volume) == ("naoenu", 0.75)


def test_voice_and_volume_go_back_when_a_text_is_preempted(audio, speech):
    thread = in_background(audio, speech, f("say", "Bonjour", voice="naofrf", volume=0.25))
    assert (speech.voice, speech.volume) == ("naofrf", 0.25)
    audio.server.preempt()
    assert ended(thread, audio).end == "preempted"
    assert (speech.voice, speech.volume) == ("naoenu", 0.75)


def test_preemption_ends_the_text_of_this_goal_alone(audio, speech):
    thread = in_background(audio, speech, f("say", "a long story"))
    audio.server.preempt()
    server = ended(thread, audio)
    assert (server.end, server.text) == ("preempted", "preempted in function 1 (say)")
    assert speech.pending[0].canceled
    assert speech.stops == 0, "what others say was silenced as well"


def test_a_robot_that_cannot_cancel_a_call_is_silenced_as_a_whole(audio, speech, monkeypatch):
    thread = in_background(audio, speech, f("say", "a long story"))
    monkeypatch.setattr(speech.pending[0], "cancel", lambda: None)
    audio.server.preempt()
    assert ended(thread, audio).end == "preempted"
    assert speech.stops == 1


def test_gestures_of_a_text(audio, robot):
    play(audio, f("animatedSay", "^start(animations/Stand/Gestures/Hey_1) Hey", body_language="random", speed=90))
    play(audio, f("animatedSay", "Hey"))
    text = "\\rspd=90\\ ^start(animations/Stand/Gestures/Hey_1) Hey"
    said = [call for call in calls(robot, "ALAnimatedSpeech") if call[0] == "say"]
    assert said == [("say", text, {"bodyLanguageMode": "random"}), ("say", "Hey")]


def test_a_text_in_a_file_tells_its_length(audio, robot):
    server = play(audio, f("sayToFile", "Hello", file_name="hello.wav", voice="naofrf"))
    assert spoken(robot)[1] == ("sayToFile", "Hello", "hello.wav")
    assert server.result.memList == ["1.5"]
    assert (server.result.files, server.result.durations) == (["hello.wav"], [1.5])
    assert robot.proxy("ALAudioPlayer").calls[-1][0] == "unloadFile"


# Words


def test_words_are_fed_back_as_they_are_spoken(audio, speech, robot):
    thread = in_background(audio, speech, f("getVoice"), f("say", "Hello, world!"))
    robot.memory.signals[SENTENCE]("Hello, world!")
    robot.memory.signals[WORD]("Hello")
    robot.memory.signals[WORD]("world")
    robot.memory.signals[WORD]("")
    speech.pending[0].end()
    server = ended(thread, audio)
    told = [(each.index, each.function, each.count, each.word, each.sentence) for each in server.feedback]
    assert told == [
        (0, "getVoice", 2, "", ""),
        (1, "say", 2, "", ""),
        (1, "say", 2, "Hello", "Hello, world!"),
        (1, "say", 2, "world", "Hello, world!"),
    ]


def test_words_of_others_are_not_fed_back(audio, robot):
    play(audio, f("say", "Hello"))
    before = len(audio.server.feedback)
    robot.memory.signals[WORD]("gossip")
    assert len(audio.server.feedback) == before


def test_words_of_a_text_in_the_background_are_fed_back_with_the_function_that_runs(audio, speech, robot):
    thread = in_background(audio, speech, f("say", "la la la", background=True), f("waitUntilSilent"))
    robot.memory.signals[WORD]("la")
    speech.pending[0].end()
    server = ended(thread, audio)
    assert server.end == "succeeded"
    assert [each.word for each in server.feedback if each.word] == ["la"]


def test_events_are_subscribed_again_after_a_reconnection_and_given_up_at_the_end(audio, robot):
    play(audio, f("say", "Hello"))
    robot.connection.become("lost", "no answer")
    robot.memory.signals.clear()
    robot.connection.become("connected")
    assert set(robot.memory.signals) == {WORD, SENTENCE}
    audio.shut_down()
    assert [len(signal.links) for signal in robot.memory.signals.values()] == [0, 0]


# Sounds


def test_a_file_is_played_with_volume_and_direction_if_they_are_given(audio, robot):
    server = play(
        audio,
        f("playFile", "ding.wav"),
        f("playFile", "ding.wav", pan=-1.0),
        f("playFile", "ding.wav", volume=0.5),
        f("playFileFromPosition", "ding.wav", position=0.5),
        f("playSine", frequency=440, duration=1.0, volume=0.5, pan=1),
        f("playWebStream", "http://radio.example/live", volume=0.5),
        f("playSoundSetFile", "Bips", file_name="ding"),
        f("playSoundSetFile", file_name="ding", volume=0.5),
    )
    assert server.end == "succeeded", server.text
    assert played(robot) == [
        ("playFile", "ding.wav"),
        ("playFile", "ding.wav", 1.0, -1.0),
        ("playFile", "ding.wav", 0.5, 0.0),
        ("playFileFromPosition", "ding.wav", 0.5),
        ("playSine", 440, 50, 1, 1.0),
        ("playWebStream", "http://radio.example/live", 0.5, 0.0),
        ("playSoundSetFile", "Bips", "ding"),
        ("playSoundSetFile", "ding", 0.0, 0.5, 0.0, False),
    ]
    assert server.result.files[-2:] == ["Bips/ding", "ding"]


def test_a_file_in_loop_is_played_for_its_duration(audio, player, edge):
    player.quick = False
    server = play(audio, f("playFileInLoop", "ding.wav", duration=0.02))
    assert server.end == "succeeded"
    assert edge.clock.waits == [0.02]
    assert player.pending[0].canceled
    assert server.result.files == ["ding.wav"]
    assert 0.02 <= server.result.durations[0] < LIMIT


def test_a_file_that_ends_before_its_duration_ends_the_function(audio, player):
    thread = in_background(audio, player, f("playFile", "ding.wav", duration=1000.0))
    player.pending[0].end()
    assert ended(thread, audio).end == "succeeded"
    assert not player.pending[0].canceled


def test_a_file_with_a_duration_is_preempted_before_it_is_over(audio, player, edge):
    thread = in_background(audio, player, f("playFileInLoop", "ding.wav", duration=1000.0))
    assert edge.clock.waiting.wait(LIMIT)
    audio.server.preempt()
    assert ended(thread, audio).end == "preempted"
    assert player.pending[0].canceled


def test_a_file_in_loop_goes_on_after_its_goal_until_it_is_stopped(audio, player):
    player.quick = False
    assert play(audio, f("playFileInLoop", "ding.wav")).end == "succeeded"
    assert play(audio, f("getMasterVolume")).end == "succeeded"
    assert not player.pending[0].done()
    play(audio, f("stopAll"))
    assert player.pending[0].done() and not player.pending[0].canceled


def test_a_chain_that_fails_silences_what_it_left_in_the_background_and_nothing_else(audio, player):
    player.quick = False
    play(audio, f("playFile", "of_before.wav", background=True))
    server = play(audio, f("playFileInLoop", "ding.wav"), f("loadFile", "missing.wav"))
    assert server.end == "aborted"
    assert [call.canceled for call in player.pending] == [False, True]


def test_preemption_silences_the_background_as_well(audio, player, speech):
    player.quick = False
    thread = in_background(audio, speech, f("playFile", "song.ogg", background=True), f("say", "la la"))
    audio.server.preempt()
    assert ended(thread, audio).end == "preempted"
    assert player.pending[0].canceled and speech.pending[0].canceled


def test_the_end_of_the_node_silences_what_goals_left(audio, player, edge):
    player.quick = False
    play(audio, f("playFileInLoop", "ding.wav"))
    edge.shutdown_actions[0]()
    assert player.pending[0].canceled


def test_a_file_in_the_background_that_is_not_there_is_an_error(audio):
    server = play(audio, f("playFile", "missing.wav", background=True))
    assert server.end == "aborted" and "no file missing.wav" in server.text


def test_only_files_that_were_played_are_in_the_result(audio, player):
    server = play(audio, f("playFile", "ding.wav"), f("playFile", "missing.wav"))
    assert (server.end, server.result.files) == ("aborted", ["ding.wav"])
    thread = in_background(audio, player, f("playFile", "ding.wav"))
    audio.server.preempt()
    assert ended(thread, audio).result.files == ["ding.wav"]


def test_waiting_for_silence_tells_of_a_sound_that_failed(audio, player):
    waiting = threading.Event()
    audio.server.publish_feedback = lambda feedback: feedback.function == "waitUntilSilent" and waiting.set()
    thread = in_background(audio, player, f("playFile", "song.ogg", background=True), f("waitUntilSilent"))
    assert waiting.wait(LIMIT)
    player.pending[0].end(error=RobotError("ALAudioPlayer", "playFile", "the file is broken"))
    server = ended(thread, audio)
    assert server.end == "aborted" and "function 2 (waitUntilSilent)" in server.text
    assert "the file is broken" in server.text


def test_waiting_for_silence_can_be_preempted(audio, player):
    thread = in_background(audio, player, f("playFileInLoop", "song.ogg"), f("waitUntilSilent"))
    audio.server.preempt()
    assert ended(thread, audio).end == "preempted"
    assert player.pending[0].canceled


def test_a_lost_robot_ends_the_wait(audio, player, robot):
    thread = in_background(audio, player, f("playFileInLoop", "song.ogg"), f("waitUntilSilent"))
    robot.connection.become("lost", "no answer")
    server = ended(thread, audio)
    assert server.end == "aborted" and "went away" in server.text


def test_loaded_sounds_go_by_name_by_id_or_by_being_the_last(audio, robot):
    server = play(
        audio,
        f("loadFile", "one.wav"),
        f("loadFile", "two.wav"),
        f("play", "one.wav"),
        f("play", volume=0.5),
        f("goTo", sound_id=7, position=0.5),
        f("pause", "two.wav"),
        f("getFileLength", "one.wav"),
        f("unloadFile"),
        f("play"),
    )
    assert server.end == "succeeded", server.text
    assert played(robot)[2:] == [
        ("play", 7),
        ("play", 8, 0.5, 0.0),
        ("goTo", 7, 0.5),
        ("pause", 8),
        ("unloadFile", 8),
        ("play", 7),
    ]
    assert server.result.memList == ["7", "8", "1.5"]
    assert server.result.files == ["one.wav", "two.wav", "one.wav"]


def test_a_robot_behind_a_new_connection_has_loaded_nothing(audio, robot):
    play(audio, f("loadFile", "one.wav"))
    robot.connection.become("connected")
    server = play(audio, f("play", "one.wav"))
    assert server.end == "aborted" and "'one.wav' is not loaded: loadFile comes first" in server.text


# Settings


def test_what_is_set_goes_back_after_the_wait(audio, speech, player, device, edge):
    seen = []
    wait = edge.clock.wait

    def look(*args):
        seen.append((device.volume, device.muted, speech.voice, speech.volume, player.master))
        return wait(*args)

    edge.clock.wait = look
    short = Duration.from_sec(0.01)
    server = play(
        audio,
        f("setOutputVolume", volume=20, revert=True, time=short),
        f("muteAudioOut", enable=True, revert=True, time=short),
        f("setVoice", "naofrf", revert=True, time=short),
        f("setVolume", volume=0.1, revert=True, time=short),
        f("setMasterVolume", volume=0.2, revert=True, time=short),
    )
    assert server.end == "succeeded", server.text
    assert seen == [
        (20, False, "naoenu", 0.75, 1.0),
        (60, True, "naoenu", 0.75, 1.0),
        (60, False, "naofrf", 0.75, 1.0),
        (60, False, "naoenu", 0.1, 1.0),
        (60, False, "naoenu", 0.75, 0.2),
    ]
    assert (device.volume, device.muted, speech.voice, speech.volume, player.master) == (60, False, "naoenu", 0.75, 1.0)


def test_what_is_set_without_revert_stays(audio, device, speech):
    server = play(audio, f("setOutputVolume", volume=20), f("setLanguage", "French"), f("getOutputVolume"))
    assert (device.volume, speech.voice) == (20, "naofrf")
    assert (server.result.memList, server.result.volume) == (["20"], 20.0)


def test_parameters_of_the_voice_and_of_the_sound_card(audio, speech, device, edge):
    server = play(
        audio,
        f("setParameter", names=["pitchShift", "speed"], values=[1.5, 80], revert=True),
        f("setParameter", names=["speed"], values=[150]),
        f("setParameter", "outputSampleRate", values=[16000]),
        f("getParameter", names=["speed", "pitchShift"]),
        f("getParameter", "outputSampleRate"),
        f("getParameter", "speed"),
    )
    assert server.end == "succeeded", server.text
    assert speech.parameters == {"speed": 150.0, "pitchShift": 1.0}
    assert device.parameters["outputSampleRate"] == 16000
    assert server.result.memList == ["150.0", "1.0", "16000", "150.0"]


def test_volume_of_speech_and_of_a_sound(audio, speech, player):
    server = play(
        audio,
        f("setVolume", volume=0.5),
        f("loadFile", "one.wav"),
        f("setVolume", "one.wav", volume=0.25, revert=True),
        f("setVolume", volume=0.5, sound_id=9),
        f("getVolume"),
        f("getVolume", sound_id=9),
    )
    assert server.end == "succeeded", server.text
    assert (speech.volume, player.volumes) == (0.5, {7: 1.0, 9: 0.5})
    assert server.result.memList == ["7", "0.5", "0.5"]


def test_numbers_of_the_robot_are_told_as_they_were_meant(audio, speech):
    speech.volume = 0.30000001192092896  # 32 bits of 0.3
    assert play(audio, f("getVolume")).result.memList == ["0.3"]


def test_words_are_taught_and_forgotten(audio, speech):
    server = play(
        audio,
        f("addToDictionary", "NAO", texts=["now"]),
        f("addToDictionary", "type", texts=["word", "1", "phonetic", "accent"]),
        f("deleteFromDictionary", "NAO"),
    )
    assert (server.end, server.result.memList) == ("succeeded", ["True", "True", "True"])
    assert speech.words == {"type": ("word", "1", "phonetic", "accent")}


def test_tags_link_words_and_animations(audio, robot):
    play(audio, f("addTagsToWords", "hello", texts=["hi", "hey"]), f("setBodyLanguageMode", body_language="random"))
    assert calls(robot, "ALAnimatedSpeech") == [
        ("addTagsToWords", {"hello": ["hi", "hey"]}),
        ("setBodyLanguageModeFromStr", "random"),
    ]


# What every function that takes nothing answers

ASKING = {
    "getVoice": ["naoenu"],
    "getAvailableVoices": ["naoenu", "naofrf"],
    "getLanguage": ["English"],
    "getAvailableLanguages": ["English", "French"],
    "getSupportedLanguages": ["English", "French", "Klingon"],
    "locale": ["en_US"],
    "getVolume": ["0.75"],
    "getMasterVolume": ["1.0"],
    "getBodyLanguageMode": ["contextual"],
    "getLoadedFilesIds": [],
    "getLoadedFilesNames": [],
    "getInstalledSoundSetsList": ["Bips"],
    "getLoadedSoundSetsList": ["Bips"],
    "getOutputVolume": ["60"],
    "isAudioOutMuted": ["False"],
    "isOutputClosed": ["False"],
    "isInputClosed": ["False"],
    "listOutputs": ['["speakers", 2]'],
    "listInputs": ['["microphones", 4]'],
    "resetSpeed": [],
    "reset": [],
    "showDictionary": [],
    "flushAudioOutputs": [],
    "openAudioOutputs": [],
    "closeAudioOutputs": [],
    "openAudioInputs": [],
    "closeAudioInputs": [],
    "unloadAllFiles": [],
    "waitUntilSilent": [],
}


@pytest.mark.parametrize("function", ASKING)
def test_answers(audio, function):
    server = play(audio, f(function))
    assert (server.end, server.result.memList) == ("succeeded", ASKING[function]), server.text


# Errors


@pytest.mark.parametrize("module", ["ALTextToSpeech", "ALAudioPlayer", "ALAudioDevice"])
def test_a_robot_without_a_module_says_so_and_the_server_stays(audio, robot, module):
    robot.add(module, NoModule(module))
    function = {
        "ALTextToSpeech": f("say", "Hello"),
        "ALAudioPlayer": f("playFile", "ding.wav"),
        "ALAudioDevice": f("muteAudioOut", enable=True),
    }[module]
    server = play(audio, function)
    assert server.end == "aborted"
    assert f"has no module '{module}'" in server.text
    assert play(audio, f("getData", "Name")).end == "succeeded"


def test_a_robot_that_does_not_tell_its_volume_speaks_all_the_same(audio, robot):
    robot.add("ALAudioDevice", NoModule("ALAudioDevice"))
    server = play(audio, f("say", "Hello"))
    assert (server.end, server.result.volume) == ("succeeded", -1.0)


def test_nothing_sounds_when_a_later_function_is_wrong(audio, robot):
    server = play(audio, f("say", "Hello"), f("playFile", "ding.wav"), f("say", "  "))
    assert server.end == "aborted"
    assert server.text == "function 3 (say): field str_param: it is empty: the text to say"
    assert spoken(robot) == played(robot) == []


def test_many_goals_from_many_clients_leave_nothing_behind(audio, player):
    player.quick = False
    for _ in range(50):
        play(audio, f("playFile", "ding.wav", background=True))
        player.pending.pop().end()
    play(audio, f("getVolume"))
    assert audio._begun == audio._left == []


# Examples


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
        monkeypatch.setattr(example.actionlib, "SimpleActionClient", lambda *_: FakeClient(audio))
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
