"""What a camera is asked for, and what its sensor makes of the light: exposure and gain, noise, colours, tone. Pure.

The picture that comes in is what a perfect camera shows of a well-lit room. All that works pixel by pixel is one table
of 256 entries a channel, so that it costs next to nothing.

Focus: what is blurred is the whole picture. How far away things are is not looked at.
"""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Mapping

import numpy as np

from nao_sim_bridge.base.imports import Library
from nao_sim_bridge.base.rotations import Quaternion, Vector3
from nao_sim_bridge.cameras.automatics import Balance, balance_of, exposure_of, metered
from nao_sim_bridge.cameras.color_spaces import Y_OF_RGB, encoded, luminance
from nao_sim_bridge.cameras.settings import (
    AUTO_FOCUS,
    BRIGHTNESS,
    CONTRAST,
    FOCUS,
    FOCUS_ONCE,
    H_FLIP,
    HUE,
    SATURATION,
    SHARPNESS,
    V_FLIP,
    SensorModel,
    load_cameras,
)

cv2 = Library("cv2")
MIDDLE = 128.0
"""What contrast leaves as it is."""
LEAST_NOISE, MOST_NOISE = 0.9, 24.0
"""Standard deviation of the noise at a gain of 1, and at most, in steps of 255."""
NOISE_LENGTH = 1 << 18
"""Values of noise that are made; they are used again and again, from another place on in each picture."""
FOCUS_BLUR = 6.0
"""Blur at the nearest focus, in pixels of a picture 640 wide."""
# What the automatics chose goes in front of the pixels, because only here the picture is known.
HEADER = struct.Struct("<iiif")


@dataclass(frozen=True)
class Shot:
    """What a camera of the robot is asked for.

    Attributes:
        version: Robot version: what the numbers of the parameters mean.
        camera: Index, 0 top, 1 bottom.
        position: Of the camera in world, m.
        orientation: Of the camera in world, quaternion (x, y, z, w); X along the optical axis, Y left, Z up.
        hfov: Horizontal field of view, rad.
        vfov: Vertical field of view, rad.
        color_space: NAOqi's id.
        parameters: Settings of the camera, by NAOqi's id; what is not there is at its default.
    """

    version: str
    camera: int
    position: Vector3
    orientation: Quaternion
    hfov: float
    vfov: float
    width: int
    height: int
    color_space: int
    parameters: Mapping[int, int] = field(default_factory=dict)
    seed: int = 0


@dataclass(frozen=True)
class Chosen:
    """What a picture was taken with: exposure and gain in the units of the camera's parameters.

    `white_balance` is the colour temperature that appears white, K, `luminance` the mean of the finished picture,
    0..255.
    """

    exposure: int
    gain: int
    white_balance: int
    luminance: float


def develop(picture: np.ndarray, shot: Shot) -> tuple[np.ndarray, Chosen]:
    """The picture that the camera takes.

    Args:
        picture: (h, w, 3) uint8 RGB as a perfect camera would show it.

    Returns:
        (h, w, 3) uint8 RGB, and what the automatics chose.
    """
    tables = load_cameras(shot.version)
    sensor, values = tables.sensor, {**tables.defaults, **shot.parameters}
    pixels = metered(picture)
    exposure = exposure_of(pixels, values, sensor)
    balance, kelvin = balance_of(pixels, values)
    contrast = values[CONTRAST] / sensor.contrast
    colored = values[SATURATION] != sensor.saturation or (sensor.hue and values[HUE] != 0)

    rgb = cv2.LUT(
        picture, _light_table(exposure.brightness(sensor), balance, None if colored else contrast, values, sensor)
    )
    rgb = _blurred(rgb, values)
    rgb = _noisy(rgb, exposure.gain / sensor.gain * (1.0 if colored else contrast), shot.seed)
    if colored:
        rgb = cv2.transform(rgb, _color_matrix(values, sensor))
        rgb = cv2.LUT(rgb, _tone(np.arange(256.0), contrast, values, sensor).round().astype(np.uint8))
    rgb = _sharpened(rgb, (values[SHARPNESS] - sensor.sharpness) * sensor.sharpness_step)
    rgb = _flipped(rgb, values)
    return rgb, Chosen(exposure.exposure, exposure.gain, kelvin, float(luminance(metered(rgb)).mean()))


def _light_table(
    brightness: float, balance: Balance, contrast: float | None, values: Mapping[int, int], sensor: SensorModel
) -> np.ndarray:
    """(256, 1, 3) uint8: light and white balance, and where `contrast` is given, tone as well."""
    levels = np.arange(256.0)[:, None] * brightness * np.array(balance)
    levels = np.clip(levels, 0.0, 255.0)
    if contrast is not None:
        levels = _tone(levels, contrast, values, sensor)
    return (levels + 0.5).astype(np.uint8)[:, None, :]


def _tone(levels: np.ndarray, contrast: float, values: Mapping[int, int], sensor: SensorModel) -> np.ndarray:
    """Contrast and brightness."""
    offset = values[BRIGHTNESS] * sensor.offset_of_brightness
    return np.clip((levels - MIDDLE) * contrast + MIDDLE + offset, 0.0, 255.0)


def _color_matrix(values: Mapping[int, int], sensor: SensorModel) -> np.ndarray:
    """(3, 3) that turns the hue and changes the saturation, and leaves luminance as it is."""
    saturation = values[SATURATION] / sensor.saturation
    angle = math.radians(values[HUE]) if sensor.hue else 0.0
    c, s = saturation * math.cos(angle), saturation * math.sin(angle)
    # Colour is what a pixel has beyond its luminance: in the plane of the differences B - Y and R - Y it is turned.
    to_plane = np.array([Y_OF_RGB, -np.array(Y_OF_RGB) + (0, 0, 1), -np.array(Y_OF_RGB) + (1, 0, 0)])
    to_plane[1] *= 0.564
    to_plane[2] *= 0.713
    turn = np.array([[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]])
    return (np.linalg.inv(to_plane) @ turn @ to_plane).astype(np.float32)


def _noisy(rgb: np.ndarray, factor: float, seed: int) -> np.ndarray:
    sigma = min(LEAST_NOISE * factor, MOST_NOISE)
    if sigma <= 0.0:
        return rgb
    size = rgb.size
    more, less = _noise(round(sigma * 8.0), -(-size // NOISE_LENGTH) + 1)
    first = seed * 40503 % NOISE_LENGTH
    flat = cv2.add(rgb.reshape(1, size), more[:, first : first + size])
    return cv2.subtract(flat, less[:, first : first + size], flat).reshape(rgb.shape)


@lru_cache(maxsize=8)
def _noise(eighths: int, repeats: int) -> tuple[np.ndarray, np.ndarray]:
    """(1, n) uint8 each: what noise adds and what it takes away; a standard deviation of `eighths` / 8."""
    values = np.rint(_normal() * (eighths / 8.0))
    return tuple(np.tile(np.clip(part, 0.0, 255.0).astype(np.uint8), repeats)[None, :] for part in (values, -values))


@lru_cache(maxsize=1)
def _normal() -> np.ndarray:
    return np.random.default_rng(5640).standard_normal(NOISE_LENGTH)


def _blurred(rgb: np.ndarray, values: Mapping[int, int]) -> np.ndarray:
    focus = values.get(FOCUS, 0)
    if values.get(AUTO_FOCUS) or focus in (0, FOCUS_ONCE):
        return rgb
    return cv2.GaussianBlur(rgb, (0, 0), max(focus / FOCUS_ONCE * FOCUS_BLUR * rgb.shape[1] / 640.0, 0.2))


def _sharpened(rgb: np.ndarray, amount: float) -> np.ndarray:
    """With an amount above 0 edges are stronger, below 0 weaker."""
    if amount == 0.0:
        return rgb
    return cv2.addWeighted(rgb, 1.0 + amount, cv2.GaussianBlur(rgb, (3, 3), 0.0), -amount, 0.0)


def _flipped(rgb: np.ndarray, values: Mapping[int, int]) -> np.ndarray:
    code = {(1, 0): 1, (0, 1): 0, (1, 1): -1}.get((values[H_FLIP], values[V_FLIP]))
    return rgb if code is None else cv2.flip(rgb, code)


@dataclass(frozen=True, eq=False)
class Photograph:
    """A picture in the colour space of its shot, with what the automatic chose for it."""

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
