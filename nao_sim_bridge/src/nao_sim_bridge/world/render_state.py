"""What a picture shows, and where the camera is: small values, and how they go to another process."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Optional, Tuple

import numpy as np

from nao_sim_bridge.base.errors import BadValue, UnknownName
from nao_sim_bridge.base.readings import Pose
from nao_sim_bridge.base.rotations import Quaternion, Vector3, vector3
from nao_sim_bridge.model.kinematics import finger_transforms, link_transforms, quaternion_matrix, transform
from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.world.world import WorldObject

Placed = Tuple[WorldObject, ...]


@dataclass(frozen=True)
class RobotLook:
    """What a robot looks like at one moment.

    Attributes:
        base_position: Torso frame in world, m.
        base_orientation: Of the torso frame in world, quaternion (x, y, z, w).
        joint_positions: (26,) in Body order, rad (hands 0..1).
        led_values: (89,) intensities 0..1 in the order of the LED layout's devices.
    """

    base_position: Vector3
    base_orientation: Quaternion
    joint_positions: tuple[float, ...]
    led_values: tuple[float, ...]


@dataclass(frozen=True)
class RenderState(RobotLook):
    """Everything that can change between two pictures of one world; the robot itself first.

    Attributes:
        objects: Poses in world of movable and of placed objects, by name; others stay where they are.
        placed: Things that were added to those of the world.
        gone: Names of things of the world that were taken away.
        others: Further robots, of the same version.
    """

    objects: Mapping[str, Pose] = field(default_factory=dict)
    placed: tuple[WorldObject, ...] = ()
    gone: frozenset[str] = frozenset()
    others: tuple[RobotLook, ...] = ()


@dataclass(frozen=True)
class Camera:
    """A camera in world.

    Attributes:
        eye: Where it is, m.
        target: What it looks at, m.
        up: Direction that is up in the picture.
        fov: Vertical field of view, rad.
        supersampling: 1 is fastest; 2 draws four pixels for each and has smooth edges.
        shadows: Whether things throw shadows; a third faster without.
    """

    eye: Vector3
    target: Vector3
    up: Vector3 = (0.0, 0.0, 1.0)
    fov: float = math.radians(40.0)
    width: int = 640
    height: int = 480
    supersampling: int = 1
    shadows: bool = True

    def __post_init__(self) -> None:
        if self.eye == self.target:
            raise BadValue("camera target", self.target, "any point but the eye")
        if not 0.0 < self.fov < math.pi:
            raise BadValue("camera fov", self.fov, "above 0 and below pi rad")
        if self.width < 1 or self.height < 1 or not 1 <= self.supersampling <= 4:
            size = (self.width, self.height, self.supersampling)
            raise BadValue("camera size and supersampling", size, "1 or more pixels, supersampling 1..4")


@dataclass(frozen=True)
class _View:
    """A preset: eye and target in the frame of what it follows, m.

    "body", "head"; "world" follows nothing; "robots" is the middle of all robots, with a metre as long as all need.
    """

    follows: str
    eye: Vector3
    target: Vector3
    fov_deg: float


PRESETS: Mapping[str, _View] = {
    "front": _View("body", (1.05, 0.0, 0.06), (0.0, 0.0, -0.045), 38.0),
    "three_quarter": _View("body", (0.86, 0.52, 0.22), (0.0, 0.0, -0.05), 38.0),
    "side": _View("body", (0.02, 1.05, 0.06), (0.02, 0.0, -0.045), 38.0),
    "back": _View("body", (-1.0, -0.3, 0.2), (0.0, 0.0, -0.05), 38.0),
    "stage": _View("body", (1.2, 0.57, 0.27), (0.0, 0.0, 0.01), 38.0),
    "far": _View("body", (2.4, 1.5, 0.9), (0.0, 0.0, -0.1), 38.0),
    "room": _View("world", (-2.1, -3.0, 2.8), (0.95, 0.03, 0.0), 42.0),
    "robots": _View("robots", (1.15, -2.55, 1.2), (0.0, 0.0, 0.15), 38.0),
    "face": _View("head", (0.36, 0.09, 0.07), (0.0, 0.0, 0.056), 26.0),
}
"""Views by name. Those of the body turn with its heading only, the view of the face with the head; that of the room
stays where it is, and that of the robots shows all of them."""


def preset_camera(
    name: str,
    model: RobotModel,
    state: RenderState,
    width: int = 640,
    height: int = 480,
    supersampling: int = 2,
) -> Camera:
    """A camera that shows the robot where it is, from a view of `PRESETS`.

    Raises:
        UnknownName: If there is no such view.
    """
    if name not in PRESETS:
        raise UnknownName("view", name, PRESETS)
    view = PRESETS[name]
    base = transform(quaternion_matrix(state.base_orientation), state.base_position)
    if view.follows == "head":
        frame = base @ link_transforms(model, state.joint_positions)["HeadPitch"]
    elif view.follows == "body":
        frame = _upright(base)
    else:
        frame = np.eye(4) if view.follows == "world" else _around_all(state)
    eye, target = (frame @ np.append(point, 1.0) for point in (view.eye, view.target))
    up = frame[:3, 2] if view.follows == "head" else np.array((0.0, 0.0, 1.0))
    places = (vector3(eye[:3]), vector3(target[:3]), vector3(up))
    return Camera(*places, math.radians(view.fov_deg), width, height, supersampling)


def _around_all(state: RenderState) -> np.ndarray:
    """The middle of all robots on the floor, enlarged until they fit into a circle of 1 m around it."""
    places = np.array([look.base_position[:2] for look in (state, *state.others)])
    center = (places.min(axis=0) + places.max(axis=0)) / 2.0
    reach = float(np.linalg.norm(places - center, axis=1).max())
    frame = np.diag([max(reach + 0.1, 0.6)] * 3 + [1.0])
    frame[:2, 3] = center
    return frame


def _upright(base: np.ndarray) -> np.ndarray:
    """The frame of the torso turned upright; a lying robot's heading is that of its Z axis."""
    forward = base[:3, 0] if abs(base[2, 0]) < 0.9 else base[:3, 2]
    yaw = math.atan2(forward[1], forward[0])
    c, s = math.cos(yaw), math.sin(yaw)
    return transform(np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]), base[:3, 3])


def frames_in_world(model: RobotModel, look: RobotLook) -> dict[str, np.ndarray]:
    """(4, 4) pose of each link by name, and of each phalanx by side and name, as `LFinger11`."""
    base = transform(quaternion_matrix(look.base_orientation), look.base_position)
    poses = {name: base @ pose for name, pose in link_transforms(model, look.joint_positions).items()}
    for joint, position in zip(model.joints, look.joint_positions):
        if joint.is_hand:
            for phalanx, pose in finger_transforms(model, position).items():
                poses[joint.name[0] + phalanx] = poses[joint.parent_link] @ pose
    return poses


Packed = Tuple[RenderState, Optional[Placed]]


class StateSender:
    """The end that sends; one for each process that receives. What was placed goes over only when it has changed."""

    def __init__(self) -> None:
        self._sent: Placed = ()

    def pack(self, state: RenderState) -> Packed:
        news = None if state.placed is self._sent else state.placed
        self._sent = state.placed
        return replace(state, placed=()), news


class StateReceiver:
    """The end that receives."""

    def __init__(self) -> None:
        self._placed: Placed = ()

    def unpack(self, packed: Packed) -> RenderState:
        """The state that was sent; what was placed is the same tuple until it changes."""
        state, placed = packed
        if placed is not None:
            self._placed = placed
        return replace(state, placed=self._placed)
