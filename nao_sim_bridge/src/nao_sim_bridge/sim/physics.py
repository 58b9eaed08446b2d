"""The PyBullet world with one NAO in it: motors in, raw readings out. Nothing here knows NAOqi.

Whoever calls this owns the world: one thread only. Readings are plain tuples in ALMotion's Body order.
"""

from __future__ import annotations

import os
import tempfile
from typing import Mapping, Sequence

import pybullet

from nao_sim_bridge.sim.collision import LOAD_FLAGS, apart
from nao_sim_bridge.sim.model import RobotModel
from nao_sim_bridge.sim.motion.joints import JointCommands
from nao_sim_bridge.sim.readings import BodyReadings, Contact, JointReadings, Pose
from nao_sim_bridge.sim.rotations import Vector3
from nao_sim_bridge.sim.settings import Settings
from nao_sim_bridge.sim.urdf import physics_urdf
from nao_sim_bridge.sim.world import FLOOR, World
from nao_sim_bridge.sim.world_bodies import WorldBodies

# Columns of PyBullet's joint info and contact point tuples.
JOINT_NAME, LINK_NAME, PARENT_FRAME_POSITION = 1, 12, 14
BODY_B, LINK_A, POSITION_ON_A, NORMAL_ON_B, DISTANCE, NORMAL_FORCE = 2, 3, 5, 7, 8, 9
NO_PUSHES: Mapping[str, Vector3] = {}
# From the torso's origin no part of the robot is further away than this, m.
REACH = 0.6


class Physics:
    """A world, a free NAO, and gravity.

    Attributes:
        client: PyBullet's physics client.
        bodies: The floor and the things of the world.
        robot: PyBullet's body id of the NAO.
        links: Link name to PyBullet's index; the torso is -1.

    Args:
        model: The robot.
        world: What else there is.
        settings: Time step, gains, friction.
        angles: (26,) joint angles to start with, rad (hands 0..1).
        pitch: Of the torso at the start, rad, for a robot that is not on its feet; see `place`.
        payload: Mass that the torso carries besides its own, at its centre of mass, kg.
    """

    def __init__(
        self,
        model: RobotModel,
        world: World,
        settings: Settings,
        angles: Sequence[float],
        pitch: float | None = None,
        payload: float = 0.0,
    ) -> None:
        self._model = model
        self._settings = settings
        self._floor = world.floor
        self.client = pybullet.connect(pybullet.DIRECT)
        pybullet.setGravity(0, 0, -settings.gravity_m_s2, physicsClientId=self.client)
        pybullet.setPhysicsEngineParameter(
            fixedTimeStep=settings.time_step_s,
            numSolverIterations=settings.solver_iterations,
            deterministicOverlappingPairs=1,
            physicsClientId=self.client,
        )
        self.bodies = WorldBodies(world, self.client)
        self.robot = self._load_robot()
        self.links = self._index(LINK_NAME)
        joints = self._index(JOINT_NAME)
        self._indices = [joints[j.name] for j in model.joints]
        self._travel = model.simulated_hand.travel
        self._hands = [i for i, j in enumerate(model.joints) if j.is_hand]
        self._torques = [float(j.max_torque) for j in model.joints]
        self._position_gains = [settings.motor.position_gain] * len(self._indices)
        self._velocity_gains = [settings.motor.velocity_gain] * len(self._indices)
        self._efforts: Sequence[float] = ()
        self._limp: list[int] = []
        self._forces: list[float] = []
        self._keep_apart()
        self._set_friction()
        self._load_torso(payload)
        self._limit_speeds()
        self._couple_hips(joints)
        local_position, local_orientation = pybullet.getDynamicsInfo(self.robot, -1, physicsClientId=self.client)[3:5]
        self._torso_to_com = (local_position, local_orientation)
        self._com_to_torso = pybullet.invertTransform(local_position, local_orientation)
        self.place(angles, pitch=pitch)

    def close(self) -> None:
        """Free the engine's memory; the object is of no use afterwards."""
        pybullet.disconnect(physicsClientId=self.client)

    # --- moving ---------------------------------------------------------------------------------------------------

    def place(
        self,
        angles: Sequence[float],
        yaw: float = 0.0,
        xy: tuple[float, float] = (0.0, 0.0),
        pitch: float | None = None,
        roll: float = 0.0,
    ) -> None:
        """Put the robot at rest on the floor; on a slope it is tilted as the floor is.

        Args:
            angles: (26,) joint angles, rad (hands 0..1).
            yaw: Heading, rad.
            xy: Of the torso's origin in world, m.
            pitch: Of the torso over the floor, rad, positive with the face down; the lowest point of the body touches
                the floor. Without it the left sole is flat on the floor.
            roll: Of the torso over the floor, rad, positive with the left side up; of no meaning without a pitch.
        """
        for index, angle in zip(self._indices, self._to_engine(angles)):
            pybullet.resetJointState(self.robot, index, angle, 0.0, physicsClientId=self.client)
        if pitch is not None:
            orientation = pybullet.getQuaternionFromEuler((roll, pitch, yaw))
            self._put_over_floor((0.0, 0.0), REACH, orientation)
            self._put_over_floor(xy, REACH - self._clearance(), orientation)
            return
        self._reset_base((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
        foot_orientation = self.link_pose("l_ankle").orientation
        upright = pybullet.invertTransform((0, 0, 0), foot_orientation)[1]
        heading = pybullet.getEulerFromQuaternion(upright)[2]
        turn = pybullet.getQuaternionFromEuler((0, 0, yaw - heading))
        orientation = pybullet.multiplyTransforms((0, 0, 0), turn, (0, 0, 0), upright)[1]
        self._reset_base((0.0, 0.0, 0.0), orientation)
        soles = [self.link_pose(f).position[2] - self._model.sole_height for f in ("l_ankle", "r_ankle")]
        self._put_over_floor(xy, -min(soles), orientation)

    def drive(self, joints: JointCommands) -> None:
        """Tell the motors commands and stiffnesses; a limp joint has only the friction of its gears."""
        share = self._settings.motor.feed_forward
        if joints.efforts is not self._efforts:  # replaced as a whole and never changed
            self._take_efforts(joints.efforts)
        targets = self._to_engine(joints.aims)
        velocities = [share * speed for speed in self._to_engine_speeds(joints.aim_velocities)]
        if self._limp:
            rests = self._to_engine(joints.rests)
            for index in self._limp:
                targets[index], velocities[index] = rests[index], 0.0
        pybullet.setJointMotorControlArray(
            self.robot,
            self._indices,
            pybullet.POSITION_CONTROL,
            targetPositions=targets,
            targetVelocities=velocities,
            forces=self._forces,
            positionGains=self._position_gains,
            velocityGains=self._velocity_gains,
            physicsClientId=self.client,
        )

    def _take_efforts(self, efforts: Sequence[float]) -> None:
        """Work out from efforts (26, 0..1) what stays the same until they change."""
        self._efforts = efforts
        self._limp = [index for index, effort in enumerate(efforts) if effort <= 0.0]
        least = self._settings.motor.limp_friction
        self._forces = [torque * max(effort, least) for torque, effort in zip(self._torques, efforts)]

    def step(self, pushes: Mapping[str, Vector3] = NO_PUSHES) -> None:
        """Advance by one tick while `pushes` (link name -> force in N, in world) act on the links' centres of mass."""
        for _ in range(self._settings.steps_per_tick):
            for link, force in pushes.items():
                self._push(link, force)
            pybullet.stepSimulation(physicsClientId=self.client)

    def _push(self, link: str, force: Vector3) -> None:
        index = self.links.get(link, -1)
        position = (
            pybullet.getBasePositionAndOrientation(self.robot, physicsClientId=self.client)[0]
            if index < 0
            else pybullet.getLinkState(self.robot, index, physicsClientId=self.client)[0]
        )
        pybullet.applyExternalForce(
            self.robot, index, force, position, pybullet.WORLD_FRAME, physicsClientId=self.client
        )

    # --- reading --------------------------------------------------------------------------------------------------

    def read_joints(self) -> JointReadings:
        """Angles, speeds and torques of the 26 joints."""
        states = pybullet.getJointStates(self.robot, self._indices, physicsClientId=self.client)
        positions, velocities, _, torques = map(list, zip(*states))
        for index in self._hands:
            positions[index] = positions[index] / self._travel + 1.0
            velocities[index] /= self._travel
        return JointReadings(tuple(positions), tuple(velocities), tuple(torques))

    def read_body(self) -> BodyReadings:
        """Pose and velocities of the torso frame."""
        com, orientation = pybullet.getBasePositionAndOrientation(self.robot, physicsClientId=self.client)
        position, orientation = pybullet.multiplyTransforms(com, orientation, *self._com_to_torso)
        velocity, angular = pybullet.getBaseVelocity(self.robot, physicsClientId=self.client)
        rx, ry, rz = position[0] - com[0], position[1] - com[1], position[2] - com[2]
        wx, wy, wz = angular
        linear = (
            velocity[0] + wy * rz - wz * ry,
            velocity[1] + wz * rx - wx * rz,
            velocity[2] + wx * ry - wy * rx,
        )
        return BodyReadings(Pose(position, orientation), linear, angular)

    def read_contacts(self) -> tuple[Contact, ...]:
        """Every point where another body presses on the robot."""
        points = pybullet.getContactPoints(self.robot, physicsClientId=self.client)
        return tuple(
            Contact(c[LINK_A], c[POSITION_ON_A], c[NORMAL_ON_B], c[NORMAL_FORCE])
            for c in points
            if c[BODY_B] != self.robot and c[NORMAL_FORCE] > 0.0
        )

    def link_pose(self, name: str) -> Pose:
        """Pose of a link frame (not of its centre of mass) in world."""
        state = pybullet.getLinkState(
            self.robot, self.links[name], computeForwardKinematics=True, physicsClientId=self.client
        )
        return Pose(state[4], state[5])

    def nearest_hits(self, start: Vector3, ends: Sequence[Vector3]) -> list[float]:
        """Share 0..1 of the way from `start` to each of `ends` that is free; the robot itself does not count."""
        hits = pybullet.rayTestBatch([start] * len(ends), list(ends), physicsClientId=self.client)
        return [1.0 if hit[0] == self.robot else hit[2] for hit in hits]

    # --- building -------------------------------------------------------------------------------------------------

    def _load_robot(self) -> int:
        descriptor, path = tempfile.mkstemp(suffix=".urdf")
        try:
            with os.fdopen(descriptor, "w", encoding="utf-8") as file:
                file.write(physics_urdf(self._model))
            return pybullet.loadURDF(path, flags=LOAD_FLAGS, physicsClientId=self.client)
        finally:
            os.remove(path)

    def _index(self, column: int) -> dict[str, int]:
        count = pybullet.getNumJoints(self.robot, physicsClientId=self.client)
        infos = [pybullet.getJointInfo(self.robot, i, physicsClientId=self.client) for i in range(count)]
        return {info[column].decode(): info[0] for info in infos}

    def _keep_apart(self) -> None:
        """Leave out the pairs of links that never touch each other: neighbours overlap at their joint."""
        for first, second in apart(self._model):
            indices = (self.links.get(first, -1), self.links.get(second, -1))
            pybullet.setCollisionFilterPair(self.robot, self.robot, *indices, 0, physicsClientId=self.client)

    def _set_friction(self) -> None:
        contact = self._settings.contact
        for index in [-1, *self.links.values()]:
            pybullet.changeDynamics(
                self.robot,
                index,
                lateralFriction=contact.body_friction,
                linearDamping=0.0,
                angularDamping=0.0,
                jointDamping=0.0,
                physicsClientId=self.client,
            )
        for foot in ("l_ankle", "r_ankle"):
            # Without friction anchors a standing robot creeps tens of degrees a minute.
            pybullet.changeDynamics(
                self.robot,
                self.links[foot],
                lateralFriction=contact.sole_friction,
                frictionAnchor=1,
                contactStiffness=contact.sole_stiffness,
                contactDamping=contact.sole_damping,
                physicsClientId=self.client,
            )

    def _load_torso(self, payload: float) -> None:
        if payload == 0.0:
            return
        mass, _, inertia = pybullet.getDynamicsInfo(self.robot, -1, physicsClientId=self.client)[:3]
        # With a mass alone the engine would take a new inertia from the collision shapes.
        pybullet.changeDynamics(
            self.robot, -1, mass=mass + payload, localInertiaDiagonal=inertia, physicsClientId=self.client
        )

    def _limit_speeds(self) -> None:
        """Keep the motors to their top speeds: without, one that lags catches up at any speed its torque allows.

        Only the call for one joint takes a limit; the engine keeps it when `drive` sets everything else anew.
        """
        speeds = self._to_engine_speeds([j.max_velocity for j in self._model.joints])
        for index, speed in zip(self._indices, speeds):
            pybullet.setJointMotorControl2(
                self.robot,
                index,
                pybullet.POSITION_CONTROL,
                targetPosition=0.0,
                force=0.0,
                maxVelocity=speed,
                physicsClientId=self.client,
            )

    def _couple_hips(self, joints: Mapping[str, int]) -> None:
        """Both HipYawPitch joints turn with one motor: a gear of ratio 1 between the two."""
        gear = pybullet.createConstraint(
            self.robot,
            joints["LHipYawPitch"],
            self.robot,
            joints["RHipYawPitch"],
            pybullet.JOINT_GEAR,
            (0, 1, 0),
            (0, 0, 0),
            (0, 0, 0),
            physicsClientId=self.client,
        )
        pybullet.changeConstraint(
            gear,
            gearRatio=-1,
            erp=0.2,
            maxForce=self._settings.motor.coupling_force_n,
            physicsClientId=self.client,
        )

    def _clearance(self) -> float:
        """Height of the lowest point of the body over the floor, m; below 2 m of it."""
        floor = self.bodies.ids[FLOOR]
        points = pybullet.getClosestPoints(self.robot, floor, 2.0, physicsClientId=self.client)
        return min(point[DISTANCE] for point in points)

    def _put_over_floor(self, xy: tuple[float, float], height: float, orientation: Sequence[float]) -> None:
        """Put the torso over (x, y) in world, `height` over the floor along its normal; orientation over the floor."""
        floor = self._floor
        turned = pybullet.multiplyTransforms((0, 0, 0), floor.orientation, (0, 0, 0), orientation)[1]
        self._reset_base((xy[0], xy[1], floor.height_at(xy[0], xy[1], height)), turned)

    def _reset_base(self, position: Vector3, orientation: Sequence[float]) -> None:
        com, turn = pybullet.multiplyTransforms(position, orientation, *self._torso_to_com)
        pybullet.resetBasePositionAndOrientation(self.robot, com, turn, physicsClientId=self.client)
        pybullet.resetBaseVelocity(self.robot, (0, 0, 0), (0, 0, 0), physicsClientId=self.client)

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
