"""A call of ALVideoDevice that waits for the next frames."""

from __future__ import annotations

import threading
from typing import Any, Callable, Sequence

from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.cameras.cameras import CameraStream
from nao_sim_bridge.cameras.frame import Frame


class WaitingCall:
    """A call that waits for a frame of each camera of a subscriber.

    The task leads here until it is over, and this leads to it no longer then: pictures are large, and must not be kept
    by a cycle.

    Args:
        count: Number of cameras.
        change: Makes the answer from the frames.
        on_end: Called when it is over.
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
