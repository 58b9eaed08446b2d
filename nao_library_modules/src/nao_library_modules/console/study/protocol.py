"""A protocol as it was read: factors, phases, steps."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar

from ...nao.touch_names import names_of, sensors_of
from ..robots.commands import RobotCommand
from .conditions import NOTHING, StudyCondition
from .drawing import generator

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

    `order`: one of `order.ORDERS`. `seed`: of what is drawn: orders, pauses. `values`: values that texts may name, of
    the whole study. `text`: the file as it was read. `blind`: whether the wizard must not know orders and conditions.
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
