"""The subscribers of ALVideoDevice, by the handles that they were given.

libqi does not say whose call it is, nor when a client has gone that is no module itself. So a handle that nobody has
used for a minute is taken from the cameras, and its place is free for others of the same name; should its client be
alive after all, its next call finds everything as it was.
"""

from __future__ import annotations

import functools
import logging
import threading
import time
from dataclasses import dataclass, field
from typing import Any, Callable, Sequence, Tuple

from nao_sim_bridge.base.errors import BadValue, SimulationError
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.cameras.cameras import Cameras, CameraStream
from nao_sim_bridge.cameras.frame import Frame
from nao_sim_bridge.naoqi.binding.errors import NaoqiError

log = logging.getLogger("nao_sim.cameras")

IDLE = load_sizes().clients.camera_idle_s
"""A handle that has not been used for longer, s of wall time, is that of a client which has gone."""
SOON_IDLE = 5.0
"""The same where a new subscriber has no place otherwise."""
REMEMBERED = load_sizes().clients.cameras_remembered
"""Handles of clients that seem to have gone, and that are found again when they are used."""
MOST = load_sizes().clients.cameras
"""Subscribers at the same time."""


class NotSubscribed(NaoqiError):
    """Nobody has the handle of a call."""


def tells_success(method: Callable[..., bool]) -> Callable[..., bool]:
    """The method, which is false for a handle that nobody has, as NAOqi documents it; the log says what was wrong."""

    @functools.wraps(method)
    def tried(*arguments: Any) -> bool:
        try:
            return method(*arguments)
        except NotSubscribed as error:
            log.warning("a call for a camera subscriber does nothing: %s", error)
            return False

    return tried


@dataclass(frozen=True)
class View:
    """What a subscriber sees of one camera: NAOqi's numbers."""

    camera: int
    resolution: int
    color_space: int


@dataclass(eq=False)
class Subscriber:
    """One subscription."""

    name: str  # what the client called itself
    handle: str  # what it got
    views: Tuple[View, ...]  # what it sees; several if it asked for several cameras
    fps: int  # frames a second that it asked for
    several: bool  # whether it asked for several cameras, if only for one of them
    streams: Tuple[CameraStream, ...] = ()
    waiting: set = field(default_factory=set)  # calls that wait for a frame
    used: float = 0.0  # when it was used last, s of wall time


class VideoSubscribers:
    """Who looks, and the pictures for them; idle ones are found by the `clock`, s of wall time. Any thread."""

    def __init__(self, cameras: Cameras, clock: Callable[[], float] = time.monotonic) -> None:
        self._cameras = cameras
        self._clock = clock
        self._lock = threading.RLock()
        self._known: dict[str, Subscriber] = {}
        self._gone: dict[str, Subscriber] = {}

    # --- who looks ------------------------------------------------------------------------------------------------

    def add(self, name: str, views: Sequence[View], fps: int, several: bool) -> str:
        """Let somebody look; returns the handle.

        A BadValue when the cameras cannot do that, or too many look already.
        """
        if not name:
            raise BadValue("name", name, "a name, not empty")
        fps = _rate(fps, self._cameras)
        if len({view.camera for view in views}) < len(views) or not views:
            raise BadValue("cameraIndexes", [view.camera for view in views], "different cameras, one or more")
        with self._lock:
            self.clean_up()
            handle = self._free_handle(name)
            subscriber = Subscriber(name, handle, tuple(views), fps, several)
            self._open(subscriber)
        return handle

    def remove(self, handle: str) -> None:
        """Let somebody look no more; a NotSubscribed when there is no such handle."""
        with self._lock:
            if self._gone.pop(handle, None) is None:
                _close(self._known.pop(self._find(handle).handle))

    def remove_all(self, name: str) -> None:
        """The same for all who have called themselves `name`."""
        with self._lock:
            for handle in [handle for handle, gone in self._gone.items() if gone.name == name]:
                del self._gone[handle]
            for subscriber in [one for one in self._known.values() if one.name == name]:
                _close(self._known.pop(subscriber.handle))

    def get(self, handle: str) -> Subscriber:
        """The subscriber with a handle; it counts as used. A NotSubscribed when there is no such handle."""
        with self._lock:
            self.clean_up()
            back = self._gone.pop(handle, None)
            if back is not None:
                log.info("camera subscriber %r is back", handle)
                self._open(back)
            found = self._find(handle)
            found.used = self._clock()
            return found

    def handles(self) -> list[str]:
        with self._lock:
            self.clean_up()
            return list(self._known)

    def change(self, handle: str, views: Sequence[View] | None = None, fps: int | None = None) -> None:
        """Change what somebody sees; with other cameras as many as before.

        A NaoqiError when there is no such handle, a BadValue when the cameras cannot do that.
        """
        with self._lock:
            subscriber = self.get(handle)
            wanted = tuple(views if views is not None else subscriber.views)
            rate = subscriber.fps if fps is None else _rate(fps, self._cameras)
            tables = self._cameras.tables
            for view in wanted:
                tables.check_rate(tables.camera(view.camera), tables.resolution(view.resolution), rate)
                tables.color_space(view.color_space)
            for stream, view in zip(subscriber.streams, wanted):
                if (stream.camera, stream.resolution) != (view.camera, view.resolution):
                    # A size that one camera has and the other has not is never asked of the wrong one.
                    stream.look(view.camera, view.resolution)
                stream.color_space = view.color_space
                if stream.fps != rate:
                    stream.fps = rate
            subscriber.views, subscriber.fps = wanted, rate

    def clean_up(self) -> None:
        """Take those from the cameras who have not been heard of for long."""
        with self._lock:
            for subscriber in self._idle_for(IDLE):
                self._let_go(subscriber)

    def close(self) -> None:
        with self._lock:
            for subscriber in self._known.values():
                _close(subscriber)
            self._known.clear()
            self._gone.clear()

    # --- pictures -------------------------------------------------------------------------------------------------

    def ask(self, handle: str, call: str, change: Callable[[list[Frame]], Any]) -> Task:
        """A task that ends with what `change` makes of the next frames; a NaoqiError when there is no such handle."""
        with self._lock:
            subscriber = self.get(handle)
            waiting = WaitingCall(call, len(subscriber.streams), change, lambda: self._answered(subscriber, waiting))
            subscriber.waiting.add(waiting)
        return waiting.begin(subscriber.streams)

    def fail(self, camera: int, reason: str) -> None:
        """Calls that wait for a frame of a camera end with an error: there will be none."""
        with self._lock:
            waiting = [w for s in self._known.values() for w in s.waiting if camera in [v.camera for v in s.views]]
        for each in waiting:
            each.fail(NaoqiError(reason))

    def _open(self, subscriber: Subscriber) -> None:
        opened: list[CameraStream] = []
        try:
            for view in subscriber.views:
                look = (view.camera, view.resolution, view.color_space, subscriber.fps)
                opened.append(self._cameras.open(subscriber.handle, *look))
        except Exception:
            for stream in opened:
                stream.close()
            raise
        subscriber.streams = tuple(opened)
        subscriber.used = self._clock()
        self._known[subscriber.handle] = subscriber

    def _free_handle(self, name: str) -> str:
        most = self._cameras.tables.same_name
        candidates = [f"{name}_{index}" for index in range(most)]
        free = [handle for handle in candidates if handle not in self._known]
        if free:
            # One whose last client has not gone silently, if there is any.
            handle = next((handle for handle in free if handle not in self._gone), free[0])
        else:
            idle = [s for s in self._idle_for(SOON_IDLE) if s.handle in candidates]
            if not idle:
                raise BadValue("name", name, f"another one: {most} subscribers have this one; unsubscribe one of them")
            oldest = min(idle, key=lambda subscriber: subscriber.used)
            self._let_go(oldest)
            handle = oldest.handle
        self._gone.pop(handle, None)
        if len(self._known) >= MOST:
            raise BadValue("subscribers", len(self._known) + 1, f"at most {MOST}; unsubscribe some of them")
        return handle

    def _idle_for(self, seconds: float) -> list[Subscriber]:
        now = self._clock()
        return [s for s in self._known.values() if not s.waiting and now - s.used > seconds]

    def _let_go(self, subscriber: Subscriber) -> None:
        log.info("camera subscriber %r has not been heard of for long and is taken off", subscriber.handle)
        del self._known[subscriber.handle]
        _close(subscriber)
        self._gone[subscriber.handle] = subscriber
        while len(self._gone) > REMEMBERED:
            del self._gone[next(iter(self._gone))]

    def _find(self, handle: str) -> Subscriber:
        if handle not in self._known:
            known = ", ".join(map(repr, self._known)) or "nobody"
            raise NotSubscribed(f"{handle!r} is not subscribed; subscribed is {known}")
        return self._known[handle]

    def _answered(self, subscriber: Subscriber, waiting: WaitingCall) -> None:
        with self._lock:
            subscriber.waiting.discard(waiting)
            subscriber.used = self._clock()


def _close(subscriber: Subscriber) -> None:
    for stream in subscriber.streams:
        stream.close()


def _rate(fps: Any, cameras: Cameras) -> int:
    """Frames a second for somebody who asks for `fps`: programs that ask for more than there are get all of them."""
    most = cameras.tables.most_fps
    if isinstance(fps, bool) or not isinstance(fps, int) or fps < 1:
        raise BadValue("fps", fps, f"1 to {most} frames a second")
    return min(fps, most)


class WaitingCall:
    """A call that waits for a frame of each of `count` cameras; `change` makes its answer of them.

    The task leads here until it is over, and this leads to it no longer then: pictures are large, and must not be kept
    by a cycle.
    """

    def __init__(self, call: str, count: int, change: Callable[[list[Frame]], Any], on_end: Callable[[], None]) -> None:
        self._frames: list[Frame | None] = [None] * count
        self._asked: list[tuple[CameraStream, Any]] = []
        self._change = change
        self._lock = threading.Lock()
        self._task: Task | None = Task(call, 0, ask=lambda _: self._give_up())
        self._task.add_done_callback(lambda _: on_end())

    def begin(self, streams: Sequence[CameraStream]) -> Task:
        """Ask the cameras; the task ends with what `change` makes of their frames."""
        task = self._task
        for index, stream in enumerate(streams):
            try:
                ask = stream.ask(lambda answer, index=index: self._hear(index, answer))
            except SimulationError as error:
                self.fail(error)  # what the other cameras were asked for is given up, too
                break
            with self._lock:
                self._asked.append((stream, ask))
        return task

    def fail(self, error: Exception) -> None:
        """End with an error; frames that come all the same wait for the next call."""
        task = self._end()
        if task is not None:
            task.finish(error=error)

    def _hear(self, index: int, answer: Frame | Exception) -> None:
        if isinstance(answer, Exception):
            self.fail(answer)
            return
        with self._lock:
            self._frames[index] = answer
            frames = list(self._frames)
        if all(frame is not None for frame in frames):
            task = self._end()
            if task is not None:
                task.finish(self._change(frames))

    def _give_up(self) -> None:
        task = self._end()
        if task is not None:
            task.kill()

    def _end(self) -> Task | None:
        """The task, if nobody has ended it yet."""
        with self._lock:
            task, self._task = self._task, None
            asked, self._asked = self._asked, []
            self._frames = [None] * len(self._frames)
        for stream, ask in asked:
            stream.give_up(ask)
        return task
