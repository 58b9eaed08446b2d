"""The robot's cameras: NAOqi's numbers, the names that go with them, and the sizes of their pictures. No ROS."""

from __future__ import annotations

from typing import Any

TOP, BOTTOM = 0, 1
CAMERAS = {TOP: "top", BOTTOM: "bottom"}
"""NAOqi's number of a camera -> its name in topics, parameters and goals."""
CAMERA_NAMES = {TOP: "CameraTop", BOTTOM: "CameraBottom"}
"""NAOqi's number of a camera -> its name in NAOqi and, with an ending, in /tf."""

RESOLUTIONS = {
    "QQQQVGA": (8, 40, 30),
    "QQQVGA": (7, 80, 60),
    "QQVGA": (0, 160, 120),
    "QVGA": (1, 320, 240),
    "VGA": (2, 640, 480),
    "4VGA": (3, 1280, 960),
    "16VGA": (4, 2560, 1920),
}
"""Name of a resolution -> NAOqi's number, width and height in pixels."""
SIZES = {number: (width, height) for number, width, height in RESOLUTIONS.values()}
"""NAOqi's number of a resolution -> width and height in pixels."""


def camera_number(value: Any) -> int | None:
    """NAOqi's number of a camera that an event tells by number or by name; None if there is no such camera."""
    if isinstance(value, str):
        return next((number for number, name in CAMERA_NAMES.items() if name == value), None)
    return int(value) if value in CAMERA_NAMES else None
