"""A NAO in a PyBullet world: motors in, raw readings out. Nothing here knows NAOqi.

Whoever calls this owns the world: one thread only. Readings are plain tuples in ALMotion's Body order.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Callable, Collection, Mapping, Sequence

from nao_sim_bridge.base.errors import check_finite
from nao_sim_bridge.base.readings import BodyReadings, Contact, JointReadings, Pose
from nao_sim_bridge.base.rotations import Vector3
from nao_sim_bridge.base.settings import Settings
from nao_sim_bridge.body.joint_commands import JointCommands
from nao_sim_bridge.body.physics_body import (
    JOINT_NAME,
    LINK_NAME,
    couple_hips,
    index_by,
    keep_apart,
    limit_speeds,
    load_robot,
    load_torso,
    set_friction,
)
from nao_sim_bridge.body.physics_world import PhysicsWorld
from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.world.places import ORIGIN, RobotPlace, places_around
from nao_sim_bridge.world.world import FLOOR, World

# Columns of PyBullet's contact point tuples.
BODY_B, LINK_A, POSITION_ON_A, NORMAL_ON_B, DISTANCE, NORMAL_FORCE = 2, 3, 5, 7, 8, 9
NO_PUSHES: Mapping[str, Vector3] = {}
# From the torso's origin no part of the robot is further away than this, m.
REACH = 0.6
# How far somebody looks who points at something, m.
SIGHT = 50.0
HIT_FRACTION = 2


class Physics:
    """A free NAO in a world with gravity, alone or among others.

    Attributes:
        shared: The world that it is in.
        engine: The world in the physics engine.
        bodies: The floor and the things of the world.
        robot: PyBullet's body id of the NAO.
        start: Where on the floor it starts.
        links: Link name to PyBullet's index; the torso is -1.
        torque_limits: (26,) most that the motors give, N m.
        payload: What the torso carries, kg.
        friction: Share of their friction that body and soles have.

    Args:
        world: What else there is; or a world that there is already, and that others may be in.
        angles: (26,) joint angles to start with, rad (hands 0..1).
        pitch: Of the torso at the start, rad, for a robot that is not on its feet; see `place`.
        payload: Mass that the torso carries besides its own, at its centre of mass, kg.
    """

    def __init__(
        self,
        model: RobotModel,
        world: World | PhysicsWorld,
        settings: Settings,
        angles: Sequence[float],
        pitch: float | None = None,
        payload: float = 0.0,
        place: RobotPlace = ORIGIN,
    ) -> None:
        self._model = model
        self._settings = settings
        self.shared = world if isinstance(world, PhysicsWorld) else PhysicsWorld(world, settings)
        self._floor = self.shared.world.floor
        self.engine = self.shared.engine
        self.bodies = self.shared.bodies
        self.robot = load_robot(self.engine, model)
        self.shared.robots.append(self.robot)
        self.links = index_by(self.engine, self.robot, LINK_NAME)
        joints = index_by(self.engine, self.robot, JOINT_NAME)
        self._indices = [joints[j.name] for j in model.joints]
        self._travel = model.simulated_hand.travel
        self._hands = [i for i, j in enumerate(model.joints) if j.is_hand]
        self.torque_limits = [float(j.max_torque) for j in model.joints]
        motor = settings.motor
        hips, rest = motor.limp_hip_pitch_friction, motor.limp_friction
        self._friction = [hips if j.name.endswith("HipPitch") else rest for j in model.joints]
        gains = {"positionGains": motor.position_gain, "velocityGains": motor.velocity_gain}
        self._gains = {name: [gain] * len(self._indices) for name, gain in gains.items()}
        self._forget_efforts()
        keep_apart(self.engine, self.robot, model, self.links)
        set_friction(self.engine, self.robot, settings.contact, self.links)
        self.payload, self.friction = 0.0, 1.0
        self.carry(payload)
        speeds = self._to_engine_speeds([j.max_velocity for j in model.joints])
        limit_speeds(self.engine, self.robot, dict(zip(self._indices, speeds)))
        couple_hips(self.engine, self.robot, joints, settings.motor.coupling_force_n)
        local_position, local_orientation = self.engine.getDynamicsInfo(self.robot, -1)[3:5]
        self._torso_to_com = (local_position, local_orientation)
        self._com_to_torso = self.engine.invertTransform(local_position, local_orientation)
        self.start = place
        self.restart(angles, pitch)

    def forget(self, payload: float) -> None:
        """The world was put to its start: what the motors were told before counts no more."""
        self._forget_efforts()
        self.carry(payload)
        self.scale_friction(1.0)

    def carry(self, payload: float) -> None:
        """Let the torso carry this mass, kg, and no other."""
        if payload != self.payload:
            load_torso(self.engine, self.robot, payload - self.payload)
            self.payload = payload

    def scale_friction(self, share: float) -> None:
        """Let body and soles have this share of their friction, until the world is put to its start."""
        if share != self.friction:
            contact = self._settings.contact
            body, sole = share * contact.body_friction, share * contact.sole_friction
            scaled = replace(contact, body_friction=body, sole_friction=sole)
            set_friction(self.engine, self.robot, scaled, self.links)
            self.friction = share

    def restart(self, angles: Sequence[float], pitch: float | None = None) -> None:
        """Put the robot to where it started, at rest; what its motors were told is forgotten."""
        self._forget_efforts()
        self.place(angles, self.start.yaw, (self.start.x, self.start.y), pitch, above=self.start.z)

    def restart_beside_others(self, angles: Sequence[float], pitch: float | None = None) -> None:
        """As `restart`, but where something is there, at the nearest place around that is free, if there is one."""
        self.scale_friction(1.0)
        for x, y in places_around(self.start):
            self._forget_efforts()
            self.place(angles, self.start.yaw, (x, y), pitch, above=self.start.z)
            if not self.inside():
                return
        self.restart(angles, pitch)

    def inside(self) -> dict[str, float]:
        """How deep the robot is in what is there, m; see `PhysicsWorld.inside`."""
        return self.shared.inside(self.robot)

    def close(self) -> None:
        """Free the engine's memory; the object, and all others in its world, are of no use afterwards."""
        self.shared.close()

    # --- moving ---------------------------------------------------------------------------------------------------

    def place(
        self,
        angles: Sequence[float],
        yaw: float = 0.0,
        xy: tuple[float, float] = (0.0, 0.0),
        pitch: float | None = None,
        roll: float = 0.0,
        above: float = 0.0,
    ) -> None:
        """Put the robot at rest on the floor; on a slope it is tilted as the floor is.

        Args:
            angles: (26,) joint angles, rad (hands 0..1).
            yaw: Heading, rad.
            xy: Of the torso's origin in world, m.
            pitch: Of the torso over the floor, rad, positive with the face down; the lowest point of the body touches
                the floor. Without it the left sole is flat on the floor.
            roll: Of the torso over the floor, rad, positive with the left side up; of no meaning without a pitch.
            above: How far over the floor what it stands on is, along its normal, m.
        """
        check_finite("angles of the robot", angles)
        for index, angle in zip(self._indices, self._to_engine(angles)):
            self.engine.resetJointState(self.robot, index, angle, 0.0)
        if pitch is not None:
            orientation = self.engine.getQuaternionFromEuler((roll, pitch, yaw))
            self._put_over_floor((0.0, 0.0), REACH, orientation)
            self._put_over_floor(xy, REACH - self._clearance() + above, orientation)
            return
        self._reset_base((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
        foot_orientation = self.link_pose("l_ankle").orientation
        upright = self.engine.invertTransform((0, 0, 0), foot_orientation)[1]
        heading = self.engine.getEulerFromQuaternion(upright)[2]
        turn = self.engine.getQuaternionFromEuler((0, 0, yaw - heading))
        orientation = self.engine.multiplyTransforms((0, 0, 0), turn, (0, 0, 0), upright)[1]
        self._reset_base((0.0, 0.0, 0.0), orientation)
        soles = [self.link_pose(f).position[2] - self._model.sole_height for f in ("l_ankle", "r_ankle")]
        self._put_over_floor(xy, above - min(soles), orientation)

    def drive(self, joints: JointCommands) -> None:
        """Tell the motors commands and stiffnesses; a limp joint has only the friction of its gears.

        Raises:
            NotFinite: One of the numbers is not; the motors go on with what they were told before.
        """
        share = self._settings.motor.feed_forward
        if joints.efforts is not self._efforts:  # replaced as a whole and never changed
            self._take_efforts(joints.efforts)
        targets = self._to_engine(joints.aims)
        velocities = [share * speed for speed in self._to_engine_speeds(joints.aim_velocities)]
        if self._limp:
            rests = self._to_engine(joints.rests)
            for index in self._limp:
                targets[index], velocities[index] = rests[index], 0.0
        check_finite("targets, speeds and torques of the motors", [*targets, *velocities, *self._forces])
        self._control(
            self.engine.POSITION_CONTROL,
            targetPositions=targets,
            targetVelocities=velocities,
            forces=self._forces,
            **self._gains,
        )

    def drive_positions(self, angles: Sequence[float]) -> None:
        """Send all joints to (26,) angles, rad (hands 0..1), with the full torque and the gains of their motors."""
        self._efforts = ()  # `drive` has to tell forces anew
        targets = self._to_engine(angles)
        self._control(self.engine.POSITION_CONTROL, targetPositions=targets, forces=self.torque_limits, **self._gains)

    def drive_velocities(self, speeds: Sequence[float]) -> None:
        """Let all joints turn at (26,) speeds, rad/s (hands 1/s), with at most the torque of their motors."""
        self._efforts = ()
        targets = self._to_engine_speeds(speeds)
        self._control(self.engine.VELOCITY_CONTROL, targetVelocities=targets, forces=self.torque_limits)

    def free_joints(self) -> None:
        """Let nothing but `turn_joints` turn the joints; their gears have no friction then."""
        self._efforts = ()
        self._control(self.engine.VELOCITY_CONTROL, forces=[0.0] * len(self._indices))

    def turn_joints(self, torques: Sequence[float]) -> None:
        """Apply (26,) torques, N m (hands N m of their simulated finger), in the coming step of the engine alone."""
        self._control(self.engine.TORQUE_CONTROL, forces=torques)

    def _control(self, mode: int, **wanted: Sequence[float]) -> None:
        self.engine.setJointMotorControlArray(self.robot, self._indices, mode, **wanted)

    def _forget_efforts(self) -> None:
        self._efforts: Sequence[float] = ()
        self._limp: list[int] = []
        self._forces: list[float] = []

    def _take_efforts(self, efforts: Sequence[float]) -> None:
        """Work out from efforts (26, 0..1) what stays the same until they change."""
        self._efforts = efforts
        self._limp = [index for index, effort in enumerate(efforts) if effort <= 0.0]
        shares = map(max, efforts, self._friction)
        self._forces = [torque * share for torque, share in zip(self.torque_limits, shares)]

    def step(self, pushes: Mapping[str, Vector3] = NO_PUSHES) -> None:
        """Advance the world by one tick while `pushes` act on links of this robot; see `pushing`."""
        self.shared.step(self.pushing(pushes))

    def pushing(self, pushes: Mapping[str, Vector3]) -> Sequence[Callable[[], None]]:
        """What `PhysicsWorld.step` calls for pushes: link name -> force in N, in world, on its centre of mass.

        Raises:
            NotFinite: A force is not.
        """
        for link, force in pushes.items():
            check_finite(f"push of {link}", force)
        return [partial(self._push, link, force) for link, force in pushes.items()]

    def _push(self, link: str, force: Vector3) -> None:
        index = self.links.get(link, -1)
        position = (
            self.engine.getBasePositionAndOrientation(self.robot)[0]
            if index < 0
            else self.engine.getLinkState(self.robot, index)[0]
        )
        self.engine.applyExternalForce(self.robot, index, force, position, self.engine.WORLD_FRAME)

    # --- reading --------------------------------------------------------------------------------------------------

    def read_joints(self) -> JointReadings:
        """Angles, speeds and torques of the 26 joints.

        Raises:
            NotFinite: The engine has lost the body.
        """
        states = self.engine.getJointStates(self.robot, self._indices)
        positions, velocities, _, torques = map(list, zip(*states))
        check_finite("joints of the robot", positions)
        for index in self._hands:
            positions[index] = positions[index] / self._travel + 1.0
            velocities[index] /= self._travel
        return JointReadings(tuple(positions), tuple(velocities), tuple(torques))

    def read_body(self) -> BodyReadings:
        """Pose and velocities of the torso frame.

        Raises:
            NotFinite: The engine has lost the body.
        """
        com, orientation = self.engine.getBasePositionAndOrientation(self.robot)
        check_finite("torso of the robot", (*com, *orientation))
        position, orientation = self.engine.multiplyTransforms(com, orientation, *self._com_to_torso)
        velocity, angular = self.engine.getBaseVelocity(self.robot)
        rx, ry, rz = position[0] - com[0], position[1] - com[1], position[2] - com[2]
        wx, wy, wz = angular
        linear = (velocity[0] + wy * rz - wz * ry, velocity[1] + wz * rx - wx * rz, velocity[2] + wx * ry - wy * rx)
        return BodyReadings(Pose(position, orientation), linear, angular)

    def read_contacts(self) -> tuple[Contact, ...]:
        """Every point where another body presses on the robot."""
        points = self.engine.getContactPoints(self.robot)
        robot = self.robot
        found = [
            Contact(c[LINK_A], c[POSITION_ON_A], c[NORMAL_ON_B], c[NORMAL_FORCE])
            for c in points
            if c[BODY_B] != robot and c[NORMAL_FORCE] > 0.0
        ]
        return tuple(found)

    def link_pose(self, name: str) -> Pose:
        """Pose of a link frame (not of its centre of mass) in world."""
        state = self.engine.getLinkState(self.robot, self.links[name], computeForwardKinematics=True)
        return Pose(state[4], state[5])

    def link_poses(self, links: Collection[int], torso: Pose) -> dict[int, Pose]:
        """Poses in world of link frames by their indices; -1 is the torso, whose pose is known."""
        poses = {}
        others = [link for link in links if link >= 0]
        if others:
            states = self.engine.getLinkStates(self.robot, others, computeForwardKinematics=True)
            poses = {link: Pose(state[4], state[5]) for link, state in zip(others, states)}
        if -1 in links:
            poses[-1] = torso
        return poses

    def pose_of(self, name: str) -> Pose:
        """As `link_pose`; of any other name that of the torso."""
        return self.link_pose(name) if name in self.links else self.read_body().pose

    def free_sight(self, eye: Vector3, direction: Vector3) -> float:
        """How far a line of sight goes before it meets something, m."""
        end = [a + SIGHT * b for a, b in zip(eye, direction)]
        return SIGHT * self.engine.rayTest(eye, end)[0][HIT_FRACTION]

    # --- inside ---------------------------------------------------------------------------------------------------

    def _clearance(self) -> float:
        """Height of the lowest point of the body over the floor, m; below 2 m of it."""
        floor = self.bodies.ids[FLOOR]
        points = self.engine.getClosestPoints(self.robot, floor, 2.0)
        return min(point[DISTANCE] for point in points)

    def _put_over_floor(self, xy: tuple[float, float], height: float, orientation: Sequence[float]) -> None:
        """Put the torso over (x, y) in world, `height` over the floor along its normal; orientation over the floor."""
        floor = self._floor
        turned = self.engine.multiplyTransforms((0, 0, 0), floor.orientation, (0, 0, 0), orientation)[1]
        self._reset_base((xy[0], xy[1], floor.height_at(xy[0], xy[1], height)), turned)

    def _reset_base(self, position: Vector3, orientation: Sequence[float]) -> None:
        com, turn = self.engine.multiplyTransforms(position, orientation, *self._torso_to_com)
        check_finite("place of the robot", (*com, *turn))
        self.engine.resetBasePositionAndOrientation(self.robot, com, turn)
        self.engine.resetBaseVelocity(self.robot, (0, 0, 0), (0, 0, 0))

    def _to_engine(self, angles: Sequence[float]) -> list[float]:
        angles = list(angles)
        for index in self._hands:
            angles[index] = (angles[index] - 1.0) * self._travel
        return angles

    def _to_engine_speeds(self, speeds: Sequence[float]) -> list[float]:
        speeds = list(speeds)
        for index in self._hands:
            speeds[index] *= self._travel
        return speeds
