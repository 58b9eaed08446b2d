"""Pictures of camera messages: decoding, scaling, encoding, queues and times of frames. No ROS."""

from __future__ import annotations

import io
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from PIL import Image, ImageOps, UnidentifiedImageError

from naoqi.errors import NaoError

from ..core.fields import limit
from ..core.lazy import Later

MOST_FRAMES = int(limit("waiting pictures").highest)
MOST_BYTES = int(limit("bytes of waiting pictures").highest)
"""Of the waiting pictures; two may always wait."""


@dataclass(frozen=True)
class Frame:
    message: Any  # sensor_msgs/Image or sensor_msgs/CompressedImage
    stamp: float  # ROS time at which it was taken, s; of its arrival if the message has none


def frame_of(message: Any, now: float) -> Frame:
    """The frame of a message that came at a ROS time, in s."""
    return Frame(message, message.header.stamp.to_sec() or now)


class FrameQueue:
    """Frames in the order in which they came."""

    def __init__(self) -> None:
        self.dropped = 0
        self._frames: deque[Frame] = deque()
        self._bytes = 0

    def __len__(self) -> int:
        return len(self._frames)

    def put(self, frame: Frame) -> None:
        """Add a frame; the oldest are dropped where there are too many."""
        self._frames.append(frame)
        self._bytes += len(frame.message.data)
        while len(self) > MOST_FRAMES or (self._bytes > MOST_BYTES and len(self) > 2):
            self.take()
            self.dropped += 1

    def drop_all(self) -> None:
        while self:
            self.take()
            self.dropped += 1

    def take(self) -> Frame:
        """Remove the oldest one; there must be one."""
        frame = self._frames.popleft()
        self._bytes -= len(frame.message.data)
        return frame


STRANGEST_GAP = 3600.0
"""s; stamps that jump further ahead come from another clock."""
FAR_BACK = 1.0
"""s; stamps that jump further back belong to a clock that was set back, as that of a simulation that starts again."""
SLACK = 0.1
"""Fraction of the period that a frame may be early: stamps are not even."""


class RateLimit:
    """Selects frames so that they are at most so many a second; rate 0: all."""

    def __init__(self, rate: float) -> None:
        self._period = 1.0 / rate if rate > 0.0 else 0.0
        self._due: float | None = None

    def passes(self, stamp: float) -> bool:
        """Whether a frame of a time (s) is passed on."""
        if not self._period:
            return True
        due = self._due
        if due is not None and due - self._period - FAR_BACK <= stamp < due - SLACK * self._period:
            return False
        on_time = due is not None and due - self._period <= stamp <= due + self._period
        self._due = (due if on_time else stamp) + self._period
        return True


class VideoTimes:
    """Times of frames in a video: as the camera stamps them, from 0, and always growing."""

    def __init__(self, step: float) -> None:
        """Begin with the next frame; the step is the resolution of times in the video, s."""
        self._step = step
        self._shift: float | None = None
        self._last = 0.0
        self._period = 0.0

    def place(self, stamp: float) -> float | None:
        """Time in the video of a frame of a time (s); None if it is less than a step after the last one."""
        if self._shift is None:
            self._shift = stamp
            return 0.0
        time = stamp - self._shift
        gap = time - self._last
        if gap < -FAR_BACK or gap > STRANGEST_GAP:
            time = self._last + max(self._period, self._step)
            self._shift = stamp - time
        elif gap < self._step:
            return None
        self._period = time - self._last
        self._last = time
        return time


class RecentRate:
    """The rate of the latest 30 frames."""

    def __init__(self) -> None:
        self._stamps: deque[float] = deque(maxlen=30)

    def count(self, stamp: float) -> None:
        if self._stamps and stamp < self._stamps[-1]:
            self._stamps.clear()  # the clock was set back
        self._stamps.append(stamp)

    @property
    def rate(self) -> float:
        """Frames a second; 0 before the second one."""
        if len(self._stamps) < 2 or self._stamps[-1] <= self._stamps[0]:
            return 0.0
        return (len(self._stamps) - 1) / (self._stamps[-1] - self._stamps[0])


cv2 = Later("cv2")

COMPRESSED = "/compressed"
"""Topics whose name ends so have pictures as JPEG, as image_transport's do."""
DEFAULT_QUALITY = 95
DECODED = ("JPEG", "PNG", "WEBP")
"""Formats of compressed messages, by Pillow's names."""
PICTURE_TYPES = ("png", "jpg", "bmp", "tiff", "webp")
LARGEST, MOST_PIXELS = int(limit("pixels").highest), 2**25
"""Pixels of a side, and in all; no camera has more."""
LARGEST_COMPRESSED = 2**26
"""Bytes of a compressed picture."""

Picture = np.ndarray
"""(height, width, 3) uint8, blue, green, red; or (height, width) uint16 where a camera is grey and that fine."""


class BadPicture(NaoError):
    """A message holds no picture that can be read."""

    def __init__(self, encoding: str, problem: str) -> None:
        super().__init__(f"a picture of encoding {encoding!r} cannot be read: {problem}")


def _as_is(rows: np.ndarray) -> Picture:
    return rows


def _converted(code: str) -> Callable[[np.ndarray], Picture]:
    return lambda rows: cv2.cvtColor(rows, getattr(cv2, code))


# Encoding of sensor_msgs/Image -> bytes a pixel, channels (0: no axis of their own), and the conversion.
ENCODINGS: dict[str, tuple[int, int, Callable[[np.ndarray], Picture]]] = {
    "bgr8": (3, 3, _as_is),
    "rgb8": (3, 3, _converted("COLOR_RGB2BGR")),
    "bgra8": (4, 4, _converted("COLOR_BGRA2BGR")),
    "rgba8": (4, 4, _converted("COLOR_RGBA2BGR")),
    "mono8": (1, 0, _converted("COLOR_GRAY2BGR")),
    "mono16": (2, 0, _as_is),
    "yuv422": (2, 2, _converted("COLOR_YUV2BGR_UYVY")),
    "yuv422_yuy2": (2, 2, _converted("COLOR_YUV2BGR_YUY2")),
    # OpenCV names the pattern by its second row, ROS by the first.
    "bayer_rggb8": (1, 0, _converted("COLOR_BayerBG2BGR")),
    "bayer_bggr8": (1, 0, _converted("COLOR_BayerRG2BGR")),
    "bayer_gbrg8": (1, 0, _converted("COLOR_BayerGR2BGR")),
    "bayer_grbg8": (1, 0, _converted("COLOR_BayerGB2BGR")),
}
ENCODINGS.update({
    "8UC3": ENCODINGS["bgr8"],
    "8UC4": ENCODINGS["bgra8"],
    "8UC1": ENCODINGS["mono8"],
    "16UC1": ENCODINGS["mono16"],
    "uyvy": ENCODINGS["yuv422"],
    "yuyv": ENCODINGS["yuv422_yuy2"],
})  # fmt: skip


def is_compressed(message: Any) -> bool:
    """Whether a message is a sensor_msgs/CompressedImage, not an Image."""
    return hasattr(message, "format")


def encoding_of(message: Any) -> str:
    """Encoding of a message: bgr8, ...; of a compressed one its format: jpeg, png, ..."""
    if not is_compressed(message):
        return message.encoding
    return message.format.split(";")[-1].replace("compressed", " ").split()[0] if message.format.strip() else "jpeg"


def size_rows() -> list[tuple[str, int, str, str]]:
    """The limits as rows of a table: name, limit, unit, where it holds."""
    where = "pictures of camera topics"
    return [
        ("width, height", LARGEST, "pixels", where),
        ("width x height", MOST_PIXELS, "pixels", where),
        ("compressed picture", LARGEST_COMPRESSED, "bytes", where),
    ]


def picture_of(message: Any) -> Picture:
    """The picture of a sensor_msgs/Image or sensor_msgs/CompressedImage.

    Raises BadPicture if it holds none that can be read.
    """
    if is_compressed(message):
        return _decompressed(message)
    if message.encoding not in ENCODINGS:
        raise BadPicture(message.encoding, f"known are {', '.join(ENCODINGS)}")
    width, height, step = message.width, message.height, message.step
    _check_size(message.encoding, width, height)
    size, channels, convert = ENCODINGS[message.encoding]
    step = step or width * size
    if step < width * size or len(message.data) < step * height:
        there = f"{len(message.data)} bytes in rows of {step}"
        raise BadPicture(message.encoding, f"{width}x{height} pixels need {width * size * height}, there are {there}")
    if channels == 2 and width % 2:
        raise BadPicture(message.encoding, f"{width} pixels a row are no pairs")
    rows = np.frombuffer(message.data, np.uint8, step * height).reshape(height, step)[:, : width * size]
    if size == 2 and not channels:
        fine = np.ascontiguousarray(rows).view(">u2" if message.is_bigendian else "<u2")
        return fine.astype(np.uint16)
    if channels:
        rows = np.ascontiguousarray(rows).reshape(height, width, channels)
    return convert(rows)


def _decompressed(message: Any) -> Picture:
    """Decode with Pillow, only the formats `DECODED`, after a check of the size in the header.

    OpenCV 4.11, the last one for NumPy 1, decodes many more formats, JPEG 2000 with a hole (CVE-2025-53644) among them,
    and fills broken pictures with what it decoded before.
    """
    content = bytes(message.data)
    if len(content) > LARGEST_COMPRESSED:
        problem = f"it has {len(content)} bytes; up to {LARGEST_COMPRESSED} are allowed"
        raise BadPicture(encoding_of(message), problem)
    try:
        with Image.open(io.BytesIO(content), formats=DECODED) as image:
            _check_size(encoding_of(message), *image.size)
            if image.format == "WEBP" and image.is_animated:
                raise ValueError("it is WebP that moves")
            ImageOps.exif_transpose(image, in_place=True)
            if image.mode.startswith("I"):  # grey of 16 bits
                grey = (np.asarray(image).astype(np.uint32) >> 8).astype(np.uint8)
                return cv2.cvtColor(grey, cv2.COLOR_GRAY2BGR)
            return np.ascontiguousarray(np.asarray(image.convert("RGB"))[:, :, ::-1])
    except BadPicture:
        raise
    except Exception as error:  # formats have errors of their own for broken files, a SyntaxError among them
        reason = f"none of {', '.join(DECODED)}" if isinstance(error, UnidentifiedImageError) else error
        problem = f"its {len(content)} bytes are no compressed picture: {reason}"
        raise BadPicture(encoding_of(message), problem) from error


def _check_size(encoding: str, width: int, height: int) -> None:
    if not (0 < width <= LARGEST and 0 < height <= LARGEST and width * height <= MOST_PIXELS):
        allowed = f"up to {LARGEST} a side and {MOST_PIXELS} of all are allowed"
        raise BadPicture(encoding, f"it is {width}x{height} pixels; {allowed}")


def visible(picture: Picture) -> Picture:
    """A picture with three channels of 8 bits, as videos and most files need it."""
    if picture.dtype == np.uint16:
        picture = (picture >> 8).astype(np.uint8)
    return picture if picture.ndim == 3 else cv2.cvtColor(picture, cv2.COLOR_GRAY2BGR)


def wanted_size(size: tuple[int, int], width: int, height: int) -> tuple[int, int]:
    """Size of a scaled picture, (width, height) in pixels.

    Args:
        size: That of the original.
        width: Pixels; 0: in proportion to the height, or as it is.
        height: Pixels, likewise.
    """
    own_width, own_height = size
    if not width and not height:
        return size
    return (
        width or max(1, round(height * own_width / own_height)),
        height or max(1, round(width * own_height / own_width)),
    )


def scaled(picture: Picture, width: int, height: int) -> Picture:
    """A picture scaled to `wanted_size`.

    Raises BadPicture if it would be too large, as the free side of a narrow picture may be.
    """
    size = (picture.shape[1], picture.shape[0])
    wanted = wanted_size(size, width, height)
    if wanted == size:
        return picture
    _check_size("bgr8", *wanted)
    shrinks = wanted[0] * wanted[1] < size[0] * size[1]
    return cv2.resize(picture, wanted, interpolation=cv2.INTER_AREA if shrinks else cv2.INTER_LINEAR)


def fitted(picture: Picture, width: int, height: int) -> Picture:
    """A picture scaled in proportion into a frame (pixels), the rest of which is black."""
    own_height, own_width = picture.shape[:2]
    if (own_width, own_height) == (width, height):
        return picture
    scale = min(width / own_width, height / own_height)
    inner = scaled(picture, max(1, round(own_width * scale)), max(1, round(own_height * scale)))
    left, top = (width - inner.shape[1]) // 2, (height - inner.shape[0]) // 2
    frame = np.zeros((height, width, *picture.shape[2:]), picture.dtype)
    frame[top : top + inner.shape[0], left : left + inner.shape[1]] = inner
    return frame


def encoded(picture: Picture, file_type: str, quality: int = 0) -> bytes:
    """The content of a file with a picture.

    Args:
        picture: See `Picture`; 16 bits are kept where the type can.
        file_type: One of PICTURE_TYPES.
        quality: 1..100, of jpg and webp; 0: the default.
    """
    if file_type not in ("png", "tiff"):
        picture = visible(picture)
    parameters = {"jpg": [cv2.IMWRITE_JPEG_QUALITY], "webp": [cv2.IMWRITE_WEBP_QUALITY]}.get(file_type, [])
    if parameters:
        parameters = [*parameters, quality or DEFAULT_QUALITY]
    _, data = cv2.imencode(f".{file_type}", picture, parameters)
    return data.tobytes()
