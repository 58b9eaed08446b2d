"""A video file with sound and captions, written frame by frame. PyAV; no simulation.

It is a row of parts, each complete in itself: what a killed process wrote can be played.
"""

from __future__ import annotations

import logging
from fractions import Fraction
from pathlib import Path
from typing import Any

import av
import numpy as np
from PIL import Image, ImageDraw, ImageFont

from nao_sim_bridge.base.whole_file import WholeFile

# What the encoders have to say of themselves is no matter of the simulator's log.
logging.getLogger("libav").setLevel(logging.ERROR)

TICKS = 60000
"""Times a second at which a frame can stand."""
QUALITY = {"preset": "veryfast", "crf": "21"}
KEY_FRAMES = 30
PARTS = {"movflags": "frag_keyframe+empty_moov+default_base_moof", "flush_packets": "1"}
CAPTION_MARGIN = 0.03
CAPTION_SIZE = 0.055
"""Of the picture's height."""


class FilmFile:
    """An mp4 file: H.264 pictures and AAC sound. One thread.

    Attributes:
        frames: How many pictures are in it.
        caption: Written into the pictures from now on; empty for none.

    Args:
        path: The file; one that is there is replaced in the end.
        width: Pixels, even.
        height: Pixels, even.
        rate: Of the sound, samples a second.
    """

    def __init__(self, path: Path, width: int, height: int, rate: int) -> None:
        self.frames = 0
        self.caption = ""
        self._last = self._period = 0.0
        self._rate = rate
        self._header = 0  # bytes
        self._font = ImageFont.load_default(size=round(CAPTION_SIZE * height))
        self._file = WholeFile(path)
        self._container = av.open(self._file, "w", format="mp4", options=dict(PARTS))
        video = self._container.add_stream("libx264", rate=30, options=dict(QUALITY))
        video.width, video.height, video.pix_fmt = width, height, "yuv420p"
        video.codec_context.time_base = Fraction(1, TICKS)
        video.codec_context.gop_size = KEY_FRAMES
        video.codec_context.thread_count = 1  # the other cores are for physics
        self._video: Any = video
        self._audio: Any = self._container.add_stream("aac", rate=rate)
        self._audio.layout = "stereo"

    @property
    def duration(self) -> float:
        """Length, s."""
        return self._last + self._period if self.frames else 0.0

    def picture(self, pixels: np.ndarray, time: float) -> None:
        """Add a frame.

        Args:
            pixels: (h, w, 3) uint8 RGB.
            time: Since the beginning of the film, s; above that of the frame before.
        """
        frame = av.VideoFrame.from_ndarray(self._captioned(pixels), format="rgb24")
        frame.pts, frame.time_base = round(time * TICKS), Fraction(1, TICKS)
        self._mux(self._video.encode(frame))
        if self.frames:
            self._period = time - self._last
        self._last = time
        self.frames += 1

    def sound(self, samples: np.ndarray, first: int) -> None:
        """Add sound.

        Args:
            samples: (n, 2) int16.
            first: Place of the first of them, counted from the beginning of the film.
        """
        frame = av.AudioFrame.from_ndarray(np.ascontiguousarray(samples).reshape(1, -1), format="s16", layout="stereo")
        frame.sample_rate, frame.pts, frame.time_base = self._rate, first, Fraction(1, self._rate)
        self._mux(self._audio.encode(frame))

    def close(self) -> None:
        """Complete the file.

        Raises:
            FileTrouble: It is not complete.
        """
        try:
            for stream in (self._video, self._audio):
                self._container.mux(stream.encode(None))
        finally:
            self._container.close()
        self._file.close()

    def _mux(self, packets: Any) -> None:
        self._container.mux(packets)
        self._header = self._header or self._file.tell()
        if self._file.tell() > self._header:  # before the first part it would be a film without a picture
            self._file.flush()

    def _captioned(self, pixels: np.ndarray) -> np.ndarray:
        if not self.caption:
            return np.ascontiguousarray(pixels)
        picture = Image.fromarray(pixels)
        edge = round(CAPTION_MARGIN * picture.height)
        ImageDraw.Draw(picture).text(
            (edge, picture.height - edge),
            self.caption,
            font=self._font,
            anchor="ls",
            fill="white",
            stroke_width=max(1, picture.height // 240),
            stroke_fill=(40, 40, 40),
        )
        return np.asarray(picture)
