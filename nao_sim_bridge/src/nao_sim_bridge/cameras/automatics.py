"""Automatic exposure and white balance. Pure functions of a picture.

They know one picture only and have always come to rest on it: the same moment gives the same picture, whoever else
has or has not looked before.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Mapping, Tuple

import numpy as np

from nao_sim_bridge.cameras.color_spaces import luminance
from nao_sim_bridge.cameras.settings import (
    AUTO_EXPOSURE,
    AUTO_WHITE_BALANCE,
    BACKLIGHT,
    BRIGHTNESS,
    EXPOSURE,
    EXPOSURE_ALGORITHM,
    GAIN,
    WHITE_BALANCE,
    SensorModel,
)

GAMMA = 2.2
"""Of the pictures: twice the light makes them 2 ** (1 / 2.2) times as bright."""
NEUTRAL_KELVIN = 4600
"""Colour temperature of light that is white as it comes in."""
METER_STEP = 8
"""Automatics look at every eighth pixel of every eighth row."""
CENTER_WEIGHT = 2.0
"""What centre-weighted metering adds to the weight of the middle."""
AVERAGE, CENTER, HIGHLIGHTS, LOWLIGHTS = range(4)
GREY_SATURATION, GREY_SHARE, GREY_LEVELS = 0.12, 0.05, (40, 245)
"""What counts as grey for the white balance: least colour, and within these levels; and the least share of it."""
MOST_BALANCE = 1.4
"""By how much automatic white balance changes a colour at most."""

Balance = Tuple[float, float, float]


@dataclass(frozen=True)
class Exposure:
    """Exposure and gain, in the units of the camera's parameters."""

    exposure: int
    gain: int

    def brightness(self, sensor: SensorModel) -> float:
        """How many times as bright as it comes in the picture is."""
        light = max(self.exposure, 0) / sensor.exposure * (max(self.gain, 1) / sensor.gain)
        return light ** (1.0 / GAMMA)


def metered(picture: np.ndarray) -> np.ndarray:
    """The pixels of a (h, w, 3) picture that automatics look at; at least a few in the smallest pictures."""
    step = min(METER_STEP, max(1, picture.shape[1] // 40))
    return np.ascontiguousarray(picture[step // 2 :: step, step // 2 :: step])


def exposure_of(pixels: np.ndarray, values: Mapping[int, int], sensor: SensorModel) -> Exposure:
    """What a picture is exposed with, by its metered pixels, (h, w, 3) uint8."""
    if not values[AUTO_EXPOSURE]:
        return Exposure(values[EXPOSURE], values[GAIN])
    levels = luminance(pixels)
    weights = _weights(levels, values, sensor)
    histogram = np.bincount(levels.ravel(), weights=weights.ravel(), minlength=256)
    target = sensor.target_luminance + sensor.target_of_brightness * values[BRIGHTNESS]
    light = _brightness_for(histogram / histogram.sum(), target) ** GAMMA
    exposure = min(max(round(light * sensor.exposure), 1), sensor.longest_exposure)
    if exposure < sensor.longest_exposure:
        return Exposure(exposure, sensor.gain)
    gain = max(round(light * sensor.exposure / exposure * sensor.gain), sensor.gain)
    return Exposure(exposure, min(gain, sensor.most_gain))


def _brightness_for(shares: np.ndarray, target: float) -> float:
    """The factor that brings the mean of a histogram (256 shares) to a target, with white where it is full."""
    levels = np.arange(256, dtype=float)
    factor = 1.0
    for _ in range(8):  # each round is exact but for what becomes or stops being white
        mean = float(shares @ np.minimum(levels * factor, 255.0))
        factor = min(max(factor * target / max(mean, 1e-3), 1e-3), 1e3)
    return factor


def _weights(levels: np.ndarray, values: Mapping[int, int], sensor: SensorModel) -> np.ndarray:
    """(h, w) weights of the metered pixels."""
    algorithm = values.get(EXPOSURE_ALGORITHM, AVERAGE)
    weights = np.ones(levels.shape)
    if algorithm == HIGHLIGHTS:
        weights += levels / 32.0
    elif algorithm == LOWLIGHTS:
        weights += (255.0 - levels) / 32.0
    extra = CENTER_WEIGHT * (algorithm == CENTER) + sensor.backlight_weight * values.get(BACKLIGHT, 0)
    height, width = levels.shape
    weights[height // 4 : height - height // 4, width // 4 : width - width // 4] += extra
    return weights


def balance_of(pixels: np.ndarray, values: Mapping[int, int]) -> tuple[Balance, int]:
    """Factors for red, green and blue, and the colour temperature, K, that they make white."""
    if not values[AUTO_WHITE_BALANCE]:
        kelvin = values.get(WHITE_BALANCE, NEUTRAL_KELVIN)
        root = (kelvin / NEUTRAL_KELVIN) ** 0.5
        return (root, 1.0, 1.0 / root), kelvin
    flat = pixels.reshape(-1, 3)
    most, least = flat.max(axis=1), flat.min(axis=1)
    grey = (most - least <= GREY_SATURATION * most) & (most >= GREY_LEVELS[0]) & (most <= GREY_LEVELS[1])
    if np.count_nonzero(grey) < GREY_SHARE * len(flat):
        return (1.0, 1.0, 1.0), NEUTRAL_KELVIN
    red, green, blue = flat[grey].mean(axis=0)
    factors = tuple(float(min(max(green / c, 1.0 / MOST_BALANCE), MOST_BALANCE)) for c in (red, green, blue))
    kelvin = round(min(max(NEUTRAL_KELVIN * factors[0] / factors[2], 2700), 6500))
    return (factors[0], 1.0, factors[2]), kelvin
