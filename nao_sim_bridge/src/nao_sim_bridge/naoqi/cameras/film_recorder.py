"""Records films to AVI files (MJPG, compressed, or IYUV, raw), from one moment of simulated time to another."""

from __future__ import annotations

import logging
import threading
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from nao_sim_bridge.base.errors import SimulationError, SimulationStopped
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.base.whole_file import FileTrouble, WholeFile
from nao_sim_bridge.cameras.stream import CameraClosed
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.binding.errors import NaoqiError

log = logging.getLogger("nao_sim.films")

CLOSING = 10.0
"""How long the end of the simulator waits for a file, s of wall time."""


# FFmpeg's name of the codec, its pixels, and the four letters in the file. JPEG has the full range of brightness.
FORMATS = {"MJPG": ("mjpeg", "yuvj420p", "MJPG"), "IYUV": ("rawvideo", "yuv420p", "IYUV")}
# The smaller the better, 2 to 31: about that of a photo camera.
JPEG_QUANTISER = "3"
RATE_STEPS = 1000


@dataclass(frozen=True)
class FilmSettings:
    """How a film is recorded."""

    camera: int  # 0 top, 1 bottom
    resolution: int  # NAOqi's number of a resolution
    color_space: int  # NAOqi's number of a colour space
    rate: float  # frames a second of simulated time
    kind: str  # format of the file, "MJPG" or "IYUV"


class VideoRecorder:
    """One recording at a time; its streams have the `name`."""

    def __init__(self, cameras: Any, runner: RobotRunner, name: str) -> None:
        self._cameras = cameras
        self._runner = runner
        self._name = name
        self._lock = threading.Lock()
        self._recording: _Recording | None = None

    @property
    def records(self) -> bool:
        return self._recording is not None

    def start(self, path: Path, settings: FilmSettings) -> Task:
        """Begin at the present moment of simulated time; the task ends when it has begun.

        A NaoqiError when a recording is under way, a FileTrouble when the file cannot be written.
        """
        size = self._cameras.tables.resolution(settings.resolution)
        with self._lock:
            if self._recording is not None:
                raise NaoqiError(f"a recording to {str(self._recording.path)!r} is under way; stop it first")
            film = Film(path, settings.kind, size.width, size.height, settings.rate)
            recording = self._recording = _Recording(path, film, settings.rate)
        log.info("recording to %s", path)

        def begin() -> None:
            recording.begin(
                self._cameras.open(
                    self._name, settings.camera, settings.resolution, settings.color_space, settings.rate, every=True
                )
            )

        return self._runner.execute(begin, "startRecording")

    def stop(self) -> Task:
        """End at the present moment of simulated time; the task ends with [frames, path] when the file is complete.

        Without a recording it ends at once with [0, ""].
        """
        with self._lock:
            recording, self._recording = self._recording, None
        if recording is None:
            nothing = Task("stopRecording", 0)
            nothing.finish([0, ""])
            return nothing
        try:
            self._runner.execute(recording.finish, "stopRecording")
        except SimulationStopped:
            recording.finish()
        return recording.ended

    def close(self) -> None:
        """End the recording, if there is one; blocking. What goes wrong is logged."""
        if self._recording is None:
            return
        try:
            self.stop().result(CLOSING)
        except (NaoqiError, SimulationError, TimeoutError) as error:
            log.error("%s", error)


class _Recording:
    """A film that grows with every frame, in a thread of its own; its task ends with [frames, path]."""

    def __init__(self, path: Path, film: Film, rate: float) -> None:
        self.path = path
        self.ended = Task("stopRecording", 0)
        self._film = film
        self._rate = rate
        self._stream: Any = None
        self._first: float | None = None
        self._last: Any = None
        self._thread = threading.Thread(target=self._run, name="film", daemon=True)

    def begin(self, stream: Any) -> None:
        self._stream = stream
        self._thread.start()

    def finish(self) -> None:
        """No further frame belongs to it; those that were due before do."""
        if self._stream is None:
            self._complete()
        else:
            self._stream.finish()

    def _run(self) -> None:
        try:
            while True:
                self._add(self._stream.take())
        except CameraClosed:
            self._complete()
        except Exception as error:
            log.error("recording to %s ends early: %s", self.path, error, exc_info=not isinstance(error, FileTrouble))
            self._stream.close()
            self._complete(error)

    def _add(self, frame: Any) -> None:
        """Append a frame. Where frames before it were lost, because the machine was too slow, the last one is shown."""
        if self._first is None:
            self._first = frame.time
        place = round((frame.time - self._first) * self._rate)
        while self._last is not None and self._film.frames < place:
            self._film.write(self._last)
        self._last = frame.array()
        self._film.write(self._last)

    def _complete(self, error: Exception | None = None) -> None:
        frames = self._film.frames
        try:
            self._film.close()
        except Exception as failure:
            error = error or failure
        path = str(self._film.path)
        if not frames:
            reason = error or "no picture was taken between start and stop"
            self.ended.finish(error=NaoqiError(f"{path!r} has not become a file: {reason}"))
        elif error is not None:
            text = f"{path!r} is not complete, it ends after {frames} frames: {error}"
            self.ended.finish(error=NaoqiError(text))
        else:
            self.ended.finish([frames, path])


class Film:
    """An AVI file that grows frame by frame, at `rate` frames a second; it replaces in the end what is at `path`.

    It can be played at any moment, also when its process is killed or the disk is full. A FileTrouble when it cannot be
    written.
    """

    def __init__(self, path: Path, kind: str, width: int, height: int, rate: float) -> None:
        import av  # takes a moment, and few robots film

        codec, pixels, letters = FORMATS[kind]
        self.frames = 0
        self._file = WholeFile(path)
        self.path = self._file.path
        # Each frame goes to the file at once, so that it ends with a whole one.
        self._container = av.open(self._file, mode="w", format="avi", options={"flush_packets": "1"})
        fraction = Fraction(round(rate * RATE_STEPS), RATE_STEPS)
        self._stream = self._container.add_stream(codec, rate=fraction)
        self._stream.width, self._stream.height, self._stream.pix_fmt = width, height, pixels
        self._stream.codec_tag = letters
        self._step = 1 / fraction
        if kind == "MJPG":
            self._stream.options = {"qmin": JPEG_QUANTISER, "qmax": JPEG_QUANTISER}

    def write(self, picture: np.ndarray) -> None:
        """Append a frame, (height, width) grey or (height, width, 3) BGR, uint8.

        A FileTrouble when it cannot be written; the film ends with the frame before.
        """
        import av

        grey = picture.ndim == 2
        frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(picture), format="gray" if grey else "bgr24")
        frame.pts, frame.time_base = self.frames, self._step
        for packet in self._stream.encode(frame):
            self._container.mux(packet)
        self._file.flush()
        self.frames += 1

    def close(self) -> None:
        """Complete the file; without a frame there is none. A FileTrouble when it is not complete."""
        try:
            if self.frames:
                for packet in self._stream.encode():
                    self._container.mux(packet)
        finally:
            self._container.close()
        if self.frames:
            self._file.close()
        else:
            self._file.discard()
