"""Pictures on things of a world: marks, codes, faces, posters, wood and cloth, and files.

What is on a thing is a small value; who draws the world paints it when it is needed, and keeps it.
"""

from __future__ import annotations

import io
import logging
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np

from nao_sim_bridge.base.config import read_bounded
from nao_sim_bridge.base.errors import BadValue, UnknownName
from nao_sim_bridge.base.sizes import load_sizes

log = logging.getLogger("nao_sim.pictures")

DECODED = ("JPEG", "PNG", "WEBP")
"""Kinds of picture files."""
KINDS = ("landmark", "qr", "barcode", "face", "head", "poster", "pattern", "file")
POSTERS = ("hills", "circles", "leaves", "waves", "city", "planets")
PATTERNS = ("oak", "walnut", "pine", "checks", "stripes", "weave", "books", "window", "bricks")
CODE128 = "code128:"
"""Begins the content of a barcode that is not an article number."""
LONGEST_QR, LONGEST_BARCODE = 300, 40
MOST_PIXELS = 2048
"""Edge of a picture, at most: larger files are made smaller."""
KEPT = 64
GREY = 128
ASPECTS = {"landmark": 1.0, "qr": 1.0, "face": 0.8, "poster": 0.75, "pattern": 1.0}
"""Width over height of the kinds that always have the same."""


@dataclass(frozen=True)
class WorldPicture:
    """What is to be seen on a thing.

    Attributes:
        kind: One of `KINDS`.
        content: landmark: its number. qr: a text. barcode: the 12 or 13 digits of an article number (EAN-13), or
            `code128:` and up to 40 characters. face: name of somebody, seen as a portrait with hair and shoulders.
            head: likewise, what is projected onto the front of a head. poster, pattern: name. file: path of a picture.

    Raises:
        UnknownName: There is no such kind, number, person, poster or pattern.
        BadValue: The content does not fit into a code, or the file is no picture.
    """

    kind: str
    content: str

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise UnknownName("kind of picture", self.kind, KINDS)
        _check(self.kind, self.content)


def barcode(content: str) -> tuple[str, str]:
    """Format and text of a barcode's content.

    Raises:
        BadValue: It is neither.
    """
    if content.startswith(CODE128):
        text = content[len(CODE128) :]
        if not 1 <= len(text) <= LONGEST_BARCODE or not all(" " <= letter <= "~" for letter in text):
            raise BadValue("barcode", content, f"{CODE128} and 1 to {LONGEST_BARCODE} printable ASCII characters")
        return "Code128", text
    if not (content.isascii() and content.isdigit() and len(content) in (12, 13)):
        raise BadValue("barcode", content, f"the 12 or 13 digits of an article number, or {CODE128} and a text")
    check = -sum(int(digit) * (3 if place % 2 else 1) for place, digit in enumerate(content[:12])) % 10
    if len(content) == 13 and int(content[12]) != check:
        raise BadValue("barcode", content, f"an article number; the check digit of this one would be {check}")
    return "EAN13", content[:12] + str(check)


@lru_cache(maxsize=KEPT)
def paint(picture: WorldPicture) -> np.ndarray:
    """The picture, (h, w, 3) uint8, first row on top; read-only, painted once.

    A file that cannot be read any more is grey: a camera must not go blind because of a file that somebody removed.
    """
    try:
        painted = _paint(picture.kind, picture.content)
    except BadValue as error:
        log.warning("a thing of the world is grey: %s", error)
        painted = np.full((8, 8, 3), GREY, np.uint8)
    painted.flags.writeable = False
    return painted


def aspect(picture: WorldPicture) -> float:
    """Width of a picture over its height; nothing is painted for it that takes long.

    Raises:
        BadValue: Its file cannot be read.
    """
    if picture.kind in ASPECTS:
        return ASPECTS[picture.kind]
    height, width = _paint(picture.kind, picture.content).shape[:2]
    return width / height


def _check(kind: str, content: str) -> None:
    """Raise an error unless the content can be painted. What paints is not loaded: the physics has no use for it."""
    if kind == "landmark":
        from nao_sim_bridge.world.painting.known_landmarks import load_landmarks

        known = [str(number) for number in load_landmarks().marks]
        if content not in known:
            raise BadValue("landmark", content, f"one of {', '.join(known)}")
    elif kind == "qr":
        if not 1 <= len(content.encode("utf-8")) <= LONGEST_QR:
            raise BadValue("qr", content, f"1 to {LONGEST_QR} bytes of text")
    elif kind == "barcode":
        barcode(content)
    elif kind in ("face", "head"):
        from nao_sim_bridge.world.painting.known_faces import load_faces

        _one_of(kind, content, load_faces())
    elif kind in ("poster", "pattern"):
        _one_of(kind, content, POSTERS if kind == "poster" else PATTERNS)
    elif not Path(content).is_file():
        raise BadValue("picture file", content, "a file that is there")


def _one_of(kind: str, content: str, known) -> None:
    if content not in known:
        raise BadValue(kind, content, f"one of {', '.join(known)}", known)


def _paint(kind: str, content: str) -> np.ndarray:
    if kind == "landmark":
        from nao_sim_bridge.world.painting.known_landmarks import paint_landmark

        return paint_landmark(int(content))
    if kind in ("qr", "barcode"):
        from nao_sim_bridge.world.painting import codes

        return codes.paint_code(codes.QR, content) if kind == "qr" else codes.paint_code(*barcode(content))
    if kind in ("face", "head"):
        from nao_sim_bridge.world.painting import face

        return face.paint_portrait(content) if kind == "face" else face.paint_head(content)
    if kind == "poster":
        from nao_sim_bridge.world.painting.poster import paint_poster

        return paint_poster(content)
    if kind == "pattern":
        from nao_sim_bridge.world.painting.pattern import paint_pattern

        return paint_pattern(content)
    return read_picture_file(content)


def read_picture_file(path: str) -> np.ndarray:
    """(h, w, 3) uint8 RGB of a file, in at most `MOST_PIXELS` a side; a BadValue when it is no picture."""
    from PIL import Image, UnidentifiedImageError

    sizes = load_sizes().picture
    try:
        content = read_bounded(Path(path), sizes.file_bytes)
        with Image.open(io.BytesIO(content), formats=DECODED) as image:  # which reads its header only
            width, height = image.size
            if max(width, height) > sizes.side or width * height > sizes.pixels:
                allowed = f"at most {sizes.side} a side and {sizes.pixels} of all are allowed"
                raise ValueError(f"it has {width}x{height} pixels, {allowed}")
            if image.format == "WEBP" and image.is_animated:
                raise ValueError("it is WebP that moves")
            image.draft("RGB", (MOST_PIXELS, MOST_PIXELS))
            image = image.convert("RGB")
            image.thumbnail((MOST_PIXELS, MOST_PIXELS))
            return np.array(image)
    except Exception as error:  # formats have errors of their own for broken files, a SyntaxError among them
        reason = f"none of {', '.join(DECODED)}" if isinstance(error, UnidentifiedImageError) else error
        raise BadValue("picture file", path, f"a picture: {reason}") from error
