"""From what was drawn to what the camera gives: runs where pictures are drawn. Pure.

What the automatic of the camera chose goes in front of the pixels, because only here the picture is known.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass

import numpy as np

from nao_sim_bridge.cameras.color_spaces import encoded
from nao_sim_bridge.cameras.sensor import Chosen, develop
from nao_sim_bridge.cameras.shot import Shot

HEADER = struct.Struct("<iiif")


@dataclass(frozen=True, eq=False)
class Photograph:
    """A picture with what the automatic chose for it.

    Attributes:
        data: The pixels in the colour space of the shot.
    """

    chosen: Chosen
    data: bytes


def photograph(picture: np.ndarray, shot: Shot) -> bytes:
    """What a camera makes of a picture.

    Args:
        picture: (h, w, 3) uint8 RGB as a perfect camera would show it.

    Returns:
        The pixels in the shot's colour space, behind a header that `read_photograph` takes apart.

    Raises:
        BadValue: The colour space is not one of a colour camera.
    """
    rgb, chosen = develop(picture, shot)
    pixels = np.ascontiguousarray(encoded(rgb, shot.color_space))
    return HEADER.pack(chosen.exposure, chosen.gain, chosen.white_balance, chosen.luminance) + pixels.data


def read_photograph(packed: bytes) -> Photograph:
    """What `photograph` packed."""
    return Photograph(Chosen(*HEADER.unpack_from(packed)), bytes(memoryview(packed)[HEADER.size :]))
