"""A protocol as it was read: factors, phases, steps."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from ...nao.touch_names import names_of, sensors_of
from ..robots.commands import RobotCommand
from .conditions import StudyCondition

HOLD, SKIP, STOP = "hold", "skip", "stop"
ON_ERROR = (HOLD, SKIP, STOP)
"""What a failed step does: the trial waits for the wizard, goes on, or is aborted."""
SENSES = ("touch", "word", "face")
LIVE = ("touches", "words", "faces", "seconds")
"""What a condition that is waited for may ask beside the values of the trial: counts since the step began, and its
time, s."""
GIVEN = ("participant", "number", "trial", "trials")
"""Values that every trial has: pseudonym and number of the participant, which trial of how many it is for him."""
NOTHING, DONE = "none", "done"
"""Answers of a step that timed out or was skipped, and of one that was done and asks nothing."""
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
        """Steps inside of a group, each list with the part of the path that leads to it."""
        return iter(())


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
    """The robot waits for a touch, a word or a face."""

    sense: str  # one of `SENSES`
    names: tuple[str, ...]  # sensors or groups; words; names of faces (none: anybody)
    timeout: float  # s of ROS time
    confidence: float  # 0..1, of words and names; 0: as the server has it

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
        return (*self.names, NOTHING) if self.names else ()


@dataclass(frozen=True)
class PauseStep(ProtocolStep):
    """Time passes."""

    kind: ClassVar[str] = "time"
    seconds: float  # of ROS time

    @property
    def text(self) -> str:
        return f"wait {self.seconds:g} s"


@dataclass(frozen=True)
class UntilStep(ProtocolStep):
    """The trial waits until all conditions hold."""

    kind: ClassVar[str] = "condition"
    conditions: tuple[StudyCondition, ...]
    timeout: float  # s of ROS time; 0: none

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

    def inner(self) -> Iterator[tuple[str, tuple[ProtocolStep, ...]]]:
        return ((f"r{i}", self.steps) for i in range(1, self.count + 1))


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

    `order`: one of `order.ORDERS`. `seed`: of random orders. `values`: values that texts may name, of the whole study.
    `text`: the file as it was read.
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

    def values_in(self, condition: Mapping[str, str]) -> dict[str, Any]:
        """Values of a condition: those of the study, the levels by their factors, and the values of the levels."""
        values = {**self.values, **condition}
        for factor in self.factors:
            values.update(factor.levels[condition[factor.name]])
        return values
