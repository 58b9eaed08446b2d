"""One look through a camera: frames of one size, colour space and rate, as they fall due."""

from __future__ import annotations

import logging
import threading
import time
from collections import deque
from fractions import Fraction
from typing import Callable, Protocol

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.cameras.frame import Answer, Ask, CameraClosed, Frame, Moment
from nao_sim_bridge.cameras.rate import Share, exact_rate
from nao_sim_bridge.cameras.settings import CameraTables, ColorSpace, Resolution

log = logging.getLogger("nao_sim.cameras")

HELD_UP = load_sizes().clients.held_up_s
"""Wall time, s: time that runs fast waits no longer than this for somebody who has got a frame to ask for the next."""
MOST_ASKS = load_sizes().clients.frames
"""How many frames may be asked for before the first of them is there."""


class StreamOwner(Protocol):
    """What a stream asks of the cameras, with their lock held but for `released`."""

    tables: CameraTables
    ticks_per_second: Fraction
    lock: threading.RLock
    released: Callable[[], None]

    def changed(self) -> None:
        """The stream is for another camera, or has another rate."""

    def forget(self, stream: CameraStream) -> None:
        """The stream has been closed."""

    def draw(self, stream: CameraStream, ask: Ask, moment: Moment) -> None:
        """Have a frame drawn for somebody who asked."""

    def answer(self, ask: Ask, answer: Answer) -> None:
        """Tell somebody who asked, in the cameras' thread."""


class CameraStream:
    """Frames for one user; `Cameras.open` makes it. Any thread may use it.

    Attributes:
        name: For the log.
        every: Whether every due frame counts, or only the newest.
        size: Of its pictures.
        pixels: How its pictures are written.
        dropped: Frames that were due and that nobody took in time; only where every frame counts.

    Args:
        cameras: Its owner; its lock guards what is in here.
        keep: How many frames wait at most.
    """

    def __init__(self, cameras: StreamOwner, name: str, every: bool, keep: int) -> None:
        self.name = name
        self.every = every
        self.dropped = 0
        self._cameras = cameras
        self._lock = cameras.lock
        self._pending: deque[Moment] = deque()
        self._keep = keep if every else 1
        self._asks: deque[Ask] = deque()
        self._drawing = 0
        self.closed = False
        self._finished = False
        self._owes_since: float | None = time.monotonic()
        self._had_one = False
        self._camera = 0
        self.size: Resolution
        self.pixels: ColorSpace
        self._fps = 0.0
        self._share: Share

    # --- for users ------------------------------------------------------------------------------------------------

    def take(self, timeout: float | None = None) -> Frame:
        """The newest due frame that this stream has not had; where there is none, the next.

        With `every`, the oldest one that waits. A frame that comes after the time is up is kept for the next call.

        Args:
            timeout: Longest time to wait, s of wall time.

        Raises:
            TimeoutError: No frame came in time: time stands still, or the camera does not run.
            CameraClosed: The stream has been closed, or is finished and empty.
            RenderError: The picture cannot be drawn.
        """
        answers: list[Answer] = []
        there = threading.Event()

        def hear(answer: Answer) -> None:
            answers.append(answer)
            there.set()

        ask = self.ask(hear)
        if not there.wait(timeout) and self.give_up(ask):
            raise TimeoutError(f"camera stream {self.name!r}: no frame within {timeout} s")
        there.wait()
        if isinstance(answers[0], Exception):
            raise answers[0]
        return answers[0]

    def ask(self, callback: Callable[[Answer], None]) -> Ask:
        """As `take`, without waiting; returns what `give_up` takes.

        Args:
            callback: Called in the cameras' thread, once, with the frame or the error; it must not block.
        """
        ask = Ask(callback)
        with self._lock:
            self._owes_since = None
            if self.closed or (self._finished and not self._pending):
                self._cameras.answer(ask, self._closed_error())
            elif len(self._asks) >= MOST_ASKS:
                raise BadValue("calls that wait for a frame", len(self._asks) + 1, f"at most {MOST_ASKS}")
            elif self._pending:
                self._draw(ask, self._pending.popleft())
            else:
                self._asks.append(ask)
        self._cameras.released()
        return ask

    def give_up(self, ask: Ask) -> bool:
        """Wait for a frame no more; False when it has been handed over. A frame on its way waits for the next one."""
        with self._lock:
            if ask in self._asks:
                self._asks.remove(ask)
                ask.given_up = True
            elif not ask.answered:
                ask.given_up = True
            return ask.given_up

    def finish(self) -> None:
        """No further frame falls due; those that wait can still be taken, after the last `take` raises CameraClosed."""
        with self._lock:
            self._finished = True
            self._cameras.changed()
            self._end_asks()
        self._cameras.released()

    def close(self) -> None:
        """Look no more; whoever waits gets CameraClosed."""
        with self._lock:
            self.closed = True
            self._pending.clear()
            self._cameras.forget(self)
            self._end_asks()
        self._cameras.released()

    @property
    def camera(self) -> int:
        """Index of the camera; what waits of another one is dropped."""
        return self._camera

    @camera.setter
    def camera(self, index: int) -> None:
        self.look(index, self.size.id)

    def look(self, camera: int, resolution: int) -> None:
        """Change camera and resolution at once.

        Raises:
            BadValue: The cameras cannot do that.
        """
        with self._lock:
            index, size = self._cameras.tables.camera(camera), self._cameras.tables.resolution(resolution)
            self._cameras.tables.check_rate(index, size, self._fps)
            if index != self._camera:
                self._pending.clear()
            self._camera, self.size = index, size
            self._restart()

    @property
    def resolution(self) -> int:
        """NAOqi's id of the resolution."""
        return self.size.id

    @resolution.setter
    def resolution(self, number: int) -> None:
        self.look(self._camera, number)

    @property
    def color_space(self) -> int:
        """NAOqi's id of the colour space."""
        return self.pixels.id

    @color_space.setter
    def color_space(self, number: int) -> None:
        space = self._cameras.tables.color_space(number)
        with self._lock:
            self.pixels = space

    @property
    def fps(self) -> float:
        """Frames a second that were asked for; large pictures may come at a lower rate."""
        return self._fps

    @fps.setter
    def fps(self, rate: float) -> None:
        with self._lock:
            self._cameras.tables.check_rate(self._camera, self.size, rate)
            self._fps = rate
            self._restart()

    # --- for the cameras; with the lock held ----------------------------------------------------------------------

    def set_up(self, camera: int, resolution: int, color_space: int, fps: float) -> None:
        """What it shows; once, before it is used."""
        tables = self._cameras.tables
        self._camera = tables.camera(camera)
        self.size = tables.resolution(resolution)
        self.pixels = tables.color_space(color_space)
        self._cameras.tables.check_rate(self._camera, self.size, fps)
        self._fps = fps
        self._share = Share(self._rate(), self._cameras.ticks_per_second)

    @property
    def rate(self) -> Fraction:
        """Frames a second that the camera has to take for it."""
        return Fraction(0) if self._finished else self._share.rate

    @property
    def waits(self) -> bool:
        """Whether time that runs fast should wait for its user."""
        if not self.every:
            return False
        owes = self._owes_since
        if owes is not None and time.monotonic() - owes > HELD_UP:
            return False
        return bool(self._pending) or self._drawing > 0 or (owes is not None and self._had_one)

    def takes(self, exact_time: Fraction) -> bool:
        """Whether a frame of its camera is for it; asked once for each."""
        return not self._finished and self._share.takes(exact_time)

    def put(self, moment: Moment) -> None:
        """A frame falls due."""
        if self._asks:
            self._draw(self._asks.popleft(), moment)
            return
        if len(self._pending) >= self._keep:
            self._pending.popleft()
            self._drop()
        self._pending.append(moment)

    def handed_over(self, ask: Ask, moment: Moment) -> Callable[[Answer], None] | None:
        """A picture is drawn. Returns who gets it; None when nobody does any more, then it is kept."""
        self._drawing -= 1
        if ask.given_up:
            if not self.closed:
                self._take_back(moment)
            return None
        self._had_one = True
        self._owes_since = time.monotonic()
        return ask.take_callback()

    def _take_back(self, moment: Moment) -> None:
        """A frame that nobody waits for any more: the next who asks gets it, unless there is a newer one to have."""
        if moment.camera != self._camera:
            return
        if self._asks:
            self._draw(self._asks.popleft(), moment)
        elif len(self._pending) < self._keep:
            self._pending.appendleft(moment)
        else:
            self._drop()

    def _draw(self, ask: Ask, moment: Moment) -> None:
        self._drawing += 1
        self._cameras.draw(self, ask, moment)

    def _drop(self) -> None:
        if not self.every:
            return
        self.dropped += 1
        if self.dropped & (self.dropped - 1) == 0:  # the first, the second, the fourth...
            log.info("%s is too slow for its camera: %d frames lost so far", self.name, self.dropped)

    def _rate(self) -> Fraction:
        most = self.size.most_fps[self._camera]
        return min(exact_rate(self._fps), Fraction(most))

    def _restart(self) -> None:
        self._share = Share(self._rate(), self._cameras.ticks_per_second)
        self._cameras.changed()

    def _end_asks(self) -> None:
        while self._asks:
            self._cameras.answer(self._asks.popleft(), self._closed_error())

    def _closed_error(self) -> CameraClosed:
        how = "closed" if self.closed else "finished"
        return CameraClosed(f"camera stream {self.name!r} is {how}")
