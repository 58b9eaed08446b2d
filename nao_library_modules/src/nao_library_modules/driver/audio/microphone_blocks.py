"""Blocks of sound from the microphones: format, channels, time, and lost ones. No ROS."""

from __future__ import annotations

import sys
from array import array
from collections.abc import Sequence
from dataclasses import dataclass

from naoqi.errors import NaoError

# nao_library_msgs/AudioBuffer has the same numbers.
FRONT_LEFT, FRONT_CENTER, FRONT_RIGHT, REAR_LEFT, REAR_CENTER, REAR_RIGHT = range(6)
MAPS = {
    "V6": (REAR_LEFT, REAR_RIGHT, FRONT_LEFT, FRONT_RIGHT),
    "older": (FRONT_LEFT, FRONT_RIGHT, FRONT_CENTER, REAR_CENTER),
}
"""Head -> where its microphones are, in NAOqi's order: left, right, front, rear.

Source: the NAO pages of NAOqi 2.8 (V6: four corners of the head) and 2.1 (V4, V5: the sides, front and back), and how
the naoqi drivers number them.
"""
FIRST_OF_CORNERS = 6
ALL_CHANNELS, FRONT_CHANNEL = 0, 3
"""What ALAudioDevice calls the channels."""
FORMATS = {16000: (FRONT_CHANNEL, 1), 48000: (ALL_CHANNELS, 4)}
"""Rate in Hz -> what ALAudioDevice is asked for, and how many channels that are."""
RATES = {rate: f"{count} channel{'s' if count > 1 else ''}" for rate, (_, count) in FORMATS.items()}
"""Rate in Hz -> what comes at it, for people."""
FRONT = 2
DRIFT = 1e-4
"""How fast one clock may run away from the other: s a second."""
GAP = 0.5
"""Share of a block from which on a jump in time is a gap."""


def channel_map(channels: int, version: str) -> tuple[int, ...]:
    """Positions of the microphones that the channels of a block come from.

    `channels`: 4, or 1 for the front one. `version`: version of the head or body, such as "6.0.0"; anything else counts
    as V6.
    """
    major = version.lstrip("Vv").split(".")[0]
    older = major.isdigit() and int(major) < FIRST_OF_CORNERS
    places = MAPS["older" if older else "V6"]
    return places if channels == len(places) else (places[FRONT],)


def read_samples(sound: bytes, channels: int, frames: int) -> array:
    """Interleaved samples of a block of 16 bit little-endian sound.

    Raises NaoError unless there are `frames` samples of each of `channels`.
    """
    samples = array("h")
    if len(sound) != channels * frames * samples.itemsize:
        raise NaoError(f"a block of {channels} channels and {frames} frames has {len(sound)} bytes")
    samples.frombytes(sound)
    if sys.byteorder == "big":
        samples.byteswap()
    return samples


@dataclass(frozen=True)
class BlockTime:
    """Time of a block's first sample, s."""

    robot: float  # robot's clock
    ros: float  # ROS time


class BlockClock:
    """Times of the blocks of one stream, and the number lost. For one thread.

    A block arrives with a varying delay. The quickest ones give the offset from the robot's clock to ROS time.
    """

    def __init__(self) -> None:
        self.lost = 0
        self._expected: float | None = None
        self._offset: float | None = None

    def restart(self) -> None:
        """Begin another stream: the time until its first block is no gap, and its clock may differ."""
        self._expected = self._offset = None

    def take(self, stamp: Sequence[float], duration: float, now: float) -> BlockTime:
        """Time of the next block.

        `stamp`: robot's time of its first sample: [s, us]. `duration`: s. `now`: ROS time of its arrival, s.
        """
        robot = stamp[0] + 1e-6 * stamp[1]
        since = 0.0 if self._expected is None else robot - self._expected
        if since < -GAP * duration:
            self._offset = None  # the robot's clock was set back
        elif since > GAP * duration:
            self.lost += round(since / duration)
        self._expected = robot + duration
        latest = now - self._expected
        self._offset = latest if self._offset is None else min(latest, self._offset + DRIFT * duration)
        return BlockTime(robot, robot + self._offset)
