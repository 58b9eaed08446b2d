"""Pieces of sound follow each other without a gap, at any rate, and senders are held back."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.services.audio.output_buffers import OutputBuffers, samples_of
from nao_sim_bridge.sim.errors import BadValue


@pytest.fixture
def buffers(bench):
    made = OutputBuffers(bench)
    made.set_rate(48000)
    return made


def tone(seconds, rate, frequency=440.0):
    time = np.arange(round(seconds * rate)) / rate
    return np.repeat((0.5 * np.sin(2.0 * np.pi * frequency * time)).astype(np.float32)[:, np.newaxis], 2, axis=1)


def test_pieces_follow_each_other_to_the_frame(bench, buffers):
    whole = tone(0.9, 48000)
    for piece in np.split(whole, [5000, 12345, 30001]):
        assert buffers.add(piece) is True
    bench.advance(1.0)
    np.testing.assert_allclose(bench.played(0.0, 0.9), whole, atol=0.5)
    np.testing.assert_allclose(bench.played(0.02, 0.88), whole[960:-960], atol=1e-6)
    assert not bench.played(0.9, 1.0).any()


def test_pieces_that_come_while_others_play_follow_without_a_gap(bench, buffers):
    whole = tone(1.2, 48000)
    for number, piece in enumerate(np.split(whole, 12)):
        assert buffers.add(piece) is True
        if number:
            bench.advance(0.09)
    bench.advance(0.3)
    np.testing.assert_allclose(bench.played(0.02, 1.18), whole[960:-960], atol=1e-6)


@pytest.mark.parametrize("rate", [16000, 22050, 44100])
def test_other_rates_are_changed_without_a_seam_and_to_the_end(bench, buffers, rate):
    buffers.set_rate(rate)
    pieces = np.array_split(tone(1.0, rate), 8)
    for number, piece in enumerate(pieces):
        buffers.add(piece)
        if number:
            bench.advance(0.1)
    bench.advance(0.6)
    expected = tone(1.0, 48000)
    heard = bench.played(0.0, 1.2)
    np.testing.assert_allclose(heard[1000:47000], expected[1000:47000], atol=0.01)
    assert np.abs(heard[47000:47950]).max() > 0.4
    assert not heard[48100:].any()


def test_a_pause_between_pieces_is_a_pause(bench, buffers):
    buffers.add(tone(0.1, 48000))
    bench.advance(0.5)
    buffers.add(tone(0.1, 48000))
    bench.advance(0.5)
    assert bench.played(0.02, 0.08).any() and bench.played(0.52, 0.58).any()
    assert not bench.played(0.1, 0.5).any()


def test_a_sender_waits_while_more_than_a_second_is_to_come(bench, buffers):
    piece = tone(0.25, 48000)
    assert [buffers.add(piece) for _ in range(4)] == [True] * 4
    waiting = buffers.add(piece)
    assert not waiting.finished
    bench.advance(0.2)
    assert not waiting.finished
    bench.advance(0.06)
    assert waiting.value is True


def test_one_that_does_not_wait_is_refused_in_the_end(bench, buffers):
    piece = tone(0.3, 48000)
    answers = [buffers.add(piece) for _ in range(150)]
    assert answers[0] is True and answers[-1] is False
    assert sum(answer is not False for answer in answers) == 101
    bench.advance(31.0)
    assert all(answer.value is True for answer in answers if answer not in (True, False))
    assert buffers.add(piece) is True


def test_dropping_is_silence_and_lets_senders_go(bench, buffers):
    piece = tone(0.4, 48000)
    answers = [buffers.add(piece) for _ in range(5)]
    bench.advance(0.1)
    buffers.drop()
    assert answers[-1].value is True
    buffers.add(piece)
    bench.advance(0.3)
    assert np.abs(bench.played(0.12, 0.38)).max() > 0.4
    bench.advance(0.5)
    assert not bench.played(0.52, 0.9).any()


def test_after_a_reset_pieces_begin_at_once(bench, buffers):
    for _ in range(4):
        buffers.add(tone(0.25, 48000))
    bench.loudspeakers.stop_all()
    bench.advance(0.1)
    assert buffers.add(tone(0.25, 48000)) is True
    bench.advance(0.2)
    assert bench.played(0.12, 0.3).any()


def test_bytes_and_numbers_are_understood():
    expected = [[0.5, -1.0], [0.0, 0.25]]
    raw = np.array([16384, -32768, 0, 8192], dtype="<i2").tobytes()
    assert samples_of(2, raw).tolist() == expected
    assert samples_of(2, bytearray(raw)).tolist() == expected
    assert samples_of(2, [16384, -32768, 0, 8192]).tolist() == expected


@pytest.mark.parametrize(
    "frames, buffer, message",
    [
        (0, b"", "nbOfFrames is 0, allowed is 1 to 16384"),
        (16385, bytes(4 * 16385), "nbOfFrames is 16385"),
        (2, bytes(4), "length of pBuffer is 4, allowed is 4 bytes a frame, 8 in all"),
        (1, [1, 2, 3], "pBuffer is 'list', allowed is bytes of 1 frames of two channels of 16 bits"),
        (1, [1, 40000], r"pBuffer\[1\] is 40000, allowed is -32768 to 32767"),
        (1, "text", "pBuffer is 'str'"),
    ],
)
def test_what_is_no_sound_is_refused(frames, buffer, message):
    with pytest.raises(BadValue, match=message):
        samples_of(frames, buffer)
