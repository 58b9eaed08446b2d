"""What a goal has taken so far: pictures, videos, and what is known of streams and recordings."""

from __future__ import annotations

from typing import Any

from nao_library_msgs.msg import PictureFile, RecordedVideo, VisionThread


class Taken:
    """What the functions of one chain left behind, for its result.

    Attributes:
        pictures: Files, in the order in which they were taken.
        recordings: Videos that are complete, in the order in which they ended.
        threads: Streams and recordings as they were found.
    """

    def __init__(self) -> None:
        """Nothing yet."""
        self.pictures: list[PictureFile] = []
        self.recordings: list[RecordedVideo] = []
        self.threads: list[VisionThread] = []

    def fill(self, result: Any) -> None:
        """Put everything into a result message."""
        result.pictures, result.recordings, result.threads = self.pictures, self.recordings, self.threads
