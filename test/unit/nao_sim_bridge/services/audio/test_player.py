"""What the player does with its sounds, heard at the loudspeakers, exact in simulated time."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from nao_sim_bridge.services.audio.background import Background
from nao_sim_bridge.services.audio.player import Player
from nao_sim_bridge.services.audio.tones import sine
from nao_sim_bridge.services.errors import NaoqiError

EDGE = 0.02
"""Time around a change in which its ramp may be heard, s."""


@pytest.fixture
def player(bench):
    return Player(bench, bench, Background())


def loudness(samples):
    return float(np.sqrt(np.mean(np.asarray(samples, dtype=np.float64) ** 2)))


def test_a_sound_is_played_as_it_is_and_its_task_ends_with_it(bench, player, noise):
    sound = noise(0.5, 2)
    task = player.play(player.load("a", sound), "play")
    bench.advance(0.499)
    assert not task.finished
    bench.advance(0.006)
    assert task.finished and not task.killed
    np.testing.assert_allclose(bench.played(EDGE, 0.5 - EDGE), sound.samples[960:-960], atol=1e-6)
    assert not bench.played(0.5, 0.505).any()


def test_numbers_are_given_in_turn_and_known_until_unloaded(bench, player, noise):
    first, second = player.load("a", noise(0.1)), player.load("b", noise(0.1))
    assert [loaded.number for loaded in player.loaded()] == [1, 2]
    player.unload(first)
    assert player.find(2) is second
    with pytest.raises(NaoqiError, match="no sound is loaded under the id 1; ids in use: 2"):
        player.find(1)


def test_a_kill_is_silence_at_once(bench, player, noise):
    task = player.play(player.load("a", noise(2.0)), "play")
    bench.advance(0.5)
    task.request_kill()
    bench.advance(0.5)
    assert task.finished and task.killed
    assert bench.played(0.4, 0.49).any()
    assert not bench.played(0.5 + EDGE, 1.0).any()


def test_pause_and_play_go_on_at_the_same_place(bench, player, noise):
    sound = noise(1.0)
    loaded = player.load("a", sound)
    task = player.play(loaded, "play")
    bench.advance(0.4)
    player.pause(loaded)
    bench.advance(1.0)
    assert player.position(loaded) == pytest.approx(0.4)
    assert player.play(loaded, "play") is task
    bench.advance(0.605)
    assert task.finished
    heard = bench.played(1.4 + EDGE, 2.0 - EDGE)[:, 0]
    np.testing.assert_allclose(heard, sound.samples[round(0.42 * 48000) : round(0.98 * 48000), 0], atol=1e-6)
    assert not bench.played(0.4 + EDGE, 1.4).any()


def test_what_does_not_play_cannot_be_paused(player, noise):
    loaded = player.load("song.ogg", noise(0.1))
    with pytest.raises(NaoqiError, match=r"the sound 1 \(song.ogg\) does not play"):
        player.pause(loaded)


def test_a_paused_sound_can_be_stopped(bench, player, noise):
    loaded = player.load("a", noise(1.0))
    task = player.play(loaded, "play")
    bench.advance(0.2)
    player.pause(loaded)
    player.stop_all()
    assert task.finished and task.killed
    assert player.position(loaded) == 0.0


def test_playing_what_plays_begins_anew(bench, player, noise):
    loaded = player.load("a", noise(1.0))
    first = player.play(loaded, "play")
    bench.advance(0.5)
    second = player.play(loaded, "play")
    assert first.killed and not second.finished
    assert player.position(loaded) == 0.0
    bench.advance(0.75)
    assert not second.finished
    bench.advance(0.26)
    assert second.finished


def test_a_jump_moves_what_plays_and_the_beginning_of_what_does_not(bench, player, noise):
    sound = noise(2.0)
    loaded = player.load("a", sound)
    player.go_to(loaded, 1.5)
    assert player.position(loaded) == 1.5
    task = player.play(loaded, "play")
    bench.advance(0.1)
    assert player.position(loaded) == pytest.approx(1.6)
    player.go_to(loaded, 0.5)
    bench.advance(1.49)
    assert not task.finished
    bench.advance(0.02)
    assert task.finished
    assert player.position(loaded) == 0.0
    np.testing.assert_allclose(bench.played(0.2, 0.3)[:, 0], sound.samples[28800:33600, 0], atol=1e-6)


def test_a_loop_goes_on_until_it_is_stopped(bench, player, noise):
    sound = noise(0.3)
    task = player.play(player.load("a", sound), "playInLoop", loop=True)
    bench.advance(1.0)
    assert not task.finished
    np.testing.assert_allclose(bench.played(0.6 + EDGE, 0.9 - EDGE)[:, 0], sound.samples[960:-960, 0], atol=1e-6)
    player.stop_all()
    assert task.finished


def test_volumes_multiply(bench, player, noise):
    loaded = player.load("a", noise(5.0))
    player.play(loaded, "play")
    bench.advance(1.0)
    player.set_volume(loaded, 0.5)
    bench.advance(1.0)
    player.set_all(volume=0.5)
    bench.advance(1.0)
    full = loudness(bench.played(EDGE, 1.0))
    assert loudness(bench.played(1.0 + EDGE, 2.0)) == pytest.approx(0.5 * full, rel=0.02)
    assert loudness(bench.played(2.0 + EDGE, 3.0)) == pytest.approx(0.25 * full, rel=0.02)
    assert player.volume == 0.5 and loaded.volume == 0.5


@pytest.mark.parametrize("pan, panorama, left, right", [(-1, 0, 1, 0), (0, 1, 0, 1), (1, -1, 1, 1), (1, 1, 0, 1)])
def test_pans_add_up(bench, player, noise, pan, panorama, left, right):
    player.set_all(panorama=float(panorama))
    loaded = player.load("a", noise(0.5))
    player.set_volume(loaded, 1.0, float(pan))
    player.play(loaded, "play")
    bench.advance(0.5)
    played = bench.played(EDGE, 0.5 - EDGE)
    assert [loudness(side) > 0.01 for side in played.T] == [bool(left), bool(right)]


def test_a_sound_that_is_unloaded_is_silent(bench, player, noise):
    loaded = player.load("a", noise(1.0))
    task = player.play(loaded, "play")
    bench.advance(0.1)
    player.unload_all()
    assert task.killed and player.loaded() == []
    bench.advance(0.2)
    assert not bench.played(0.1 + EDGE, 0.3).any()


@pytest.mark.parametrize("end", ["played", "stopped"])
def test_a_temporary_sound_is_forgotten_afterwards(bench, player, noise, end):
    player.play(player.load("a", noise(0.2), temporary=True), "playFile")
    assert len(player.loaded()) == 1
    if end == "played":
        bench.advance(0.3)
    else:
        player.stop_all()
    assert player.loaded() == []


def test_what_takes_time_to_get_is_played_when_it_is_there(bench, player, noise, patience):
    may_come = threading.Event()

    def fetch(wanted):
        assert may_come.wait(patience) and wanted()
        return noise(0.2)

    task = player.play_when_there(fetch, lambda sound: player.play(player.load("a", sound), "play"), "playWebStream")
    assert not task.finished
    may_come.set()
    playing = task.result(patience).result(patience)
    bench.advance(0.1)
    task.request_kill()
    assert playing.killed


@pytest.mark.parametrize("way", ["give_up_pending", "request_kill"])
@pytest.mark.parametrize("fails", [False, True])
def test_what_is_on_its_way_when_all_is_stopped_is_not_played(player, noise, patience, way, fails):
    may_come = threading.Event()

    def fetch(wanted):
        assert may_come.wait(patience) and not wanted()
        if fails:
            raise NaoqiError("it was cut off")
        return noise(0.2)

    task = player.play_when_there(fetch, lambda sound: player.play(player.load("a", sound), "play"), "playWebStream")
    (player.give_up_pending if way == "give_up_pending" else task.request_kill)()
    may_come.set()
    begun = task.result(patience)
    assert begun is None or begun.result(patience) is None
    assert player.loaded() == []


def test_what_cannot_be_got_is_an_error(player, patience):
    def fetch(_):
        raise NaoqiError("nothing there")

    task = player.play_when_there(fetch, lambda _: None, "playWebStream")
    with pytest.raises(NaoqiError, match="nothing there"):
        task.result(patience)


def frequency(samples):
    return np.argmax(np.abs(np.fft.rfft(samples * np.hanning(len(samples))))) * 48000 / len(samples)


def test_another_pitch_changes_what_plays_at_its_place(bench, player, patience):
    loaded = player.load("a", sine(440.0, 50.0, 3.0))
    task = player.play(loaded, "play")
    bench.advance(1.0)
    player.change_pitch(loaded.number, 1.5).result(patience).result(patience)
    assert player.position(loaded) == pytest.approx(1.0)
    bench.advance(1.0)
    player.change_pitch(loaded.number, 1.0).result(patience).result(patience)
    bench.advance(0.99)
    assert not task.finished
    bench.advance(0.02)
    assert task.finished and not task.killed
    heard = [frequency(bench.played(begin, begin + 0.5)[:, 0]) for begin in (0.25, 1.25, 2.25)]
    assert heard == pytest.approx([440.0, 660.0, 440.0], abs=2.1)


def test_another_pitch_keeps_a_paused_sound_silent(bench, player, patience):
    loaded = player.load("a", sine(440.0, 50.0, 1.0))
    player.play(loaded, "play")
    bench.advance(0.25)
    player.pause(loaded)
    player.change_pitch(loaded.number, 2.0).result(patience).result(patience)
    bench.advance(0.5)
    assert player.position(loaded) == pytest.approx(0.25)
    assert not bench.played(0.25 + EDGE, 0.75).any()
    player.play(loaded, "play")
    bench.advance(0.75)
    assert frequency(bench.played(0.8, 1.4)[:, 0]) == pytest.approx(880.0, abs=2.1)
