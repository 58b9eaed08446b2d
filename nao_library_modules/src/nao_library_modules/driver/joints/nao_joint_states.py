"""The node nao_joint_states: joints, inertial unit and odometry of the robot, read in one go."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import rospy
from nav_msgs.msg import Odometry
from rospy import Time
from sensor_msgs.msg import Imu, JointState
from std_srvs.srv import Empty
from tf2_ros import TransformBroadcaster

from nao_library_msgs.srv import SetTransform
from naoqi.errors import NaoError, RobotUnreachable

from ...base.cancellation import CancellationToken
from ...base.clock import WallClock
from ...base.field_checks import number_parameter
from ...base.limits import limit
from ...nao.joint_names import JointNames
from ...ros.health import Level, Report
from ...ros.node_interface import NodeInterface
from ...ros.ros_clock import RosClock
from ..base.node import frame_parameter
from ..base.rate import Rate
from . import state_messages as messages
from .feet import LEG_JOINTS, footprint
from .joint_sensors import JointSensors, Reading
from .odometry_offset import OdometryOffset
from .planar_frames import read_transform
from .slope import SlopeEstimator

log = logging.getLogger(__name__)

DEFAULT_RATE = 50.0
FASTEST = 0.008
"""s of real time from one reading to the next at least, however fast simulated time runs."""
RETRY = 0.5
"""s between two attempts to read a robot that cannot be read."""
COMPLAINT_PERIOD = 10.0
END_LIMIT = 2.0


class NaoJointStates:
    """Publishes the state of one robot, at an even rate.

    Threads: one reads and publishes; `close` and the diagnostics come from others and touch only what is set once.

    ROS API (relative names):
        Publishes `joint_states` (sensor_msgs/JointState; efforts are torques in N m from the motor currents),
        `imu` (sensor_msgs/Imu, in the frame of the torso), `odom` (nav_msgs/Odometry), and on /tf the frames odom ->
        base_link and base_link -> base_footprint (REP 105, REP 120). `~joint_stiffness` (sensor_msgs/JointState:
        efforts are stiffnesses, 0 to 1), while somebody listens: under the name of the node, for what is published on
        `joint_stiffness` is what nao_controller sets.
        Services, with `~use_odometry`: `pause_odometry` (std_srvs/Empty: place and heading stand still, whatever the
        robot does), `resume_odometry` (std_srvs/Empty: they go on from there), `set_odometry_pose`
        (nao_library_msgs/SetTransform: pose of the torso in odometry), `odometry_offset`
        (nao_library_msgs/SetTransform: moves it, in its own frame). Of transforms x, y and yaw count.
        Parameters `~sensor_rate` (50 Hz; `~torso_odom_rate` is its older name), `~base_frame_id` (base_link),
        `~footprint_frame_id` (base_footprint), `~odom_frame_id` (odom), `~use_joint_sensors` (true; false publishes
        commanded angles), `~use_odometry` (true; false leaves `odom` and its frame to others), `tf_prefix` (searched
        upwards; put before all frames).
    """

    def __init__(self, robot: Any, node: NodeInterface) -> None:
        """Raises NaoError if a parameter is wrong; the robot need not be there yet."""
        self._robot = robot
        self._names = JointNames(robot)
        rate = node.param("~sensor_rate", node.param("~torso_odom_rate", DEFAULT_RATE))
        self._period = 1.0 / number_parameter("~sensor_rate", rate, limit("reading rate"))
        self._base = frame_parameter(node, "~base_frame_id", "base_link")
        self._footprint = frame_parameter(node, "~footprint_frame_id", "base_footprint")
        self._odom = frame_parameter(node, "~odom_frame_id", "odom")
        self._use_sensors = bool(node.param("~use_joint_sensors", True))
        self._use_odometry = bool(node.param("~use_odometry", True))
        self._joint_states = node.publisher("joint_states", JointState, queue_size=10)
        self._imu = node.publisher("imu", Imu, queue_size=10)
        self._stiffness = node.publisher("~joint_stiffness", JointState, queue_size=10)
        self._odometry = node.publisher("odom", Odometry, queue_size=10) if self._use_odometry else None
        self._offset = OdometryOffset()
        if self._use_odometry:
            place_in = lambda request: read_transform(request.offset)  # noqa: E731
            node.offer("pause_odometry", Empty, lambda _: self._offset.pause())
            node.offer("resume_odometry", Empty, lambda _: self._offset.resume())
            node.offer("odometry_offset", SetTransform, lambda request: self._offset.move_by(place_in(request)))
            node.offer("set_odometry_pose", SetTransform, lambda request: self._offset.set(place_in(request)))
        self._frames = TransformBroadcaster()
        self._interrupt = CancellationToken()
        self._problem = "nothing was read yet"
        self._wall = WallClock()
        self._last_read = self._wall.now()
        self._thread = threading.Thread(target=self._run, name="joint states", daemon=True)
        self._thread.start()

    def reports(self) -> dict[str, Callable[[], Report]]:
        return {"readings": self._report}

    def close(self) -> None:
        self._interrupt.stop()
        self._thread.join(END_LIMIT)

    def _report(self) -> Report:
        age = self._wall.now() - self._last_read
        values = {"asked for every (ms)": f"{1000 * self._period:.0f}", "last one (s ago)": f"{age:.2f}"}
        if self._problem:
            return Report(Level.ERROR, self._problem, values)
        return Report(Level.OK, "joints, inertial unit and odometry are read", values)

    # --- the thread -----------------------------------------------------------------------------------------------

    def _run(self) -> None:
        while not self._interrupt.is_set():
            try:
                self._robot.connection.wait_connected(RETRY)
                sensors = JointSensors(self._robot, self._names.body, self._use_sensors, self._use_odometry)
                self._read_on(sensors)
            except RobotUnreachable as error:
                self._problem = str(error)  # the log has it already, from the connection
                self._interrupt.wait(RETRY)
            except NaoError as error:
                self._problem = str(error)
                rospy.logwarn_throttle(COMPLAINT_PERIOD, f"joints cannot be read: {error}")
                self._interrupt.wait(RETRY)
            except rospy.ROSException:
                return  # the topics were closed before this thread
            except Exception as error:  # a mistake in here must not leave a node that lives and says nothing
                self._problem = f"unexpected error: {error!r}"
                log.exception("joints cannot be read")
                self._interrupt.wait(RETRY)

    def _read_on(self, sensors: JointSensors) -> None:
        clock = RosClock()
        rate = Rate(clock, self._period, min(FASTEST, self._period / 2), self._interrupt)
        velocities, speeds = SlopeEstimator(), SlopeEstimator()
        last, jumps = None, 0
        while rate.wait():
            before = clock.now()
            if before == last:
                continue  # a step of simulated time may be longer than the wait: frames come once for a moment
            last = before
            reading = sensors.read()
            if reading.torso is not None:
                torso, jumps_now = self._offset.correct(reading.torso)
                reading = replace(reading, torso=torso)
                if jumps != jumps_now:
                    jumps, speeds = jumps_now, SlopeEstimator()
            # The robot answered somewhere between question and answer.
            now = (before + clock.now()) / 2
            stamp = Time.from_sec(now)
            changes = velocities.add(now, reading.positions)
            self._joint_states.publish(messages.joint_state(stamp, sensors.joints, reading, changes))
            if self._imu.get_num_connections() > 0:
                self._imu.publish(messages.imu(stamp, self._base, reading))
            if self._stiffness.get_num_connections() > 0:
                stiffnesses = sensors.read_stiffnesses()
                self._stiffness.publish(messages.joint_stiffness(stamp, sensors.joints, stiffnesses))
            transforms = self._foot_transforms(stamp, sensors, reading)
            if self._odometry is not None and reading.torso is not None:
                speed = speeds.add(now, reading.torso[:3])
                if self._odometry.get_num_connections() > 0:
                    self._odometry.publish(messages.odometry(stamp, self._odom, self._base, reading, speed))
                transforms.insert(0, messages.odometry_transform(stamp, self._odom, self._base, reading))
            if transforms:
                self._frames.sendTransform(transforms)
            self._problem = ""
            self._last_read = self._wall.now()

    def _foot_transforms(self, stamp: Time, sensors: JointSensors, reading: Reading) -> list[Any]:
        angles = dict(zip(sensors.joints, reading.positions))
        if not all(joint in angles for joints in LEG_JOINTS.values() for joint in joints):
            return []  # a robot without legs
        # Level as far as the frame above knows: there, the two lines of the feet are level exactly.
        roll, pitch = (reading.roll, reading.pitch) if reading.torso is None else reading.torso[3:5]
        return [messages.transform(stamp, self._base, self._footprint, *footprint(angles, roll, pitch))]
