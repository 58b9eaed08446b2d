"""A contact sheet of a film: of each part a strip of pictures, with its name. PyAV and Pillow; no ROS."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import av
from PIL import Image, ImageDraw, ImageFont

from nao_library_modules.core.files import WholeFile

MOMENTS = 6
BAND = 22
"""Height of the line with a name over its strip, pixels."""
INK, PAPER = (30, 30, 30), (255, 255, 255)
COLOURS = 192
"""Of a sheet that is to be small."""


@dataclass(frozen=True)
class Part:
    """A part of a film.

    Attributes:
        name: What is written over its strip.
        begin: s from the beginning of the film.
        end: Likewise.
    """

    name: str
    begin: float
    end: float

    def moments(self, count: int) -> list[float]:
        """Times spread evenly over the part, none at its very edge, s."""
        return [self.begin + (self.end - self.begin) * (place + 0.5) / count for place in range(count)]


def frames_at(film: Path, times: Sequence[float]) -> list[Image.Image]:
    """Pictures of a film.

    Args:
        film: The file.
        times: s, in any order; after the end of the film stands for its last picture.

    Returns:
        One picture a time: the last that had begun by then.

    Raises:
        ValueError: The film has no pictures.
    """
    wanted = sorted(range(len(times)), key=lambda place: times[place])
    found: dict[int, Image.Image] = {}
    with av.open(str(film)) as container:
        shown = None
        for frame in container.decode(video=0):
            while wanted and shown is not None and frame.time > times[wanted[0]]:
                found[wanted.pop(0)] = shown.to_image()
            shown = frame
            if not wanted:
                break
        if shown is None:
            raise ValueError(f"{film} has no pictures")
        for place in wanted:
            found[place] = shown.to_image()
    return [found[place] for place in range(len(times))]


def contact_sheet(
    film: Path, parts: Sequence[Part], side: int = 180, columns: int = 1, share: float = 1.0
) -> Image.Image:
    """The sheet.

    Args:
        film: The film.
        parts: Its parts, in the order of the sheet.
        side: Height of a picture, pixels; its width follows.
        columns: How many strips stand side by side.
        share: How much of the width of a picture is shown, of its middle.

    Raises:
        ValueError: The film has no pictures.
    """
    times = [time for part in parts for time in part.moments(MOMENTS)]
    pictures = [_middle(picture, share) for picture in frames_at(film, times)]
    width = round(side * pictures[0].width / pictures[0].height)
    rows = -(-len(parts) // columns)
    sheet = Image.new("RGB", (columns * MOMENTS * width + (columns - 1) * BAND, rows * (side + BAND)), PAPER)
    draw, font = ImageDraw.Draw(sheet), ImageFont.load_default(size=BAND - 8)
    for place, part in enumerate(parts):
        column, row = divmod(place, rows)
        left, top = column * (MOMENTS * width + BAND), row * (side + BAND)
        draw.text((left + 4, top + BAND / 2), part.name, fill=INK, font=font, anchor="lm")
        for moment in range(MOMENTS):
            picture = pictures[place * MOMENTS + moment].resize((width, side), Image.LANCZOS)
            sheet.paste(picture, (left + moment * width, top + BAND))
    return sheet


def _middle(picture: Image.Image, share: float) -> Image.Image:
    edge = round(picture.width * (1.0 - share) / 2.0)
    return picture.crop((edge, 0, picture.width - edge, picture.height))


def save_small(sheet: Image.Image, path: Path) -> None:
    """Save a sheet as a PNG of few colours."""
    with WholeFile(path) as file:
        sheet.quantize(COLOURS, dither=Image.Dither.NONE).save(file, "PNG", optimize=True)
