"""A calibration for a camera node: from a file or a field of view, by its service set_camera_info."""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Sequence
from pathlib import Path

import rospy
from sensor_msgs.srv import SetCameraInfo
from std_msgs.msg import Header

from naoqi.errors import NaoError

from ...core.nao_facts import CAMERAS
from .camera_calibration import Calibration, ideal, read, scaled
from .camera_images import to_info

WAIT = 10.0
DEGREES = "degrees, the whole picture"


def parse_size(text: str) -> tuple[int, int]:
    """Width and height from a text such as 320x240; raises ValueError for anything else."""
    width, height = (int(each) for each in text.lower().split("x"))
    if width <= 0 or height <= 0:
        raise ValueError(text)
    return width, height


def parser() -> argparse.ArgumentParser:
    options = argparse.ArgumentParser(
        description="Gives a camera of the robot its calibration, which nao_camera keeps for later runs.",
        epilog="With ROS remappings, such as __ns:=robot1, for a robot in a namespace.",
    )
    options.add_argument("camera", choices=list(CAMERAS.values()), help="camera of the robot")
    options.add_argument("file", nargs="?", help="calibration in YAML, as camera_calibration writes it")
    options.add_argument("--fov", type=float, nargs=2, metavar=("WIDE", "HIGH"), help=f"field of view, {DEGREES}")
    options.add_argument("--size", type=parse_size, metavar="WxH", help="size of the pictures (640x480, or the file's)")
    options.add_argument("--service", help="name of the service (nao_robot/camera/CAMERA/set_camera_info)")
    return options


def read_calibration(options: argparse.Namespace) -> Calibration:
    """The calibration that the options describe; raises NaoError if they describe none."""
    if (options.file is None) == (options.fov is None):
        raise NaoError("either a file or --fov is needed")
    if options.fov is not None:
        wide, high = options.fov
        if not (0.0 < wide < 180.0 and 0.0 < high < 180.0):
            raise NaoError(f"--fov is {wide:g} {high:g}: above 0 and below 180 degrees")
        return ideal(*(options.size or (640, 480)), math.radians(wide), math.radians(high))
    found = read(Path(options.file))
    return scaled(found, *options.size) if options.size else found


def send(service: str, calibration: Calibration) -> str:
    """Set the calibration by the service of a camera node, and return its answer.

    Raises NaoError if it is not there, or refuses.
    """
    try:
        rospy.wait_for_service(service, WAIT)
        info = to_info(calibration, calibration.width, calibration.height, Header())
        answer = rospy.ServiceProxy(service, SetCameraInfo)(info)
    except (rospy.ROSException, rospy.ServiceException) as error:
        raise NaoError(f"{rospy.resolve_name(service)}: {error}") from error
    if not answer.success:
        raise NaoError(f"the camera refuses it: {answer.status_message}")
    return answer.status_message


def main(argv: Sequence[str] | None = None) -> int:
    """Run the program and return its exit status; `argv` begins with the name of the program."""
    options = parser().parse_args(rospy.myargv(argv if argv is not None else sys.argv)[1:])
    try:
        calibration = read_calibration(options)
        rospy.init_node("send_camera_info", anonymous=True, disable_signals=True)
        service = options.service or f"nao_robot/camera/{options.camera}/set_camera_info"
        print(send(service, calibration))
    except NaoError as error:
        print(error, file=sys.stderr)
        return 1
    return 0
