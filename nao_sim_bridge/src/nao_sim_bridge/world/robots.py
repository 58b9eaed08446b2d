"""Other NAOs in a world, that stand still. `position` is on the floor, below the torso; they look along X.

`nao` is the name of a posture; `color` is that of the coloured shells, `leds` the light of eyes, ears, head and chest.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np

from nao_sim_bridge.base.errors import UnknownName
from nao_sim_bridge.model.appearance import OFF, load_appearance
from nao_sim_bridge.model.kinematics import finger_transforms, link_transforms, matrix_rpy, rpy_matrix, transform
from nao_sim_bridge.model.meshes import tessellate
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.postures import posture, start_pitch
from nao_sim_bridge.model.shapes import Shape, rod
from nao_sim_bridge.world.entries import Kind, Made, color
from nao_sim_bridge.world.world import Part, WorldError

SHELL, SHELL_COLOR = "shell", (0.16, 0.42, 0.72)
LIMBS = (
    ("HipPitch", "KneePitch", 0.045),
    ("KneePitch", "AnklePitch", 0.040),
    ("ShoulderPitch", "ElbowYaw", 0.035),
    ("ElbowYaw", "WristYaw", 0.030),
)
"""Links between whose frames a limb is, and its radius, m."""
FEET_ROOM = Shape("box", (0.15, 0.08, 0.05), (0.02, 0.0, -0.02))
TORSO_ROOM = Shape("box", (0.13, 0.16, 0.22), (-0.01, 0.0, 0.03))
HEAD_ROOM = Shape("sphere", (0.068,), (0.0, 0.0, 0.055))


def _make(entry: Mapping[str, Any], where: str, _files: object) -> Made:
    try:
        shapes, lamps, body = _figure(str(entry["nao"]))
    except UnknownName as error:
        raise WorldError(f"{where}.nao", str(error)) from error
    colors = {**load_appearance().materials, SHELL: color(entry, "color", where, SHELL_COLOR)}
    light = color(entry, "leds", where, colors[OFF])
    parts = [Part(shape, colors[shape.material]) for shape in shapes]
    parts += [Part(shape, light, shining="leds" in entry) for shape in lamps]
    return Made(tuple(parts), body)


@lru_cache(maxsize=None)
def _figure(name: str) -> tuple[tuple[Shape, ...], tuple[Shape, ...], tuple[Shape, ...]]:
    """Shapes, lamps and body of a NAO in a posture, on the floor."""
    model, looks = load_model(), load_appearance()
    angles = posture(model, name)
    lean = transform(rpy_matrix((0.0, start_pitch(name) or 0.0, 0.0)), (0.0, 0.0, 0.0))
    poses = {link: lean @ pose for link, pose in link_transforms(model, angles).items()}
    shapes = [_put(shape, poses[link]) for link, listed in looks.shapes.items() for shape in listed]
    for index, joint in enumerate(model.joints):
        if joint.is_hand:
            for pose in finger_transforms(model, angles[index]).values():
                shapes += [_put(shape, poses[joint.parent_link] @ pose) for shape in looks.phalanx]
    lamps = [_put(lamp.shape, poses[lamp.link]) for lamp in looks.lamps]
    lowest = min(tessellate(shape).placed(shape).vertices[:, 2].min() for shape in shapes)
    lift = lambda listed: tuple(shape.moved((0.0, 0.0, -lowest)) for shape in listed)  # noqa: E731
    return lift(shapes), lift(lamps), lift(_body(poses))


def _body(poses: Mapping[str, np.ndarray]) -> list[Shape]:
    """A few shapes that take up the room of the robot."""
    body = [_put(TORSO_ROOM, poses["Torso"]), _put(HEAD_ROOM, poses["HeadPitch"])]
    for side in ("L", "R"):
        body.append(_put(FEET_ROOM, poses[side + "AnkleRoll"]))
        for start, end, radius in LIMBS:
            ends = (poses[side + link][:3, 3] for link in (start, end))
            body.append(rod("capsule", radius, *ends))
    return body


def _put(shape: Shape, pose: np.ndarray) -> Shape:
    """A shape of a link's frame in the frame that the pose is in."""
    place = pose @ transform(rpy_matrix(shape.rpy), shape.xyz)
    return replace(shape, xyz=tuple(place[:3, 3].tolist()), rpy=matrix_rpy(place[:3, :3]))


NAO = Kind(("color", "leds"), _make)
