#!/usr/bin/env python3
"""Saves what the robot sees as a PNG, as a program for the robot maker's SDK does: no ROS, only ALProxy.

Needs a robot or a simulator at `--ip` and `--port`, for example `python3 -m nao_sim_bridge --world lab`.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from PIL import Image

import vision_definitions
from nao_library_modules.whole_file import WholeFile, require_new
from naoqi import ALProxy
from naoqi.errors import NaoError

CAMERAS = {"top": vision_definitions.kTopCamera, "bottom": vision_definitions.kBottomCamera}
SIZES = {
    "160x120": vision_definitions.kQQVGA,
    "320x240": vision_definitions.kQVGA,
    "640x480": vision_definitions.kVGA,
    "1280x960": vision_definitions.k4VGA,
}
FPS = 10


def picture(video: ALProxy, camera: int, size: int) -> Image.Image:
    """The next picture of a camera.

    Args:
        video: ALVideoDevice.
        camera: Its index.
        size: NAOqi's number of the resolution.
    """
    handle = video.subscribeCamera("naoqi_picture", camera, size, vision_definitions.kRGBColorSpace, FPS)
    try:
        width, height, _, _, seconds, microseconds, pixels = video.getImageRemote(handle)[:7]
    finally:
        video.unsubscribe(handle)
    print(f"{width}x{height} pixels, taken at {seconds + microseconds * 1e-6:.3f} s", flush=True)
    return Image.frombytes("RGB", (width, height), pixels)


def main() -> int:
    """Take one picture and save it; the exit status tells whether it worked."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--ip", default="127.0.0.1", help="address of the robot (127.0.0.1)")
    parser.add_argument("--port", type=int, default=9559, help="port of its NAOqi (9559)")
    parser.add_argument("--camera", choices=CAMERAS, default="top", help="which one (top)")
    parser.add_argument("--size", choices=SIZES, default="640x480", help="in pixels (640x480)")
    parser.add_argument("file", type=Path, nargs="?", default=Path("picture.png"), help="(picture.png)")
    parser.add_argument("--overwrite", action="store_true", help="replace a file of that name")
    options = parser.parse_args()
    try:
        path = require_new(options.file, options.overwrite)
        taken = picture(
            ALProxy("ALVideoDevice", options.ip, options.port), CAMERAS[options.camera], SIZES[options.size]
        )
        with WholeFile(path) as file:
            taken.save(file, "PNG")
    except (NaoError, OSError, ValueError) as error:
        print(error)
        return 1
    print(f"saved {path}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
