"""Files of goals: the folder for pictures and videos, and video files with every frame at its time (PyAV). No ROS."""

from __future__ import annotations

import logging
import os
import threading
import time
from array import array
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from naoqi.errors import NaoError

from ..core.errors import BadGoal
from ..core.fields import CONTROL, LONGEST_NAME, require_known
from ..core.files import FileTrouble, WholeFile, numbered_names, tidy
from ..core.lazy import Later
from .pictures import VideoTimes, fitted

DEFAULT_RECORD_DIR = "~/.ros/nao_recordings"
"""As that of the simulator: beside a simulated robot on the same computer, its files and these are in one place."""
TYPE_SYNONYMS = {"jpeg": "jpg", "tif": "tiff"}
SHORT = f"up to {LONGEST_NAME - 10} bytes"


class VisionFiles:
    """Files of one server. Any thread."""

    def __init__(self, folder: str) -> None:
        """Remove what killed servers have left; nothing is made yet.

        `folder`: "~" stands for the home of the user; relative to the working directory, which is ROS_HOME for a node
        that a launch file started.
        """
        self.folder = Path(folder).expanduser().absolute()
        self._lock = threading.Lock()
        self._open: set[Path] = set()  # being written: must not be replaced
        tidy(self.folder)

    def file_type(self, name: str, file_type: str, known: Sequence[str]) -> str:
        """Type of a file: that of the field, of the end of the name, or the first known one.

        Raises BadGoal if it is not known, or name and field differ.
        """
        field = known_type("file_type", file_type, known)
        end = known_type("str_param", Path(name.strip()).suffix, known)
        if field and end and field != end:
            allowed = f"{end}, as the file's name ends"
            raise BadGoal("file_type", file_type, allowed, problem=f"{name!r} is no {field}")
        return field or end or known[0]

    def path(self, name: str, file_type: str) -> Path:
        """Path of a file that a goal names; its folder may have to be made.

        `name`: relative to the folder, or absolute and inside it, with or without a suffix. `file_type`: suffix where
        the name has none. Raises BadGoal if it leads out of the folder or cannot be a name.
        """
        allowed = f"a name of a file in {self.folder}"
        bare = name.strip()
        if CONTROL.search(bare) or bare.startswith("~") or bare.endswith("/"):
            raise BadGoal("str_param", name, allowed, problem=f"{name!r} is not the name of a file")
        require_short("str_param", name)
        root = self.folder.resolve()
        path = (root / bare).resolve()
        if root not in path.parents:
            raise BadGoal("str_param", name, allowed, problem=f"{name!r} leads out of the folder for recordings")
        if not path.suffix:
            path = path.with_name(f"{path.name}.{file_type}")
        if path.exists() and not path.is_file():
            raise BadGoal("str_param", name, allowed, problem=f"{path} is a folder or something else that is no file")
        return path

    def require_free(self, path: Path, overwrite: bool) -> None:
        """Check that a file may be written.

        Raises BadGoal if it exists and may not be replaced, or a recording writes it.
        """
        with self._lock:
            busy = path in self._open
        if busy:
            raise BadGoal("str_param", path.name, "another name", problem=f"a recording is writing {path}")
        if path.exists() and not overwrite:
            raise BadGoal("str_param", path.name, "another name, or overwrite", problem=f"{path} is there already")

    def plan(self, path: Path, overwrite: bool, planned: set[Path]) -> None:
        """Check that a file may be written after the planned ones, and add it to these.

        Raises BadGoal as `require_free`, or if an earlier function of the chain writes it.
        """
        self.require_free(path, overwrite)
        if path in planned and not overwrite:
            problem = f"an earlier function writes {path}"
            raise BadGoal("str_param", path.name, "another name, or overwrite", problem=problem)
        planned.add(path)

    def named_by_time(self, prefix: str, file_type: str) -> Path:
        """Path of a file that a goal does not name: a prefix and the local time."""
        now = time.time()
        stamp = time.strftime("%Y-%m-%d_%H-%M-%S", time.localtime(now))
        return self.folder.resolve() / f"{prefix}_{stamp}.{int(now * 1000) % 1000:03d}.{file_type}"

    def create(self, path: Path, overwrite: bool = False, numbered: bool = False) -> WholeFile:
        """Open a file for writing; call `done` at its end.

        Raises BadGoal if it exists and is neither to be replaced nor to be numbered, FileTrouble if it cannot be
        written.

        Args:
            path: See `path`.
            overwrite: Whether an existing file is replaced.
            numbered: Whether this file becomes name-2, name-3, ... beside an existing one.
        """
        with self._lock:
            names = numbered_names(path) if numbered else [path]
            free = next((n for n in names if n not in self._open and (overwrite or not n.exists())), None)
            if free is None:
                problem = f"{path} is there already"
                raise BadGoal("str_param", path.name, "another name, or overwrite", problem=problem)
            file = WholeFile(free, numbered)
            self._open.add(free)
        return file

    def done(self, path: Path) -> None:
        """Take note that a file is complete: it may be replaced from now on."""
        with self._lock:
            self._open.discard(path)

    def write(self, path: Path, data: bytes, overwrite: bool = False, numbered: bool = False) -> Path:
        """Write a whole file, as `create` takes it; answers its path."""
        file = self.create(path, overwrite, numbered)
        wanted = file.path
        try:
            with file:
                file.write(data)
        finally:
            self.done(wanted)
        return file.path


def known_type(field: str, text: str, known: Sequence[str]) -> str:
    """Usual name of a type of file; empty for none. Raises BadGoal if it is not known."""
    bare = text.strip().lower().lstrip(".")
    kind = TYPE_SYNONYMS.get(bare, bare)
    return require_known(field, kind, known, "type of file for this") if kind else ""


def require_short(field: str, name: str) -> None:
    """Check that file systems take each part of a path, also with a number and a suffix behind it."""
    if any(len(os.fsencode(part)) > LONGEST_NAME - len("-000.webp") for part in Path(name.strip()).parts):
        raise BadGoal(field, name, SHORT, problem="the name is too long")


av = Later("av")
# The encoders' reports on themselves do not belong into the node's log.
logging.getLogger("libav").setLevel(logging.ERROR)

VIDEO_TYPES = ("mp4", "avi")


@dataclass(frozen=True)
class Codec:
    encoder: str  # name in FFmpeg
    pixels: str  # format of the pixels
    bits: float  # per pixel and frame, roughly; 0: the encoder has a measure of its own
    options: dict[str, str]
    file_types: tuple[str, ...]


# An AVI file has a grid of times; H.264 cannot leave places of it empty.
CODECS = {
    "h264": Codec("libx264", "yuv420p", 0.0, {"preset": "ultrafast", "tune": "zerolatency", "crf": "20"}, ("mp4",)),
    "mpeg4": Codec("mpeg4", "yuv420p", 0.35, {}, ("mp4", "avi")),
    "mjpeg": Codec("mjpeg", "yuvj420p", 2.0, {"qmin": "2", "qmax": "6"}, ("avi", "mp4")),
    "ffv1": Codec("ffv1", "bgr0", 0.0, {}, ("avi",)),
}
CODEC_SYNONYMS = {
    "avc1": "h264", "x264": "h264", "libx264": "h264", "mp4v": "mpeg4", "xvid": "mpeg4", "divx": "mpeg4",
    "mjpg": "mjpeg",
}  # fmt: skip
PREFERRED = {"mp4": ("h264", "mpeg4"), "avi": ("mjpeg",)}
TICKS = {"mp4": 60000, "avi": 120}
"""Times a second at which a frame can stand."""
# Each part of an mp4 file is complete in itself, so that what a lost process wrote can be played.
CONTAINER_OPTIONS = {
    "mp4": {"movflags": "frag_keyframe+empty_moov+default_base_moof", "flush_packets": "1"},
    "avi": {"flush_packets": "1"},
}
KEY_FRAMES = 30
"""Frames from one key frame to the next."""


def known_codecs(file_type: str) -> list[str]:
    return [name for name, codec in CODECS.items() if file_type in codec.file_types and _has(codec.encoder)]


def codec_name(text: str, file_type: str) -> str:
    """Usual name of a codec, also of an unknown one; of an empty text the preferred codec that this computer has."""
    bare = text.strip().lower()
    if bare:
        return CODEC_SYNONYMS.get(bare, bare)
    known = known_codecs(file_type)
    return next(name for name in (*PREFERRED[file_type], *known) if name in known)


def _has(encoder: str) -> bool:
    try:
        av.codec.Codec(encoder, "w")
    except ValueError:  # PyAV's UnknownCodecError
        return False
    return True


class VideoFile:
    """A video that is being written. Used by one thread.

    Attributes:
        width: Pixels; even, as codecs need it.
        height: Pixels, likewise.
        frames: Number of frames in it.
        dropped: Frames that came too early after the one before, or twice.
        began: Stamp of the first frame, s.
        duration: s from the first frame to the end of the last one.
    """

    def __init__(self, file: WholeFile, file_type: str, codec: str, width: int, height: int) -> None:
        """Open the video; the file is closed with it.

        Raises NaoError if FFmpeg cannot make such a video.

        Args:
            file: Open for writing.
            file_type: One of VIDEO_TYPES.
            codec: One of `known_codecs`.
            width: Pixels of the first picture; an odd one is left out.
            height: Pixels, likewise.
        """
        self.width, self.height = max(2, width - width % 2), max(2, height - height % 2)
        self.frames = self.dropped = 0
        self.began = 0.0
        self._places = array("d")  # of the frames, s after the first
        self._ticks = TICKS[file_type]
        self._times = VideoTimes(1.0 / self._ticks)
        self._kind = file_type
        self._file = file
        self._muxed = self._whole = 0  # frames that were passed on, and those that can be played
        self._held: Any = None  # the latest packet: only the next one tells how long its frame lasts
        kind = CODECS[codec]
        try:
            self._container = av.open(file, "w", format=file_type, options=CONTAINER_OPTIONS[file_type])
            rate = self._ticks if file_type == "avi" else 30
            stream = self._container.add_stream(kind.encoder, rate=rate, options=dict(kind.options))
            stream.width, stream.height, stream.pix_fmt = self.width, self.height, kind.pixels
            context = stream.codec_context
            context.time_base = Fraction(1, self._ticks)
            context.thread_count = 1  # there are other recordings, and a robot to simulate
            context.gop_size = KEY_FRAMES
            if kind.bits:
                context.bit_rate = max(400_000, int(kind.bits * 30 * self.width * self.height))
        except (av.error.FFmpegError, ValueError) as error:
            raise _trouble(error) from error
        self._stream: Any = stream

    @property
    def duration(self) -> float:
        return self._places[-1] + self._period if self.frames else 0.0

    @property
    def _period(self) -> float:
        """Duration of the last frame, s: that of the one before it."""
        return self._places[-1] - self._places[-2] if self.frames > 1 else 0.0

    def write(self, picture: np.ndarray, stamp: float) -> bool:
        """Add a frame.

        `picture`: (height, width, 3) uint8, blue, green, red. One of another size than the first is made to fit.
        `stamp`: when it was taken, s. Returns whether it has a place in the video. Raises NaoError if it cannot be
        compressed, FileTrouble if it cannot be written.
        """
        time = self._times.place(stamp)
        if time is None:
            self.dropped += 1
            return False
        if picture.shape[1] - picture.shape[1] % 2 == self.width and picture.shape[0] // 2 * 2 == self.height:
            picture = picture[: self.height, : self.width]
        frame = av.VideoFrame.from_ndarray(
            np.ascontiguousarray(fitted(picture, self.width, self.height)), format="bgr24"
        )
        frame.pts = round(time * self._ticks)
        frame.time_base = Fraction(1, self._ticks)
        self._encode(frame)
        if not self.frames:
            self.began = stamp
        self._places.append(time)
        self.frames += 1
        return True

    def close(self) -> None:
        """End the video and the file; of one that could not be written to its end the playable part is kept.

        Raises NaoError if the end cannot be compressed, FileTrouble if the end cannot be written.
        """
        try:
            try:
                if self.frames:
                    self._encode(None)
                    self._held.duration = max(1, round(self._period * self._ticks))
                    self._mux(self._held)
            finally:
                self._container.close()
            self._file.close()
        except (av.error.FFmpegError, FileTrouble) as error:
            self.frames = self._whole
            del self._places[self.frames :]
            if isinstance(error, FileTrouble):
                raise
            raise _trouble(error) from error
        finally:
            if not self.frames:
                self._file.discard()

    def _encode(self, frame: Any) -> None:
        try:
            for packet in self._stream.encode(frame):
                if self._held is not None:
                    self._mux(self._held)
                self._held = packet
        except av.error.FFmpegError as error:
            raise _trouble(error) from error

    def _mux(self, packet: Any) -> None:
        """Pass a packet on; the part of the file that it completes is written."""
        self._container.mux(packet)
        self._muxed += 1
        if self._file.flush():
            # A part of an mp4 file ends when the next one begins.
            self._whole = self._muxed - (self._kind == "mp4")


def _trouble(error: Exception) -> NaoError:
    return NaoError(f"the video cannot be written: {error}")
