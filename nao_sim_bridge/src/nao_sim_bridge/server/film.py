"""Films of a running simulation from outside, with what the loudspeakers play.

Frames are recorded as states and drawn while the computer has time for it; the rest is drawn when the film ends.
"""

from __future__ import annotations

import logging
import threading
import time
from collections import deque
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from nao_sim_bridge.base.child_process import ChildProcess
from nao_sim_bridge.base.samples import RATE
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.render.client import START_TIMEOUT, PictureRefused, RenderError
from nao_sim_bridge.sound.timeline import Follower
from nao_sim_bridge.world.render_state import StateSender

log = logging.getLogger("nao_sim.film")

MODULE = "nao_sim_bridge.render.film_worker"
SOUND_STEP = RATE // 10
MANY_WAITING = 2000
"""Frames that are not drawn yet: fast time waits then."""
LATE_LOOK = 0.1
"""How often to look whether the simulation still falls behind its speed, s of wall time."""
TOO_MANY_WAITING = 4000
"""Likewise, of time that does not wait: further ones are left out."""
END_LIMIT = 1800.0
"""s of wall time; at the end everything that waits is drawn."""
FOLLOWER_LIMIT = 5.0
"""s of wall time; likewise for what is heard."""


@dataclass(frozen=True)
class FilmReport:
    """A film that is complete."""

    path: Path
    frames: int  # how many pictures it has
    duration: float  # s
    left_out: int  # frames that the computer was too slow for


class Film:
    """One film that is being taken, which replaces the file at `path`; a RenderError when there is no film process.

    Threads: the simulation's puts states into a queue, a follower of the sound's clock puts sound there, a third one
    sends both to the process that draws. The lock guards the queue.
    """

    def __init__(
        self, simulation: Simulation, path: Path, view: str, size: tuple[int, int], frame_rate: float, engine: str
    ) -> None:
        self.path = path
        self._simulation = simulation
        self._period = 1.0 / frame_rate
        self._news = threading.Condition()
        self._waiting: deque[tuple[str, Any]] = deque()
        self._ending = False
        self._left_out = 0
        self._begin = self._frame = 0.0
        self._first_sample = 0
        self._sender = StateSender()
        self._failure: RenderError | None = None
        self._follower: Follower | None = None
        scene = simulation.scene
        arguments = (engine, scene.world, scene.version, str(path), view, str(size[0]), str(size[1]))
        self._worker = ChildProcess(MODULE, arguments, "film process", RenderError, PictureRefused)
        try:
            log.info("%s is drawn by %s", path.name, self._worker.receive(START_TIMEOUT, "film"))
        except RenderError:
            self._worker.stop()
            raise
        self._thread = threading.Thread(target=self._send, name="film", daemon=True)

    def begin(self) -> None:
        """Film from now on; simulation thread."""
        self._begin = self._simulation.time
        self._first_sample = self._simulation.sound.timeline.now
        self._thread.start()
        self._follower = Follower("film sound", self._simulation.sound.timeline, self._hear, SOUND_STEP)
        self._simulation.after_tick.append(self._look)
        self._simulation.holds.append(self._behind)

    def pause(self) -> None:
        """Film no longer; simulation thread."""
        self._simulation.after_tick.remove(self._look)
        self._simulation.holds.remove(self._behind)

    def caption(self, text: str) -> None:
        """Write a text into the pictures from now on; any thread."""
        self._put("caption", text)

    def end(self, limit: float = END_LIMIT) -> FilmReport:
        """Draw what waits and complete the file, with what is drawn within `limit` s of wall time; after `pause`.

        A RenderError when something went wrong on the way, or it has taken too long.
        """
        deadline = time.monotonic() + limit
        if self._follower is not None:
            self._follower.close(min(FOLLOWER_LIMIT, limit))
        with self._news:
            self._ending = True
            self._news.notify_all()
        self._thread.join(max(0.0, deadline - time.monotonic()))
        late = self._thread.is_alive()
        if not late and self._failure is None:
            self._worker.send("end", None, "film")
            late = not self._worker.pipe.poll(max(0.0, deadline - time.monotonic()))
        if late:
            self._leave(RenderError(f"{self.path} ends early: it could not be drawn within {limit:g} s"))
        try:
            if self._failure is not None:
                raise self._failure
            frames, duration = self._worker.receive(0.0, "film")
        finally:
            if not late:
                self._worker.stop()
        if self._left_out:
            log.warning("%d frames are missing in %s: the computer is too slow for them", self._left_out, self.path)
        return FilmReport(self.path, frames, duration, self._left_out)

    def _leave(self, reason: RenderError) -> None:
        """Leave the process to itself: it completes the file with what it has."""
        with self._news:
            self._failure = reason
            self._waiting.clear()
        self._worker.leave()

    def _look(self, snapshot: Snapshot) -> None:
        """Take a frame if one is due; after every tick."""
        elapsed = snapshot.time - self._begin
        if elapsed + 1e-9 < self._frame * self._period:
            return
        self._frame = int(elapsed / self._period + 1e-9) + 1
        if len(self._waiting) > TOO_MANY_WAITING:
            self._left_out += 1
            return
        self._put("frame", (elapsed, self._simulation.render_state(snapshot)))

    def _hear(self, first: int, last: int) -> None:
        """Take sound; in the thread of the follower."""
        samples = self._simulation.sound.loudspeakers.pcm(first, last)
        self._put("sound", (first - self._first_sample, samples.tobytes()))

    def _behind(self) -> bool:
        return len(self._waiting) > MANY_WAITING

    def _draws_later(self) -> bool:
        """Whether the simulation needs the processor more than the film does."""
        return self._simulation.shared.late and not self._behind()

    def _put(self, kind: str, content: Any) -> None:
        with self._news:
            if self._failure is None:
                self._waiting.append((kind, content))
                self._news.notify_all()

    def _send(self) -> None:
        while True:
            with self._news:
                while not self._ending and (not self._waiting or self._draws_later()):
                    self._news.wait(LATE_LOOK if self._waiting else None)
                if not self._waiting:
                    return
                kind, content = self._waiting.popleft()
            try:
                if kind == "frame":
                    content = (content[0], self._sender.pack(content[1]))
                self._worker.send(kind, content, "film")
            except Exception as error:
                with self._news:
                    if self._failure is None:
                        log.warning("%s is incomplete: %s", self.path, error)
                        self._failure = error if isinstance(error, RenderError) else RenderError(repr(error))
                    self._waiting.clear()
            if len(self._waiting) <= MANY_WAITING:
                self._simulation.wake()
