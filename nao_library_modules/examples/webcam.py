#!/usr/bin/env python3
"""Records any camera and passes it on smaller, without a robot: `webcam.py usb_cam/image_raw film.mp4 --seconds 10`.

Needs a camera's node, for example `rosrun usb_cam usb_cam_node`. The file is in ~/.ros/nao_recordings, or where
--folder says; the small pictures are on TOPIC with _small behind its last name but one: usb_cam_small/image_raw.
"""

import argparse
import sys

import rospy

from nao_library_modules.vision.threads import ImageThreads
from naoqi.errors import NaoError


def main():
    """Record for a while."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("topic", help="of sensor_msgs/Image or CompressedImage")
    parser.add_argument("file", help="name of the video, .mp4 or .avi")
    parser.add_argument("--seconds", type=float, default=10.0, help="how long (default: 10)")
    parser.add_argument("--folder", default="~/.ros/nao_recordings", help="where the file goes")
    parser.add_argument("--width", type=int, default=160, help="of the small pictures (default: 160)")
    parser.add_argument("--overwrite", action="store_true", help="replace a file of that name")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("webcam", anonymous=True)
    space, _, last = rospy.resolve_name(options.topic).rpartition("/")
    try:
        with ImageThreads(options.folder) as threads:
            small = threads.stream("small", options.topic, f"{space}_small/{last}", width=options.width)
            film = threads.record("film", options.topic, options.file, overwrite=options.overwrite)
            rospy.sleep(options.seconds)
            passed, video = small.stop(), film.stop()
    except NaoError as error:
        print(error)
        return 1
    print(f"{passed.frames} small pictures on {passed.topic_out}")
    print(video.error or f"{video.path}: {video.frames} frames, {video.duration:.1f} s, {video.width} x {video.height}")
    return 1 if video.error else 0


if __name__ == "__main__":
    sys.exit(main())
