"""Contacts of the robot sorted by link and turned into link frames."""

from __future__ import annotations

from typing import Dict, List, Mapping, NamedTuple, Sequence

from nao_sim_bridge.base.readings import Contact, Pose


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


# Share of a push along the Z axis from which on it comes from below.
FROM_BELOW = 0.5

Presses = Dict[int, List[Press]]


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
