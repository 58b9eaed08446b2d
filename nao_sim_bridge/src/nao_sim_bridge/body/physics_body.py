"""How the body of a NAO is put into a PyBullet world: shapes, joints, friction, limits, the coupled hips."""

from __future__ import annotations

from collections.abc import Mapping

import pybullet

from nao_sim_bridge.base.settings import ContactSettings
from nao_sim_bridge.base.whole_file import memory_file
from nao_sim_bridge.model.collision import LOAD_FLAGS, apart
from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.model.urdf.physics import physics_urdf

# Columns of PyBullet's joint info.
JOINT_NAME, LINK_NAME = 1, 12


def load_robot(client: int, model: RobotModel) -> int:
    """Put a robot into a world; PyBullet's body id of it."""
    with memory_file(physics_urdf(model).encode()) as path:
        return pybullet.loadURDF(path, flags=LOAD_FLAGS, physicsClientId=client)


def index_by(client: int, robot: int, column: int) -> dict[str, int]:
    """PyBullet's index of every joint and of the link behind it, by one of their names.

    Args:
        robot: Body id.
        column: JOINT_NAME or LINK_NAME.
    """
    count = pybullet.getNumJoints(robot, physicsClientId=client)
    infos = [pybullet.getJointInfo(robot, i, physicsClientId=client) for i in range(count)]
    return {info[column].decode(): info[0] for info in infos}


def keep_apart(client: int, robot: int, model: RobotModel, links: Mapping[str, int]) -> None:
    """Leave out the pairs of links that never touch each other: neighbours overlap at their joint."""
    for first, second in apart(model):
        indices = (links.get(first, -1), links.get(second, -1))
        pybullet.setCollisionFilterPair(robot, robot, *indices, 0, physicsClientId=client)


def set_friction(client: int, robot: int, contact: ContactSettings, links: Mapping[str, int]) -> None:
    """Give the body and the soles their friction; the soles are a little soft."""
    for index in [-1, *links.values()]:
        pybullet.changeDynamics(
            robot,
            index,
            lateralFriction=contact.body_friction,
            linearDamping=0.0,
            angularDamping=0.0,
            jointDamping=0.0,
            physicsClientId=client,
        )
    for foot in ("l_ankle", "r_ankle"):
        # Without friction anchors a standing robot creeps tens of degrees a minute.
        pybullet.changeDynamics(
            robot,
            links[foot],
            lateralFriction=contact.sole_friction,
            frictionAnchor=1,
            contactStiffness=contact.sole_stiffness,
            contactDamping=contact.sole_damping,
            physicsClientId=client,
        )


def load_torso(client: int, robot: int, payload: float) -> None:
    """Have the torso carry so much more mass, at its centre of mass, kg."""
    mass, _, inertia = pybullet.getDynamicsInfo(robot, -1, physicsClientId=client)[:3]
    # With a mass alone the engine would take a new inertia from the collision shapes.
    pybullet.changeDynamics(robot, -1, mass=mass + payload, localInertiaDiagonal=inertia, physicsClientId=client)


def limit_speeds(client: int, robot: int, speeds: Mapping[int, float]) -> None:
    """Keep the motors to their top speeds: without, one that lags catches up at any speed its torque allows.

    Only the call for one joint takes a limit; the engine keeps it when everything else is set anew for all of them.

    Args:
        robot: Body id.
        speeds: Index of a joint -> its top speed, rad/s or m/s.
    """
    for index, speed in speeds.items():
        pybullet.setJointMotorControl2(
            robot,
            index,
            pybullet.POSITION_CONTROL,
            targetPosition=0.0,
            force=0.0,
            maxVelocity=speed,
            physicsClientId=client,
        )


def couple_hips(client: int, robot: int, joints: Mapping[str, int], force: float) -> None:
    """Both HipYawPitch joints turn with one motor: a gear of ratio 1 between the two, of at most `force` N."""
    gear = pybullet.createConstraint(
        robot,
        joints["LHipYawPitch"],
        robot,
        joints["RHipYawPitch"],
        pybullet.JOINT_GEAR,
        (0, 1, 0),
        (0, 0, 0),
        (0, 0, 0),
        physicsClientId=client,
    )
    pybullet.changeConstraint(gear, gearRatio=-1, erp=0.2, maxForce=force, physicsClientId=client)
