"""The camera_info that belongs to a stream: that of its camera, in the stream's size. Pure."""

from __future__ import annotations

import posixpath
from typing import Any

from sensor_msgs.msg import CameraInfo, RegionOfInterest

COMPRESSED = "/compressed"
"""Topics whose name ends so have pictures as JPEG, as image_transport's do."""
IMAGE = "image"


def info_topic(topic: str) -> str:
    """Topic of the camera_info beside a topic of pictures, where ROS's tools look for it; empty if there is none.

    Args:
        topic: Full name; one whose last part does not begin with "image" is no camera's.
    """
    base = topic[: -len(COMPRESSED)] if topic.endswith(COMPRESSED) else topic
    folder, name = posixpath.split(base)
    return posixpath.join(folder, "camera_info") if name.startswith(IMAGE) else ""


def scaled_info(info: Any, header: Any, width: int, height: int) -> CameraInfo:
    """A camera_info for pictures of another size.

    Args:
        info: sensor_msgs/CameraInfo of the camera.
        header: That of the picture: the two belong together by their stamps.
        width: Pixels of the picture.
        height: Pixels likewise.
    """
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
