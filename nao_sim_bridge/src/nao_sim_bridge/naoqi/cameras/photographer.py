"""Takes series of pictures, each at its moment of simulated time, and writes them to files in NAOqi's formats."""

from __future__ import annotations

import logging
import posixpath
import threading
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Sequence

import numpy as np

from nao_sim_bridge.base.errors import BadValue, SimulationError
from nao_sim_bridge.base.imports import Library
from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.base.whole_file import write_whole
from nao_sim_bridge.cameras.stream import CameraClosed
from nao_sim_bridge.naoqi.binding.errors import NaoqiError

cv2 = Library("cv2")
log = logging.getLogger("nao_sim.photos")

HIGHEST_RATE = 30.0
"""Pictures per second that a camera gives at most."""
MOST_SERIES = load_sizes().clients.series
LOOK_AGAIN = 1.0
"""How long a wait for a picture lasts before it is looked whether it is still wanted, s of wall time: a paused
simulation takes none for hours."""


JPEG_QUALITY = 95
GREY_ONLY = ("pbm", "pgm")
"""Formats that hold no colour: a colour picture becomes grey, in "pbm" black and white."""
FORMATS = ("bmp", "dib", "jpeg", "jpg", "jpe", "png", "pbm", "pgm", "ppm", "sr", "ras", "tiff", "tif")


@dataclass(frozen=True)
class PhotoSettings:
    """How pictures are taken."""

    camera: int  # 0 top, 1 bottom
    resolution: int  # NAOqi's number of a resolution
    color_space: int  # NAOqi's number of a colour space
    interval: float  # simulated time from one picture to the next, s


class Photographer:
    """Takes pictures with the robot's cameras, as `name`. Any thread; each series has one of its own."""

    def __init__(self, cameras: Any, name: str) -> None:
        self._cameras = cameras
        self._name = name
        self._lock = threading.Lock()
        self._held: tuple[Any, PhotoSettings] | None = None
        self._series: set[_Series] = set()
        self._closed = False
        self.keeps = False

    @property
    def held(self) -> bool:
        return self._held is not None

    def hold(self, settings: PhotoSettings) -> None:
        """Hold a camera ready; until `release`, pictures are taken with these settings."""
        with self._lock:
            self._hold(settings)

    def release(self) -> None:
        """Hold it no longer."""
        with self._lock:
            held, self._held = self._held, None
        if held is not None:
            held[0].close()

    def keep(self, keeps: bool) -> None:
        """Whether to hold the camera ready from one picture to the next; a camera that is held is let go with it."""
        self.keeps = keeps
        if not keeps:
            self.release()

    def take(self, paths: Sequence[Path], settings: PhotoSettings) -> Task:
        """Take one picture for each path; the task ends with the paths when all are written.

        When the task is killed, what has been taken stays. A BadValue when too many are being taken already.
        """
        with self._lock:
            if self._closed:
                raise NaoqiError("the simulator ends")
            if len(self._series) >= MOST_SERIES:
                raise BadValue("series of pictures", len(self._series) + 1, f"at most {MOST_SERIES} at the same time")
            if self.keeps:
                self._hold(settings)
            held = None
            if self._held is not None:
                held, settings = self._held
            stream = None
            if held is None or len(paths) > 1:
                stream = self._open(settings, every=True)
            series = _Series(paths, settings.interval, held, stream)
            self._series.add(series)
        series.task.add_done_callback(lambda _: self._series.discard(series))
        series.thread.start()
        return series.task

    def close(self) -> None:
        """Take no more pictures; what has not been taken ends with an error."""
        with self._lock:
            self._closed = True
            series = list(self._series)
        self.release()
        for one in series:
            one.end(NaoqiError("the simulator ended before the pictures were taken"))

    def _hold(self, settings: PhotoSettings) -> None:
        if self._held is None:
            self._held = (self._open(settings, every=False), settings)

    def _open(self, settings: PhotoSettings, every: bool) -> Any:
        rate = min(HIGHEST_RATE, 1.0 / settings.interval) if every else HIGHEST_RATE
        return self._cameras.open(
            self._name, settings.camera, settings.resolution, settings.color_space, rate, every=every
        )


class _Series:
    """Pictures that are being taken, in a thread of their own: writing a large one takes its time.

    The first one comes at once from `held`, the stream of a camera that is held ready, if that is not None; the others
    from `stream`, every `interval` s of simulated time. The task ends with the paths.
    """

    def __init__(self, paths: Sequence[Path], interval: float, held: Any, stream: Any) -> None:
        self._paths = paths
        self._interval = interval
        self._held, self._stream = held, stream
        self._ended = threading.Event()
        self.task = Task("takePictures", 0, ask=self._cancel)
        self.thread = threading.Thread(target=self._run, name="pictures", daemon=True)

    def end(self, error: Exception | None = None) -> None:
        """Take no more; the task ends, with this error."""
        self._ended.set()
        if self._stream is not None:
            self._stream.close()
        self.task.finish(error=error)

    def _cancel(self, task: Task) -> None:
        task.killed = not task.finished
        self.end()

    def _run(self) -> None:
        try:
            last = None
            for path in self._paths:
                frame = self._wait(self._held or self._stream) if last is None else self._next(last)
                if frame is None:
                    return
                write_whole(path, encoded(frame.array(), path.suffix[1:]))
                last = frame.time
        except CameraClosed as error:
            self.task.finish(error=NaoqiError(f"the camera was closed before all pictures were taken: {error}"))
        except Exception as error:
            if not isinstance(error, (SimulationError, NaoqiError)):
                log.exception("a series of pictures failed")
            self.task.finish(error=error)
        else:
            self.task.finish(self._paths)
        finally:
            self.end()

    def _next(self, last: float) -> Any:
        """The first picture that is due after the one of time `last`, None when nobody wants it any more.

        The stream of a series that a held camera began gives another one for its beginning, which is left out.
        """
        frame = self._wait(self._stream)
        while frame is not None and frame.time < last + 0.5 * self._interval:
            frame = self._wait(self._stream)
        return frame

    def _wait(self, stream: Any) -> Any:
        while not self._ended.is_set():
            try:
                return stream.take(LOOK_AGAIN)
            except TimeoutError:
                continue
        return None


def picture_files(files: ClientFiles, folder: str, name: str, kind: str, count: int, overwrite: bool) -> list[Path]:
    """Paths of the pictures of a series; folders on the way are made.

    One picture has the name as it was given, several are name_0, name_1, ...; the ending of the format is added when
    the name does not have it. A BadValue when the name is that of a folder; a NaoqiError when there is such a file, and
    it must not be overwritten; a ValueError when a file leads out of the folder for recordings, or cannot be made
    there.
    """
    ending = f".{kind}"
    stem = name[: -len(ending)] if name.lower().endswith(ending) else name
    if not posixpath.basename(stem):
        raise BadValue("fileName", name, "the name of a file")
    names = [stem] if count == 1 else [f"{stem}_{number}" for number in range(count)]
    paths = [files.to_write(posixpath.join(folder, one + ending)) for one in names]
    check_new(files, paths, overwrite)
    return paths


def check_new(files: ClientFiles, paths: Sequence[Path], overwrite: bool) -> None:
    """Refuse to overwrite a file, unless that is wanted."""
    there = next((path for path in paths if path.exists()), None)
    if there is not None and not overwrite:
        raise NaoqiError(f"file {files.to_robot(there)!r} exists already, and is not to be overwritten")


def encoded(picture: np.ndarray, kind: str) -> bytes:
    """A picture, (height, width) grey or (height, width, 3) BGR, uint8, in a file format, one of `FORMATS`."""
    if picture.ndim == 3 and picture.shape[2] == 1:
        picture = picture[:, :, 0]
    if kind in GREY_ONLY and picture.ndim == 3:
        picture = cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY)
    elif kind == "ppm" and picture.ndim == 2:
        picture = cv2.cvtColor(picture, cv2.COLOR_GRAY2BGR)
    written, content = cv2.imencode(f".{kind}", picture, [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])
    if not written:
        raise NaoqiError(f"a picture of {picture.shape[1]}x{picture.shape[0]} cannot be written as {kind!r}")
    return content.tobytes()
