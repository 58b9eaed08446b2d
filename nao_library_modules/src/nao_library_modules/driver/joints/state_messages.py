"""A reading of the robot as ROS messages."""

from __future__ import annotations

from collections.abc import Sequence

from geometry_msgs.msg import Quaternion, TransformStamped, Twist, Vector3
from nav_msgs.msg import Odometry
from rospy import Time
from sensor_msgs.msg import Imu, JointState
from std_msgs.msg import Header

from ...base.rotations import from_roll_pitch_yaw, inverse, rotate
from ...ros.robot_frames import pose_of
from .joint_sensors import Reading

# Rough figures for filters that fuse sensors, on the diagonal: the robot publishes none.
TILT_VARIANCE, YAW_VARIANCE, UNKNOWN = 1e-4, 1e-2, 1e6
TURN_VARIANCE, ACCELERATION_VARIANCE = 1e-4, 1e-2
PLACE_VARIANCE, HEIGHT_VARIANCE, VELOCITY_VARIANCE = 1e-2, 1e-3, 1e-3


def joint_state(stamp: Time, joints: Sequence[str], reading: Reading, velocities: Sequence[float]) -> JointState:
    """Positions (rad), velocities (rad/s) and efforts (N m) of the joints."""
    positions, efforts = reading.positions, reading.efforts
    return JointState(Header(stamp=stamp), list(joints), positions, velocities, efforts)


def joint_stiffness(stamp: Time, joints: Sequence[str], stiffnesses: Sequence[float]) -> JointState:
    """Stiffnesses of the joints, 0 to 1, as efforts."""
    return JointState(header=Header(stamp=stamp), name=list(joints), effort=stiffnesses)


def imu(stamp: Time, frame: str, reading: Reading) -> Imu:
    """The inertial unit, in the frame of the torso. The heading is that of odometry, and unknown without it."""
    yaw = 0.0 if reading.torso is None else reading.torso[5]
    message = Imu()
    message.header.stamp, message.header.frame_id = stamp, frame
    message.orientation = Quaternion(*from_roll_pitch_yaw(reading.roll, reading.pitch, yaw))
    message.orientation_covariance = diagonal(
        TILT_VARIANCE, TILT_VARIANCE, UNKNOWN if reading.torso is None else YAW_VARIANCE
    )
    message.angular_velocity = Vector3(*reading.angular_velocity)
    message.angular_velocity_covariance = diagonal(*[TURN_VARIANCE] * 3)
    message.linear_acceleration = Vector3(*reading.acceleration)
    message.linear_acceleration_covariance = diagonal(*[ACCELERATION_VARIANCE] * 3)
    return message


def odometry(stamp: Time, frame: str, base: str, reading: Reading, velocity: Sequence[float]) -> Odometry:
    """The torso in the robot's own odometry.

    `velocity` is that of the torso in `frame`, (3,) m/s; the message has it in `base`, as REP 105 asks.
    """
    turn = from_roll_pitch_yaw(*reading.torso[3:])
    message = Odometry()
    message.header.stamp, message.header.frame_id, message.child_frame_id = stamp, frame, base
    message.pose.pose = pose_of(reading.torso)
    message.pose.covariance = diagonal(
        PLACE_VARIANCE, PLACE_VARIANCE, HEIGHT_VARIANCE, TILT_VARIANCE, TILT_VARIANCE, YAW_VARIANCE
    )
    ahead = rotate(inverse(turn), (velocity[0], velocity[1], velocity[2]))
    message.twist.twist = Twist(Vector3(*ahead), Vector3(*reading.angular_velocity))
    message.twist.covariance = diagonal(*[VELOCITY_VARIANCE] * 3, *[TURN_VARIANCE] * 3)
    return message


def transform(stamp: Time, parent: str, child: str, place: Sequence[float], turn: Sequence[float]) -> TransformStamped:
    """Pose of `child` in `parent`: place in m, turn as a quaternion (x, y, z, w)."""
    message = TransformStamped(child_frame_id=child)
    message.header.stamp, message.header.frame_id = stamp, parent
    message.transform.translation = Vector3(*place)
    message.transform.rotation = Quaternion(*turn)
    return message


def odometry_transform(stamp: Time, frame: str, base: str, reading: Reading) -> TransformStamped:
    place = reading.torso
    return transform(stamp, frame, base, place[:3], from_roll_pitch_yaw(*place[3:]))


def diagonal(*variances: float) -> list[float]:
    """A covariance matrix, row by row, of independent values."""
    count = len(variances)
    return [variances[i // count] if i % (count + 1) == 0 else 0.0 for i in range(count * count)]
