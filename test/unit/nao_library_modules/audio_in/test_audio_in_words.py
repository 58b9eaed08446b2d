"""Listening on stand-ins: what counts, what goes back, what others see."""

from __future__ import annotations

import pytest
from audio_in_goals import LISTEN, STATUS, WORDS, YES_NO, f, play, succeed


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
