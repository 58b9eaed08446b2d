"""A bounded queue of frames that drops the oldest. No ROS; the caller does the locking."""

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
    """The frame of a message that arrived at ROS time `now`, s."""
    return Frame(message, message.header.stamp.to_sec() or now)


class FrameQueue:
    def __init__(self) -> None:
        self.dropped = 0
        self._frames: deque[Frame] = deque()
        self._bytes = 0

    def __len__(self) -> int:
        return len(self._frames)

    def put(self, frame: Frame) -> None:
        """Add a frame; drop the oldest if the queue is full."""
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
        """Remove the oldest frame; the queue must not be empty."""
        frame = self._frames.popleft()
        self._bytes -= len(frame.message.data)
        return frame
