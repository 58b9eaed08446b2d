"""Text with instructions, as ^start(animations/Stand/Gestures/Hey_1), read into what is said and what is done."""

from __future__ import annotations

import ast
import logging
import re
from dataclasses import dataclass
from typing import Any, Iterator, Tuple, Union

from nao_sim_bridge.base.written_numbers import written_number

log = logging.getLogger("nao_sim.speech")

ANIMATION, TAG, SOUND, MODE, CALL = "animation", "tag", "sound", "mode", "call"
# Instruction -> what is done, and what its argument is.
INSTRUCTIONS = {
    "start": ("start", ANIMATION),
    "run": ("run", ANIMATION),
    "wait": ("wait", ANIMATION),
    "stop": ("stop", ANIMATION),
    "startTag": ("start", TAG),
    "runTag": ("run", TAG),
    "waitTag": ("wait", TAG),
    "stopTag": ("stop", TAG),
    "startSound": ("start", SOUND),
    "runSound": ("run", SOUND),
    "waitSound": ("wait", SOUND),
    "stopSound": ("stop", SOUND),
    "mode": ("mode", MODE),
    "call": ("call", CALL),
    "pCall": ("post", CALL),
}
MARK = re.compile(r"\^([A-Za-z]+)\(")
# So many instructions that never end are looked for to the end of the text; what comes behind them is text.
MOST_UNENDED = 20
# Characters: a parser may fail badly at deep brackets.
LONGEST_ARGUMENTS = 2000
METHOD = re.compile(r"\s*(\w+)\.(\w+)\s*\((.*)\)\s*", re.DOTALL)


@dataclass(frozen=True)
class Instruction:
    """Something to do at a place of the text."""

    act: str  # start, run, wait or stop an animation or a sound, change the mode, call or post a method
    kind: str  # what `value` is: an animation's name, a tag, a sound, a mode, or a call
    value: str  # as it is written


def read(text: str) -> list[Union[str, Instruction]]:
    """Texts and instructions in their order; what is no instruction of NAOqi's is left out, and told in the log."""
    parts: list[Union[str, Instruction]] = []
    unknown: dict[str, None] = {}
    place = 0
    for mark, end in _marks(text):
        parts.append(text[place : mark.start()])
        name, value = mark.group(1), text[mark.end() : end - 1].strip()
        if name in INSTRUCTIONS:
            parts.append(Instruction(*INSTRUCTIONS[name], value))
        else:
            unknown[name] = None
        place = end
    parts.append(text[place:])
    if unknown:
        left_out = ", ^".join(name[:20] for name in list(unknown)[:10])
        log.warning("instructions ^%s are left out, there are ^%s", left_out, ", ^".join(INSTRUCTIONS))
    return [part for part in parts if part != ""]


def path_and_tag(text: str) -> Tuple[str | None, str]:
    """The path, or None, and the tag of an instruction: "hello" or "animations/Stand, hello"."""
    path, comma, tag = text.rpartition(",")
    return (path.strip(), tag.strip()) if comma else (None, text.strip())


def sound_and_volume(text: str) -> Tuple[str, float]:
    """The sound, which is a set and a file, and its volume, 0..1: "Aldebaran/laugh" or "Aldebaran/laugh, 50".

    A ValueError when the volume is none.
    """
    sound, comma, percent = text.rpartition(",")
    if not comma:
        return text.strip(), 1.0
    volume = written_number(percent.strip(), 100)
    if volume is None:
        raise ValueError(f"{percent.strip()[:20]!r} is no volume, which is 0 to 100")
    return sound.strip(), volume / 100.0


def method_call(text: str) -> Tuple[str, str, list[Any]]:
    """Module, method and arguments of a call as it is written, for example ALLeds.fadeRGB("FaceLeds", "red", 0.5).

    A ValueError when the text is no such call.
    """
    found = METHOD.fullmatch(text)
    if found is None:
        raise ValueError(f"{text[:80]!r} is no call like Module.method(arguments)")
    module, method, arguments = found.groups()
    if len(arguments) > LONGEST_ARGUMENTS:
        raise ValueError(f"{text[:80]!r} has arguments of {len(arguments)} characters, at most {LONGEST_ARGUMENTS}")
    try:
        values = ast.literal_eval(f"({arguments},)") if arguments.strip() else ()
    except (SyntaxError, ValueError, TypeError, MemoryError, RecursionError) as error:  # the last two: nested deep
        raise ValueError(f"{text[:80]!r} has arguments that are no texts, numbers or lists") from error
    return module, method, list(values)


def _marks(text: str) -> Iterator[tuple[re.Match, int]]:
    """The instructions in a text, and where each ends: at the bracket that closes its own."""
    place = unended = 0
    while unended < MOST_UNENDED:
        mark = MARK.search(text, place)
        if mark is None:
            return
        end = _closing(text, mark.end())
        if end is None:
            place = mark.end()
            unended += 1
            continue
        yield mark, end
        place = end


def _closing(text: str, place: int) -> int | None:
    """Behind the bracket that closes the one before `place`; brackets in quotes do not count."""
    depth, quote = 1, ""
    for number in range(place, len(text)):
        letter = text[number]
        if quote:
            quote = "" if letter == quote else quote
        elif letter in "\"'" and (depth > 1):
            quote = letter
        else:
            depth += (letter == "(") - (letter == ")")
        if depth == 0:
            return number + 1
    return None
