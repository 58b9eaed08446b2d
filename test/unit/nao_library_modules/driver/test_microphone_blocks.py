"""Blocks of sound: samples, channels, times and gaps."""

from __future__ import annotations

import pytest

from nao_library_modules.driver.microphone_blocks import (
    FRONT_CENTER,
    FRONT_LEFT,
    FRONT_RIGHT,
    REAR_CENTER,
    REAR_LEFT,
    REAR_RIGHT,
    BlockClock,
    channel_map,
    read_samples,
)
from naoqi.errors import NaoError

BLOCK = 0.17


@pytest.mark.parametrize("version", ["6.0.0", "V6.0", "", "unknown"])
def test_corners_of_the_head(version):
    assert channel_map(4, version) == (REAR_LEFT, REAR_RIGHT, FRONT_LEFT, FRONT_RIGHT)
    assert channel_map(1, version) == (FRONT_LEFT,)


@pytest.mark.parametrize("version", ["5.0.0", "V4.0", "4"])
def test_sides_front_and_back_of_older_heads(version):
    assert channel_map(4, version) == (FRONT_LEFT, FRONT_RIGHT, FRONT_CENTER, REAR_CENTER)
    assert channel_map(1, version) == (FRONT_CENTER,)


def test_samples_are_signed_and_little_end_first():
    assert list(read_samples(b"\x01\x00\xff\xff\x00\x80\xff\x7f", 2, 2)) == [1, -1, -32768, 32767]


def test_a_block_that_is_cut_off_is_no_block():
    with pytest.raises(NaoError, match="4 channels and 2 frames has 15 bytes"):
        read_samples(bytes(15), 4, 2)


def stamp(seconds):
    return [int(seconds), round(1e6 * (seconds - int(seconds)))]


def test_times_of_the_first_sample_follow_the_quickest_blocks():
    clock, ahead = BlockClock(), 1000.0
    delays = [0.05, 0.03, 0.2, 0.01, 0.3, 0.02]
    times = []
    for n, delay in enumerate(delays):
        heard = 5.0 + n * BLOCK
        times.append((heard, clock.take(stamp(heard), BLOCK, heard + BLOCK + ahead + delay)))
    assert all(time.robot == pytest.approx(heard) for heard, time in times)
    off = [time.ros - ahead - heard for heard, time in times]
    assert off == pytest.approx([0.05, 0.03, 0.03, 0.01, 0.01, 0.01], abs=1e-3)
    assert clock.lost == 0


def test_clocks_that_run_apart_are_followed():
    clock = BlockClock()
    for n in range(3000):
        heard = n * BLOCK
        time = clock.take(stamp(heard), BLOCK, (heard + BLOCK) * 1.00005 + 0.01)
    assert time.ros - heard * 1.00005 == pytest.approx(0.01, abs=0.005)


def test_gaps_are_counted_in_blocks():
    clock = BlockClock()
    for n in (0, 1, 2, 5, 6, 8):
        clock.take(stamp(n * BLOCK), BLOCK, n * BLOCK)
    assert clock.lost == 3


def test_a_robot_that_starts_again_has_lost_nothing():
    clock = BlockClock()
    clock.take(stamp(100.0), BLOCK, 1100.0)
    time = clock.take(stamp(0.0), BLOCK, 2000.0)
    assert time.ros == pytest.approx(2000.0 - BLOCK)
    clock.restart()
    clock.take(stamp(50.0), BLOCK, 2050.0)
    assert clock.lost == 0
