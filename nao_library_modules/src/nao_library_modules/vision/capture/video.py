"""A video file in which every frame stands at the time at which the camera took it. PyAV; no ROS."""

from __future__ import annotations

import logging
from array import array
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from naoqi.errors import NaoError

from ...base.doors import Later
from ...base.whole_file import FileTrouble, WholeFile
from .pictures import fitted
from .times import VideoTimes

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
