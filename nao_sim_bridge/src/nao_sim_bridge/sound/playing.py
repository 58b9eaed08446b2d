"""A sound that plays, and the handle of whoever plays it."""

from __future__ import annotations

from typing import Callable, Iterable, NamedTuple, Sequence, Tuple

import numpy as np

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.samples import RATE, Sound, frame_at
from nao_sim_bridge.base.tasks import Task, TaskIds
from nao_sim_bridge.sound.envelope import Envelope
from nao_sim_bridge.sound.timeline import Timeline

Mark = Tuple[float, Callable[[], None]]
RAMP = 192
"""Frames (4 ms) in which something that begins or ends in the middle of a wave fades, so that it does not click."""


class Segment(NamedTuple):
    """A stretch in which a sound goes on without a break, from a frame on the timeline on.

    `offset` is the frame of the sound that is there; it ends where it was broken off, None as long as it was not.
    """

    begin: int
    offset: int
    end: int | None


class Track:
    """A sound, (frames, channels), on the timeline: when which part of it sounds.

    Written in the simulation thread, and only for frames that are still to come; read in any thread.
    """

    def __init__(self, samples: np.ndarray, loop: bool) -> None:
        self.samples = samples
        self.loop = loop
        self._segments: tuple[Segment, ...] = ()

    def start(self, frame: int, offset: int) -> None:
        """Let the sound's frame `offset` sound at `frame`, and what follows after it."""
        self._segments = (*self._segments, Segment(frame, offset, None))

    def stop(self, frame: int) -> None:
        """Break off at `frame`."""
        if self._segments and self._segments[-1].end is None:
            *before, running = self._segments
            self._segments = (*before, running._replace(end=frame)) if running.begin < frame else tuple(before)

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
        self._segments = tuple(s for s in self._segments if s.end is None or s.end + RAMP > before)

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


class Playing:
    """One sound, at RATE, that plays. Everything but the properties is for the simulation thread.

    It begins at a frame of the timeline, None for now, and `start` s in the sound; a loop begins again at its end,
    until it is stopped. Its task ends when it has been played; killing that is silence at once. Marks are (seconds,
    callback), called in the simulation thread when playing passes that place of the sound, in a loop each time.
    The gains are factors of its volume at first, one a channel.
    """

    def __init__(
        self,
        timeline: Timeline,
        ids: TaskIds,
        name: str,
        sound: Sound,
        start: float,
        loop: bool,
        marks: Iterable[Mark],
        begin: int | None,
        gains: Sequence[float],
    ) -> None:
        self.sound = sound.at_rate(RATE)
        if loop and not self.sound.frames:
            raise BadValue("sound", "empty", "a sound that lasts, when it is to be repeated")
        self._timeline = timeline
        self._track = Track(self.sound.samples, loop)
        self._gains = Envelope(gains, RAMP)
        self._marks = sorted(((frame_at(at), call) for at, call in marks), key=lambda mark: mark[0])
        self._next_mark = 0
        self._origin = 0  # the frame at which the sound's first frame is, or would have been
        self._resting: int | None = None  # where in the sound it is paused
        self._guard = ids.guard
        self.task: Task = ids.make(name, on_kill=lambda _: self._break_off())
        self._begin(max(timeline.now, begin or 0), self._checked(start))

    # --- any thread -----------------------------------------------------------------------------------------------

    @property
    def position(self) -> float:
        """Where in the sound playing is, s."""
        resting = self._resting
        return (self._place(self._timeline.now) if resting is None else resting) / RATE

    @property
    def paused(self) -> bool:
        return self._resting is not None and not self.task.finished

    @property
    def ended(self) -> bool:
        """Whether it is over, in whatever way."""
        return self.task.finished

    @property
    def end_frame(self) -> int | None:
        """The frame of the timeline at which it will be over; None in a loop, when paused, and afterwards."""
        if self._track.loop or self._resting is not None or self.task.finished:
            return None
        return self._origin + self.sound.frames

    # --- simulation thread ----------------------------------------------------------------------------------------

    def pause(self) -> None:
        """Be silent until `resume`; the task goes on."""
        if self._resting is None and not self.task.finished:
            self._resting = self._place(self._timeline.now)
            self._track.stop(self._timeline.now)

    def resume(self) -> None:
        """Go on where it was paused."""
        if self._resting is not None and not self.task.finished:
            offset, self._resting = self._resting, None
            self._begin(self._timeline.now, offset)

    def seek(self, seconds: float) -> None:
        """Go to another place of the sound; what is between is not played, and its marks are not called."""
        offset = self._checked(seconds)
        if self.task.finished:
            return
        if self._resting is not None:
            self._resting = offset
            return
        self._track.stop(self._timeline.now)
        self._begin(self._timeline.now, offset)

    def stop(self) -> None:
        """Silence at once; the task is killed."""
        self.task.kill()

    def next_due(self) -> int | None:
        """The frame of the next mark or of the end."""
        if self._resting is not None or self.task.finished:
            return None
        if self._next_mark < len(self._marks):
            return self._origin + min(self._marks[self._next_mark][0], self.sound.frames)
        return self._origin + self.sound.frames

    def work(self, frame: int) -> None:
        """Call the marks up to `frame`, and end the task when the sound is over."""
        while True:
            due = self.next_due()
            if due is None or due > frame:
                return
            if self._next_mark < len(self._marks):
                self._next_mark += 1
                self._guard.call(self._marks[self._next_mark - 1][1])
            elif self._track.loop:
                self._origin += self.sound.frames
                self._next_mark = 0
            else:
                self.task.finish()

    # --- for those who render -------------------------------------------------------------------------------------

    def render(self, first: int, last: int) -> np.ndarray | None:
        """(last - first, channels) as it plays, before its gains; None when nothing sounds."""
        return self._track.render(first, last)

    def gains(self, first: int, last: int) -> list[np.ndarray] | Tuple[float, ...]:
        """Its gains from frame `first` to `last`; numbers when they do not change."""
        return self._gains.between(first, last)

    def over_before(self, frame: int) -> bool:
        """Whether nothing of it sounds from `frame` on, nor will."""
        last = self._track.last_frame()
        return self.task.finished and last is not None and last <= frame

    def forget(self, before: int) -> None:
        """Drop what was over before a frame."""
        self._track.forget(before)
        self._gains.forget(before)

    # --- inside ---------------------------------------------------------------------------------------------------

    def _set_gains(self, gains: Sequence[float]) -> None:
        self._gains.set(self._timeline.now, gains)

    def _place(self, frame: int) -> int:
        place = max(0, frame - self._origin)
        if self._track.loop:
            return place % self.sound.frames
        return min(place, self.sound.frames)

    def _checked(self, seconds: float) -> int:
        if not 0.0 <= seconds <= self.sound.duration:
            raise BadValue("position", seconds, f"0 to {self.sound.duration:g} s, the length of the sound")
        return frame_at(seconds)

    def _begin(self, frame: int, offset: int) -> None:
        self._track.start(frame, offset)
        self._origin = frame - offset
        self._next_mark = sum(1 for at, _ in self._marks if at < offset)
        self._timeline.add(self)

    def _break_off(self) -> None:
        if self._resting is None:
            self._resting = self._place(self._timeline.now)
        self._track.stop(self._timeline.now)
