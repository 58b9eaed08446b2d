"""The trace of a plan's run: the tree of its tasks, their times and outcomes; as text, as JSON and as a picture.

A picture has one line per task, with a bar from its start to its end; it needs Pillow, which is loaded with the first.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from naoqi.errors import NaoError

from ..core.files import WholeFile
from .failures import cut, short_numbers, short_repr
from .tasks import Task

if TYPE_CHECKING:
    from PIL import Image, ImageDraw, ImageFont


MARKS = {
    "created": ".",
    "running": ">",
    "suspended": "=",
    "succeeded": "+",
    "failed": "!",
    "evaporated": "-",
}
LONGEST = 160


@dataclass(frozen=True)
class Record:
    """One task, as it was when the record was taken."""

    number: int  # in the order of creation, from 0
    parent: int | None  # number of the parent task; None at the root
    name: str
    state: str
    created: float  # s since the creation of the root, as `began` and `ended`, which are None until then
    began: float | None
    ended: float | None
    result: str  # as text; empty for none
    failure: str  # class and text of the failure; or why it was evaporated or suspended
    facts: dict[str, str]


@dataclass(frozen=True)
class Trace:
    """All tasks of a tree, parents before their children."""

    records: tuple[Record, ...]

    def children(self, number: int | None) -> list[Record]:
        return [record for record in self.records if record.parent == number]

    def named(self, name: str) -> list[Record]:
        return [record for record in self.records if record.name == name]

    def __str__(self) -> str:
        """The tree as text, one line per task."""
        return "\n".join(
            f"{'  ' * depth}{MARKS[record.state]} {record.name}{_details(record)}" for record, depth in self.walk()
        )

    def walk(self, parent: int | None = None, depth: int = 0) -> Iterator[tuple[Record, int]]:
        """The tasks in the order of the tree, each with its depth."""
        for record in self.children(parent):
            yield record, depth
            yield from self.walk(record.number, depth + 1)

    def to_json(self) -> str:
        """The tree as JSON: {"tasks": [...]}, with a `Record` each."""
        return json.dumps({"tasks": [asdict(record) for record in self.records]}, indent=1)

    @staticmethod
    def from_json(text: str) -> Trace:
        return Trace(tuple(Record(**entry) for entry in json.loads(text)["tasks"]))


def trace_of(root: Task) -> Trace:
    """The trace of a tree, from any thread, during the run or afterwards."""
    with root.tree.lock:
        tasks = list(root)
        return Trace(tuple(_record(task, root.created) for task in tasks))


def _record(task: Task, start: float) -> Record:
    """The record of one task; times count from `start`, s."""
    failure = ""
    if task.failure is not None:
        failure = f"{type(task.failure).__name__}: {task.failure}"
    elif task.state.value in ("evaporated", "suspended"):
        failure = task.reason
    return Record(
        number=task.number,
        parent=task.parent.number if task.parent is not None else None,
        name=task.name,
        state=task.state.value,
        created=round(task.created - start, 6),
        began=_since(task.began, start),
        ended=_since(task.ended, start),
        result=short_repr(task.result, LONGEST) if task.result is not None else "",
        failure=cut(short_numbers(failure), LONGEST),
        facts={name: cut(fact if isinstance(fact, str) else repr(fact), LONGEST) for name, fact in task.facts.items()},
    )


def _details(record: Record) -> str:
    parts = []
    if "arguments" in record.facts:
        parts.append(f"({record.facts['arguments']})")
    if record.began is not None and record.ended is not None:
        parts.append(f"{record.began:.3f} s + {record.ended - record.began:.3f} s")
    if record.result:
        parts.append(f"-> {record.result}")
    if record.failure:
        parts.append(record.failure)
    return "".join(f"  {part}" for part in parts)


def _since(time: float | None, start: float) -> float | None:
    return None if time is None else round(time - start, 6)


# --- the picture ------------------------------------------------------------------------------------------------------

PAPER, GRID, INK, FAINT = (255, 255, 255), (228, 228, 232), (50, 50, 56), (130, 130, 138)
COLORS = {
    "created": (200, 200, 205),
    "running": (66, 133, 244),
    "suspended": (244, 180, 0),
    "succeeded": (52, 160, 90),
    "failed": (205, 55, 45),
    "evaporated": (150, 150, 158),
}
LINE, TEXT, INDENT, MARGIN = 22, 13, 16, 14
NAMES, BARS = 400, 560
"""Widths of the column of names and of that of bars, in pixels."""
SHORTEST = 120
"""Pixels; where a bar leaves less behind it, what came of the task stands before it."""
MOST_LINES = 200
FINE = 2
"""Drawn so many times larger and then reduced, for smooth edges."""


def draw_trace(trace: Trace) -> Image.Image:
    """The picture of a trace; of a very long one the first tasks. Raises NaoError if it has no task."""
    from PIL import Image, ImageDraw  # takes its time to load

    lines = list(trace.walk())
    if not lines:
        raise NaoError("a trace without a task cannot be drawn")
    left_out, lines = max(0, len(lines) - MOST_LINES), lines[:MOST_LINES]
    end = max(max(record.ended or 0.0, record.began or 0.0, record.created) for record, _ in lines) or 1e-3
    size = (NAMES + BARS + 2 * MARGIN, (len(lines) + 2) * LINE + 2 * MARGIN)
    picture = Image.new("RGB", (size[0] * FINE, size[1] * FINE), PAPER)
    pen = ImageDraw.Draw(picture)
    top = MARGIN + LINE
    _draw_time(pen, end, top, top + len(lines) * LINE)
    for row, (record, depth) in enumerate(lines):
        _draw_task(pen, record, depth, top + row * LINE, end)
    _draw_legend(pen, top + len(lines) * LINE + LINE // 4, left_out)
    return picture.resize(size, Image.LANCZOS)


def save_picture(trace: Trace, path: Path) -> None:
    """Draw a trace into a PNG file.

    Raises NaoError if the trace has no task, FileTrouble if the file cannot be written.
    """
    from PIL import Image

    # A few colours are enough, and a third of the size.
    with WholeFile(path) as file:
        draw_trace(trace).quantize(64, dither=Image.Dither.NONE).save(file, "PNG", optimize=True)


def draw_trace_file(argv: list[str] | None = None) -> int:
    """Draw a trace that was saved as JSON."""
    parser = argparse.ArgumentParser(description=draw_trace_file.__doc__)
    parser.add_argument("trace", type=Path, help="JSON file of a trace")
    parser.add_argument("picture", type=Path, help="PNG file to write")
    options = parser.parse_args(argv)
    try:
        save_picture(Trace.from_json(options.trace.read_text(encoding="utf-8")), options.picture)
    except (OSError, ValueError, KeyError, TypeError, NaoError) as error:
        print(f"{options.trace}: {error}", file=sys.stderr)
        return 1
    return 0


def _draw_time(pen: ImageDraw.ImageDraw, end: float, top: int, bottom: int) -> None:
    step = 10.0 ** math.floor(math.log10(end))
    step = next(each for each in (step / 5.0, step / 2.0, step, 2.0 * step) if end / each <= 8.0)
    for number in range(int(end / step) + 1):
        x = _x(number * step, end)
        pen.line([_fine(x, top), _fine(x, bottom)], fill=GRID, width=FINE)
        pen.text(_fine(x, top - 4), f"{number * step:g} s", FAINT, _font(), anchor="ms")


def _draw_task(pen: ImageDraw.ImageDraw, record: Record, depth: int, y: int, end: float) -> None:
    middle, color = y + LINE / 2.0, COLORS[record.state]
    x = MARGIN + depth * INDENT
    pen.ellipse([*_fine(x, middle - 4), *_fine(x + 8, middle + 4)], fill=color)
    arguments = record.facts.get("arguments", "")
    name = f"{record.name}({arguments})" if arguments else record.name
    pen.text(_fine(x + 14, middle), _fitting(pen, name, NAMES + MARGIN - 12 - (x + 14)), INK, _font(), "lm")
    if record.began is None:
        return
    begin, stop = _x(record.began, end), _x(record.ended if record.ended is not None else end, end)
    pen.rounded_rectangle([*_fine(begin, y + 5), *_fine(max(stop, begin + 2), y + LINE - 5)], 3 * FINE, fill=color)
    text = record.failure.partition(":")[0] if record.state == "failed" else record.result
    room_after, room_before = NAMES + MARGIN + BARS - stop - 6, begin - 6 - NAMES - MARGIN
    if text and room_after >= min(room_before, SHORTEST):
        pen.text(_fine(stop + 6, middle), _fitting(pen, text, room_after), FAINT, _font(), "lm")
    elif text:
        pen.text(_fine(begin - 6, middle), _fitting(pen, text, room_before), FAINT, _font(), "rm")


def _draw_legend(pen: ImageDraw.ImageDraw, y: int, left_out: int) -> None:
    x = float(MARGIN)
    for state, color in COLORS.items():
        pen.ellipse([*_fine(x, y + LINE / 2.0 - 4), *_fine(x + 8, y + LINE / 2.0 + 4)], fill=color)
        pen.text(_fine(x + 12, y + LINE / 2.0), state, FAINT, _font(), "lm")
        x += 12 + pen.textlength(state, _font()) / FINE + 18
    if left_out:
        pen.text(_fine(x, y + LINE / 2.0), f"({left_out} tasks more)", FAINT, _font(), "lm")


def _x(time: float, end: float) -> float:
    return NAMES + MARGIN + (BARS - 60) * time / end


def _fine(x: float, y: float) -> tuple[float, float]:
    return x * FINE, y * FINE


def _fitting(pen: ImageDraw.ImageDraw, text: str, width: float) -> str:
    """The text, cut to a width in pixels of the picture."""
    if pen.textlength(text, _font()) <= width * FINE:
        return text
    while text and pen.textlength(f"{text}…", _font()) > width * FINE:
        text = text[:-1]
    return f"{text}…" if text else ""


def _font() -> ImageFont.ImageFont:
    from PIL import ImageFont

    return ImageFont.load_default(TEXT * FINE)


if __name__ == "__main__":
    sys.exit(draw_trace_file())
