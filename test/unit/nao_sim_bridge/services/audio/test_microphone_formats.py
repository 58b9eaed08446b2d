"""Formats of what the microphones hear, as clients ask for them."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.services.audio.microphone_formats import MicrophoneFormat, flags_to_channel, microphone_format
from nao_sim_bridge.sim.errors import BadValue


@pytest.mark.parametrize(
    "asked, wants, channel",
    [
        ((48000, 0, 0), "48k4", None),
        ((48000, [1, 1, 1, 1], 1), "48k4", None),
        ((16000, 1, 0), "16k1", "left"),
        ((16000, 2, 0), "16k1", "right"),
        ((16000, 3, 0), "16k1", "front"),
        ((16000, 4, 0), "16k1", "rear"),
        ((16000, [0, 0, 1, 0], 0), "16k1", "front"),
        ((16000, (0, 1, 0, 0), 0), "16k1", "right"),
    ],
)
def test_what_the_robot_offers_is_understood(asked, wants, channel):
    found = microphone_format(*asked)
    assert found.wants == wants
    assert channel is None or found.channel_name == channel


@pytest.mark.parametrize(
    "asked", [(16000, 0, 0), (48000, 3, 0), (44100, 0, 0), (16000, 5, 0), (16000, -1, 0), (16000, "front", 0)]
)
def test_everything_else_is_refused_with_what_there_is(asked):
    with pytest.raises(BadValue, match="48000 Hz with channels 0 .all four., or 16000 Hz with 1 .left."):
        microphone_format(*asked)


def test_the_order_is_named():
    with pytest.raises(BadValue, match="deinterleaved is 2, allowed is 0 or 1"):
        microphone_format(48000, 0, 2)


@pytest.mark.parametrize("flags", [[], [0, 0, 0, 0], [1, 1, 0, 0], [2, 0, 0, 0], [1, 0, 0], [1, 0, 0, 0, 0], "1000", 3])
def test_flags_mean_one_or_all(flags):
    with pytest.raises(BadValue, match="flags .left, right, front, rear. of 0 or 1: one of them set, or all four"):
        flags_to_channel(flags)


def test_samples_are_packed_frame_by_frame_or_channel_by_channel():
    samples = np.array([[1, 2, 3, 4], [5, 6, 7, -8]], dtype=np.int16)
    assert np.frombuffer(MicrophoneFormat().packed(samples), "<i2").tolist() == [1, 2, 3, 4, 5, 6, 7, -8]
    apart = MicrophoneFormat(deinterleaved=True).packed(samples)
    assert np.frombuffer(apart, "<i2").tolist() == [1, 5, 2, 6, 3, 7, 4, -8]
