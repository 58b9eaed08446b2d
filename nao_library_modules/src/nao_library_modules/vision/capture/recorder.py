"""A recording: frames of a topic in a video file, each at the time at which it was taken."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from genpy import Time

from nao_library_msgs.msg import RecordedVideo, VisionThread

from ...base.whole_file import WholeFile
from .files import VisionFiles
from .job import CaptureJob
from .pictures import picture_of, scaled, visible
from .queue import Frame
from .video import VideoFile


@dataclass(frozen=True)
class VideoSpec:
    path: Path | None  # None: named by the time of the start
    file_type: str  # mp4 or avi
    codec: str  # one of `known_codecs`
    width: int = 0  # pixels, as `wanted_size` takes them
    height: int = 0
    overwrite: bool = False


class VideoRecording(CaptureJob):
    """Writes frames into a file; each start makes a new one."""

    kind = "recording"
    whole = True

    def __init__(
        self,
        ident: str,
        topic: str,
        rate: float,
        topics: Any,
        clock: Any,
        files: VisionFiles,
        spec: VideoSpec,
        again: bool = False,
    ) -> None:
        """Take what CaptureJob takes; again: a node that has died started it before, and its file stays."""
        super().__init__(ident, topic, rate, topics, clock)
        self._files = files
        self._spec = spec
        self._file: WholeFile | None = None
        self._video: VideoFile | None = None
        self._again = again

    @property
    def settings(self) -> dict[str, Any]:
        return {**super().settings, "spec": {**asdict(self._spec), "path": self._spec.path and str(self._spec.path)}}

    @property
    def video(self) -> RecordedVideo:
        """The file of the latest start."""
        report = self.report()
        video = self._video
        message = RecordedVideo(
            id=self.ident,
            path=report.path,
            file_type=self._spec.file_type,
            codec=self._spec.codec,
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
        again, self._again = self._again, True
        self._video = None
        spec = self._spec
        path = spec.path or self._files.named_by_time(self.ident, spec.file_type)
        # Only the first start was checked before the chain: a second one must not replace its file.
        self._file = self._files.create(path, spec.overwrite and not again, numbered=again or spec.path is None)
        self._wanted = self._file.path

    def _handle(self, frame: Frame) -> tuple[int, int] | None:
        picture = visible(scaled(picture_of(frame.message), self._spec.width, self._spec.height))
        if self._video is None:
            height, width = picture.shape[:2]
            self._video = VideoFile(self._file, self._spec.file_type, self._spec.codec, width, height)
        written = self._video.write(picture, frame.stamp)
        return (self._video.width, self._video.height) if written else None

    def _end(self) -> None:
        file = self._file
        if file is None or file.closed:
            return
        try:
            if self._video is not None:
                self._video.close()
            else:
                file.discard()  # no frame came: an empty file is no video
        finally:
            if self._video is not None and not self._video.frames:
                self._video = None  # the disk was full before there was anything to be seen
            self._files.done(self._wanted)

    def _fill(self, report: VisionThread) -> None:
        report.path = str(self._file.path if self._file is not None else self._spec.path or "")
