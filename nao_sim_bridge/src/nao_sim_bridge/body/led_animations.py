"""Key frames of the LED animations ALLeds knows by name. Pure: time and chance are passed in."""

from __future__ import annotations

import random
from typing import Iterable, Sequence

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.body.leds import LedKeyframe
from nao_sim_bridge.model.leds_layout import LedLayout

Color = Sequence[float]

# Seconds that one colour of an animation stays; the maker publishes none of these figures.
RANDOM_STEP = 0.25
RASTA_STEP = 0.4
# So many colours of one animation are worked out when it begins, while the robot waits: more than an hour of them.
MOST_STEPS = 15000
RASTA_COLORS: tuple[Color, ...] = ((0.0, 1.0, 0.0), (1.0, 1.0, 0.0), (1.0, 0.0, 0.0))
COLOR_NAMES: dict[str, Color] = {
    "white": (1.0, 1.0, 1.0),
    "red": (1.0, 0.0, 0.0),
    "green": (0.0, 1.0, 0.0),
    "blue": (0.0, 0.0, 1.0),
    "yellow": (1.0, 1.0, 0.0),
    "magenta": (1.0, 0.0, 1.0),
    "cyan": (0.0, 1.0, 1.0),
}
CHANNEL = {"red": 0, "green": 1, "blue": 2, "white": 2}


def color_of_int(rgb: int) -> Color:
    """(r, g, b) in 0..1 of 0x00RRGGBB."""
    return (((rgb >> 16) & 255) / 255.0, ((rgb >> 8) & 255) / 255.0, (rgb & 255) / 255.0)


def colored(layout: LedLayout, devices: Iterable[int], color: Color) -> dict[int, float]:
    """Intensity of each device for a colour; one-colour LEDs (ears, head) take its blue part, as on the robot."""
    return {index: color[CHANNEL[layout.channels[index]]] for index in devices}


def power_on(layout: LedLayout) -> dict[int, float]:
    """Intensities after boot and after a reset: white eyes, lit ears and head, chest and feet dark."""
    lit = {i for name in ("FaceLeds", "EarLeds", "BrainLeds") for i in layout.devices_of(name)}
    return {index: float(index in lit) for index in range(len(layout.devices))}


def random_eyes(layout: LedLayout, duration: float, chance: random.Random) -> list[LedKeyframe]:
    """Each eye segment jumps to a random colour again and again for `duration` s."""
    lamps = layout.lamps_of("eye")
    frames = []
    for time in _steps(duration, RANDOM_STEP):
        values: dict[int, float] = {}
        for lamp in lamps:
            values.update(zip(lamp.devices, (chance.random() for _ in lamp.devices)))
        frames.append(LedKeyframe(time, values))
    return [*frames, LedKeyframe(duration, {})]


def rasta(layout: LedLayout, duration: float) -> list[LedKeyframe]:
    """Green, yellow and red in turn on every coloured LED for `duration` s."""
    devices = [i for lamp in layout.lamps if lamp.color is None for i in lamp.devices]
    frames = [
        LedKeyframe(time, colored(layout, devices, RASTA_COLORS[k % len(RASTA_COLORS)]))
        for k, time in enumerate(_steps(duration, RASTA_STEP))
    ]
    return [*frames, LedKeyframe(duration, {})]


def rotate_eyes(layout: LedLayout, color: Color, rotation: float, duration: float) -> list[LedKeyframe]:
    """One lit segment runs round each eye, once in `rotation` s, for `duration` s; the others are dark."""
    eyes = [layout.lamps_of("eye", side) for side in ("Left", "Right")]
    frames = []
    for k, time in enumerate(_steps(duration, rotation / len(eyes[0]))):
        values: dict[int, float] = {}
        for lamps in eyes:
            for position, lamp in enumerate(lamps):
                values.update(zip(lamp.devices, color if position == k % len(lamps) else (0.0, 0.0, 0.0)))
        frames.append(LedKeyframe(time, values))
    return [*frames, LedKeyframe(duration, {})]


def ear_angle(layout: LedLayout, degrees: float, duration: float, leave_on: bool) -> list[LedKeyframe]:
    """Shows a direction on both ears: 0 up, 90 front, 180 down, 270 back; dark after `duration` s unless left on.

    The two LEDs next to the direction share the light by their distance from it.
    """
    shown: dict[int, float] = {}
    for side in ("Left", "Right"):
        lamps = layout.lamps_of("ear", side)
        spacing = 360.0 / len(lamps)
        for lamp in lamps:
            distance = abs((degrees - lamp.angle + 180.0) % 360.0 - 180.0)
            shown[lamp.devices[0]] = max(0.0, 1.0 - distance / spacing)
    end = shown if leave_on else {index: 0.0 for index in shown}
    return [LedKeyframe(0.0, shown), LedKeyframe(duration, end)]


def _steps(duration: float, step: float) -> list[float]:
    """Times 0, step, 2 step, ... below `duration`.

    Raises:
        BadValue: There would be too many of them.
    """
    if duration > MOST_STEPS * step:
        raise BadValue("duration", duration, f"{MOST_STEPS * step:g} s at most, with a new colour each {step:g} s")
    count = max(1, int(duration / step + 0.999999))
    return [k * step for k in range(count)]
