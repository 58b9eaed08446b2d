"""Pictures of a subscriber that go to a file as they are: bytes of one picture after the other, and nothing else."""

from __future__ import annotations

import logging
import threading
from pathlib import Path

from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.base.whole_file import WholeFile
from nao_sim_bridge.cameras.cameras import Cameras, CameraStream
from nao_sim_bridge.cameras.stream import CameraClosed
from nao_sim_bridge.naoqi.binding.arguments import number
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.cameras.video_device_subscribers import Subscriber

log = logging.getLogger("nao_sim.cameras")

MOST_PICTURES = 100000
CLOSING = 10.0
"""How long the end of the simulator waits for a file, s of wall time."""
WAITING = 15
"""Pictures that wait for the file before the oldest is dropped."""


class RawRecordings:
    """The recordings, by the handle of the subscriber; any thread."""

    def __init__(self, cameras: Cameras, files: ClientFiles) -> None:
        self._cameras = cameras
        self._files = files
        self._lock = threading.Lock()
        self._running: dict[str, _Recording] = {}

    def start(self, subscriber: Subscriber, path: str, total: int, period: int) -> None:
        """Record pictures as a subscriber gets them; of several cameras the first.

        Of `period` pictures that fall due one is recorded, `total` in all, in a file inside the folder for recordings.
        A NaoqiError when it records already, a FileTrouble when the file cannot be written, a BadValue when a number is
        out of range.
        """
        number(total, "totalNumber", 1, MOST_PICTURES)
        number(period, "period", 1, 1000)
        target = self._files.to_write(path)
        view = subscriber.views[0]
        with self._lock:
            before = self._running.get(subscriber.handle)
            if before is not None and not before.task.finished:
                raise NaoqiError(f"{subscriber.handle!r} records already; end that with stopVideo first")
            file = WholeFile(target)
            look = (view.camera, view.resolution, view.color_space, subscriber.fps)
            stream = self._cameras.open(f"recording of {subscriber.handle}", *look, every=True, keep=WAITING)
            recording = _Recording(stream, file, target, total, period, lambda: self._ended(subscriber.handle))
            self._running[subscriber.handle] = recording
        recording.thread.start()

    def stop(self, handle: str) -> Task:
        """End the recording of a subscriber; the task ends when the file is complete, or tells why it ended early.

        A NaoqiError when it does not record.
        """
        with self._lock:
            recording = self._running.get(handle)
            if recording is not None and recording.task.finished:
                del self._running[handle]
            known = ", ".join(map(repr, self._running)) or "nobody"
        if recording is None:
            raise NaoqiError(f"{handle!r} does not record; recording is {known}")
        recording.stream.finish()
        return recording.task

    def close(self) -> None:
        """End all of them and wait for their files."""
        with self._lock:
            running = list(self._running.values())
        for recording in running:
            recording.stream.finish()
            recording.thread.join(CLOSING)

    def _ended(self, handle: str) -> None:
        with self._lock:
            self._running.pop(handle, None)


class _Recording:
    """One file that grows, in a thread of its own."""

    def __init__(
        self, stream: CameraStream, file: WholeFile, path: Path, total: int, period: int, on_end: object
    ) -> None:
        self.task = Task("stopVideo", 0)
        self.stream = stream
        self._file = file
        self._path = path
        self._left = total
        self._period = period
        self._on_end = on_end
        self.thread = threading.Thread(target=self._run, name="raw video", daemon=True)

    def _run(self) -> None:
        error: Exception | None = None
        try:
            try:
                self._record()
            finally:
                self._file.close()
        except Exception as failure:
            error = failure
            log.warning("recording %s ends: %s", self._path.name, failure)
        self.stream.close()
        if error is None:
            self._on_end()
        self.task.finish(error is None, error)

    def _record(self) -> None:
        count = 0
        while self._left > 0:
            try:
                frame = self.stream.take()
            except CameraClosed:
                return
            if count % self._period == 0:
                self._file.write(frame.data)
                self._file.flush()
                self._left -= 1
            count += 1
