"""What suites of cameras share: pictures with their calibrations, things of a colour, and where they should be seen."""

import threading

import numpy as np
import rospy
import tf2_ros
from sensor_msgs.msg import CameraInfo, Image

LIMIT = 60.0
CHANNELS = {"bgr8": 3, "rgb8": 3, "mono8": 1, "yuv422": 2}
MAGENTA = [0.9, 0.0, 0.9]


def pixels_of(message):
    """(h, w) or (h, w, channels) array of a picture; three channels are red, green and blue."""
    channels = CHANNELS[message.encoding]
    pixels = np.frombuffer(message.data, np.uint8).reshape(message.height, message.width, channels)
    if message.encoding == "bgr8":
        return pixels[..., ::-1]
    return pixels[..., 0] if channels == 1 else pixels


class Look:
    """Looks through a camera while it is open: pictures with their calibrations, in the order of their coming."""

    def __init__(self, folder):
        self.folder = folder
        self.pairs = []
        self._news = threading.Condition()
        self._halves = {}
        self._subscribers = [
            rospy.Subscriber(f"{folder}image_raw", Image, lambda message: self._note(0, message), queue_size=100),
            rospy.Subscriber(
                f"{folder}camera_info", CameraInfo, lambda message: self._note(1, message), queue_size=100
            ),
        ]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for subscriber in self._subscribers:
            subscriber.unregister()

    def _note(self, place, message):
        with self._news:
            halves = self._halves.setdefault(message.header.stamp, [None, None])
            halves[place] = message
            if None not in halves:
                self.pairs.append(tuple(self._halves.pop(message.header.stamp)))
                self._news.notify_all()

    def after(self, time, fits=lambda image: True):
        """The first picture taken after a ROS time, in s, that fits, and its calibration."""

        def found():
            return next((p for p in self.pairs if p[0].header.stamp.to_sec() > time and fits(p[0])), None)

        with self._news:
            if not self._news.wait_for(lambda: found() is not None, LIMIT):
                raise AssertionError(f"no picture of {self.folder} after {time:.2f} s that fits, of {len(self.pairs)}")
            return found()

    def now(self, fits=lambda image: True):
        """A picture that is taken from now on."""
        return self.after(rospy.get_time(), fits)


class Geometry:
    """Where points in world are seen: the true torso in world, and /tf from there on."""

    def __init__(self, robot):
        self._robot = robot
        self._buffer = tf2_ros.Buffer(rospy.Duration(600))  # a busy computer looks back
        self._listener = tf2_ros.TransformListener(self._buffer)

    def optical_in_world(self, frame, stamp):
        """(4, 4) pose of a camera's optical frame in world, when a picture was taken."""
        pose = self._robot.true_pose()
        torso = matrix(pose.position, pose.orientation)
        found = self._buffer.lookup_transform("torso", frame, stamp, rospy.Duration(120.0)).transform
        return torso @ matrix(found.translation, found.rotation)


def matrix(position, orientation):
    """(4, 4) matrix of a pose."""
    x, y, z, w = orientation.x, orientation.y, orientation.z, orientation.w
    turned = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    found = np.eye(4)
    found[:3, :3] = turned
    found[:3, 3] = (position.x, position.y, position.z)
    return found


def project(info, point):
    """Pixels (x, y) of a point in the optical frame, m; the middle of the first pixel is at 0.5."""
    projection = np.array(info.P).reshape(3, 4)
    x, y, z = projection @ np.append(point, 1.0)
    return np.array((x / z, y / z))


def magenta_spot(message):
    """Pixels (x, y) of the middle of what is magenta in a picture, and how many pixels that are."""
    red, green, blue = (pixels_of(message)[..., channel].astype(int) for channel in range(3))
    rows, columns = np.nonzero((red - green > 50) & (blue - green > 50))
    if not len(rows):
        return None, 0
    return np.array((columns.mean() + 0.5, rows.mean() + 0.5)), len(rows)
