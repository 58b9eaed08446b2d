"""A stream: frames of one topic on another, in another size or rate."""

from __future__ import annotations

import posixpath
from typing import Any

from sensor_msgs.msg import CameraInfo, CompressedImage, Image, RegionOfInterest

from nao_library_msgs.msg import VisionThread

from .job import CaptureJob
from .pictures import COMPRESSED, encoded, encoding_of, is_compressed, picture_of, scaled, wanted_size
from .queue import Frame


class Stream(CaptureJob):
    """Passes frames on to a topic.

    Frames whose form does not change are published as they came; others are converted only while the topic has
    subscribers. The camera_info of the camera, if there is one, is published beside them in the size of the stream.
    """

    kind = "stream"

    def __init__(
        self, ident: str, topic: str, rate: float, topics: Any, clock: Any, topic_out: str, width: int, height: int
    ) -> None:
        """Take what CaptureJob takes, the topic to publish (as JPEG if it ends in /compressed), and `wanted_size`."""
        super().__init__(ident, topic, rate, topics, clock)
        self.topic_out = topic_out
        self._wanted = (width, height)
        self._compress = topic_out.endswith(COMPRESSED)
        self._publisher: Any = None
        self._infos: Any = None
        self._info_subscription: Any = None
        self._info: Any = None  # the latest one; set by the thread that receives it

    @property
    def settings(self) -> dict[str, Any]:
        width, height = self._wanted
        return {**super().settings, "topic_out": self.topic_out, "width": width, "height": height}

    def _begin(self) -> None:
        self._publisher = self._topics.publisher(self.topic_out, CompressedImage if self._compress else Image)
        theirs, ours = info_topic(self.topic), info_topic(self.topic_out)
        if theirs and ours and theirs != ours:
            self._info = None
            self._infos = self._topics.publisher(ours, CameraInfo)
            self._info_subscription = self._topics.subscribe_info(theirs, self._take_info)

    def _take_info(self, info: Any) -> None:
        self._info = info

    def _handle(self, frame: Frame) -> tuple[int, int] | None:
        size = self._publish(frame.message)
        info = self._info
        if info is not None and self._infos.is_heard():
            width, height = size if all(size) else (info.width, info.height)
            self._infos.publish(scaled_info(info, frame.message.header, width, height))
        return size

    def _publish(self, message: Any) -> tuple[int, int]:
        if self._as_it_came(message):
            self._publisher.publish(message)
            return (0, 0) if is_compressed(message) else (message.width, message.height)
        if not self._publisher.is_heard():
            return self._size if is_compressed(message) else wanted_size((message.width, message.height), *self._wanted)
        picture = scaled(picture_of(message), *self._wanted)
        self._publisher.publish(self._message(message, picture))
        return picture.shape[1], picture.shape[0]

    def _as_it_came(self, message: Any) -> bool:
        if is_compressed(message) != self._compress:
            return False
        if self._compress:
            return self._wanted == (0, 0)
        size = (message.width, message.height)
        return 0 in size or wanted_size(size, *self._wanted) == size

    def _message(self, message: Any, picture: Any) -> Any:
        if self._compress:
            original = "bgr8" if is_compressed(message) else message.encoding
            return CompressedImage(
                header=message.header, format=f"{original}; jpeg compressed bgr8", data=encoded(picture, "jpg")
            )
        if picture.ndim == 2:  # grey of 16 bits
            encoding = "mono16"
        elif encoding_of(message) == "mono8":
            encoding, picture = "mono8", picture[:, :, 0].copy()
        else:
            encoding = "bgr8"
        height, width = picture.shape[:2]
        return Image(
            header=message.header,
            height=height,
            width=width,
            encoding=encoding,
            is_bigendian=0,
            step=picture.nbytes // height,
            data=picture.tobytes(),
        )

    def _end(self) -> None:
        for end in (self._info_subscription, self._infos, self._publisher):
            if end is not None:
                end.close()
        self._info_subscription = self._infos = self._publisher = None

    def _fill(self, report: VisionThread) -> None:
        report.topic_out = self.topic_out


def info_topic(topic: str) -> str:
    """Topic of the camera_info beside a topic of pictures (full name), where ROS's tools look for it.

    Empty for a topic whose last part does not begin with "image": no camera publishes it.
    """
    base = topic[: -len(COMPRESSED)] if topic.endswith(COMPRESSED) else topic
    folder, name = posixpath.split(base)
    return posixpath.join(folder, "camera_info") if name.startswith("image") else ""


def scaled_info(info: Any, header: Any, width: int, height: int) -> CameraInfo:
    """The sensor_msgs/CameraInfo of a camera for pictures of another size (pixels), with the header of the picture."""
    across, down = width / info.width if info.width else 1.0, height / info.height if info.height else 1.0
    k, p, region = list(info.K), list(info.P), info.roi
    # Of both matrices the first row counts columns of the picture, the second one rows.
    k = [value * (across, down, 1.0)[index // 3] for index, value in enumerate(k)]
    p = [value * (across, down, 1.0)[index // 4] for index, value in enumerate(p)]
    return CameraInfo(
        header=header,
        width=width,
        height=height,
        distortion_model=info.distortion_model,
        D=list(info.D),
        K=k,
        R=list(info.R),
        P=p,
        binning_x=info.binning_x,
        binning_y=info.binning_y,
        roi=RegionOfInterest(
            x_offset=round(region.x_offset * across),
            y_offset=round(region.y_offset * down),
            width=round(region.width * across),
            height=round(region.height * down),
            do_rectify=region.do_rectify,
        ),
    )
