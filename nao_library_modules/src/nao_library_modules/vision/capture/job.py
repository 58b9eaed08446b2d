"""What streams and recordings have in common: a thread that handles the frames of a camera in order. No ROS."""

from __future__ import annotations

import logging
import threading
import time
from abc import ABC, abstractmethod
from typing import Any

from nao_library_msgs.msg import VisionThread
from naoqi.errors import NaoError

from ...base.errors import BadGoal
from .pictures import BadPicture
from .queue import Frame, FrameQueue, frame_of
from .times import RateLimit, RecentRate

log = logging.getLogger(__name__)

STALLED_AFTER = 2.0
"""s of ROS time without a frame after which a camera has stalled."""
SLOW_CAMERA = 5.0
"""Periods without a frame after which a camera with few frames a second has stalled."""
STALL_CHECK = 1.0
"""s of wall-clock time between two checks whether frames still come."""
STAMP_STEP = 1e-6
"""s; more than what rounding does to stamps, which are whole nanoseconds."""
END_LIMIT = 10.0
"""s that the waiting frames may take when a job is stopped."""
LAST_FRAME_LIMIT = 1.0
"""s to wait at a stop for frames that are on their way; a camera that is later than that has another clock."""


def taken(ident: str) -> BadGoal:
    """The error for the name of a job that runs."""
    return BadGoal("id", ident, "stop it first, or take another name", problem=f"{ident!r} runs already")


class CaptureJob(ABC):
    """Handles the frames of a topic in a thread of its own from each start to the next stop.

    Threads: the receiver of messages calls `_arrived`, the worker `_handle` and `_end`, the executor of goals all else;
    the thread that ends the node may call `stop`. The condition guards what they share.
    """

    kind = ""
    """stream or recording"""
    whole = False
    """Whether a stop waits for frames that were taken before it and have not come yet."""

    def __init__(self, ident: str, topic: str, rate: float, topics: Any, clock: Any) -> None:
        """Nothing is received before `start`.

        Args:
            ident: The user's name for the job.
            topic: Full name of the source.
            rate: Frames a second at most; 0: all.
            topics: VisionTopics, or what takes its place.
            clock: ROS time.
        """
        self.ident = ident
        self.topic = topic
        self._rate = rate
        self._topics = topics
        self._clock = clock
        self._changed = threading.Condition()
        self._state = "ready"
        self._worker: threading.Thread | None = None
        self._subscription: Any = None
        self._forget()

    @abstractmethod
    def _begin(self) -> None:
        """Open the target, before the first frame can come; if a NaoError is raised the job does not start."""

    @abstractmethod
    def _handle(self, frame: Frame) -> tuple[int, int] | None:
        """Pass a frame on; width and height at the target, None if the frame was dropped.

        Raises:
            BadPicture: The frame cannot be read; the job goes on.
            NaoError: The job fails.
        """

    @abstractmethod
    def _end(self) -> None:
        """Close the target."""

    @property
    def settings(self) -> dict[str, Any]:
        """Arguments of the constructor that JSON can hold, to make the job again after the death of the node."""
        return {"ident": self.ident, "topic": self.topic, "rate": self._rate}

    @abstractmethod
    def _fill(self, report: VisionThread) -> None:
        """Fill the fields that only this kind of job has."""

    # Life

    @property
    def runs(self) -> bool:
        with self._changed:
            return self._state == "running"

    def start(self) -> None:
        """Begin to take frames. Raises NaoError if it runs already, or cannot."""
        if self.runs:
            raise taken(self.ident)
        self._finish()  # what failed before may still have something open
        self._forget()
        self._begin()
        with self._changed:
            self._state = "running"
            self._began = self._clock.now()
        self._worker = threading.Thread(target=self._work, name=f"{self.kind} {self.ident}", daemon=True)
        self._worker.start()
        try:
            self._subscription = self._topics.subscribe(self.topic, self._arrived)
        except NaoError:
            self._state = "ready"
            self._finish()
            raise

    def stop(self, at_once: bool = False) -> None:
        """End after the frames that have come; no effect on a job that does not run.

        `at_once`: whether not to wait for frames that are on their way.
        """
        with self._changed:
            if self._state == "running" and self.whole and not at_once:
                self._wait_for_the_last()
            if self._state == "running":
                self._state = "stopped"
        self._finish()

    def let_go(self) -> None:
        """Take no further frames, without any wait; `stop` has to follow."""
        with self._changed:
            if self._state == "running":
                self._state = "stopped"
            self._ended = self._ended or self._clock.now()
            self._changed.notify_all()

    def wait_until(self, deadline: float) -> None:
        """Wait until the frames that have come are handled; drop those left at the deadline (`time.monotonic`, s)."""
        worker = self._worker
        if worker is not None:
            worker.join(max(0.0, deadline - time.monotonic()))
            with self._changed:
                self._queue.drop_all()

    def _wait_for_the_last(self) -> None:
        """Wait for a frame that was taken after this moment; with the condition held."""
        now = self._clock.now()
        late = self._last_arrival - self._last_stamp
        if not self._arrivals or self._stalled(now) or not -STAMP_STEP <= late < LAST_FRAME_LIMIT:
            return
        self._until = self._ended = now
        due = now - STAMP_STEP
        self._changed.wait_for(lambda: self._last_stamp >= due or self._state != "running", LAST_FRAME_LIMIT)

    def _finish(self) -> None:
        """Unsubscribe, and wait for the worker's end."""
        subscription, self._subscription = self._subscription, None
        if subscription is not None:
            subscription.close()
        with self._changed:
            self._ended = self._ended or self._clock.now()
            self._changed.notify_all()
        worker = self._worker
        if worker is not None:
            worker.join(END_LIMIT)
            if worker.is_alive():
                log.warning("%s %r has not ended after %g s", self.kind, self.ident, END_LIMIT)

    def report(self) -> VisionThread:
        """State, counts, rate and size now."""
        now = self._clock.now()
        with self._changed:
            stalled = self._stalled(now)
            state = self._state
            if state == "running":
                state = "stalled" if stalled else "running" if self._arrivals else "waiting"
            report = VisionThread(
                id=self.ident,
                kind=self.kind,
                state=state,
                error=self._error,
                topic=self.topic,
                frames=self._frames,
                dropped=self._dropped + self._queue.dropped,
                frame_rate=0.0 if stalled or self._state != "running" else self._meter.rate,
                width=self._size[0],
                height=self._size[1],
                duration=max(0.0, (self._ended or now) - self._began) if self._began is not None else 0.0,
            )
        self._fill(report)
        return report

    # Frames

    def _forget(self) -> None:
        self._queue = FrameQueue()
        self._limit = RateLimit(self._rate)
        self._meter = RecentRate()
        self._arrivals = self._frames = self._dropped = 0
        self._size = (0, 0)
        self._error = ""
        self._began: float | None = None
        self._ended: float | None = None
        self._last_arrival = self._last_stamp = 0.0
        self._until: float | None = None
        self._stall_reported = False

    def _arrived(self, message: Any) -> None:
        """Queue a message, and nothing that takes time: rospy calls this from the thread that receives."""
        now = self._clock.now()
        frame = frame_of(message, now)
        with self._changed:
            if self._state != "running":
                return
            self._arrivals += 1
            self._last_arrival, self._last_stamp = now, frame.stamp
            if self._until is not None and frame.stamp >= self._until:
                self._changed.notify_all()
                return
            if not self._limit.passes(frame.stamp):
                return
            self._queue.put(frame)
            self._changed.notify_all()

    def _next(self) -> Frame | None:
        """The oldest frame that waits, or the next to come; None when no further one will come."""
        while True:
            with self._changed:
                if not self._queue and self._state == "running":
                    self._changed.wait(STALL_CHECK)
                if self._queue:
                    return self._queue.take()
                if self._state != "running":
                    return None
            self._report_stall()

    def _work(self) -> None:
        problem = ""
        try:
            for frame in iter(self._next, None):
                self._pass_on(frame)
        except NaoError as error:
            problem = str(error)
        except Exception as error:
            log.exception("%s %r", self.kind, self.ident)
            problem = f"unexpected error: {error!r}"
        try:
            self._end()
        except NaoError as error:
            problem = problem or str(error)
        if problem:
            log.error("%s %r ended: %s", self.kind, self.ident, problem)
            with self._changed:
                self._state, self._error = "failed", problem
                self._ended = self._ended or self._clock.now()
            subscription = self._subscription  # `stop` may close it as well, which does no harm
            if subscription is not None:
                subscription.close()

    def _pass_on(self, frame: Frame) -> None:
        try:
            size = self._handle(frame)
        except BadPicture as error:
            with self._changed:
                is_new = self._error != str(error)
                self._error = str(error)
                self._dropped += 1
            if is_new:
                log.error("%s %r: %s", self.kind, self.ident, error)
            return
        with self._changed:
            if size is None:
                self._dropped += 1
                return
            self._error = ""
            self._size = size
            self._frames += 1
            self._meter.count(frame.stamp)

    def _stalled(self, now: float) -> bool:
        """Whether frames have come and no longer come; with the condition held."""
        if not self._arrivals or self._state != "running":
            return False
        rate = self._meter.rate
        return now - self._last_arrival > max(STALLED_AFTER, SLOW_CAMERA / rate if rate else 0.0)

    def _report_stall(self) -> None:
        with self._changed:
            stalled = self._stalled(self._clock.now())
            is_new = stalled != self._stall_reported
            self._stall_reported = stalled
        if is_new and stalled:
            log.warning("%s %r: no frames come from %s any more", self.kind, self.ident, self.topic)
