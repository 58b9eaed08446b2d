"""A recording: frames of a topic in a video file, each at the time at which it was taken."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

from genpy import Time

from nao_library_msgs.msg import RecordedVideo, VisionThread

from .vision_files import FileTrouble, VisionFiles
from .vision_pictures import picture_of, scaled, visible
from .vision_queue import Frame
from .vision_thread import FrameThread
from .vision_video import VideoFile


@dataclass(frozen=True)
class VideoWish:
    """What a recording is to be.

    Attributes:
        path: The file; None: named by the time of its start.
        file_type: mp4 or avi.
        codec: One that there is.
        width: Pixels, as `vision_pictures.wanted_size` takes it.
        height: Pixels, likewise.
        overwrite: Whether a file that is there may be replaced.
    """

    path: Path | None
    file_type: str
    codec: str
    width: int = 0
    height: int = 0
    overwrite: bool = False


class Recording(FrameThread):
    """Writes frames into a file; each start makes a new one."""

    kind = "recording"
    whole = True

    def __init__(
        self, ident: str, topic: str, rate: float, topics: Any, clock: Any, files: VisionFiles, wish: VideoWish
    ) -> None:
        """Make it ready.

        Args:
            ident: The user's name for it.
            topic: Where frames come from.
            rate: Frames a second at most; 0: all.
            topics: Gives subscriptions.
            clock: ROS time.
            files: Folder for the file.
            wish: What it is to be.
        """
        super().__init__(ident, topic, rate, topics, clock)
        self._files = files
        self._wish = wish
        self._path: Path | None = None
        self._file: BinaryIO | None = None
        self._video: VideoFile | None = None
        self._starts = 0

    @property
    def video(self) -> RecordedVideo:
        """What the file of the latest start holds."""
        report = self.report()
        video = self._video
        message = RecordedVideo(
            id=self.ident,
            path=report.path,
            file_type=self._wish.file_type,
            codec=self._wish.codec,
            topic=self.topic,
            dropped=report.dropped,
            error=report.error or ("" if video is not None else f"no frame came from {self.topic}: there is no file"),
        )
        if video is None:
            message.path = ""
        else:
            message.began = Time.from_sec(video.began)
            message.duration, message.frames = video.duration, video.frames
            message.width, message.height = video.width, video.height
            message.frame_rate = video.frames / video.duration if video.duration > 0.0 else 0.0
        return message

    def _begin(self) -> None:
        self._starts += 1
        self._video = None
        wish = self._wish
        path = wish.path or self._files.named_by_time(self.ident, wish.file_type)
        # Only the first start was asked about: what it wrote must not be replaced by the second.
        again = self._starts > 1
        self._file, self._path = self._files.create(
            path, wish.overwrite and not again, numbered=again or wish.path is None
        )

    def _handle(self, frame: Frame) -> tuple[int, int] | None:
        picture = visible(scaled(picture_of(frame.message), self._wish.width, self._wish.height))
        try:
            if self._video is None:
                height, width = picture.shape[:2]
                self._video = VideoFile(self._file, self._wish.file_type, self._wish.codec, width, height)
            written = self._video.write(picture, frame.stamp)
        except OSError as error:
            raise FileTrouble(self._path, error) from error
        return (self._video.width, self._video.height) if written else None

    def _end(self) -> None:
        file, self._file = self._file, None
        if file is None:
            return
        try:
            if self._video is not None:
                self._video.close()
            else:
                file.close()
                self._path.unlink()  # no frame came: an empty file is no video
        except OSError as error:
            raise FileTrouble(self._path, error) from error
        finally:
            if self._video is not None and not self._video.frames:
                self._video = None
                self._path.unlink(missing_ok=True)  # the disk was full before there was anything to be seen
            self._files.done(self._path)

    def _fill(self, report: VisionThread) -> None:
        report.path = str(self._path or self._wish.path or "")
