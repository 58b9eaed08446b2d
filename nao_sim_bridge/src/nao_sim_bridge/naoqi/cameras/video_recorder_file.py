"""AVI files of films: MJPG, compressed, or IYUV, raw."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np

from nao_sim_bridge.base.whole_file import WholeFile

# FFmpeg's name of the codec, its pixels, and the four letters in the file. JPEG has the full range of brightness.
FORMATS = {"MJPG": ("mjpeg", "yuvj420p", "MJPG"), "IYUV": ("rawvideo", "yuv420p", "IYUV")}
# The smaller the better, 2 to 31: about that of a photo camera.
JPEG_QUANTISER = "3"
RATE_STEPS = 1000


class Film:
    """An AVI file that grows frame by frame, at a constant rate.

    It can be played at any moment, also when its process is killed or the disk is full.

    Args:
        path: The file; one that is there is replaced in the end.
        rate: Frames a second.

    Raises:
        FileTrouble: It cannot be written.
    """

    def __init__(self, path: Path, kind: str, width: int, height: int, rate: float) -> None:
        import av  # takes a moment, and few robots film

        codec, pixels, letters = FORMATS[kind]
        self.frames = 0
        self._file = WholeFile(path)
        # Each frame goes to the file at once, so that it ends with a whole one.
        self._container = av.open(self._file, mode="w", format="avi", options={"flush_packets": "1"})
        fraction = Fraction(round(rate * RATE_STEPS), RATE_STEPS)
        self._stream = self._container.add_stream(codec, rate=fraction)
        self._stream.width, self._stream.height, self._stream.pix_fmt = width, height, pixels
        self._stream.codec_tag = letters
        self._step = 1 / fraction
        if kind == "MJPG":
            self._stream.options = {"qmin": JPEG_QUANTISER, "qmax": JPEG_QUANTISER}

    @property
    def path(self) -> Path:
        return self._file.path

    def write(self, picture: np.ndarray) -> None:
        """Append a frame, (height, width) grey or (height, width, 3) BGR, uint8.

        Raises:
            FileTrouble: It cannot be written; the film ends with the frame before.
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
        """Complete the file; without a frame there is none.

        Raises:
            FileTrouble: It is not complete.
        """
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
