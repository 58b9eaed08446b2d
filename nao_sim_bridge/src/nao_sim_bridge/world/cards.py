"""Cards with something to be seen on them: landmarks, codes, faces, posters, pictures from files.

`position` is the middle of the picture, which faces along X of the thing: with `heading: 3.1416` it faces the robot at
its start. `size`, in m, is the diameter of the disc of a landmark, the edge of a QR code with its margin, the width of
everything else. With `stand: true` the card stands on the floor by a foot, else it hangs where it is.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any, Callable

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.model.shapes import Shape
from nao_sim_bridge.world.entries import Kind, Made, color, number, picture, truth
from nao_sim_bridge.world.painting.known_landmarks import load_landmarks
from nao_sim_bridge.world.pictures import aspect
from nao_sim_bridge.world.world import Part, WorldError

THICKNESS = 0.006
SMALLEST, LARGEST = 0.01, 4.0
POLE_RADIUS, FOOT_RADIUS, FOOT_HEIGHT = 0.010, 0.07, 0.012
CARD, STAND = (0.92, 0.92, 0.90), (0.30, 0.31, 0.33)
SIZES = {"qr": 0.15, "barcode": 0.20, "face": 0.22, "poster": 0.50, "image": 0.40}
"""Sizes of cards without one of their own, m; a face has about that of a person."""


def _make(kind: str, entry: Mapping[str, Any], where: str, files: Callable[[str], Path]) -> Made:
    content, place = entry[kind], f"{where}.{kind}"
    shown = picture("file", str(files(str(content))), place) if kind == "image" else picture(kind, content, place)
    default = load_landmarks().diameter if kind == "landmark" else SIZES[kind]
    size = number(entry, "size", where, default, SMALLEST, LARGEST)
    width = size * (1.0 + load_landmarks().margin) if kind == "landmark" else size
    try:
        height = width / aspect(shown)
    except BadValue as error:
        raise WorldError(place, str(error)) from error
    card = Shape("box", (THICKNESS, width, height), (0.0, 0.0, 0.0))
    parts = (Part(card, color(entry, "color", where, CARD), shown),)
    if truth(entry, "stand", where):
        parts += _stand(entry, where, height)
    return Made(parts)


def _stand(entry: Mapping[str, Any], where: str, height: float) -> tuple[Part, ...]:
    """A foot on the floor and a pole behind the card."""
    middle = float(entry["position"][2])
    if middle - height / 2.0 < 0.0:
        raise WorldError(f"{where}.position", f"has z {middle:g}: a card of {height:.3g} m on a stand needs half of it")
    top = height * 0.25
    behind = -(THICKNESS / 2.0 + POLE_RADIUS)
    pole = Shape("cylinder", (POLE_RADIUS, middle + top), (behind, 0.0, (top - middle) / 2.0))
    foot = Shape("cylinder", (FOOT_RADIUS, FOOT_HEIGHT), (behind, 0.0, FOOT_HEIGHT / 2.0 - middle))
    return Part(pole, STAND), Part(foot, STAND)


CARDS: Mapping[str, Kind] = {
    kind: Kind(("size", "stand", "color"), partial(_make, kind))
    for kind in ("landmark", "qr", "barcode", "face", "poster", "image")
}
"""Kinds of cards by the key that says what is on them."""
