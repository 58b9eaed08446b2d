"""Playing files on stand-ins: how long, how loud, what is silenced."""

from __future__ import annotations

import threading

from audio_out_goals import LIMIT, ended, f, in_background, play, played

from naoqi.errors import RobotError


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
