"""Functions that take pictures."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from nao_library_msgs.msg import PictureFile
from naoqi.errors import NaoError

from ...base.cancellation import CancellationToken
from ...functions.chain import checked_by
from .base import VisionBase
from .cameras import camera_name
from .checks import check_picture, check_pictures, numbered
from .fields import (
    DEFAULT_TIMEOUT,
    Camera,
    Count,
    Height,
    Interval,
    Overwrite,
    PictureName,
    PictureNames,
    PictureType,
    Quality,
    Timeout,
    Topic,
    Width,
)
from .pictures import PICTURE_TYPES, encoded, encoding_of, picture_of, scaled
from .queue import Frame, frame_of

TAKING = "taking pictures"
"""Status in the feedback."""
OLD_FRAMES = 5
"""So many frames may be from before they were asked for: they were on their way. A camera that goes on like that has
another clock, and is taken at its word."""


class NoPicture(NaoError):  # noqa: N818  named like the errors of the proxy layer
    """A camera sent nothing in time.

    Attributes:
        topic: Its topic.
    """

    def __init__(self, topic: str, timeout: float) -> None:
        """Compose the text.

        Args:
            topic: The camera's.
            timeout: How long it was waited, s.
        """
        super().__init__(f"no picture came from {topic} within {timeout:g} s: is its camera running?")
        self.topic = topic


class Frames:
    """The newest frame of a topic, for one function that waits for it."""

    def __init__(self, topic: str, clock: Any, interrupt: CancellationToken) -> None:
        """Nothing has come yet.

        Args:
            topic: Where they come from, for texts.
            clock: ROS time.
            interrupt: Ends waits.
        """
        self._topic = topic
        self._clock = clock
        self._interrupt = interrupt
        self._news = CancellationToken()
        self._newest: Frame | None = None
        self._old = 0

    def take(self, message: Any) -> None:
        """Take a message; called from the thread that receives it."""
        self._newest = frame_of(message, self._clock.now())
        self._news.trigger()

    def next(self, since: float, timeout: float) -> Frame:
        """The next frame that was taken since a time, or has come after too many others.

        Args:
            since: ROS time, s.
            timeout: s to wait for it.

        Raises:
            NoPicture: If none came.
            Preempted: Or whatever reason the interrupt has.
        """
        end = self._clock.now() + timeout
        while True:
            self._interrupt.check()
            self._news.clear()
            frame, self._newest = self._newest, None
            if frame is not None:
                if frame.stamp >= since or self._old >= OLD_FRAMES:
                    return frame
                self._old += 1
                continue
            remaining = end - self._clock.now()
            if remaining <= 0.0:
                raise NoPicture(self._topic, timeout)
            with self._interrupt.waking(self._news.trigger):
                self._clock.wait(remaining, self._news)


class PictureFunctions(VisionBase):
    """Pictures in files. Parameters are fields of VisionFunction."""

    @checked_by(check_picture)
    def take_picture(
        self,
        str_param: PictureName,
        camera: Camera,
        topic: Topic,
        file_type: PictureType,
        quality: Quality,
        width: Width,
        height: Height,
        timeout: Timeout,
        overwrite: Overwrite,
    ) -> list[str]:
        """Take a picture from now on, not an older one; answers its file."""
        return self.take_pictures(
            str_param, camera, topic, file_type, quality, width, height, timeout, 1, 0.0, overwrite
        )

    @checked_by(check_pictures)
    def take_pictures(
        self,
        str_param: PictureNames,
        camera: Camera,
        topic: Topic,
        file_type: PictureType,
        quality: Quality,
        width: Width,
        height: Height,
        timeout: Timeout,
        count: Count,
        interval: Interval,
        overwrite: Overwrite,
    ) -> list[str]:
        """Take several pictures; answers their files."""
        source = self.source(camera, topic)
        kind = self.files.file_type(str_param, file_type, PICTURE_TYPES)
        named = self.files.path(str_param, kind) if str_param.strip() else None
        prefix = camera_name(camera, self.active_camera) if not topic.strip() else "picture"
        count = count or 1
        answers = []
        began = self.clock.now()
        with self._frames(source) as frames:
            for number in range(1, count + 1):
                due = began + (number - 1) * interval
                self._wait_until(due)
                frame = frames.next(due, timeout or DEFAULT_TIMEOUT)
                picture = scaled(picture_of(frame.message), width, height)
                path = numbered(named, number, count) if named else self.files.named_by_time(prefix, kind)
                data = encoded(picture, kind, quality)
                path = self.files.write(path, data, overwrite and named is not None, numbered=named is None)
                self._note(frame, path, kind, source, picture)
                answers.append(str(path))
                if count > 1:
                    self.tell(TAKING, done=number)
        return answers

    @contextmanager
    def _frames(self, source: str) -> Iterator[Frames]:
        frames = Frames(source, self.clock, self.interrupt)
        subscription = self.topics.subscribe(source, frames.take)
        try:
            yield frames
        finally:
            subscription.close()

    def _wait_until(self, due: float) -> None:
        remaining = due - self.clock.now()
        if remaining > 0.0 and not self.clock.wait(remaining, self.interrupt):
            self.interrupt.check()

    def _note(self, frame: Frame, path: Path, kind: str, source: str, picture: Any) -> None:
        height, width = picture.shape[:2]
        self.taken.pictures.append(
            PictureFile(
                header=frame.message.header,
                path=str(path),
                file_type=kind,
                topic=source,
                width=width,
                height=height,
                encoding=encoding_of(frame.message),
            )
        )

    functions = {
        "takePicture": take_picture,
        "takePictures": take_pictures,
    }
