"""What follows from the raw readings of the whole body: foot forces, touch, motor currents. Without state."""

from __future__ import annotations

import math
from typing import Callable, Dict, Iterable, List, Mapping, NamedTuple, Sequence, Tuple

from nao_sim_bridge.base.readings import Contact, FootForces, Pose
from nao_sim_bridge.base.settings import Settings
from nao_sim_bridge.body.sensors.power import Motors
from nao_sim_bridge.model.robot_model import Place, RobotModel

# Share of a push along the Z axis from which on it comes from below.
FROM_BELOW = 0.5

# A contact this near to the middle of a sensor presses it, in m: the sensors are about 4 cm wide.
REACH = 0.022
# A finger between two sensors of one part touches both when it is this much nearer to one of them at most, in m.
OVERLAP = 0.001
# Bumpers are pressed from the front or the side, not by the floor under the sole.
BUMPER_MAX_UPWARD = 0.5
# The two bumpers of a foot meet at the tip: what hits less than this beside it, in m, presses both.
BUMPER_OVERLAP = 0.008
UNLOADED = FootForces()


class Press(NamedTuple):
    """One contact, in the frame of the link that it presses on.

    Attributes:
        x: Where, m.
        y: Where, m.
        z: Where, m.
        upward: Share of the push that goes along the link's Z axis, -1..1.
        force: N.
    """

    x: float
    y: float
    z: float
    upward: float
    force: float


Presses = Dict[int, List[Press]]
Felt = Callable[[Press], Iterable[str]]


def in_link_frames(contacts: Sequence[Contact], poses: Mapping[int, Pose]) -> Presses:
    """Contacts by link index; `poses` are those of the link frames in world."""
    presses: Presses = {}
    frames: dict[int, tuple] = {}
    for link, position, normal, force in contacts:
        frame = frames.get(link)
        if frame is None:
            frame = frames[link] = _axes(poses[link])
            presses[link] = []
        (ox, oy, oz), (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = frame
        px, py, pz = position[0] - ox, position[1] - oy, position[2] - oz
        presses[link].append(
            Press(
                px * xx + py * xy + pz * xz,
                px * yx + py * yy + pz * yz,
                px * zx + py * zy + pz * zz,
                normal[0] * zx + normal[1] * zy + normal[2] * zz,
                force,
            )
        )
    return presses


def not_from_below(contacts: Sequence[Contact], poses: Mapping[int, Pose]) -> list[Contact]:
    """Contacts but those that push along the Z axis of their link; without the work of turning them into its frame."""
    up: dict[int, tuple[float, float, float]] = {}
    kept = []
    for contact in contacts:
        link = contact[0]
        axis = up.get(link)
        if axis is None:
            x, y, z, w = poses[link].orientation
            axis = up[link] = (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y))
        normal = contact[2]
        if normal[0] * axis[0] + normal[1] * axis[1] + normal[2] * axis[2] <= FROM_BELOW:
            kept.append(contact)
    return kept


def _axes(pose: Pose) -> tuple:
    """Origin of a frame and its three unit vectors, in world."""
    x, y, z, w = pose.orientation
    return (
        pose.position,
        (1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
        (2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)),
        (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)),
    )


class TouchSensors:
    """All touch sensors, bumpers and the chest button: pressed by what really presses on them.

    Args:
        link_of: Name of a model link to PyBullet's link index.
    """

    def __init__(self, model: RobotModel, link_of: Callable[[str], int]) -> None:
        self.names = tuple(place.name for place in model.touch)
        self._felt: dict[int, Felt] = {}
        for link in {place.parent_link for place in model.touch}:
            places = [place for place in model.touch if place.parent_link == link]
            bumpers = all("/Bumper/" in place.name for place in places)
            self._felt[link_of(link)] = _toes(places) if bumpers else _pads(places)

    def read(self, presses: Presses) -> frozenset[str]:
        return frozenset(
            name
            for link in self._felt.keys() & presses.keys()
            for press in presses[link]
            for name in self._felt[link](press)
        )


def _pads(places: Sequence[Place]) -> Felt:
    """Sensors side by side, each a little larger than the place that is nearer to it than to the others."""
    middles = [(place.name, *map(float, place.position)) for place in places]

    def felt(at: Press) -> List[str]:
        distances = [(math.dist((at.x, at.y, at.z), middle), name) for name, *middle in middles]
        limit = min(REACH, min(distances)[0] + OVERLAP)
        return [name for distance, name in distances if distance <= limit]

    return felt


def _toes(pair: Sequence[Place]) -> Felt:
    """The shell round the toes, from a little behind the middle of the bumpers to the tip; each has its side of it."""
    rear = min(float(place.position[0]) for place in pair) - REACH
    tip = sum(float(place.position[1]) for place in pair) / len(pair)
    sides = [(place.name, 1.0 if place.position[1] > tip else -1.0) for place in pair]

    def felt(at: Press) -> List[str]:
        if abs(at.upward) > BUMPER_MAX_UPWARD or at.x < rear:
            return []
        return [name for name, side in sides if side * (at.y - tip) >= -BUMPER_OVERLAP]

    return felt


class FootSensors:
    """The four sensors of one foot.

    A force between the sensors is shared out bilinearly, as a stiff sole on four springs does; one outside their
    rectangle loads the nearest edge.
    """

    def __init__(self, model: RobotModel, side: str) -> None:
        # Plain floats: the forces go over the network, which knows no numpy.
        place = {p.name: p.position.tolist() for p in model.fsr if p.name.startswith(f"{side}Foot/")}
        corners = [place[f"{side}Foot/FSR/{name}"] for name in ("FrontLeft", "FrontRight", "RearLeft", "RearRight")]
        self._front = (corners[0][0] + corners[1][0]) / 2
        self._rear = (corners[2][0] + corners[3][0]) / 2
        self._front_y = (corners[0][1], corners[1][1])
        self._rear_y = (corners[2][1], corners[3][1])

    def read(self, presses: Iterable[Press]) -> FootForces:
        """Forces of what presses on this foot, in the ankle roll frame."""
        front_left = front_right = rear_left = rear_right = 0.0
        moment_x = moment_y = total = 0.0
        for x, y, _, upward, force in presses:
            load = force * upward
            if load <= 0.0:
                continue
            to_front = load * _share(x, self._rear, self._front)
            to_rear = load - to_front
            left = to_front * _share(y, self._front_y[1], self._front_y[0])
            front_left += left
            front_right += to_front - left
            left = to_rear * _share(y, self._rear_y[1], self._rear_y[0])
            rear_left += left
            rear_right += to_rear - left
            total += load
            moment_x += load * x
            moment_y += load * y
        if total == 0.0:
            return UNLOADED
        forces = (front_left, front_right, rear_left, rear_right)
        return FootForces(forces, total, (moment_x / total, moment_y / total))


def _share(value: float, low: float, high: float) -> float:
    """How far `value` is from `low` towards `high`, 0..1."""
    if value <= low:
        return 0.0
    return 1.0 if value >= high else (value - low) / (high - low)


class BodySensors:
    """Sensors that are pure functions of contacts and torques.

    Attributes:
        touch_names: Names of all touch sensors.
        motors: What the motors draw.

    Args:
        links: URDF link name to PyBullet's link index; a name that is not there is the torso.
    """

    def __init__(self, model: RobotModel, settings: Settings, links: Mapping[str, int]) -> None:
        self._feet = {side: FootSensors(model, side) for side in "LR"}
        self._ankles = {side: links[f"{side.lower()}_ankle"] for side in "LR"}
        self._touch = TouchSensors(model, lambda name: links.get(model.link(name).alt_name, -1))
        self.motors = Motors(model, settings)
        self.touch_names = self._touch.names

    def foot_forces(self, side: str, presses: Presses) -> FootForces:
        """Force sensors of the foot of `side`, "L" or "R"."""
        return self._feet[side].read(presses.get(self._ankles[side], ()))

    def foot_loads(self, contacts: Sequence[Contact]) -> Tuple[float, float]:
        """Upward force on the left and on the right foot, N: at the price of a sum, without the single sensors."""
        left = right = 0.0
        for link, _, normal, force in contacts:
            if link == self._ankles["L"]:
                left += force * normal[2]
            elif link == self._ankles["R"]:
                right += force * normal[2]
        return left, right

    def touched(self, presses: Presses) -> frozenset:
        """Names of the touch sensors that something presses."""
        return self._touch.read(presses)
