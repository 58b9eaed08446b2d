"""Frames that wait for their turn: bounded, the oldest go first. No ROS, no locks: who uses it has one."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import Any

from ...base.limits import limit

MOST_FRAMES = int(limit("waiting pictures").highest)
"""That wait; of more the oldest go."""
MOST_BYTES = int(limit("bytes of waiting pictures").highest)
"""Of pictures that wait; two always may."""


@dataclass(frozen=True)
class Frame:
    """A message of a camera.

    Attributes:
        message: sensor_msgs/Image or sensor_msgs/CompressedImage.
        stamp: When it was taken, s; when it came, if the camera does not say.
    """

    message: Any
    stamp: float


def frame_of(message: Any, now: float) -> Frame:
    """A message that came at a ROS time, in s."""
    return Frame(message, message.header.stamp.to_sec() or now)


class FrameQueue:
    """Frames in the order in which they came.

    Attributes:
        dropped: How many were too many.
    """

    def __init__(self) -> None:
        """Begin empty."""
        self.dropped = 0
        self._frames: deque[Frame] = deque()
        self._bytes = 0

    def __len__(self) -> int:
        """How many wait."""
        return len(self._frames)

    def put(self, frame: Frame) -> None:
        """Add a frame; the oldest make room."""
        self._frames.append(frame)
        self._bytes += len(frame.message.data)
        while len(self) > MOST_FRAMES or (self._bytes > MOST_BYTES and len(self) > 2):
            self.take()
            self.dropped += 1

    def drop_all(self) -> None:
        """Let nobody have those that wait."""
        while self:
            self.take()
            self.dropped += 1

    def take(self) -> Frame:
        """Remove the oldest one; there must be one."""
        frame = self._frames.popleft()
        self._bytes -= len(frame.message.data)
        return frame
