"""When which part of a sound sounds. Arithmetic only."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

RAMP = 192
"""Frames (4 ms) in which something that begins or ends in the middle of a wave fades, so that it does not click."""


class Segment(NamedTuple):
    """A stretch in which a sound goes on without a break.

    Attributes:
        begin: First frame on the timeline.
        offset: The frame of the sound that is there.
        end: Where it was broken off; None as long as it was not.
    """

    begin: int
    offset: int
    end: int | None


class Track:
    """A sound, (frames, channels), on the timeline: pieces of it that begin and end at certain frames.

    Written in the simulation thread, and only for frames that are still to come; read in any thread.
    """

    def __init__(self, samples: np.ndarray, loop: bool) -> None:
        self.samples = samples
        self.loop = loop
        self._segments: tuple[Segment, ...] = ()

    @property
    def running(self) -> Segment | None:
        """The segment that was not broken off."""
        last = self._segments[-1] if self._segments else None
        return last if last is not None and last.end is None else None

    def start(self, frame: int, offset: int) -> None:
        """Let the sound's frame `offset` sound at `frame`, and what follows after it."""
        self._segments = (*self._segments, Segment(frame, offset, None))

    def stop(self, frame: int) -> None:
        """Break off at `frame`."""
        running = self.running
        if running is not None:
            if running.begin >= frame:
                self._segments = self._segments[:-1]
            else:
                self._segments = (*self._segments[:-1], running._replace(end=frame))

    def last_frame(self) -> int | None:
        """Where the last sound of it is over; None when that is open."""
        if not self._segments:
            return -(2**62)
        last = self._segments[-1]
        if last.end is not None:
            return last.end + RAMP
        return None if self.loop else last.begin + len(self.samples) - last.offset

    def render(self, first: int, last: int) -> np.ndarray | None:
        """(last - first, channels) samples from frame `first` to `last`; None when nothing sounds there."""
        out = None
        for segment in self._segments:
            low, high = max(first, segment.begin), min(last, self._audible_until(segment, last))
            if low >= high:
                continue
            piece = self._piece(segment.offset + low - segment.begin, high - low)
            fade = _fade(segment, low, high)
            if fade is not None:
                piece = piece * fade[:, None]
            if out is None:
                if high - low == last - first:
                    out = piece
                    continue
                out = np.zeros((last - first, self.samples.shape[1]), np.float32)
            elif not out.flags.writeable:
                out = out.copy()
            out[low - first : high - first] += piece
        return out

    def forget(self, before: int) -> None:
        """Drop segments that were over before a frame."""
        kept = tuple(s for s in self._segments if s.end is None or s.end + RAMP > before)
        if len(kept) != len(self._segments):
            self._segments = kept

    def _audible_until(self, segment: Segment, last: int) -> int:
        until = last if segment.end is None else segment.end + RAMP
        return until if self.loop else min(until, segment.begin + len(self.samples) - segment.offset)

    def _piece(self, start: int, count: int) -> np.ndarray:
        if not self.loop:
            return self.samples[start : start + count]
        start %= len(self.samples)
        if start + count <= len(self.samples):
            return self.samples[start : start + count]
        return np.take(self.samples, np.arange(start, start + count), axis=0, mode="wrap")


def _fade(segment: Segment, low: int, high: int) -> np.ndarray | None:
    fade = None
    if segment.offset > 0 and low < segment.begin + RAMP:
        fade = np.clip(np.arange(low - segment.begin, high - segment.begin, dtype=np.float32) / RAMP, 0.0, 1.0)
    if segment.end is not None and high > segment.end:
        out = np.clip(1.0 - np.arange(low - segment.end, high - segment.end, dtype=np.float32) / RAMP, 0.0, 1.0)
        fade = out if fade is None else fade * out
    return fade
