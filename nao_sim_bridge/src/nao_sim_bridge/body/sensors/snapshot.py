"""What the simulated robot senses at one tick, immutable: services and nodes read it from any thread.

What costs time and is not needed at every tick (foot forces, touch, motor currents) is worked out from the raw
readings when somebody asks for it, and kept.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Mapping, Tuple

from nao_sim_bridge.base.readings import Contact, FootForces, Pose
from nao_sim_bridge.base.rotations import Vector3, rotate_back
from nao_sim_bridge.body.sensors.battery import BatteryReading
from nao_sim_bridge.body.sensors.body import BodySensors, Presses, in_link_frames, not_from_below
from nao_sim_bridge.world.world import WorldObject


@dataclass(frozen=True)
class Imu:
    """The inertial unit in the torso.

    Attributes:
        accelerometer: Proper acceleration in the torso frame, m/s2; (0, 0, 9.81) when upright and at rest.
        gyroscope: Angular velocity in the torso frame, rad/s.
        angles: Roll, pitch and yaw of the torso in world, rad; yaw counts from where the robot looked at the start.
    """

    accelerometer: Vector3
    gyroscope: Vector3
    angles: Vector3


@dataclass(frozen=True)
class Snapshot:
    """State after one tick. Joint arrays are in ALMotion's Body order (26,).

    Attributes:
        tick: Number of ticks since the start of the program; never goes back, not even at a reset.
        time: Simulated time, s; as `tick`.
        age: Simulated time since the robot was put to its start, s: after a reset equal commands meet equal ages to the
            last bit.
        positions: Measured joint angles, rad (hands 0..1).
        velocities: Measured joint speeds, rad/s.
        torques: Torque of each motor, N m.
        temperatures: Motor temperatures, degC.
        commands: Commanded joint angles, rad.
        stiffnesses: 0..1.
        torso: True pose of the torso in world.
        linear_velocity: True velocity of the torso in world, m/s.
        angular_velocity: True angular velocity of the torso in world, rad/s.
        imu: The inertial unit.
        odometry: Pose of the torso as the robot itself reckons it, in the frame where it stood at the start.
        sonars: Distances of the first echoes left and right, m.
        echoes: All echoes left and right, m, nearest first; none when nothing echoes. A new tuple with each shot.
        head_temperature: Of the computer in the head, degC.
        battery: What the battery's board tells; a new one whenever it changes.
        objects: True poses of things that can be moved, were placed, or were put elsewhere, by name.
        placed: Things that were added to those of the world.
        gone: Names of things of the world that were taken away.
        contacts: Points where something presses on the robot.
        link_poses: Link index to the pose in world of each link that has a contact.
        foot_loads: Upward force on the left and on the right foot, N; about the totals of their sensors.
        fingers: Touch sensors that a simulated finger presses.
        sensors: How forces, touch and currents follow from the raw readings.
    """

    tick: int
    time: float
    age: float
    positions: Tuple[float, ...]
    velocities: Tuple[float, ...]
    torques: Tuple[float, ...]
    temperatures: Tuple[float, ...]
    commands: Tuple[float, ...]
    stiffnesses: Tuple[float, ...]
    torso: Pose
    linear_velocity: Vector3
    angular_velocity: Vector3
    imu: Imu
    odometry: Pose
    sonars: Tuple[float, ...]
    echoes: Tuple[Tuple[float, ...], ...]
    head_temperature: float
    battery: BatteryReading
    objects: Mapping[str, Pose]
    placed: Tuple[WorldObject, ...]
    gone: frozenset
    contacts: Tuple[Contact, ...]
    link_poses: Mapping[int, Pose]
    foot_loads: Tuple[float, float]
    fingers: frozenset
    sensors: BodySensors = field(repr=False, compare=False)

    @cached_property
    def left_foot(self) -> FootForces:
        return self.sensors.foot_forces("L", self._presses)

    @cached_property
    def right_foot(self) -> FootForces:
        return self.sensors.foot_forces("R", self._presses)

    @cached_property
    def touched(self) -> frozenset:
        """Names of touch sensors, bumpers and buttons that something presses."""
        # No touch sensor looks down, and nearly all contacts are those of soles with the floor.
        contacts = not_from_below(self.contacts, self.link_poses)
        if not contacts:
            return self.fingers
        return self.fingers | self.sensors.touched(in_link_frames(contacts, self.link_poses))

    @cached_property
    def currents(self) -> Tuple[float, ...]:
        """Electric current of each motor, A, absolute."""
        return self.sensors.motors.currents(self.torques)

    @cached_property
    def _presses(self) -> Presses:
        return in_link_frames(self.contacts, self.link_poses)

    @property
    def velocity_in_torso(self) -> Vector3:
        """True velocity of the torso in its own frame, m/s."""
        return rotate_back(self.torso.orientation, self.linear_velocity)

    @property
    def turn_in_torso(self) -> Vector3:
        """True angular velocity of the torso in its own frame, rad/s."""
        return rotate_back(self.torso.orientation, self.angular_velocity)
