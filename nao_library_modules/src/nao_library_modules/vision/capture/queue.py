"""A bounded queue of frames, from which the oldest are dropped. No ROS, no locks: the user has one."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import Any

from ...base.limits import limit

MOST_FRAMES = int(limit("waiting pictures").highest)
MOST_BYTES = int(limit("bytes of waiting pictures").highest)
"""Of the waiting pictures; two may always wait."""


@dataclass(frozen=True)
class Frame:
    message: Any  # sensor_msgs/Image or sensor_msgs/CompressedImage
    stamp: float  # ROS time at which it was taken, s; of its arrival if the message has none


def frame_of(message: Any, now: float) -> Frame:
    """The frame of a message that came at a ROS time, in s."""
    return Frame(message, message.header.stamp.to_sec() or now)


class FrameQueue:
    """Frames in the order in which they came."""

    def __init__(self) -> None:
        self.dropped = 0
        self._frames: deque[Frame] = deque()
        self._bytes = 0

    def __len__(self) -> int:
        return len(self._frames)

    def put(self, frame: Frame) -> None:
        """Add a frame; the oldest are dropped where there are too many."""
        self._frames.append(frame)
        self._bytes += len(frame.message.data)
        while len(self) > MOST_FRAMES or (self._bytes > MOST_BYTES and len(self) > 2):
            self.take()
            self.dropped += 1

    def drop_all(self) -> None:
        while self:
            self.take()
            self.dropped += 1

    def take(self) -> Frame:
        """Remove the oldest one; there must be one."""
        frame = self._frames.popleft()
        self._bytes -= len(frame.message.data)
        return frame
