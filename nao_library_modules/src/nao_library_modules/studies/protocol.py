"""What a study's protocol consists of: factors, phases, steps, conditions such as `answer == yes`. Pure."""

from __future__ import annotations

import operator
import random
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

from naoqi.errors import NaoError

from ..behaviors.parameters import BadExpression, names_in, substitute, text_of
from ..core.errors import of_those
from ..core.nao_facts import names_of, sensors_of
from .commands import RobotCommand


class StudyError(NaoError):
    """A study or a trial cannot be done, or what it has left cannot be read."""


NOTHING = "none"
"""What a value is that has not been given yet, and the answer of a step without one."""
OPERATIONS = {
    "==": operator.eq,
    "!=": operator.ne,
    "<=": operator.le,
    ">=": operator.ge,
    "<": operator.lt,
    ">": operator.gt,
}
ORDERED = ("<", "<=", ">", ">=")
"""Operators that compare numbers only."""
FORM = (
    "a condition is VALUE == WORD, VALUE != WORD, or VALUE < NUMBER (also <=, >, >=); VALUE is a name, or arithmetic "
    "on names; {NAME} on the right stands for a value"
)
_COMPARISON = re.compile(r"\s*([^=!<>]+?)\s*(==|!=|<=|>=|<|>)\s*([^=!<>]*?)\s*")
_NAME = re.compile(r"\{([A-Za-z_]\w*)\}")
_ONE_EQUALS = re.compile(r"\s*([A-Za-z_]\w*)\s*=\s*([^=]+)")
_JOINED = re.compile(r"\s+(and|or|&&|\|\|)\s+")


@dataclass(frozen=True)
class StudyCondition:
    """A comparison of a value of the trial with a word, a number or another value."""

    left: str  # a name, or arithmetic on names and numbers
    operation: str  # one of `OPERATIONS`
    right: str  # a word, a number, or {name}
    line: int = field(default=0, compare=False)  # of the file

    @staticmethod
    def read(text: str, line: int = 0) -> StudyCondition:
        """Of its text. Raises ValueError if it is none."""
        joined = _JOINED.search(text)
        if joined:
            remedy = (
                "a list has several that all have to hold: [A == B, C == D]"
                if joined[1] in ("and", "&&")
                else "`choose` has a branch for each answer, and `timeout` ends a wait as well"
            )
            raise ValueError(f"{text!r} is no condition: `{joined[1]}` is not known; {remedy}")
        match = _COMPARISON.fullmatch(text)
        if match is None:
            single = _ONE_EQUALS.fullmatch(text)
            hint = f"did you mean {single[1]} == {single[2].strip()}? " if single else ""
            raise ValueError(f"{text!r} is no condition: {hint}{FORM}")
        left, operation, right = match.groups()
        condition = StudyCondition(left, operation, right.strip("'\""), line)
        try:
            condition.names()
        except BadExpression:
            raise ValueError(f"{left!r} in {text!r} cannot be read: {FORM}") from None
        if not condition.right:
            raise ValueError(f"{text!r} has nothing on the right; {NOTHING} is what an answer is that was not given")
        if operation in ORDERED and not _NAME.fullmatch(condition.right) and number_of(condition.right) is None:
            raise ValueError(f"{right!r} in {text!r} is no number: {operation} compares numbers")
        return condition

    def names(self) -> list[str]:
        """Names that it asks for."""
        return [*names_in(_expression(self.left)), *_NAME.findall(self.right)]

    def holds(self, values: Mapping[str, Any]) -> bool:
        """Whether it is true. A value that was not given is `none`, and neither less nor greater than a number."""
        left, right = self._left(values), filled(self.right, _given(_NAME.findall(self.right), values))
        number, other = number_of(left), number_of(right)
        if number is not None and other is not None:
            return bool(OPERATIONS[self.operation](number, other))
        if self.operation in ORDERED:
            return False
        return bool(OPERATIONS[self.operation](text_of(left), right))

    def _left(self, values: Mapping[str, Any]) -> Any:
        given = _given(names_in(_expression(self.left)), values)
        if self.left in given:
            return given[self.left]
        numbers = {name: number_of(value) for name, value in given.items()}
        try:
            return NOTHING if None in numbers.values() else substitute(_expression(self.left), numbers)
        except BadExpression:  # it divides by zero
            return NOTHING

    def __str__(self) -> str:
        return f"{self.left} {self.operation} {self.right}"


def filled(text: str, values: Mapping[str, Any]) -> str:
    """A text with its `{name}` replaced by values; names that there are not stay as they are."""
    return _NAME.sub(lambda match: text_of(values[match[1]]) if match[1] in values else match[0], text)


def unknown_names(text: str, known: Iterable[str]) -> list[str]:
    """What is to be said of the `{name}` in a text that mean nothing."""
    names = list(known)
    return [f"there is no {{{name}}}{of_those(name, names)}" for name in _NAME.findall(text) if name not in names]


def number_of(value: Any) -> float | None:
    """A number, also of its text; None for anything else."""
    if isinstance(value, bool):
        return None
    try:
        return float(value)
    except (TypeError, ValueError):
        return None


def _given(names: Iterable[str], values: Mapping[str, Any]) -> dict[str, Any]:
    return {name: NOTHING if values.get(name) in (None, "") else values[name] for name in names}


def _expression(text: str) -> str:
    return "${" + text + "}"


def generator(seed: int, values: Mapping[str, Any], path: str) -> random.Random:
    """What draws for one place of a protocol. `values`: of the trial. `path`: of the step."""
    return random.Random(f"{seed}:{values['number']}:{values['trial']}:{path}")


HOLD, SKIP, STOP = "hold", "skip", "stop"
ON_ERROR = (HOLD, SKIP, STOP)
"""What a failed step does: the trial waits for the wizard, goes on, or is aborted."""
SENSES = ("touch", "word", "sound", "face")
OTHER_NAMES = {"person": "face"}
"""What a sense may be called as well: a robot knows a person by the face."""
COUNTED = {"touched": "touches", "heard": "words", "seen": "faces"}
"""Kind of an event -> what conditions that are waited for call its count."""
LIVE = (*COUNTED.values(), "seconds")
"""What a condition that is waited for may ask beside the values of the trial: what happened in the window of the step,
and the time since it began, s."""
NOW = "now"
"""As `since` of a step that waits: only what happens after its begin counts."""
TIME_UP = "time"
"""Answer of a `while` that its own time has ended."""
GIVEN = ("participant", "number", "trial", "trials")
"""Values that every trial has: pseudonym and number of the participant, which trial of how many it is for him."""
DONE = "done"
"""Answer of a step that was done and asks nothing. One that timed out or was skipped has `NOTHING`."""
FIRST, LAST = "first", "last"
BAG_TOPICS = ("joint_states", "/tf", "/rosout")
"""Of a rosbag that a protocol does not name topics for."""


@dataclass(frozen=True)
class ProtocolStep:
    """A step of a protocol, or a group of them."""

    kind: ClassVar[str] = ""
    line: int  # of the file, from 1
    label: str  # name of its answer; empty: none

    @property
    def text(self) -> str:
        """What it does, for people; may have `{name}` in it."""
        return self.kind

    @property
    def answers(self) -> tuple[str, ...]:
        """What its answer can be; empty: anything."""
        return (DONE, NOTHING)

    def inner(self) -> Iterator[tuple[str, tuple[ProtocolStep, ...]]]:
        """Steps inside of a group, each list with the part of the path to it; of a `while` its first round."""
        return iter(())

    def inside(self, part: str) -> tuple[ProtocolStep, ...] | None:
        """Steps behind a part of a path; None if there are none."""
        return dict(self.inner()).get(part)


@dataclass(frozen=True)
class CommandStep(ProtocolStep):
    """The robot does something."""

    kind: ClassVar[str] = "robot"
    command: RobotCommand
    timeout: float  # s of ROS time; 0: none
    on_error: str  # one of `ON_ERROR`

    @property
    def text(self) -> str:
        return self.command.label

    @property
    def asks(self) -> bool:
        """Whether its answer is what the functions answer, rather than that they were done."""
        return any(form in (self.command.source or {}) for form in ("call", "chain"))

    @property
    def answers(self) -> tuple[str, ...]:
        return () if self.asks else (DONE, NOTHING)


@dataclass(frozen=True)
class ChoiceStep(ProtocolStep):
    """The wizard chooses."""

    kind: ClassVar[str] = "wizard"
    question: str
    choices: tuple[str, ...]
    timeout: float  # s of ROS time; 0: none

    @property
    def text(self) -> str:
        return self.question

    @property
    def answers(self) -> tuple[str, ...]:
        return (*self.choices, NOTHING)


@dataclass(frozen=True)
class SenseStep(ProtocolStep):
    """The robot waits for a touch, a word, a sound or a face."""

    sense: str  # one of `SENSES`
    names: tuple[str, ...]  # sensors or groups; words; names of faces (none: anybody); none for sounds
    timeout: float  # s of ROS time
    confidence: float  # 0..1, of words, sounds and names; 0: as the server has it
    since: str = ""  # `NOW`, the label of an earlier step, or empty: since the wait before

    @property
    def kind(self) -> str:  # type: ignore[override]
        return self.sense

    @property
    def text(self) -> str:
        return f"wait for a {self.sense}" + (f": {', '.join(self.names)}" if self.names else "")

    @property
    def answers(self) -> tuple[str, ...]:
        if self.sense == "touch":
            return (*names_of(sensors_of(self.names)), NOTHING)
        if self.sense == "sound":
            return (self.sense, NOTHING)
        return (*self.names, NOTHING) if self.names else ()


@dataclass(frozen=True)
class PauseStep(ProtocolStep):
    """Time passes."""

    kind: ClassVar[str] = "time"
    seconds: float  # of ROS time; the least, where it is drawn
    longest: float | None = None  # where it is drawn evenly: the most
    seed: int = 0

    @property
    def text(self) -> str:
        return f"wait {self.seconds:g} s" if self.longest is None else f"wait {self.seconds:g} to {self.longest:g} s"

    def drawn(self, path: str, values: Mapping[str, Any]) -> PauseStep:
        """With the time that is drawn for a place in a trial, in ms."""
        if self.longest is None:
            return self
        seconds = generator(self.seed, values, path).uniform(self.seconds, self.longest)
        return replace(self, seconds=round(seconds, 3), longest=None)


@dataclass(frozen=True)
class UntilStep(ProtocolStep):
    """The trial waits until all conditions hold."""

    kind: ClassVar[str] = "condition"
    conditions: tuple[StudyCondition, ...]
    timeout: float  # s of ROS time; 0: none
    since: str = ""  # as of a `SenseStep`

    @property
    def text(self) -> str:
        return f"wait until {' and '.join(map(str, self.conditions))}"


@dataclass(frozen=True)
class BranchStep(ProtocolStep):
    """The first branch is taken whose conditions all hold."""

    kind: ClassVar[str] = "branch"
    branches: tuple[tuple[tuple[StudyCondition, ...], tuple[ProtocolStep, ...]], ...]  # conditions (none: else), steps

    def inner(self) -> Iterator[tuple[str, tuple[ProtocolStep, ...]]]:
        return ((f"b{i}", steps) for i, (_, steps) in enumerate(self.branches, 1))

    def branch(self, values: Mapping[str, Any]) -> int:
        """Number of the branch that is taken, from 1; 0: none."""
        holds = (i for i, (ifs, _) in enumerate(self.branches, 1) if all(each.holds(values) for each in ifs))
        return next(holds, 0)


@dataclass(frozen=True)
class RoundsStep(ProtocolStep):
    """The same steps several times."""

    kind: ClassVar[str] = "rounds"
    count: int
    name: str  # of the value that is 1, 2, ...; empty: none
    steps: tuple[ProtocolStep, ...]
    seed: int | None = None  # of the order in which the value is 1, 2, ...; None: as they are counted

    def value(self, number: int, path: str, values: Mapping[str, Any]) -> int:
        """The value in a round. `number`: of the round, from 1. `path`: of this step. `values`: of the trial."""
        if self.seed is None:
            return number
        order = list(range(1, self.count + 1))
        generator(self.seed, values, path).shuffle(order)
        return order[number - 1]

    def inner(self) -> Iterator[tuple[str, tuple[ProtocolStep, ...]]]:
        return ((f"r{i}", self.steps) for i in range(1, self.count + 1))


@dataclass(frozen=True)
class WhileStep(ProtocolStep):
    """Steps that are done until something happens, which ends the one that runs."""

    kind: ClassVar[str] = "while"
    waits: tuple[ProtocolStep, ...]  # SenseStep, PauseStep, UntilStep: the first that is over ends it
    steps: tuple[ProtocolStep, ...]  # of the robot, pauses, and groups of those
    rounds: int  # how often they are done; 0: until it ends
    timeout: float  # s of ROS time; 0: none

    def drawn(self, path: str, values: Mapping[str, Any]) -> WhileStep:
        """With the times that are drawn for a place in a trial."""
        waits = (
            each.drawn(f"{path}.{i}", values) if isinstance(each, PauseStep) else each
            for i, each in enumerate(self.waits, 1)
        )
        return replace(self, waits=tuple(waits))

    @property
    def text(self) -> str:
        what = " and ".join(step.text for step in self.steps[:2]) + (" ..." if len(self.steps) > 2 else "")
        return f"while {what}: {' or '.join(each.text for each in self.waits)}"

    @property
    def answers(self) -> tuple[str, ...]:
        own = [(TIME_UP,) if isinstance(each, PauseStep) else each.answers for each in self.waits]
        return tuple(dict.fromkeys((*(answer for answers in own for answer in answers), NOTHING))) if all(own) else ()

    def inner(self) -> Iterator[tuple[str, tuple[ProtocolStep, ...]]]:
        return iter((("w1", self.steps),))

    def inside(self, part: str) -> tuple[ProtocolStep, ...] | None:
        return self.steps if re.fullmatch(r"w[1-9]\d*", part) else None


WAITING = (ChoiceStep, SenseStep, UntilStep, WhileStep)
"""Steps that wait for somebody: what happens after the end of one of them counts in the next."""


@dataclass(frozen=True)
class StudyPhase:
    """A part of a trial."""

    name: str
    only: str  # `FIRST` or `LAST`: only in that trial of a participant; empty: in each
    steps: tuple[ProtocolStep, ...]


@dataclass(frozen=True)
class StudyFactor:
    """What differs between trials, or between participants."""

    name: str
    levels: Mapping[str, Mapping[str, Any]]  # level -> values that texts may name while it holds
    within: bool  # each participant meets all levels; else one


@dataclass(frozen=True)
class WantedRecordings:
    """What is recorded of each trial."""

    bag: tuple[str, ...] = ()  # topics of the rosbag, relative to the robot or absolute; none: no rosbag
    video: str = ""  # camera: top or bottom; empty: no video
    sound: bool = False


@dataclass(frozen=True)
class StudyProtocol:
    """A study.

    `order`: one of `schedule.ORDERS`. `seed`: of what is drawn: orders, pauses. `values`: values that texts may name,
    of the whole study. `text`: the file as it was read. `blind`: whether the wizard must not know orders and
    conditions.
    """

    name: str
    help: str
    factors: tuple[StudyFactor, ...]
    order: str
    seed: int
    values: Mapping[str, Any]
    record: WantedRecordings
    phases: tuple[StudyPhase, ...]
    text: str
    blind: bool = False

    def values_in(self, condition: Mapping[str, str]) -> dict[str, Any]:
        """Values of a condition: those of the study, the levels by their factors, and the values of the levels."""
        values = {**self.values, **condition}
        for factor in self.factors:
            values.update(factor.levels[condition[factor.name]])
        return values
