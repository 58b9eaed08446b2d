"""A behaviour that is edited: its text, its steps and what of them can be changed, undo and redo."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

from ...behaviors.behavior_errors import BehaviorError, Problem
from ...behaviors.behavior_reader import KINDS, read
from ...behaviors.model import Behavior, at_of
from ...behaviors.strict_yaml import load
from ...core.errors import BadGoal
from ...studies.commands import LONGEST
from .yaml_places import (
    EditRefused,
    Place,
    delete_item,
    delete_key,
    insert_item,
    move_item,
    set_value,
    value_at,
)

GROUPS = ("parallel", "race", "timeline", "do")
"""Keys with lists of steps."""
DIGITS = 3
"""Decimal places of times that are dragged: ms."""
_ROUND = re.compile(r"#\d+")
_NUMBER = re.compile(r"\d+")


def step_path(path: str) -> str:
    """The step of the file that a path of a run is about: of a round its repetition's, of a box the box."""
    return _ROUND.sub("", path.partition("/")[0])


def place_of(content: Any, path: str) -> Place:
    """Where a step stands. `content`: values of the file. Raises EditRefused if there is none of that path."""
    place: Place = ("do",)
    numbers = [int(number) - 1 for number in _NUMBER.findall(path)]
    if not numbers:
        raise EditRefused(f"{path!r} is no path of a step, as 2.1")
    for depth, number in enumerate(numbers):
        if depth:
            key = group_of(value_at(content, place))
            place = (*place, key) if key else place
        place = (*place, number)
    value_at(content, place)
    return place


def group_of(step: Any) -> str | None:
    """The key of a step with the steps inside of it; empty for a list of steps, None for a step without any inside."""
    if isinstance(step, list):
        return ""
    found = [key for key in GROUPS if isinstance(step, dict) and key in step]
    return found[0] if found else None


def kind_of_step(step: Any) -> str:
    """What says what a step does: one of the keys of behaviours, or SERVER.FUNCTION; empty for what is no step."""
    if isinstance(step, list):
        return "do"
    if not isinstance(step, dict):
        return ""
    kinds = [key for key in step if isinstance(key, str) and (key in KINDS or "." in key)]
    return "repeat" if "repeat" in kinds else kinds[0] if kinds else ""


def functions_in(step: Any) -> list[tuple[str, str, Mapping[str, Any], Place]]:
    """Server, function, fields and their place in the step, for each function that a step calls."""
    kind = kind_of_step(step)
    if "." in kind:
        server, _, function = kind.partition(".")
        return [(server, function, step[kind] or {}, (kind,))]
    if kind == "chain" and isinstance(step["chain"], dict):
        return [
            (server, str(each.get("function", "")), each, ("chain", server, number))
            for server, functions in step["chain"].items()
            for number, each in enumerate(functions or [])
            if isinstance(each, dict)
        ]
    return []


def is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def shifted(at: Any, seconds: float) -> Any:
    """A value of `at` that is later by so many s, never before what it counts from.

    Raises EditRefused if its time is calculated.
    """
    try:
        time = at_of(at)
    except BadGoal as error:
        raise EditRefused(str(error)) from None
    if not is_number(time.offset):
        raise EditRefused(f"its time is calculated, {time.offset}: edit the field at")
    offset = round(max(time.offset + seconds, 0.0), DIGITS)
    if not time.label:
        return offset
    name = f"{time.label}.end" if time.of_end else time.label
    return f"{name} + {offset:g}" if offset else name


def can_shift(step: Any) -> bool:
    """Whether the time of an entry of a timeline can be dragged."""
    try:
        shifted(step.get("at", 0.0), 0.0)
    except (EditRefused, AttributeError):
        return False
    return True


def stretches(step: Any) -> Iterator[tuple[Place, Callable[[float, float], Any]]]:
    """Fields that make a step longer: their place in it, and from its former and its new length to their new value."""
    if not isinstance(step, dict):
        return
    if is_number(step.get("wait")):
        yield ("wait",), lambda _, new: round(new, DIGITS)
        return
    functions = functions_in(step)
    if len(functions) == 1:
        _, _, fields, place = functions[0]
        times = fields.get("times")
        if is_number(fields.get("duration")) and fields["duration"] > 0.0:
            rest = fields["time"] if is_number(fields.get("time")) else 0.0
            yield (*place, "duration"), lambda _, new: round(max(new - rest, 0.05), DIGITS)
            return
        if isinstance(times, list) and times and all(map(is_number, times)):
            yield (*place, "times"), lambda old, new: [round(each * new / old, DIGITS) for each in times]
            return
        if is_number(fields.get("time")) and fields["time"] > 0.0:
            time = fields["time"]
            yield (*place, "time"), lambda old, new: round(max(time + new - old, 0.0), DIGITS)
            return
    if is_number(step.get("for")):
        yield ("for",), lambda _, new: round(new, DIGITS)


def can_stretch(step: Any) -> bool:
    return next(stretches(step), None) is not None


MOST_KEPT = 200
"""Former texts."""
TEMPLATE = """\
help: {help}
do:
  - wait: 1.0
"""
HELP = "What it does."
SHORTEST = 0.05
"""s that a step has at least which is stretched by hand."""


class BehaviorDocument:
    """The text of a behaviour and its history; every edit is an edit of the text.

    One thread changes it, others may look.

    Args:
        name: That it is stored under; empty for a new one.
        shipped: Whether it comes with the library: it is stored under another name.

    Attributes:
        text: As it is now.
        behavior: As far as it can be read; None where it cannot.
        problems: What is wrong with the text by itself.
        content: Its values; None where it is no YAML.
    """

    def __init__(self, name: str, text: str, shipped: bool = False) -> None:
        self.name = name
        self.shipped = shipped
        self._stored = text
        self._before: list[str] = []
        self._after: list[str] = []
        self._take(text)

    @classmethod
    def new(cls, help_: str = HELP) -> BehaviorDocument:
        """One that is not stored yet."""
        document = cls("", TEMPLATE.format(help=help_))
        document._stored = ""
        return document

    @property
    def changed(self) -> bool:
        """Whether it differs from what is stored."""
        return self.text != self._stored

    @property
    def stored_text(self) -> str:
        """As it is stored; of one that is not, as it was begun."""
        return self._stored or TEMPLATE.format(help=HELP)

    @property
    def file(self) -> str:
        """What problems call its file."""
        return f"{self.name or 'new'}.yaml"

    def stored(self, name: str) -> None:
        """Note that it is stored as it is now."""
        self.name, self.shipped, self._stored = name, False, self.text

    def set_text(self, text: str) -> None:
        """Replace the whole text."""
        if text != self.text:
            self._before = [*self._before, self.text][-MOST_KEPT:]
            self._after.clear()
            self._take(text)

    def undo(self) -> None:
        if self._before:
            self._after.append(self.text)
            self._take(self._before.pop())

    def redo(self) -> None:
        if self._after:
            self._before.append(self.text)
            self._take(self._after.pop())

    # --- looking ------------------------------------------------------------------------------------------------------

    def step(self, path: str) -> Any:
        """The values of a step. Raises EditRefused if there is none of that path."""
        return value_at(self.content, place_of(self.content, path))

    def has(self, path: str) -> bool:
        try:
            self.step(path)
        except EditRefused:
            return False
        return True

    def in_timeline(self, path: str) -> bool:
        """Whether a step is an entry of a timeline."""
        return place_of(self.content, path)[-2] == "timeline"

    # --- edits: each raises EditRefused with what to do instead -------------------------------------------------------

    def set_key(self, path: str, key: str, value: Any) -> None:
        """Give a step another value of a key of its own, as label, at, for or wait; None removes it."""
        place = self._place(path)
        if isinstance(value_at(self.content, place), list):
            raise EditRefused(f"a list of steps has no {key}: write `do: [...]`, which may have it")
        self._change((*place, key), value)

    def set_field(self, path: str, number: int, field: str, value: Any) -> None:
        """Give a field of one of the functions of a step another value; None removes it. `number`: counted from 0."""
        functions = functions_in(self.step(path))
        if number >= len(functions):
            raise EditRefused(f"step {path} has no function {number + 1}: the text has changed")
        self._change((*self._place(path), *functions[number][3], field), value)

    def set_parameter(self, path: str, name: str, value: Any) -> None:
        """Give a parameter of a box another value; None: its default."""
        place = self._place(path)
        given = value_at(self.content, place).get("parameters")
        if given is None and value is None:
            return
        if given is None:
            self._change((*place, "parameters"), {name: value})
        else:
            self._change((*place, "parameters", name), value)

    def shift(self, path: str, seconds: float) -> None:
        """Have an entry of a timeline begin later by so many s, or sooner."""
        step = self.step(path)
        if not self.in_timeline(path) or not isinstance(step, dict):
            raise EditRefused("only entries of a timeline have a time: others follow each other")
        if "barrier" in step:
            raise EditRefused("a barrier comes when all above has ended")
        self.set_key(path, "at", shifted(step.get("at", 0.0), seconds))

    def stretch(self, path: str, former: float, seconds: float) -> None:
        """Have a step take so many s. `former`: s that it takes now."""
        for place, value in stretches(self.step(path)):
            old = max(former, SHORTEST)
            self._set((*self._place(path), *place), value(old, max(seconds, SHORTEST)))
            return
        raise EditRefused("it takes what it takes: give it a duration, or a time after which it is ended (for)")

    def insert(self, step: Any, path: str = "", inside: bool = False, begin: float = 0.0) -> str:
        """Put in a step behind another one, inside of a group behind all, or at the end of all; its path.

        `begin`: s from the beginning, where it becomes an entry of a timeline.
        """
        place, index, above = self._spot(path, inside)
        if place[-1] == "timeline":
            step = {**step, "at": round(begin, 2)} if "barrier" not in step else step
        self.set_text(insert_item(self.text, place, index, step))
        return f"{above}.{index + 1}" if above else str(index + 1)

    def duplicate(self, path: str) -> str:
        """Put in a step once more behind itself, without its label; the path of the second."""
        place = self._place(path)
        step = self.step(path)
        if isinstance(step, dict):
            step = {key: value for key, value in step.items() if key != "label"}
        self.set_text(insert_item(self.text, place[:-1], int(place[-1]) + 1, step))
        return self._with_number(path, int(place[-1]) + 2)

    def delete(self, path: str) -> None:
        self.set_text(delete_item(self.text, self._place(path)))

    def move(self, path: str, target: str, inside: bool = False, after: bool = True) -> None:
        """Move a step beside another one, or into a group behind all that is in it.

        An entry of a timeline that leaves it has no time any more; one that comes to one gets one.
        """
        place, index, _ = self._spot(target, inside)
        if not inside and not after:
            index -= 1
        source = self._place(path)
        step, text = self.step(path), self.text
        if isinstance(step, dict):
            if place[-1] != "timeline" and "at" in step:
                text = delete_key(text, (*source, "at"))
            elif place[-1] == "timeline" and "at" not in step and "barrier" not in step:
                text = set_value(text, (*source, "at"), 0.0)
        self.set_text(move_item(text, source, place, index))

    def reorder(self, path: str, by: int) -> str:
        """Move a step among those beside it; where it is then. `by`: 1: later, -1: sooner."""
        place = self._place(path)
        position = int(place[-1])
        last = len(value_at(self.content, place[:-1])) - 1
        new = min(max(position + by, 0), last)
        if new != position:
            self.set_text(move_item(self.text, place, place[:-1], new + (new > position)))
        return self._with_number(path, new + 1)

    # --- helpers ------------------------------------------------------------------------------------------------------

    def _take(self, text: str) -> None:
        content: Any = None
        behavior: Behavior | None = None
        problems: Sequence[Problem] = ()
        try:
            if len(text) > LONGEST:
                told = f"the text has {len(text)} characters: pages show {LONGEST} at most"
                raise BehaviorError(self.file, [Problem("", told)])
            content = load(text, self.name or "new")
            behavior = read(text, self.name or "new", self.file)
        except BehaviorError as error:
            behavior, problems = error.readable, error.problems
        # All at once: who draws the document looks at it from another thread.
        self.text, self.content, self.behavior, self.problems = text, content, behavior, tuple(problems)

    def _place(self, path: str) -> Place:
        return place_of(self.content, step_path(path))

    def _spot(self, path: str, inside: bool) -> tuple[Place, int, str]:
        """The list behind a step, or inside of it; the position there; and the path of the group that has the list."""
        if not path:
            return ("do",), len(value_at(self.content, ("do",))), ""
        place = self._place(path)
        if not inside:
            return place[:-1], int(place[-1]) + 1, path.rpartition(".")[0]
        step = value_at(self.content, place)
        key = group_of(step)
        if key is None:
            raise EditRefused(f"a step {kind_of_step(step)} holds no others")
        inner = (*place, key) if key else place
        return inner, len(value_at(self.content, inner)), path

    def _change(self, place: Place, value: Any) -> None:
        if value is not None:
            self._set(place, value)
        elif place[-1] in (value_at(self.content, place[:-1]) or ()):
            self._edit(lambda text: delete_key(text, place))

    def _set(self, place: Place, value: Any) -> None:
        self._edit(lambda text: set_value(text, place, value))

    def _edit(self, edit: Callable[[str], str]) -> None:
        self.set_text(edit(self.text))

    @staticmethod
    def _with_number(path: str, number: int) -> str:
        above, dot, _ = path.rpartition(".")
        return f"{above}{dot}{number}"
