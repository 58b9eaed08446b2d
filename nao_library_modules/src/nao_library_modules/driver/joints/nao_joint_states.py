"""The node nao_joint_states: joints, inertial unit and odometry of the robot, read in one go."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from geometry_msgs.msg import Quaternion, TransformStamped, Twist, Vector3
from nav_msgs.msg import Odometry
from rospy import Time
from sensor_msgs.msg import Imu, JointState
from std_msgs.msg import Header
from std_srvs.srv import Empty
from tf2_msgs.msg import TFMessage

from nao_library_msgs.srv import SetTransform

from ...core.geometry import BASE_LINK, FOOTPRINT, ODOM, from_roll_pitch_yaw, inverse, rotate
from ...core.health import Report
from ...core.nao_facts import JointNames
from ...core.waiting import OncePerConnection
from ...ros.node_interface import NodeInterface
from ...ros.time_and_frames import RosClock, pose_of
from ..base.driver_node import LazyTopic, frame_parameter, number, publish
from ..base.polling import Polling
from .joint_sensors import LEG_JOINTS, JointSensors, OdometryOffset, Reading, SlopeEstimator, footprint
from .planar_frames import read_transform

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


DEFAULT_RATE = 50.0


class NaoJointStates:
    """Publishes the state of one robot, at an even rate, while one of its topics or /tf has subscribers.

    One thread reads and publishes; `close` and the diagnostics come from others and touch only what is set once.

    ROS API (relative names):
        Publishes `joint_states` (sensor_msgs/JointState; efforts are torques in N m from the motor currents),
        `imu` (sensor_msgs/Imu, in the frame of the torso), `odom` (nav_msgs/Odometry), and on /tf the frames odom ->
        base_link and base_link -> base_footprint (REP 105, REP 120). `~joint_stiffness` (sensor_msgs/JointState:
        efforts are stiffnesses, 0 to 1), while it has subscribers: under the name of the node, for what is published on
        `joint_stiffness` is what nao_controller sets.
        Services, with `~use_odometry`: `pause_odometry` (std_srvs/Empty: place and heading stand still, whatever the
        robot does), `resume_odometry` (std_srvs/Empty: they continue from there), `set_odometry_pose`
        (nao_library_msgs/SetTransform: pose of the torso in odometry), `odometry_offset`
        (nao_library_msgs/SetTransform: moves it, in its own frame). Of transforms x, y and yaw count.
        Parameters `~sensor_rate` (50 Hz; `~torso_odom_rate` is its older name), `~base_frame_id` (base_link),
        `~footprint_frame_id` (base_footprint), `~odom_frame_id` (odom), `~use_joint_sensors` (true; false publishes
        commanded angles), `~use_odometry` (true; false leaves `odom` and its frame to others), `~frame_publisher`
        (robot_state_publisher; the node that only makes frames of joint states: it alone wants none), `tf_prefix`
        (searched upwards; put before all frames).
    """

    def __init__(self, robot: Any, node: NodeInterface) -> None:
        rate = number(node, "~sensor_rate", node.param("~torso_odom_rate", DEFAULT_RATE), "reading rate")
        self._base = frame_parameter(node, "~base_frame_id", BASE_LINK)
        self._footprint = frame_parameter(node, "~footprint_frame_id", FOOTPRINT)
        self._odom = frame_parameter(node, "~odom_frame_id", ODOM)
        use_sensors = bool(node.param("~use_joint_sensors", True))
        use_odometry = bool(node.param("~use_odometry", True))
        names = JointNames(robot)
        self._sensors = OncePerConnection(robot, lambda: JointSensors(robot, names.body, use_sensors, use_odometry))
        self._joint_states = node.publisher("joint_states", JointState, queue_size=10)
        self._imu = node.publisher("imu", Imu, queue_size=10)
        self._stiffness = node.publisher("~joint_stiffness", JointState, queue_size=10)
        self._odometry = node.publisher("odom", Odometry, queue_size=10) if use_odometry else None
        self._frames = node.publisher("/tf", TFMessage, queue_size=100)
        self._offset = OdometryOffset()
        if use_odometry:
            place_in = lambda request: read_transform(request.offset)  # noqa: E731
            node.offer("pause_odometry", Empty, lambda _: self._odometry_now().pause())
            node.offer("resume_odometry", Empty, lambda _: self._odometry_now().resume())
            node.offer("odometry_offset", SetTransform, lambda request: self._odometry_now().move_by(place_in(request)))
            node.offer("set_odometry_pose", SetTransform, lambda request: self._odometry_now().set(place_in(request)))
        self._clock = RosClock()
        self._velocities, self._speeds, self._jumps = SlopeEstimator(), SlopeEstimator(), 0
        self._polling = Polling(robot, "joints", rate, self._clock, self._read)
        node.if_it_fails(self._polling.close)
        topics = (self._joint_states, self._imu, self._stiffness, self._odometry, self._frames)
        # It runs at all times, and only turns joint states into frames on /tf.
        frames_only = node.resolve(node.param("~frame_publisher", "robot_state_publisher"))
        self._lazy = LazyTopic(self._polling.want, *filter(None, topics), but=(frames_only,))

    def reports(self) -> dict[str, Callable[[], Report]]:
        return {"readings": self._polling.report}

    def close(self) -> None:
        self._polling.close()

    def _odometry_now(self) -> OdometryOffset:
        """The offset, corrected by where the robot is now: the last reading may be old."""
        self._offset.correct(self._sensors().read_torso())
        return self._offset

    # --- the thread of the readings -------------------------------------------------------------------------------

    def _read(self) -> None:
        sensors, before = self._sensors(), self._clock.now()
        reading = sensors.read()
        if reading.torso is not None:
            torso, jumps = self._offset.correct(reading.torso)
            reading = replace(reading, torso=torso)
            if self._jumps != jumps:
                self._jumps, self._speeds = jumps, SlopeEstimator()
        # The robot answered somewhere between question and answer.
        now = (before + self._clock.now()) / 2
        stamp = Time.from_sec(now)
        changes = self._velocities.add(now, reading.positions)
        publish(self._joint_states, joint_state(stamp, sensors.joints, reading, changes))
        if self._imu.get_num_connections() > 0:
            publish(self._imu, imu(stamp, self._base, reading))
        if self._stiffness.get_num_connections() > 0:
            publish(self._stiffness, joint_stiffness(stamp, sensors.joints, sensors.read_stiffnesses()))
        transforms = self._foot_transforms(stamp, sensors, reading)
        if self._odometry is not None and reading.torso is not None:
            speed = self._speeds.add(now, reading.torso[:3])
            if self._odometry.get_num_connections() > 0:
                publish(self._odometry, odometry(stamp, self._odom, self._base, reading, speed))
            transforms.insert(0, odometry_transform(stamp, self._odom, self._base, reading))
        if transforms:
            publish(self._frames, TFMessage(transforms))

    def _foot_transforms(self, stamp: Time, sensors: JointSensors, reading: Reading) -> list[Any]:
        angles = dict(zip(sensors.joints, reading.positions))
        if not all(joint in angles for joints in LEG_JOINTS.values() for joint in joints):
            return []  # a robot without legs
        # Level as far as the frame above knows: there, the two lines of the feet are level exactly.
        roll, pitch = (reading.roll, reading.pitch) if reading.torso is None else reading.torso[3:5]
        return [transform(stamp, self._base, self._footprint, *footprint(angles, roll, pitch))]
