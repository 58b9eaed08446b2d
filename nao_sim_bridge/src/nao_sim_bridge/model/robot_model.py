"""The robot as numbers: links, joints, limits and sensor places of the NAO H25, from `config/nao_h25.json`.

Every link frame sits at its parent joint and is parallel to the torso (X forward, Y left, Z up) when all
joints are zero, so joint origins are translations. All values are SI units; arrays are read-only.
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Mapping, Sequence

import numpy as np

from nao_sim_bridge.base.errors import BadValue, UnknownName

FILE = "nao_h25.json"
VERSIONS = ("V6", "V5")


@dataclass(frozen=True, eq=False)
class Link:
    """One rigid body.

    Attributes:
        name: Name of its parent joint, or `Torso`.
        alt_name: Name it has in the robot's URDF (`torso`, `LTibia`, `l_ankle`).
        parent_joint: Joint that carries it; None for the torso.
        mass: kg.
        com: (3,) centre of mass in the link frame, m.
        inertia: (3, 3) about the centre of mass, in link axes, kg m2.
    """

    name: str
    alt_name: str
    parent_joint: str | None
    mass: float
    com: np.ndarray
    inertia: np.ndarray


@dataclass(frozen=True, eq=False)
class Joint:
    """One joint of ALMotion's Body.

    Attributes:
        name: NAOqi name.
        parent_link: Link that carries it.
        child_link: Link that it moves; None for a hand, whose fingers are not bodies of the published tables.
        origin: (3,) place in the frame of the parent link, m.
        axis: (3,) unit vector in the frame of the parent link.
        lower: Lower limit, rad; a hand: 0 (closed).
        upper: Upper limit, rad; a hand: 1 (open).
        max_velocity: rad/s; a hand: 1/s.
        max_torque: N m.
        is_hand: Whether its value is an opening in [0, 1] instead of an angle.
    """

    name: str
    parent_link: str
    child_link: str | None
    origin: np.ndarray
    axis: np.ndarray
    lower: float
    upper: float
    max_velocity: float
    max_torque: float
    is_hand: bool


@dataclass(frozen=True, eq=False)
class Place:
    """A named frame fixed to a link: effector, sensor, microphone, camera.

    Attributes:
        name: Name in the tables.
        parent_link: Link that carries it.
        position: (3,) in the frame of the link, m.
        rpy: (3,) fixed-axis roll, pitch, yaw in rad (R = Rz Ry Rx).
    """

    name: str
    parent_link: str
    position: np.ndarray
    rpy: np.ndarray


@dataclass(frozen=True, eq=False)
class Camera:
    """One camera of the head; its frame has X along the optical axis, Y left, Z up.

    Attributes:
        name: `CameraTop` or `CameraBottom`.
        index: ALVideoDevice index, 0 top, 1 bottom.
        place: Frame of the camera.
        horizontal_fov: rad.
        vertical_fov: rad.
    """

    name: str
    index: int
    place: Place
    horizontal_fov: float
    vertical_fov: float


@dataclass(frozen=True, eq=False)
class CoupledLimit:
    """Limits of one joint that depend on where another one is, fast enough for every tick.

    Attributes:
        joint: Index of the joint that is limited.
        by: Index of the joint that it depends on.
        rows: (value of `by`, lower, upper) in rad, first column ascending; linear between rows.
    """

    joint: int
    by: int
    rows: Sequence[tuple[float, float, float]]

    def limits_at(self, value: float) -> tuple[float, float]:
        """Lower and upper limit in rad when the other joint is at `value` rad; the ends hold outside the table."""
        rows = self.rows
        after = bisect_right(rows, (value,))
        if after == 0:
            return rows[0][1], rows[0][2]
        if after == len(rows):
            return rows[-1][1], rows[-1][2]
        (x0, low0, high0), (x1, low1, high1) = rows[after - 1], rows[after]
        share = (value - x0) / (x1 - x0)
        return low0 + share * (low1 - low0), high0 + share * (high1 - high0)


@dataclass(frozen=True, eq=False)
class Finger:
    """One finger or thumb of either hand, in the frame of the wrist link.

    Attributes:
        name: `Finger1`, `Finger2` or `Thumb`.
        phalanges: Names of its phalanges from the palm outwards.
        base: Frame of the first phalanx at hand value 1 (straight), X along the finger.
        length: Length of one phalanx, m.
        axis: (3,) axis of each phalanx joint in its own frame; negative angles close.
        travel: Angle between open and closed of one phalanx, rad: angle = (hand value - 1) * travel.
    """

    name: str
    phalanges: tuple[str, ...]
    base: Place
    length: float
    axis: np.ndarray
    travel: float


@dataclass(frozen=True, eq=False)
class SimulatedHand:
    """The one finger body a hand has in the physics; angle = (hand value - 1) * travel.

    Attributes:
        origin: (3,) joint in the frame of the wrist link, m.
        axis: (3,) unit vector in the frame of the wrist link.
        mass: kg, part of the wrist's mass of the tables.
        com: (3,) in the frame of the finger body, m.
        inertia: (3, 3) about the centre of mass, kg m2.
        travel: rad.
        phalanx_mass: Of each of the eight phalanges where they are bodies of their own, kg.
    """

    origin: np.ndarray
    axis: np.ndarray
    mass: float
    com: np.ndarray
    inertia: np.ndarray
    travel: float
    phalanx_mass: float


@dataclass(frozen=True, eq=False)
class CollisionShape:
    """A `sphere` (length None) or a `cylinder` (axis along Z) of the published self-collision model, m."""

    place: Place
    shape: str
    radius: float
    length: float | None


@dataclass(frozen=True, eq=False)
class Motor:
    """A motor type.

    Attributes:
        model: Maker's name of the motor.
        no_load_speed: rad/s at the motor shaft.
        stall_torque: N m at the motor shaft.
        gear_ratio_of: Joint kind without side (`HipPitch`, `Hand`) to gear ratio.
    """

    model: str
    no_load_speed: float
    stall_torque: float
    gear_ratio_of: Mapping[str, float]


@dataclass(frozen=True, eq=False)
class RobotModel:
    """Everything the tables say about one version of the robot.

    Attributes:
        version: `V6` or `V5`.
        joints: The 26 joints in the order of ALMotion's Body.
        joint_index: Joint name to its index in `joints`.
        chains: Name of a chain or group of joints to its joint names.
        chain_names: The five kinematic chains.
        links: The 25 links; a parent comes before its children.
        coupled_limits: Limited joint name to its coupled limit, in the order of the joints.
        effectors: End transforms of the chains and the torso, by name.
        fsr: The eight foot pressure sensors.
        imu: Places of `Accelerometer` and `Gyrometer`, by name.
        sonars: Left and right sonar.
        cameras: Top and bottom camera.
        touch: Touch sensors, bumpers and chest button.
        microphones: Microphones of the V6 head.
        loudspeakers: Left and right loudspeaker.
        infrared: Places of the infrared pair; the V6 keeps the frames, not the parts.
        fingers: Fingers and thumb, the same for both hands.
        simulated_hand: The finger body of the physics.
        collision_shapes: Published self-collision shapes.
        motors: Motor types.
        sole_height: Sole below the ankle roll axis, m.
        sole_contour: (n, 2) outline of the left sole in the ankle frame, counter-clockwise, m.
        total_mass: kg.
    """

    version: str
    joints: tuple[Joint, ...]
    joint_index: Mapping[str, int]
    chains: Mapping[str, tuple[str, ...]]
    chain_names: tuple[str, ...]
    links: tuple[Link, ...]
    coupled_limits: Mapping[str, CoupledLimit]
    effectors: Mapping[str, Place]
    fsr: tuple[Place, ...]
    imu: Mapping[str, Place]
    sonars: tuple[Place, ...]
    cameras: tuple[Camera, ...]
    touch: tuple[Place, ...]
    microphones: tuple[Place, ...]
    loudspeakers: tuple[Place, ...]
    infrared: tuple[Place, ...]
    fingers: tuple[Finger, ...]
    simulated_hand: SimulatedHand
    collision_shapes: tuple[CollisionShape, ...]
    motors: tuple[Motor, ...]
    sole_height: float
    sole_contour: np.ndarray
    total_mass: float

    def joint(self, name: str) -> Joint:
        return self.joints[self.joint_index[name]]

    def link(self, name: str) -> Link:
        return next(link for link in self.links if link.name == name)

    def limits_array(self) -> np.ndarray:
        """(26, 2) lower and upper limits in Body order, rad (hands 0 and 1), read-only."""
        limits = np.array([(joint.lower, joint.upper) for joint in self.joints])
        limits.flags.writeable = False
        return limits

    def sole_polygon(self, side: str) -> np.ndarray:
        """(n, 2) outline of the sole of `L` or, mirrored, `R` in its ankle roll frame, counter-clockwise, m."""
        if side == "L":
            return self.sole_contour
        polygon = (self.sole_contour * (1.0, -1.0))[::-1]
        polygon.flags.writeable = False
        return polygon


def joint_kind(joint: str) -> str:
    """Name of a joint without its side (`HipPitch`)."""
    return joint[1:] if joint[0] in "LR" else joint


def frozen_mapping(entries: Mapping) -> Mapping:
    """A read-only view of a copy of the mapping."""
    return MappingProxyType(dict(entries))


def joint_names(names: Any, model: RobotModel) -> list[str]:
    """Joint names behind a joint, a chain, or a list of both, in order.

    Raises:
        UnknownName: A name is neither a joint nor a chain.
        BadValue: `names` is no string and no list, or empty, or holds something else than strings.
    """
    if isinstance(names, str):
        names = [names]
    if not isinstance(names, (list, tuple)) or not names:
        raise BadValue("names", names, "a joint, a chain, or a list of them")
    found: list[str] = []
    for name in names:
        if not isinstance(name, str):
            raise BadValue("names", name, "the name of a joint or of a chain")
        if name in model.joint_index:
            found.append(name)
        elif name in model.chains and all(n in model.joint_index for n in model.chains[name]):
            found.extend(model.chains[name])
        else:
            raise UnknownName("joint or chain", name, [*model.joint_index, *model.chains])
    return found
