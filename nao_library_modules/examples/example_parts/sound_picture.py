"""Draws a sound: its waveform, its spectrogram, and below the time axis who said and heard what. Needs Pillow."""

from __future__ import annotations

import math
from typing import Dict, List, Sequence, Tuple

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from .dialogue_record import DOES, HEARS, PERSON, ROBOT, SAYS, Turn

MOST_CHANNELS = 4
MICROPHONES = ("left", "right", "front", "rear")
"""Names of four channels: a NAO's microphones in the order in which it records them."""
PAPER, GRID, INK = (255, 255, 255), (226, 226, 230), (60, 60, 66)
WAVE = (35, 95, 180)
LINES = {ROBOT: (35, 95, 180), PERSON: (205, 85, 20)}
# Lines below the time axis, from above.
LANES = [f"{who} {what}" for who in (PERSON, ROBOT) for what in (HEARS, SAYS, DOES)]
FILLS = {ROBOT: (205, 222, 245), PERSON: (252, 222, 200)}
# Quiet to loud in the spectrogram: share of the range, and color.
SHADES = ((0.0, PAPER), (0.35, (200, 215, 240)), (0.6, (90, 130, 200)), (0.8, (190, 60, 110)), (1.0, (70, 10, 50)))
# Pixels: of the picture, of what is left and right of the time axis, above it, and of each of its parts.
WIDTH, LEFT, RIGHT, TOP, GAP = 1000, 108, 14, 10, 8
WAVE_HEIGHT, LEAST_WAVE_HEIGHT, SPECTRUM_HEIGHT, AXIS_HEIGHT, LANE_HEIGHT = 100, 46, 180, 28, 30
PANEL = WIDTH - LEFT - RIGHT
# Of letters, pixels.
SIZE = 15
# The spectrogram: length of a look, s; highest frequency, Hz; between the lowest and the highest level, dB.
WINDOW_S, HIGHEST, RANGE_DB = 0.025, 8000.0, 70.0
# Looks that are worked on at once.
CHUNK = 2048
# Marks of the time axis, s: the first of these distances that leaves room between them.
DISTANCES = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 60.0, 300.0, 900.0, 3600.0)
LEAST_DISTANCE = 60


def draw(samples: np.ndarray, rate: int, turns: Sequence[Turn] = ()) -> Image.Image:
    """Draw a sound.

    Args:
        samples: (frames, channels) or (frames,), 1 is full scale; 1 to 4 channels.
        rate: Hz.
        turns: What was said and heard, in s from the first sample.

    Raises:
        ValueError: There are no samples, or more channels than that.
    """
    samples = samples[:, np.newaxis] if samples.ndim == 1 else samples
    frames, channels = samples.shape
    if not frames or not 1 <= channels <= MOST_CHANNELS:
        raise ValueError(f"{frames} samples of {channels} channels: not 1 to {MOST_CHANNELS} channels with samples")
    lanes = _lanes(turns)
    wave_height = max(LEAST_WAVE_HEIGHT, WAVE_HEIGHT // channels)
    spectrum_top = TOP + channels * (wave_height + GAP)
    axis_top = spectrum_top + SPECTRUM_HEIGHT
    picture = Image.new("RGB", (WIDTH, axis_top + AXIS_HEIGHT + len(lanes) * LANE_HEIGHT + TOP), PAPER)
    pen = ImageDraw.Draw(picture)
    duration = frames / rate
    _draw_waves(pen, samples, wave_height)
    picture.paste(spectrogram(samples, rate, (PANEL, SPECTRUM_HEIGHT)), (LEFT, spectrum_top))
    _draw_frequencies(pen, spectrum_top, min(HIGHEST, rate / 2.0))
    _draw_times(pen, axis_top, duration, picture.size[1] - TOP)
    for number, (label, there) in enumerate(lanes.items()):
        _draw_lane(pen, axis_top + AXIS_HEIGHT + number * LANE_HEIGHT, label, there, duration)
    return picture


def spectrogram(samples: np.ndarray, rate: int, size: Tuple[int, int]) -> Image.Image:
    """Power over time (to the right) and frequency (upwards, linear), of all channels together.

    Args:
        samples: (frames, channels), at least one frame.
        rate: Hz.
        size: Of the picture, pixels.
    """
    window = max(2, round(WINDOW_S * rate))
    hop = window // 2
    shape = np.hanning(window).astype(np.float32)
    bins = 1 + math.ceil(min(HIGHEST, rate / 2.0) * window / rate)
    # Silence around it, so that also the first and the last sample are in the middle of a look.
    padded = np.pad(samples.astype(np.float32), ((hop, window), (0, 0)))
    starts = np.arange(0, len(samples) + 1, hop)
    powers = np.empty((len(starts), min(bins, window // 2 + 1)), np.float32)
    for first in range(0, len(starts), CHUNK):
        chosen = starts[first : first + CHUNK, np.newaxis] + np.arange(window)
        total = sum(np.abs(np.fft.rfft(channel[chosen] * shape)) ** 2 for channel in padded.T)
        powers[first : first + CHUNK] = total[:, : powers.shape[1]]
    levels = 10.0 * np.log10(powers + 1e-12)
    shares = np.clip((levels - levels.max()) / RANGE_DB + 1.0, 0.0, 1.0)
    small = Image.fromarray(shares.T[::-1].astype(np.float32)).resize(size, Image.BILINEAR)
    places, colors = zip(*SHADES)
    flat = np.asarray(small)
    layers = [np.interp(flat, places, [color[layer] for color in colors]) for layer in range(3)]
    return Image.fromarray(np.stack(layers, axis=-1).astype(np.uint8))


def _lanes(turns: Sequence[Turn]) -> Dict[str, List[Turn]]:
    """Turns by what stands before their line, each line in the order of time."""
    lanes: Dict[str, List[Turn]] = {}
    for turn in sorted(turns, key=lambda turn: turn.began):
        lanes.setdefault(f"{turn.who} {turn.what}", []).append(turn)
    return {label: lanes[label] for label in LANES if label in lanes}


def _draw_waves(pen: ImageDraw.ImageDraw, samples: np.ndarray, height: int) -> None:
    frames, channels = samples.shape
    names = MICROPHONES if channels == MOST_CHANNELS else [str(n) for n in range(1, channels + 1)] * (channels > 1)
    peak = float(np.abs(samples).max()) or 1.0
    starts = np.minimum(np.arange(PANEL) * frames // PANEL, frames - 1)
    low, high = np.minimum.reduceat(samples, starts), np.maximum.reduceat(samples, starts)
    for channel in range(channels):
        top = TOP + channel * (height + GAP)
        middle, reach = top + height / 2.0, height / 2.0 / peak
        pen.rectangle([LEFT, top, LEFT + PANEL - 1, top + height], outline=GRID)
        for x in range(PANEL):
            pen.line(
                [(LEFT + x, middle - reach * high[x, channel]), (LEFT + x, middle - reach * low[x, channel])], fill=WAVE
            )
        if names:
            pen.text((LEFT - 8, middle), names[channel], INK, _font(), anchor="rm")
    if not names:
        pen.text((LEFT - 8, TOP), f"{peak:.2g}", INK, _font(), anchor="rt")
        pen.text((LEFT - 8, TOP + height / 2.0), "0", INK, _font(), anchor="rm")


def _draw_frequencies(pen: ImageDraw.ImageDraw, top: int, highest: float) -> None:
    step = 2000.0 if highest > 4000.0 else 1000.0
    pen.rectangle([LEFT, top, LEFT + PANEL - 1, top + SPECTRUM_HEIGHT], outline=GRID)
    for number in range(1 + int(highest / step)):
        y = top + SPECTRUM_HEIGHT * (1.0 - number * step / highest)
        pen.line([LEFT - 4, y, LEFT, y], fill=INK)
        text = f"{number * step / 1000.0:g}" + " kHz" * (number > 0)
        anchor = "rb" if number == 0 else "rt" if y - top < SIZE else "rm"
        pen.text((LEFT - 8, y), text, INK, _font(), anchor=anchor)


def _draw_times(pen: ImageDraw.ImageDraw, top: int, duration: float, bottom: int) -> None:
    fitting = (step for step in DISTANCES if step / duration * PANEL >= LEAST_DISTANCE)
    step = next(fitting, DISTANCES[-1])
    for number in range(1 + int(duration / step)):
        x = _at(number * step, duration)
        pen.line([x, top, x, top + 5], fill=INK)
        pen.line([x, top + AXIS_HEIGHT, x, bottom], fill=GRID)
        pen.text((x, top + 7), f"{number * step:g}" + " s" * (number == 0), INK, _font(), anchor="mt")


def _draw_lane(pen: ImageDraw.ImageDraw, top: int, label: str, turns: Sequence[Turn], duration: float) -> None:
    middle, font = top + LANE_HEIGHT / 2.0, _font()
    who = turns[0].who
    pen.text((LEFT - 8, middle), label, LINES[who], font, anchor="rm")
    inside = [turn for turn in turns if turn.ended >= 0.0 and turn.began <= duration]
    places = [(_at(turn.began, duration), _at(turn.ended, duration)) for turn in inside]
    limits = [start for start, _ in places[1:]] + [WIDTH]
    for turn, (start, end), limit in zip(inside, places, limits):
        pen.rectangle([start, top + 3, max(end, start + 2), top + LANE_HEIGHT - 4], fill=FILLS[who], outline=LINES[who])
        text, room = turn.title, limit - start - 8
        while text and pen.textlength(text, font) > room:
            text = text[:-2].rstrip() + "…" if len(text) > 2 else ""
        pen.text((start + 5, middle), text, INK, font, anchor="lm")


def _at(time: float, duration: float) -> float:
    """Where a time is on the axis, pixels; the nearest end of the axis if it is beyond."""
    return LEFT + min(max(time / duration, 0.0), 1.0) * (PANEL - 1)


def _font() -> ImageFont.FreeTypeFont:
    return ImageFont.load_default(SIZE)
