"""Pixels as NAOqi's colour spaces have them. Pure functions of arrays.

Luminance and chrominance (Y, U, V) are those of JPEG: full range, BT.601; U and V are 128 where there is no colour.
Hue goes once round the circle in 256 steps. CIE colour spaces are scaled to bytes as OpenCV does it: L times 2.55, the
others plus 128, and in those with a chroma C instead, the hue h as above.
"""

from __future__ import annotations

from typing import Callable, Mapping, Sequence

import numpy as np

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.imports import Library

cv2 = Library("cv2")

Y_OF_RGB = (0.299, 0.587, 0.114)


def encoded(rgb: np.ndarray, color_space: int) -> np.ndarray:
    """The pixels of a (h, w, 3) uint8 picture of even width in a colour space (NAOqi's id), (h, w) or (h, w, layers).

    Raises:
        BadValue: A colour camera does not have this colour space.
    """
    if color_space not in ENCODERS:
        raise BadValue("colorSpace", color_space, "one of " + ", ".join(map(str, ENCODERS)))
    return ENCODERS[color_space](rgb)


def luminance(rgb: np.ndarray) -> np.ndarray:
    """(h, w) uint8."""
    return cv2.cvtColor(rgb, cv2.COLOR_RGB2GRAY)


def _converted(space: str) -> Callable[[np.ndarray], np.ndarray]:
    """To a colour space that OpenCV has."""
    return lambda rgb: cv2.cvtColor(rgb, getattr(cv2, f"COLOR_RGB2{space}"))


def _plane(convert: Callable[[np.ndarray], np.ndarray], index: int) -> Callable[[np.ndarray], np.ndarray]:
    return lambda rgb: convert(rgb)[..., index]


def _yuv(rgb: np.ndarray) -> np.ndarray:
    """Y, U, V; OpenCV has the last two the other way round."""
    return cv2.cvtColor(rgb, cv2.COLOR_RGB2YCrCb)[..., (0, 2, 1)]


def _of_pairs(order: Sequence[int]) -> Callable[[np.ndarray], np.ndarray]:
    """Four bytes for two pixels: Y of the left one (0), of the right one (1), their U or Cb (2), their V or Cr (3)."""

    def convert(rgb: np.ndarray) -> np.ndarray:
        y, v, u = cv2.split(cv2.cvtColor(rgb, cv2.COLOR_RGB2YCrCb))
        half = (rgb.shape[1] // 2, rgb.shape[0])
        u, v = (cv2.resize(plane, half, interpolation=cv2.INTER_AREA) for plane in (u, v))
        planes = (y[:, 0::2], y[:, 1::2], u, v)
        return cv2.merge([planes[number] for number in order]).reshape(*rgb.shape[:2], 2)

    return convert


def _hsy(rgb: np.ndarray) -> np.ndarray:
    """Hue and saturation as in HSV, with luminance."""
    pixels = cv2.cvtColor(rgb, cv2.COLOR_RGB2HSV_FULL)
    pixels[..., 2] = luminance(rgb)
    return pixels


def _hue_as_color(rgb: np.ndarray) -> np.ndarray:
    """The pure colour of each pixel's hue; grey has the hue of red."""
    pixels = cv2.cvtColor(rgb, cv2.COLOR_RGB2HSV_FULL)
    pixels[..., 1:] = 255
    return cv2.cvtColor(pixels, cv2.COLOR_HSV2RGB_FULL)


def _hue_saturation_mixed(rgb: np.ndarray) -> np.ndarray:
    """Hue, saturation, and their mean."""
    pixels = _hsy(rgb)
    pixels[..., 2] = (pixels[..., 0].astype(np.uint16) + pixels[..., 1]) // 2
    return pixels


def _argb(rgb: np.ndarray) -> np.ndarray:
    opaque = np.full(rgb.shape[:2], 255, dtype=np.uint8)
    return cv2.merge((opaque, *cv2.split(rgb)))


def _polar(space: str) -> Callable[[np.ndarray], np.ndarray]:
    """Lightness, chroma and hue from a CIE colour space with two colour axes."""
    to_space = _converted(space)

    def convert(rgb: np.ndarray) -> np.ndarray:
        # From floats: in bytes the axes have offsets and scales of their own.
        lightness, a, b = cv2.split(to_space(rgb.astype(np.float32) / np.float32(255.0)))
        chroma, hue = cv2.cartToPolar(a, b)
        planes = (lightness * 2.55, chroma, np.mod(hue * (256.0 / (2.0 * np.pi)), 256.0))
        return np.stack([np.clip(plane + 0.5, 0.0, 255.0).astype(np.uint8) for plane in planes], axis=-1)

    return convert


def _same(rgb: np.ndarray) -> np.ndarray:
    return rgb


ENCODERS: Mapping[int, Callable[[np.ndarray], np.ndarray]] = {
    0: luminance,
    1: _plane(_yuv, 1),
    2: _plane(_yuv, 2),
    3: _plane(_same, 0),
    4: _plane(_same, 1),
    5: _plane(_same, 2),
    6: _plane(_hsy, 0),
    7: _plane(_hsy, 1),
    8: luminance,
    9: _of_pairs((0, 2, 1, 3)),  # as the cameras themselves give it
    10: _yuv,
    11: _same,
    12: _hsy,
    13: _converted("BGR"),
    14: _of_pairs((0, 1, 2, 3)),
    15: _hue_as_color,
    16: _hue_saturation_mixed,
    18: _argb,
    19: _converted("XYZ"),
    22: _converted("Lab"),
    24: _converted("Luv"),
    25: _polar("Lab"),
    26: _polar("Luv"),
}
"""By NAOqi's id. What is missing needs a depth camera."""
