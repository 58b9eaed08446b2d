"""Speaking on stand-ins: what is called, what goes back, which words are told."""

from __future__ import annotations

from audio_out_goals import LIMIT, SENTENCE, WORD, calls, ended, f, in_background, play, spoken

from nao_library_modules.audio import NaoAudio
from nao_library_modules.nao_basic import NaoBasic


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
