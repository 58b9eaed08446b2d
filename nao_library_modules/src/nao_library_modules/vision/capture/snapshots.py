"""Functions that take pictures."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Any

from nao_library_msgs.msg import PictureFile
from naoqi.errors import NaoError

from ...base.cancellation import CancellationToken
from ...functions.chain import checked_by
from ...functions.parts import Part
from .base import Cameras, ChainResults
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
from .files import VisionFiles
from .pictures import PICTURE_TYPES, encoded, encoding_of, picture_of, scaled
from .queue import Frame, frame_of

if TYPE_CHECKING:
    from ...server.nao_basic import NaoBasic

TAKING = "taking pictures"
"""Status in the feedback."""
OLD_FRAMES = 5
"""So many frames may be older than the request: they were on their way. A camera that sends more of them has another
clock, and its stamps do not count."""

SILENCE_GRACE = 1.0
"""s of ROS time that pictures are waited for at least while the robot is silent, and after that."""


class Frames:
    """The newest frame of a topic, for one function that waits for it."""

    def __init__(self, topic: str, clock: Any, interrupt: CancellationToken, connection: Any) -> None:
        """Wait for none yet. `connection`: of the robot, whose silence gives its cameras more time."""
        self._topic = topic
        self._clock = clock
        self._interrupt = interrupt
        self._connection = connection
        self._news = CancellationToken()
        self._newest: Frame | None = None
        self._old = 0

    def take(self, message: Any) -> None:
        """Take a message. Called from the thread that receives it."""
        self._newest = frame_of(message, self._clock.now())
        self._news.trigger()

    def next(self, since: float, timeout: float) -> Frame:
        """The next frame that is not older than a time, or comes after OLD_FRAMES older ones.

        `since`: ROS time, s. `timeout`: s to wait for it. Raises NaoError if none came; Preempted, or whatever reason
        the interrupt has.
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
            if self._connection.silent:
                end = max(end, self._clock.now() + SILENCE_GRACE)
            remaining = end - self._clock.now()
            if remaining <= 0.0:
                raise NaoError(f"no picture came from {self._topic} within {timeout:g} s: is its camera running?")
            with self._interrupt.waking(self._news.trigger):
                self._clock.wait(remaining, self._news)


class PictureFunctions(Part):
    left_by_goals = frozenset({"files"})

    def __init__(self, module: NaoBasic, cameras: Cameras, files: VisionFiles, results: ChainResults) -> None:
        self.files = files
        self._module = module
        self._cameras = cameras
        self._results = results

    def _check_pictures(
        self, str_param: str, file_type: str, count: int, overwrite: bool, context: dict[str, Any]
    ) -> None:
        kind = self.files.file_type(str_param, file_type, PICTURE_TYPES)
        if str_param.strip():
            path = self.files.path(str_param, kind)
            for number in range(1, (count or 1) + 1):
                self.files.plan(_numbered(path, number, count or 1), overwrite, context.setdefault("files", set()))

    def _check_picture(self, str_param: str, file_type: str, overwrite: bool, context: dict[str, Any]) -> None:
        self._check_pictures(str_param, file_type, 1, overwrite, context)

    @checked_by(_check_picture)
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

    @checked_by(_check_pictures)
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
        module, cameras = self._module, self._cameras
        source = cameras.source(camera, topic)
        kind = self.files.file_type(str_param, file_type, PICTURE_TYPES)
        named = self.files.path(str_param, kind) if str_param.strip() else None
        prefix = cameras.name(camera) if not topic.strip() else "picture"
        count = count or 1
        answers = []
        began = module.clock.now()
        frames = Frames(source, module.clock, module.interrupt, module.robot.connection)
        with closing(cameras.topics.subscribe(source, frames.take)):
            for number in range(1, count + 1):
                due = began + (number - 1) * interval
                module.wait(due - module.clock.now())
                frame = frames.next(due, timeout or DEFAULT_TIMEOUT)
                picture = scaled(picture_of(frame.message), width, height)
                path = _numbered(named, number, count) if named else self.files.named_by_time(prefix, kind)
                data = encoded(picture, kind, quality)
                path = self.files.write(path, data, overwrite and named is not None, numbered=named is None)
                self._results.pictures.append(
                    PictureFile(
                        header=frame.message.header,
                        path=str(path),
                        file_type=kind,
                        topic=source,
                        width=picture.shape[1],
                        height=picture.shape[0],
                        encoding=encoding_of(frame.message),
                    )
                )
                answers.append(str(path))
                if count > 1:
                    module.publish_feedback(status=TAKING, done=number)
        return answers

    functions = {
        "takePicture": take_picture,
        "takePictures": take_pictures,
    }


def _numbered(path: Path, number: int, count: int) -> Path:
    """Path of one of several pictures: name-001 and so on; the path itself if there is only one picture."""
    if count == 1:
        return path
    return path.with_name(f"{path.stem}-{number:0{max(3, len(str(count)))}d}{path.suffix}")
