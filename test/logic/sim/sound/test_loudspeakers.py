"""What loudspeakers play: exact in time and without clicks."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.base.samples import RATE, Sound, sine
from nao_sim_bridge.sound.playing import RAMP

STEADY = Sound(np.full(2 * RATE, 0.5, np.float32))
RISING = Sound(np.arange(RATE, dtype=np.float32) / RATE)
A_TICK = 0.0084
"""A little more than a tick of the simulation, s."""


def noting(one, *times, notes):
    """Marks at times of a sound that note (time of the sound, time of the room)."""
    return [(at, lambda at=at: notes.append((at, one.time))) for at in times]


def test_marks_are_called_when_playing_passes_them_and_one_that_fails_stops_nothing(room, caplog):
    one, notes = room(), []
    marks = [*noting(one, 0.5, 0.1, 0.0, 1.0, notes=notes), (0.3, lambda: 1 / 0)]
    playing = one.loudspeakers.play(sine(500.0, 1.0), "say", marks=marks)
    one.run(2.0)
    assert [at for at, _ in notes] == [0.0, 0.1, 0.5, 1.0]
    assert all(0.0 <= when - at < A_TICK for at, when in notes)
    assert playing.task.finished and "ZeroDivisionError" in caplog.text


def test_marks_wait_while_it_is_paused_and_are_left_out_when_sought_past(room):
    one, notes = room(), []
    playing = one.loudspeakers.play(sine(500.0, 2.0), "play", marks=noting(one, 0.5, 1.0, notes=notes))
    one.run(0.25)
    playing.pause()
    one.run(1.0)
    assert playing.paused and playing.position == pytest.approx(0.25) and not notes
    playing.resume()
    one.run(0.5)
    assert notes == [(0.5, pytest.approx(1.5, abs=0.02))]
    playing.seek(1.5)
    one.run(1.0)
    assert len(notes) == 1 and playing.task.finished


def test_a_loop_goes_on_without_a_gap_and_calls_its_marks_each_time(room):
    one, notes = room(), []
    playing = one.loudspeakers.play(RISING, "play", loop=True, marks=noting(one, 0.5, notes=notes))
    one.run(3.25)
    assert len(notes) == 3 and playing.position == pytest.approx(0.25) and not playing.task.finished
    played = one.loudspeakers.played(0.0, 3.25).samples[:, 0]
    assert np.array_equal(played, np.resize(RISING.samples[:, 0], len(played)))


@pytest.mark.parametrize(
    "change",
    [
        lambda one, playing: playing.pause(),
        lambda one, playing: playing.stop(),
        lambda one, playing: playing.task.kill(),
        lambda one, playing: playing.set_volume(0.0),
        lambda one, playing: playing.set_pan(-1.0),
        lambda one, playing: setattr(one.loudspeakers, "volume", 0.0),
        lambda one, playing: setattr(one.loudspeakers, "muted", True),
        lambda one, playing: setattr(one.loudspeakers, "closed", True),
    ],
    ids=["pause", "stop", "kill", "volume", "pan", "all", "muted", "closed"],
)
def test_silence_comes_within_milliseconds_and_without_a_click(room, change):
    one = room()
    playing = one.loudspeakers.play(STEADY, "play")
    one.run(0.5)
    change(one, playing)
    one.run(0.5)
    right = one.loudspeakers.played(0.4, 1.0).samples[:, 1]
    assert np.abs(np.diff(right)).max() < 0.004
    assert (right[: RATE // 10] == 0.5).all() and not right[RATE // 10 + RAMP :].any()


def test_sounds_are_mixed_and_cut_at_full_scale(room):
    one = room()
    for _ in range(3):
        one.loudspeakers.play(STEADY, "play")
    one.run(0.1)
    assert one.loudspeakers.played(0.05, 0.1).samples.max() == 1.0
    one.loudspeakers.stop_all()
    one.run(0.1)
    assert not one.loudspeakers.playing and not one.loudspeakers.played(0.15, 0.2).samples.any()


def test_sounds_in_a_row_have_no_gap_even_when_one_ends_between_two_ticks(room):
    one = room()
    first = one.loudspeakers.play(Sound(RISING.samples[:5000]), "send")
    one.loudspeakers.play(Sound(RISING.samples[5000:9001]), "send", after=first)
    one.run(0.3)
    assert np.array_equal(one.loudspeakers.played(0.0, 9001 / RATE).samples[:, 0], RISING.samples[:9001, 0])


def test_volumes_multiply_pan_takes_from_the_other_side_and_stereo_keeps_its_sides(room):
    one = room()
    two_sided = Sound(np.array([[0.1, 0.2]] * RATE, np.float32))
    for sound, options, sides in [
        (STEADY, {"volume": 0.5}, [0.125, 0.125]),
        (STEADY, {"pan": 0.25}, [0.1875, 0.25]),
        (STEADY, {"pan": -1.0}, [0.25, 0.0]),
        (two_sided, {}, [0.05, 0.1]),
    ]:
        one.loudspeakers.volume = 50.0
        one.run(0.1)
        playing = one.loudspeakers.play(sound, "play", **options)
        one.run(0.1)
        assert one.loudspeakers.played(one.time - 0.02, one.time).samples[0].tolist() == pytest.approx(sides)
        playing.stop()
        one.run(0.1)
