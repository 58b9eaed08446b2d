"""Pictures and calibrations as messages, and back."""

from __future__ import annotations

import rospy
from sensor_msgs.msg import CameraInfo, CompressedImage, Image
from std_msgs.msg import Header

from .camera_calibration import PLUMB_BOB, Calibration
from .camera_formats import Picture


def to_image(picture: Picture, header: Header) -> Image:
    """A picture; its pixels are not copied."""
    return Image(
        header=header,
        height=picture.height,
        width=picture.width,
        encoding=picture.encoding,
        is_bigendian=0,
        step=picture.step,
        data=picture.pixels,
    )


def to_compressed(kind: str, file: bytes, header: Header) -> CompressedImage:
    """A picture as a file."""
    return CompressedImage(header=header, format=kind, data=file)


def to_info(calibration: Calibration | None, picture: Picture, header: Header) -> CameraInfo:
    """The calibration of a picture; without one, all numbers are zero, which says just that."""
    return fill_info(calibration, picture.width, picture.height, header)


def fill_info(calibration: Calibration | None, width: int, height: int, header: Header) -> CameraInfo:
    """A calibration, or none, for pictures of a size."""
    info = CameraInfo(header=header, width=width, height=height)
    if calibration is not None:
        info.distortion_model = calibration.model
        info.D, info.K = list(calibration.d), list(calibration.k)
        info.R, info.P = list(calibration.r), list(calibration.p)
    return info


def from_info(info: CameraInfo) -> Calibration:
    """The calibration in a message.

    Raises:
        NaoError: If it holds none.
    """
    projection = tuple(info.P) if any(info.P) else ()
    rotation = tuple(info.R) if any(info.R) else (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
    model = info.distortion_model or PLUMB_BOB
    return Calibration(info.width, info.height, tuple(info.K), tuple(info.D), rotation, projection, model)


def header_of(time: float, frame: str) -> Header:
    """A header; times are told to the microsecond, as the robot tells them.

    Args:
        time: ROS time, s.
        frame: Name of the frame.
    """
    seconds, microseconds = divmod(round(time * 1e6), 1000000)
    return Header(stamp=rospy.Time(seconds, 1000 * microseconds), frame_id=frame)
