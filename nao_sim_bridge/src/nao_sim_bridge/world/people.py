"""People who stand in a world: simple figures with a face.

`position` is on the floor, between the feet; they look along X of the thing. `person` is one of the names of
`config/faces.json`; `height` in m, `clothes` and `trousers` are colours. `nod` is how far the head is bent down, rad;
if it is not told, about as far as people do it who look at a robot some steps away.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from nao_sim_bridge.model.kinematics import rpy_matrix
from nao_sim_bridge.model.shapes import Shape, rod
from nao_sim_bridge.world.entries import Kind, Made, color, number, picture
from nao_sim_bridge.world.painting.known_faces import HEAD_HALF_HEIGHT, FaceLook, load_faces
from nao_sim_bridge.world.pictures import WorldPicture
from nao_sim_bridge.world.world import Color, Part

SHORTEST, TALLEST, USUAL = 0.9, 1.9, 1.65
TROUSERS, SHOES = (0.22, 0.24, 0.30), (0.12, 0.11, 0.11)
HEAD_HALF_WIDTH, HEAD_HALF_DEPTH = 0.077, 0.094
"""Of somebody of the usual height, m; the head of a child is larger for its height."""

LOOKED_AT, LOOK_DISTANCE, SHARE_OF_NOD = 0.47, 1.7, 0.7
"""Height and distance of what people look at, m, and how much of the way down the head goes; the eyes do the rest."""
MOST_NOD = 0.9


def _make(entry: Mapping[str, Any], where: str, _files: object) -> Made:
    shown = picture("head", entry["person"], f"{where}.person")
    look = load_faces()[shown.content]
    height = number(entry, "height", where, USUAL, SHORTEST, TALLEST)
    scale = height / USUAL
    head_scale = 0.45 + 0.55 * scale
    half_height = HEAD_HALF_WIDTH * HEAD_HALF_HEIGHT * head_scale
    head_middle = height - half_height
    clothes, trousers = color(entry, "clothes", where, look.clothes), color(entry, "trousers", where, TROUSERS)
    parts, body = _trunk(scale, clothes, trousers, look.skin)
    # The neck takes up what a larger head leaves.
    chin = head_middle - half_height * 0.7
    parts.append(Part(_rod(0.050 * scale, (-0.012, 0, 1.36 * scale), (-0.008, 0, chin)), look.skin))
    half_axes = (HEAD_HALF_DEPTH * head_scale, HEAD_HALF_WIDTH * head_scale, half_height)
    usual = SHARE_OF_NOD * math.atan2(head_middle - LOOKED_AT, LOOK_DISTANCE)
    nod = number(entry, "nod", where, usual, -MOST_NOD, MOST_NOD)
    parts += [_nodding(part, (0.0, 0.0, chin), nod) for part in _head(look, shown, half_axes, head_middle)]
    body.append(Shape("sphere", (half_height,), (0.0, 0.0, head_middle)))
    return Made(tuple(parts), tuple(body))


def _trunk(scale: float, clothes: Color, trousers: Color, skin: Color) -> tuple[list[Part], list[Shape]]:
    """Everything below the neck: what is to be seen, and what is to be felt."""

    def solid(kind: str, size: tuple, place: tuple) -> Shape:
        return Shape(kind, tuple(edge * scale for edge in size), tuple(way * scale for way in place))

    parts, body = [], []
    for side in (-1.0, 1.0):
        hip, knee, ankle = ((x * scale, side * y * scale, z * scale) for x, y, z in _LEG)
        shoulder, elbow, wrist = ((x * scale, side * y * scale, z * scale) for x, y, z in _ARM)
        parts += [
            Part(solid("pillow", (0.25, 0.10, 0.09), (0.045, side * 0.10, 0.045)), SHOES),
            Part(_rod(0.062 * scale, ankle, knee), trousers),
            Part(_rod(0.078 * scale, knee, hip), trousers),
            Part(_rod(0.052 * scale, shoulder, elbow), clothes),
            Part(_rod(0.042 * scale, elbow, wrist), clothes),
            Part(solid("ellipsoid", (0.035, 0.022, 0.065), (0.045, side * 0.232, 0.76)), skin),
        ]
        body.append(_rod(0.075 * scale, (0.0, side * 0.10 * scale, 0.076 * scale), hip))
        body.append(_rod(0.045 * scale, shoulder, wrist))
    parts += [
        Part(solid("ellipsoid", (0.115, 0.170, 0.130), (0.0, 0.0, 0.90)), trousers),
        Part(solid("pillow", (0.23, 0.34, 0.46), (0.0, 0.0, 1.12)), clothes),
        Part(solid("ellipsoid", (0.095, 0.195, 0.085), (-0.01, 0.0, 1.31)), clothes),
    ]
    body.append(_rod(0.14 * scale, (0.0, 0.0, 0.95 * scale), (0.0, 0.0, 1.25 * scale)))
    return parts, body


_LEG = ((0.0, 0.095, 0.86), (0.01, 0.10, 0.47), (-0.005, 0.10, 0.09))
_ARM = ((0.0, 0.188, 1.32), (-0.02, 0.222, 1.06), (0.03, 0.232, 0.83))


def _head(look: FaceLook, face: WorldPicture, half_axes: tuple[float, float, float], middle: float) -> list[Part]:
    hair = look.skin if look.hair_style == "bald" else look.hair
    parts = [Part(Shape("ellipsoid", half_axes, (0.0, 0.0, middle)), hair, face)]
    for side in (-1.0, 1.0):
        ear = Shape("ellipsoid", (0.018, 0.010, 0.028), (-0.005, side * half_axes[1] * 1.03, middle - 0.012))
        parts.append(Part(ear, look.skin))
    return parts + _hair(look, half_axes, middle)


def _nodding(part: Part, neck: tuple[float, float, float], nod: float) -> Part:
    """A part of the head turned about the neck."""
    turned = rpy_matrix((0.0, nod, 0.0)) @ np.subtract(part.shape.xyz, neck) + neck
    return replace(part, shape=replace(part.shape, xyz=tuple(turned.tolist()), rpy=(0.0, nod, 0.0)))


def _hair(look: FaceLook, half_axes: tuple[float, float, float], middle: float) -> list[Part]:
    """Hair that stands off the head; it leaves the face free."""
    if look.hair_style == "bald":
        return []
    depth, width, height = half_axes
    more = 1.16 if look.hair_style == "curly" else 1.06
    cap = Shape("ellipsoid", (depth * 0.97, width * more, height * 1.02), (-depth * 0.24, 0.0, middle + height * 0.10))
    parts = [Part(cap, look.hair)]
    if look.hair_style in ("long", "fringe"):
        length = 1.9 if look.hair_style == "long" else 1.25
        fall = Shape(
            "pillow",
            (depth * 0.95, width * 2.16, height * length),
            (-depth * 0.52, 0.0, middle + height * (0.75 - length / 2.0)),
        )
        parts.append(Part(fall, look.hair))
    return parts


def _rod(radius: float, start: tuple, end: tuple) -> Shape:
    return rod("capsule", radius, np.array(start, dtype=float), np.array(end, dtype=float))


PERSON = Kind(("height", "clothes", "trousers", "nod"), _make)
