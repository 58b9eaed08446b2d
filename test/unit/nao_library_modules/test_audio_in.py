"""The module for hearing on stand-ins: what is asked of the robot, what comes back, what ends, what is refused."""

from __future__ import annotations

import math

import pytest
from fake_hearing import Ears, HearingClock
from genpy import Duration

from nao_library_actions.msg import NaoAudioInGoal
from nao_library_modules.audio_in_checks import recording_format
from nao_library_msgs.msg import AudioInFunction
from naoqi.errors import RobotError

WORDS, STATUS = "WordRecognized", "ALSpeechRecognition/Status"
LOCATED, DETECTED = "ALSoundLocalization/SoundLocated", "SoundDetected"
YES_NO = ["yes", "no"]
LEVEL = [0.0] * 6


def f(function, **fields):
    return AudioInFunction(function=function, **fields)


LISTEN = f("listen", vocabulary=YES_NO, timeout=5.0)


@pytest.fixture
def ears(robot):
    return Ears(robot)


@pytest.fixture
def clock(edge):
    edge.clock = HearingClock()
    return edge.clock


@pytest.fixture
def hearing(robot, edge, clock, ears):
    from nao_library_modules.audio_in import NaoAudioInput

    return NaoAudioInput("10.0.0.7", 9559, robot=robot, edge=edge)


def play(hearing, *functions):
    return hearing.server.play(NaoAudioInGoal(list(functions)))


def succeed(hearing, *functions):
    server = play(hearing, *functions)
    assert server.end == "succeeded", server.text
    return server.result


# Recordings


def test_a_recording_takes_its_time_and_is_in_the_result(hearing, ears, robot, clock):
    result = succeed(hearing, f("record", str_param="day/hello.wav", duration=3.0))
    start, stop = robot.proxy("ALAudioRecorder").calls
    assert start[1:] == ("/home/nao/day/hello.wav", "wav", 16000, [0, 0, 1, 0])
    assert stop == ("stopMicrophonesRecording",)
    (file,) = result.files
    assert (file.path, file.duration, file.rate, file.channels) == ("day/hello.wav", 3.0, 16000, ["front"])
    assert (file.file_type, clock.waits, result.memList) == ("wav", [3.0], [])
    assert result.results[0].values == ["day/hello.wav", "3.0"]


@pytest.mark.parametrize(
    "rate, channels, expected",
    [
        (0, [], (16000, ["front"])),
        (48000, [], (48000, ["left", "right", "front", "rear"])),
        (0, ["rear"], (16000, ["rear"])),
        (16000, ["left"], (16000, ["left"])),
        (0, ["rear", "front", "left", "right"], (48000, ["left", "right", "front", "rear"])),
    ],
)
def test_rate_and_channels_belong_together(rate, channels, expected):
    assert recording_format(rate, channels) == expected


def test_a_preempted_recording_is_closed_and_in_the_result(hearing, ears, clock):
    clock.script = [hearing.server.preempt]
    server = play(hearing, f("record", str_param="a.ogg", duration=60.0), LISTEN)
    assert server.end == "preempted"
    assert ears.recorder.done == ["/home/nao/a.ogg"] and ears.idle()
    assert [file.path for file in server.result.files] == ["a.ogg"]
    assert server.result.files[0].duration < 60.0


def test_a_recording_outlives_its_goal_until_it_is_stopped(hearing, ears, clock):
    assert succeed(hearing, f("startRecording", str_param="a.wav", rate=48000)).files == []
    assert ears.recorder.running
    clock.time += 7.0
    result = succeed(hearing, f("stopRecording"))
    assert (result.files[0].path, result.files[0].duration) == ("a.wav", 7.0)
    assert len(result.files[0].channels) == 4 and ears.idle()


def test_the_end_of_the_server_ends_what_goals_have_left(hearing, ears, edge):
    succeed(
        hearing,
        f("startRecording", str_param="a.wav"),
        f("startRecognition", vocabulary=YES_NO),
        f("enableEnergyComputation"),
        f("pause"),
    )
    assert ears.recorder.running and ears.recognition.subscribers and ears.card.computing and ears.recognition.paused
    for action in edge.shutdown_actions:
        action()
    assert ears.idle() and not ears.recognition.paused


def test_two_recordings_at_once_are_refused_before_anything_runs(hearing, ears):
    start, record = f("startRecording", str_param="a.wav"), f("record", str_param="b.wav", duration=1.0)
    server = play(hearing, start, record)
    assert server.end == "aborted"
    assert "function 2 (record)" in server.text and "stopRecording comes first" in server.text
    assert ears.recorder.running is None
    succeed(hearing, start)
    assert play(hearing, record).end == "aborted"
    succeed(hearing, f("stopRecording"), record)


def test_a_recording_of_another_program_is_left_alone(hearing, ears):
    ears.recorder.running = ("theirs.wav", "wav", 16000, [1, 0, 0, 0])
    server = play(hearing, f("record", str_param="a.wav", duration=1.0))
    assert server.end == "aborted" and "a recording runs already" in server.text
    assert ears.recorder.running and server.result.files == []


def test_a_preemption_while_the_recording_begins_ends_it(hearing, ears, robot, make_call):
    call = make_call("ALAudioRecorder.startMicrophonesRecording")
    begun = ears.recorder.startMicrophonesRecording

    def slow(*args):
        begun(*args)
        hearing.server.preempt()
        call.end()
        return call

    ears.recorder.startMicrophonesRecording = slow
    assert play(hearing, f("record", str_param="a.wav", duration=1.0)).end == "preempted"
    assert ears.recorder.done == ["/home/nao/a.wav"] and not call.canceled


# Words


def test_listening_ends_with_the_first_words(hearing, ears, clock):
    seen = []
    clock.script = [
        lambda: ears.raise_event(STATUS, "SpeechDetected"),
        lambda: (seen.append(ears.recognition.vocabulary), ears.raise_event(WORDS, ["yes", 0.7])),
    ]
    result = succeed(hearing, f("listen", vocabulary=[" yes", "stand  up"], word_spotting=True, timeout=5.0))
    assert seen == [(["yes", "stand up"], True)]
    assert result.words == ["yes"] and clock.time < 101.0 and ears.idle()


def test_words_with_too_little_confidence_are_told_but_do_not_count(hearing, ears, clock):
    clock.script = [
        lambda: ears.raise_event(STATUS, "SpeechDetected"),
        lambda: ears.raise_event(WORDS, ["no", 0.2]),
        lambda: ears.raise_event(WORDS, ["yes", 0.7, "no", 0.1]),
    ]
    server = play(hearing, f("listen", vocabulary=YES_NO, confidence=0.5))
    result = server.result
    assert (result.words, result.memList) == (["yes"], [])
    assert result.confidences == pytest.approx([0.7])
    assert result.results[0].values == ["yes", "0.7"]
    told = [(feedback.status, feedback.words) for feedback in server.feedback]
    assert told == [("", []), ("SpeechDetected", []), (WORDS, ["no"]), (WORDS, ["yes", "no"])]
    assert {(feedback.index, feedback.function, feedback.count) for feedback in server.feedback} == {(0, "listen", 1)}


def test_all_hypotheses_are_in_the_result_best_first(hearing, ears, clock):
    clock.script = [lambda: ears.raise_event(WORDS, ["yes", 0.7, "no", 0.3])]
    result = succeed(hearing, LISTEN)
    assert result.words == YES_NO
    assert result.confidences == pytest.approx([0.7, 0.3])


def test_nothing_in_time_is_no_failure(hearing, ears, clock):
    clock.script = [lambda: ears.raise_event(WORDS, ["", -3.0])]  # as the robot resets it
    result = succeed(hearing, LISTEN)
    assert (result.words, result.confidences, result.results[0].values) == ([], [], [])
    assert clock.time == pytest.approx(105.0) and ears.idle()
    clock.time = 100.0
    succeed(hearing, f("listen", vocabulary=YES_NO))
    assert clock.time == pytest.approx(110.0)


def test_the_vocabulary_of_another_program_is_back_afterwards(hearing, ears, clock):
    ears.recognition.vocabulary = (["theirs"], True)
    ears.recognition.subscribe("another program")
    during = []
    clock.script = [lambda: during.append((ears.recognition.vocabulary, ears.recognition.runs))]
    succeed(hearing, f("listen", vocabulary=["stand up"], word_spotting=True, timeout=1.0))
    assert during == [((["stand up"], True), True)]
    assert ears.recognition.vocabulary == (["theirs"], True)
    assert (ears.recognition.subscribers, ears.recognition.paused) == (["another program"], False)


@pytest.mark.parametrize("subscribed", [False, True])
def test_a_pause_of_another_program_stays(hearing, ears, subscribed):
    if subscribed:
        ears.recognition.vocabulary = (["theirs"], False)
        ears.recognition.subscribe("another program")
    ears.recognition.pause(True)
    succeed(hearing, f("listen", vocabulary=YES_NO, timeout=1.0))
    assert play(hearing, f("setVocabulary", vocabulary=["qxzt"])).end == "aborted"
    assert ears.recognition.paused


def test_the_subscriber_has_a_name_of_its_own_in_its_namespace(hearing, ears, clock):
    names = []
    clock.script = [lambda: names.extend(ears.recognition.subscribers)]
    succeed(hearing, LISTEN)
    assert names[0].startswith("nao_audio_in_") and names[0].endswith("robot1_listen")


def test_words_that_the_robot_does_not_know_abort_with_its_text_and_leave_all_as_it_was(hearing, ears):
    ears.recognition.vocabulary = (["theirs"], False)
    server = play(hearing, f("listen", vocabulary=["yes", "qxzt"]))
    assert server.end == "aborted"
    assert server.text == "function 1 (listen): ALSpeechRecognition.setVocabulary failed: no pronunciation for qxzt"
    assert ears.recognition.vocabulary == (["theirs"], False) and ears.idle()


def test_preempted_listening_leaves_all_as_it_was(hearing, ears, clock):
    ears.recognition.vocabulary = (["theirs"], False)
    clock.script = [hearing.server.preempt]
    assert play(hearing, f("listen", vocabulary=YES_NO, str_param="French")).end == "preempted"
    assert ears.recognition.vocabulary == (["theirs"], False) and ears.idle()
    assert ears.recognition.language == "English"


def test_a_language_is_for_this_time_only(hearing, ears, clock):
    during = []
    clock.script = [lambda: during.append(ears.recognition.language)]
    succeed(hearing, f("listen", vocabulary=["oui", "non"], str_param="French", timeout=1.0))
    assert (during, ears.recognition.language) == (["French"], "English")
    succeed(hearing, f("setLanguage", str_param="French"))
    assert ears.recognition.language == "French"


def test_a_robot_that_keeps_no_vocabulary_listens_all_the_same(hearing, ears, clock):
    ears.recognition.keeps = False
    clock.script = [lambda: ears.raise_event(WORDS, ["yes", 0.7])]
    assert succeed(hearing, LISTEN).words == ["yes"]


def test_a_vocabulary_set_before_need_not_be_repeated(hearing, ears, clock):
    server = play(hearing, f("listen", timeout=1.0))
    assert server.end == "aborted" and "field vocabulary: it is empty" in server.text
    clock.script = [lambda: ears.raise_event(WORDS, ["no", 0.7])]
    result = succeed(hearing, f("setVocabulary", vocabulary=YES_NO), f("listen", timeout=1.0), f("listen", timeout=1.0))
    assert result.words == ["no"]
    assert [entry.values for entry in result.results] == [[], ["no", "0.7"], []]
    assert ears.recognition.vocabulary == (YES_NO, False)


def test_recognition_outlives_its_goal_and_its_words_are_published(hearing, ears, edge):
    ears.recognition.vocabulary = (["theirs"], False)
    succeed(hearing, f("startRecognition", vocabulary=YES_NO))
    ears.raise_event(WORDS, ["yes", 0.6])
    assert edge.events == [(WORDS, ["yes", 0.6])]
    assert len(ears.recognition.subscribers) == 1
    succeed(hearing, f("startRecognition", vocabulary=["stop"], word_spotting=True))
    assert (ears.recognition.vocabulary, len(ears.recognition.subscribers)) == ((["stop"], True), 1)
    succeed(hearing, f("stopRecognition"), f("stopRecognition"))
    assert ears.idle() and ears.recognition.vocabulary == (["theirs"], False)


def test_listening_in_the_middle_of_a_recognition_leaves_it_running(hearing, ears, clock):
    succeed(hearing, f("startRecognition", vocabulary=["stop"]))
    clock.script = [lambda: ears.raise_event(WORDS, ["yes", 0.7])]
    assert succeed(hearing, LISTEN).words == ["yes"]
    assert ears.recognition.vocabulary == (["stop"], False) and ears.recognition.runs


def test_a_recognition_that_cannot_begin_leaves_nothing_behind(hearing, ears):
    ears.recognition.vocabulary = (["theirs"], False)
    server = play(hearing, f("startRecognition", vocabulary=["qxzt"]))
    assert server.end == "aborted" and "no pronunciation for qxzt" in server.text
    assert ears.idle() and ears.recognition.vocabulary == (["theirs"], False)


def test_events_that_a_user_subscribed_stay_when_the_recognition_ends(hearing, ears, edge):
    succeed(hearing, f("subscribeToEvent", str_param=WORDS), f("startRecognition", vocabulary=YES_NO))
    succeed(hearing, f("stopRecognition"))
    ears.raise_event(WORDS, ["yes", 0.6])
    assert len(edge.events) == 1


def test_a_recognition_runs_again_when_the_robot_is_back(hearing, ears, robot):
    succeed(hearing, f("startRecognition", vocabulary=YES_NO, word_spotting=True))
    subscribers = list(ears.recognition.subscribers)
    robot.connection.become("lost")
    ears.recognition.subscribers.clear()
    ears.recognition.vocabulary = ([], False)
    robot.connection.become("connected")
    assert (ears.recognition.subscribers, ears.recognition.vocabulary) == (subscribers, (YES_NO, True))
    robot.connection.become("connected")  # the same robot, which knows it already
    assert ears.recognition.subscribers == subscribers


def test_a_lost_robot_ends_listening(hearing, ears, robot, clock):
    clock.script = [lambda: robot.connection.become("lost", "no answer")]
    server = play(hearing, LISTEN)
    assert server.end == "aborted" and "went away" in server.text


def test_who_has_paused_the_recognition_does_not_listen_in_vain(hearing, ears):
    server = play(hearing, f("pause"), LISTEN)
    assert server.end == "aborted" and "the recognition is paused: resume comes first" in server.text
    assert not ears.recognition.paused
    succeed(hearing, f("pause"))
    assert ears.recognition.paused
    assert play(hearing, LISTEN).end == "aborted"
    succeed(hearing, f("resume"), LISTEN)
    assert not ears.recognition.paused


def test_what_a_server_of_this_name_has_left_ends_and_others_go_on(hearing, ears):
    ears.recognition.vocabulary = (["theirs"], False)
    for name in (hearing.subscriber_for("listen"), "another program"):
        ears.recognition.subscribe(name)
    ears.localization.subscribe(hearing.subscriber_for("localize"))
    succeed(hearing, f("ping"))
    assert (ears.recognition.subscribers, ears.localization.subscribers) == (["another program"], [])


# Sounds


def test_a_sound_that_begins_is_detected(hearing, ears, clock):
    clock.script = [
        lambda: ears.raise_event(DETECTED, [[0, 0, 0.9, 1]]),
        lambda: ears.raise_event(DETECTED, [[0, 1, 0.2, 1]]),
        lambda: ears.raise_event(DETECTED, [[0, 1, 0.8, 1]]),
    ]
    result = succeed(hearing, f("detectSound", confidence=0.5, timeout=5.0))
    (sound,) = result.sounds
    assert (sound.located, sound.confidence, sound.header.frame_id) == (False, 0.8, "robot1/Head")
    assert [float(value) for value in result.results[0].values] == pytest.approx([0.8, 0.3])
    assert ears.idle()


@pytest.mark.parametrize("function", ["detectSound", "localizeSound"])
def test_silence_is_no_failure(hearing, ears, clock, function):
    result = succeed(hearing, f(function, timeout=2.0))
    assert (result.sounds, result.results[0].values, clock.time) == ([], [], 102.0)
    assert ears.idle()


def located(azimuth, confidence, head=LEVEL):
    return [[1, 2], [azimuth, 0.1, confidence, 0.25], LEVEL, head]


def test_a_sound_is_located_in_the_head_and_in_the_base(hearing, ears, clock):
    head = [0.05, 0.0, 0.45, 0.0, 0.0, 0.5]
    clock.script = [
        lambda: ears.raise_event(LOCATED, located(1.0, 0.2)),
        lambda: ears.raise_event(LOCATED, located(0.25, 0.9, head)),
    ]
    (sound,) = succeed(hearing, f("localizeSound", confidence=0.5)).sounds
    assert (sound.header.frame_id, sound.base_frame, sound.located) == ("robot1/Head", "robot1/base_footprint", True)
    assert (sound.azimuth, sound.elevation, sound.confidence, sound.energy) == (0.25, 0.1, 0.9, 0.25)
    assert (sound.base_azimuth, sound.base_elevation) == pytest.approx((0.75, 0.1))
    assert (sound.head.x, sound.head.y, sound.head.z) == (0.05, 0.0, 0.45)
    assert sound.header.stamp.to_sec() == pytest.approx(100.2)
    assert ears.localization.parameters["EnergyComputation"] is True and ears.idle()


def test_with_some_patience_the_most_confident_direction_counts(hearing, ears, clock):
    clock.script = [
        lambda: ears.raise_event(LOCATED, located(1.0, 0.5)),
        lambda: ears.raise_event(LOCATED, located(0.3, 0.9)),
        lambda: ears.raise_event(LOCATED, located(2.0, 0.6)),
    ]
    (sound,) = succeed(hearing, f("localizeSound", duration=1.0)).sounds
    assert sound.azimuth == 0.3
    assert clock.time == pytest.approx(101.1)


@pytest.mark.parametrize("function", ["detectSound", "localizeSound", "getEnergy", "listen"])
def test_preemption_ends_every_wait_and_every_subscription(hearing, ears, clock, function):
    clock.script = [hearing.server.preempt]
    server = play(hearing, f(function, vocabulary=YES_NO, duration=5.0))
    assert server.end == "preempted" and ears.idle()


def test_nonsense_of_the_robot_is_passed_over(hearing, ears, clock):
    clock.script = [
        lambda: ears.raise_event(LOCATED, "nonsense"),
        lambda: ears.raise_event(LOCATED, located(0.3, 0.9)),
    ]
    assert len(succeed(hearing, f("localizeSound")).sounds) == 1


def test_sensitivity_of_one_sense_or_of_all(hearing, ears):
    succeed(hearing, f("setSensitivity", str_param="detection", sensitivity=0.4))
    senses = (ears.recognition, ears.detection, ears.localization)
    assert [sense.parameters["Sensitivity"] for sense in senses] == [0.9, 0.4, 0.9]
    succeed(hearing, f("setSensitivity", sensitivity=0.5))
    assert [sense.parameters["Sensitivity"] for sense in senses] == [0.5, 0.5, 0.5]


# Energies


def test_energies_are_computed_only_for_the_function(hearing, ears):
    result = succeed(hearing, f("getEnergy"), f("getRearMicEnergy"))
    assert result.microphones == ["left", "right", "front", "rear", "rear"]
    assert [energy // 100 for energy in result.energies] == [1, 2, 3, 4, 4]
    assert all(energy % 100 for energy in result.energies)  # they were computed
    assert result.memList == [] and ears.idle()


def test_energies_that_another_program_has_computed_go_on(hearing, ears, robot):
    ears.card.computing = True
    succeed(hearing, f("getFrontMicEnergy"))
    assert ears.card.computing
    assert "enableEnergyComputation" not in [call[0] for call in robot.proxy("ALAudioDevice").calls]


def test_energies_that_are_computed_all_the_time_are_there_at_once(hearing, ears, clock):
    succeed(hearing, f("enableEnergyComputation"), f("getEnergy"))
    assert clock.waits == [] and ears.card.computing
    succeed(hearing, f("disableEnergyComputation"))
    assert ears.idle()


def test_energies_are_the_mean_over_a_while(hearing, ears):
    succeed(hearing, f("enableEnergyComputation"))
    result = succeed(hearing, f("getFrontMicEnergy", duration=0.5))
    assert result.energies == [302.0]  # 301, 302, 303


# The sound card, and parameters of two modules


def test_the_sound_card_of_naoaudio_is_there(hearing, ears):
    assert succeed(hearing, f("setOutputVolume", volume=30), f("getOutputVolume")).memList == ["30"]


def test_parameters_of_the_recognition_and_of_the_sound_card(hearing, ears):
    chain = [
        f("setParameter", str_param="NbHypotheses", values=[3]),
        f("getParameter", str_param="NbHypotheses"),
        f("setParameter", str_param="outputSampleRate", values=[16000]),
        f("getParameter", str_param="outputSampleRate"),
    ]
    assert succeed(hearing, *chain).memList == ["3.0", "16000"]
    server = play(hearing, f("getParameter", str_param="NbHypothesis"))
    assert server.end == "aborted" and "no parameter NbHypothesis" in server.text


def test_settings_go_back_after_the_wait(hearing, ears, clock):
    during = []
    second = Duration(1)
    clock.script = [
        lambda: during.append(ears.recognition.language),
        lambda: during.append(ears.recognition.audio_expression),
        lambda: during.append(ears.recognition.parameters["Sensitivity"]),
    ]
    succeed(
        hearing,
        f("setLanguage", str_param="French", revert=True, time=second),
        f("setAudioExpression", enable=False, revert=True, time=second),
        f("setParameter", str_param="Sensitivity", values=[0.1], revert=True, time=second),
    )
    assert during == ["French", False, 0.1]
    assert (ears.recognition.language, ears.recognition.audio_expression) == ("English", True)
    assert ears.recognition.parameters["Sensitivity"] == 0.9


def test_a_file_instead_of_the_microphones(hearing, ears):
    succeed(hearing, f("setFileAsInput", str_param="question.wav"))
    assert ears.card.file == "/home/nao/question.wav"


# What is refused, before anything runs


NAN, INF = math.nan, math.inf
FIRST = f("setOutputVolume", volume=10)


@pytest.mark.parametrize(
    "bad, told",
    [
        (f("record", str_param="a.wav"), "field duration: 0.0 is not allowed: above 0 to 3600 s"),
        (f("record", str_param="a.wav", duration=NAN), "field duration"),
        (f("record", str_param="a.wav", duration=-1.0), "field duration"),
        (f("record", str_param="a.wav", duration=1e9), "field duration"),
        (f("record", duration=1.0), "field str_param: it is empty"),
        (f("record", str_param="../a.wav", duration=1.0), "leads out of the folder"),
        (f("record", str_param="/etc/a.wav", duration=1.0), "leads out of the folder"),
        (f("record", str_param="a.mp3", duration=1.0), "ends in .wav, .ogg"),
        (f("record", str_param="a.wav", file_type="ogg", duration=1.0), "field file_type"),
        (f("record", str_param="a.wav", file_type="flac", duration=1.0), "'flac' is no type of recordings"),
        (f("record", str_param="a.wav", rate=44100, duration=1.0), "field rate: 44100 is not allowed: 16000, 48000"),
        (f("record", str_param="a.wav", channels=["fornt"], duration=1.0), "did you mean 'front'"),
        (f("record", str_param="a.wav", channels=["left", "left"], duration=1.0), "each microphone once"),
        (f("record", str_param="a.wav", channels=["left", "rear"], duration=1.0), "2 channel(s): one of left, right"),
        (f("startRecording", str_param="a.wav", rate=48000, channels=["left"]), "1 channel(s) at 48000 Hz"),
        (f("startRecording", str_param="a.wav", rate=-1), "field rate"),
        (f("listen"), "field vocabulary: it is empty: at least one word or phrase, here or by setVocabulary before"),
        (f("listen", vocabulary=["yes", " "]), "there is an empty phrase in it"),
        (f("listen", vocabulary=["yes|no"]), "'|' in 'yes|no' cannot be said"),
        (f("listen", vocabulary=["<yes>"]), "'<' in '<yes>' cannot be said"),
        (f("listen", vocabulary=["a\x07b"]), "cannot be said"),
        (f("listen", vocabulary=["☎"]), "cannot be said"),
        (f("listen", vocabulary=["..."]), "nothing to say in '...'"),
        (f("listen", vocabulary=["word " * 50]), "is too long"),
        (f("listen", vocabulary=["word"] * 1001), "1001 words and phrases are too many"),
        (f("listen", vocabulary=YES_NO, timeout=NAN), "field timeout"),
        (f("listen", vocabulary=YES_NO, timeout=-1.0), "field timeout"),
        (f("listen", vocabulary=YES_NO, timeout=1e7), "field timeout: 10000000.0 is not allowed: up to 3600 s"),
        (f("listen", vocabulary=YES_NO, confidence=1.5), "field confidence: 1.5 is not allowed: 0..1"),
        (f("listen", vocabulary=YES_NO, confidence=NAN), "field confidence"),
        (
            f("listen", vocabulary=YES_NO, str_param="Frensh"),
            "did you mean 'French', 'English'?: one of English, French",
        ),
        (f("setVocabulary"), "at least one word or phrase"),
        (f("startRecognition"), "at least one word or phrase"),
        (f("setLanguage", str_param="Klingon"), "no language that the robot recognises"),
        (f("detectSound", timeout=INF), "field timeout"),
        (f("detectSound", confidence=-0.1), "field confidence"),
        (f("localizeSound", timeout=NAN), "field timeout"),
        (f("localizeSound", duration=NAN), "field duration"),
        (f("getEnergy", duration=-1.0), "field duration"),
        (f("setSensitivity"), "field sensitivity: 0.0 is not allowed: above 0 to 1"),
        (f("setSensitivity", sensitivity=2.0), "field sensitivity"),
        (f("setSensitivity", sensitivity=0.5, str_param="smell"), "one of speech, detection, localization"),
        (f("setParameter", str_param="Sensitivity"), "field values: [] is not allowed: one number"),
        (f("setParameter", values=[1.0]), "the name of a parameter"),
        (f("setParameter", str_param="outputSampleRate", values=[11025]), "16000, 22050, 44100, 48000"),
        (f("getParameter"), "the name of a parameter"),
        (f("setFileAsInput", str_param="a.txt"), "not a file of a known kind"),
        (f("setOutputVolume", volume=101), "field volume"),
        (f("lisen", vocabulary=YES_NO), "did you mean 'listen'"),
        (f("listen", vocabulary=YES_NO, time=Duration(-1)), "field time"),
    ],
)
def test_a_bad_function_moves_nothing_of_its_chain(hearing, ears, bad, told):
    server = play(hearing, FIRST, bad)
    assert server.end == "aborted"
    assert server.text.startswith(f"function 2 ({bad.function}): ") and told in server.text, server.text
    assert ears.card.volume == 60 and ears.idle()


@pytest.mark.parametrize("phrase", ["don't", "stand-up", "Größe", "R2 D2", "bon jour", "3.5", "now!"])
def test_what_people_say_is_allowed(hearing, ears, phrase):
    succeed(hearing, f("setVocabulary", vocabulary=[phrase]))
    assert ears.recognition.vocabulary == ([phrase], False)


def test_a_robot_without_hearing_is_told_and_the_server_stays(hearing, ears, robot):
    class Deaf:
        def call_async(self, method, *args):
            raise RobotError("naoqi", method, "there is no module ALSpeechRecognition")

    robot._proxies["ALSpeechRecognition"] = Deaf()
    server = play(hearing, LISTEN)
    assert server.end == "aborted" and "no module ALSpeechRecognition" in server.text
    assert ears.idle()
    succeed(hearing, f("ping"))
