#!/usr/bin/env python3
"""Makes an mp4 of the pictures in a bag, each at its time: `bag_film.py walk.bag walk.mp4`."""

import argparse
import sys
from pathlib import Path

from sensor_msgs.msg import Image

from nao_library_modules.core.files import WholeFile, require_new
from nao_library_modules.ros.bag_types import read_bag
from nao_library_modules.vision.pictures import picture_of, visible
from nao_library_modules.vision.video import VideoFile, codec_name
from naoqi.errors import NaoError


def make_film(bag: str, path: Path, topic: str) -> VideoFile:
    """Write the film. `topic`: of sensor_msgs/Image. Raises NaoError if it cannot be made."""
    film = None
    for _, message in read_bag(Path(bag), topic, Image):
        if film is None:
            film = VideoFile(WholeFile(path), "mp4", codec_name("", "mp4"), message.width, message.height)
        film.write(visible(picture_of(message)), message.header.stamp.to_sec())
    if film is None:
        raise NaoError(f"{bag} has no pictures of the topic {topic}: `rosbag info {bag}` lists its topics")
    film.close()
    return film


def main() -> int:
    """Make a film; the exit status tells whether there is one."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("bag")
    parser.add_argument("film", help="the mp4 file")
    parser.add_argument("--topic", default="/nao_robot/camera/top/image_raw", help="default: %(default)s")
    parser.add_argument("--overwrite", action="store_true", help="replace a file that is there")
    options = parser.parse_args()
    try:
        path = require_new(options.film, options.overwrite)
        film = make_film(options.bag, path, options.topic)
    except NaoError as error:
        print(error)
        return 1
    print(f"written: {path}, {film.frames} pictures in {film.duration:.1f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
