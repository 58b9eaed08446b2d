"""Pictures and calibrations as messages, and back."""

from __future__ import annotations

import rospy
from sensor_msgs.msg import CameraInfo, CompressedImage, Image
from std_msgs.msg import Header

from .camera_calibration import NO_ROTATION, PLUMB_BOB, Calibration
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
    return CompressedImage(header=header, format=kind, data=file)


def to_info(calibration: Calibration | None, width: int, height: int, header: Header) -> CameraInfo:
    """The calibration of pictures of a size; without one, all numbers are zero, as CameraInfo defines it."""
    info = CameraInfo(header=header, width=width, height=height)
    if calibration is not None:
        info.distortion_model = calibration.model
        info.D, info.K = list(calibration.d), list(calibration.k)
        info.R, info.P = list(calibration.r), list(calibration.p)
    return info


def from_info(info: CameraInfo) -> Calibration:
    """The calibration in a message; raises NaoError if it holds none."""
    projection = tuple(info.P) if any(info.P) else ()
    rotation = tuple(info.R) if any(info.R) else NO_ROTATION
    model = info.distortion_model or PLUMB_BOB
    return Calibration(info.width, info.height, tuple(info.K), tuple(info.D), rotation, projection, model)


def header_of(time: float, frame: str) -> Header:
    """A header of ROS time `time`, s; rounded to microseconds, the robot's resolution."""
    seconds, microseconds = divmod(round(time * 1e6), 1000000)
    return Header(stamp=rospy.Time(seconds, 1000 * microseconds), frame_id=frame)
