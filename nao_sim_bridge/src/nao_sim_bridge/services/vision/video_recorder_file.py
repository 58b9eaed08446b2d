"""AVI files of films: MJPG, compressed, or IYUV, raw."""

from __future__ import annotations

import io
from fractions import Fraction
from pathlib import Path

import av
import numpy as np

# FFmpeg's name of the codec, its pixels, and the four letters in the file. JPEG has the full range of brightness.
FORMATS = {"MJPG": ("mjpeg", "yuvj420p", "MJPG"), "IYUV": ("rawvideo", "yuv420p", "IYUV")}
# The smaller the better, 2 to 31: about that of a photo camera.
JPEG_QUANTISER = "3"
RATE_STEPS = 1000


class Film:
    """An AVI file that grows frame by frame, at a constant rate.

    When the disk is full, what has been written stays and can be read; the frames after it are counted out.

    Attributes:
        frames: How many are in it.
        failure: Why no more can be written, None while all is well.

    Args:
        path: The file; what it had is lost.
        kind: "MJPG" or "IYUV".
        width: Pixels.
        height: Pixels.
        rate: Frames a second.

    Raises:
        OSError: It cannot be written.
    """

    def __init__(self, path: Path, kind: str, width: int, height: int, rate: float) -> None:
        codec, pixels, letters = FORMATS[kind]
        self.frames = 0
        self._file = _Forgiving(path)
        # Each frame goes to the disk at once, so that it is known which one was the last that had room.
        self._container = av.open(self._file, mode="w", format="avi", options={"flush_packets": "1"})
        fraction = Fraction(round(rate * RATE_STEPS), RATE_STEPS)
        self._stream = self._container.add_stream(codec, rate=fraction)
        self._stream.width, self._stream.height, self._stream.pix_fmt = width, height, pixels
        self._stream.codec_tag = letters
        self._step = 1 / fraction
        if kind == "MJPG":
            self._stream.options = {"qmin": JPEG_QUANTISER, "qmax": JPEG_QUANTISER}

    @property
    def failure(self) -> OSError | None:
        """Why no more can be written, None while all is well."""
        return self._file.failure

    def write(self, picture: np.ndarray) -> None:
        """Append a frame, (height, width) grey or (height, width, 3) BGR, uint8."""
        if self.failure is not None:
            return
        grey = picture.ndim == 2
        frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(picture), format="gray" if grey else "bgr24")
        frame.pts, frame.time_base = self.frames, self._step
        for packet in self._stream.encode(frame):
            self._container.mux(packet)
        if self.failure is None:
            self.frames += 1
            self._file.mark()

    def close(self) -> None:
        """Complete the file."""
        for packet in self._stream.encode():
            self._container.mux(packet)
        self._container.close()
        self._file.close()


class _Forgiving(io.RawIOBase):
    """A file for FFmpeg that keeps what is on the disk usable when no more goes on it.

    FFmpeg writes nothing any more after an error, not even how long the film is into its header. So it does not get
    to know: what would make the file longer is dropped, what changes its beginning is still written, and in the end
    the file is as long as it was when it was last marked.

    Attributes:
        failure: The first error, None while all is well.
    """

    def __init__(self, path: Path) -> None:
        super().__init__()
        # Unbuffered: otherwise an error would come at a moment when nobody expects it.
        self._file = path.open("wb", buffering=0)
        self._position = 0
        self._length = self._marked = 0
        self.failure: OSError | None = None

    def writable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return True

    def tell(self) -> int:
        return self._position

    def seek(self, offset: int, whence: int = io.SEEK_SET) -> int:
        base = {io.SEEK_SET: 0, io.SEEK_CUR: self._position, io.SEEK_END: self._length}[whence]
        self._position = base + offset
        return self._position

    def mark(self) -> None:
        """What is there now is worth keeping."""
        self._marked = self._length

    def write(self, content: bytes) -> int:
        content = memoryview(content)
        if self.failure is None or self._position + len(content) <= self._length:
            try:
                self._put(content)
            except OSError as error:
                self.failure = self.failure or error
        self._position += len(content)
        return len(content)

    def close(self) -> None:
        if not self.closed:
            if self.failure is not None:
                self._file.truncate(self._marked)  # half a frame would be shown as a torn one
            self._file.close()
        super().close()

    def _put(self, content: memoryview) -> None:
        self._file.seek(self._position)
        done = 0
        while done < len(content):
            done += self._file.write(content[done:])
            self._length = max(self._length, self._position + done)
