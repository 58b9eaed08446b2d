"""How the body of a NAO is put into a PyBullet world: shapes, joints, friction, limits, the coupled hips."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache

from nao_sim_bridge.base.engine import LOAD_FLAGS, Engine
from nao_sim_bridge.base.memory_file import memory_file
from nao_sim_bridge.base.settings import ContactSettings
from nao_sim_bridge.model.collision import apart
from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.model.urdf.physics import physics_urdf

# Columns of PyBullet's joint info.
JOINT_NAME, LINK_NAME = 1, 12
SPECK = '<visual><geometry><box size="0.01 0.01 0.01"/></geometry></visual>'


def load_robot(engine: Engine, model: RobotModel) -> int:
    """Put a robot into a world; PyBullet's body id of it."""
    with memory_file(_description(model)) as path:
        return engine.loadURDF(path, flags=LOAD_FLAGS)


@lru_cache(maxsize=None)
def _description(model: RobotModel) -> bytes:
    """URDF whose links have something to be seen, for the engine would make pictures of all that can be touched."""
    return physics_urdf(model).replace("</inertial>", f"</inertial>{SPECK}").encode()


def index_by(engine: Engine, robot: int, column: int) -> dict[str, int]:
    """PyBullet's index of every joint and of the link behind it, by one of their names.

    Args:
        robot: Body id.
        column: JOINT_NAME or LINK_NAME.
    """
    count = engine.getNumJoints(robot)
    infos = [engine.getJointInfo(robot, i) for i in range(count)]
    return {info[column].decode(): info[0] for info in infos}


def keep_apart(engine: Engine, robot: int, model: RobotModel, links: Mapping[str, int]) -> None:
    """Leave out the pairs of links that never touch each other: neighbours overlap at their joint."""
    for first, second in apart(model):
        indices = (links.get(first, -1), links.get(second, -1))
        engine.setCollisionFilterPair(robot, robot, *indices, 0)


def set_friction(engine: Engine, robot: int, contact: ContactSettings, links: Mapping[str, int]) -> None:
    """Give the body and the soles their friction; the soles are a little soft."""
    for index in [-1, *links.values()]:
        engine.changeDynamics(
            robot, index, lateralFriction=contact.body_friction, linearDamping=0.0, angularDamping=0.0, jointDamping=0.0
        )
    for foot in ("l_ankle", "r_ankle"):
        # Without friction anchors a standing robot creeps tens of degrees a minute.
        engine.changeDynamics(
            robot,
            links[foot],
            lateralFriction=contact.sole_friction,
            frictionAnchor=1,
            contactStiffness=contact.sole_stiffness,
            contactDamping=contact.sole_damping,
        )


def load_torso(engine: Engine, robot: int, payload: float) -> None:
    """Have the torso carry so much more mass, at its centre of mass, kg."""
    mass, _, inertia = engine.getDynamicsInfo(robot, -1)[:3]
    # With a mass alone the engine would take a new inertia from the collision shapes.
    engine.changeDynamics(robot, -1, mass=mass + payload, localInertiaDiagonal=inertia)


def limit_speeds(engine: Engine, robot: int, speeds: Mapping[int, float]) -> None:
    """Keep the motors to their top speeds: without, one that lags catches up at any speed its torque allows.

    Only the call for one joint takes a limit; the engine keeps it when everything else is set anew for all of them.

    Args:
        robot: Body id.
        speeds: Index of a joint -> its top speed, rad/s or m/s.
    """
    for index, speed in speeds.items():
        engine.setJointMotorControl2(
            robot, index, engine.POSITION_CONTROL, targetPosition=0.0, force=0.0, maxVelocity=speed
        )


def couple_hips(engine: Engine, robot: int, joints: Mapping[str, int], force: float) -> None:
    """Both HipYawPitch joints turn with one motor: a gear of ratio 1 between the two, of at most `force` N."""
    gear = engine.createConstraint(
        robot, joints["LHipYawPitch"], robot, joints["RHipYawPitch"], engine.JOINT_GEAR, (0, 1, 0), (0, 0, 0), (0, 0, 0)
    )
    engine.changeConstraint(gear, gearRatio=-1, erp=0.2, maxForce=force)
