"""What a behaviour is made of. Pure data; `player.py` plays it."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from typing import Mapping, Tuple, Union

from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.control.joints.bezier import PackedKeyPoints

NO_NATURE = "no nature"
STEP_BYTES = 200
"""Of a step or a joint's way without what is in it, about."""


class BehaviorFailed(SimulationError):
    """A behaviour that cannot go on; the text names its step."""


@dataclass(frozen=True)
class JointWay:
    """Where one joint goes, from wherever it is when the step begins.

    Times of its points are in s after that, rising from above 0; angles in rad (hands 0..1). Their handles shape a
    curved way; else it is smooth and at rest at both ends.
    """

    points: PackedKeyPoints
    curved: bool = False

    @property
    def length(self) -> float:
        """Time of the last point, s."""
        return self.points[-1].time


@dataclass(frozen=True)
class Joints:
    """Joints that move through key points, all at once; their ways are by name."""

    ways: Mapping[str, JointWay]

    @property
    def length(self) -> float:
        """How long it takes, s."""
        return max(way.length for way in self.ways.values())


@dataclass(frozen=True)
class Gesture:
    """An animation of arms and head that ends where it began, by its name in the library of animations."""

    name: str


@dataclass(frozen=True)
class Lights:
    """An LED or a group that fades, in s, to red, green, blue, 0..1; LEDs of one colour take the blue part."""

    group: str
    color: Tuple[float, float, float]
    duration: float


@dataclass(frozen=True)
class Say:
    """A text that is spoken, animated by gestures or not."""

    text: str
    animated: bool = False


@dataclass(frozen=True)
class GoToPosture:
    """A predefined posture that the robot goes to; the speed is a share of the top speed, above 0 to 1."""

    name: str
    speed: float = 0.8


@dataclass(frozen=True)
class Wait:
    """Nothing for a while, s."""

    duration: float


@dataclass(frozen=True)
class InTurn:
    """Steps one after the other."""

    steps: Tuple[Step, ...]


@dataclass(frozen=True)
class Together:
    """Steps that begin at the same time; it ends when all have ended."""

    steps: Tuple[Step, ...]


@dataclass(frozen=True)
class Repeat:
    """A step again and again; None times are until somebody stops the behaviour."""

    step: Step
    times: int | None


Step = Union[Joints, Gesture, Lights, Say, GoToPosture, Wait, InTurn, Together, Repeat]


@dataclass(frozen=True, eq=False)
class Behavior:
    """A behaviour by NAOqi's path, for example "animations/Stand/Gestures/Hey_1"; its help is one line about it.

    Its nature, "solitary", "interactive" or "no nature", says whether autonomous life may make it its activity.
    """

    name: str
    step: Step
    help: str = ""
    nature: str = NO_NATURE
    tags: Tuple[str, ...] = ()


def words(step: Step) -> str:
    """A single step as error texts name it."""
    if isinstance(step, Joints):
        return f"move of {', '.join(list(step.ways)[:3])}"
    if isinstance(step, (Gesture, GoToPosture)):
        return f"{'gesture' if isinstance(step, Gesture) else 'posture'} {step.name}"
    if isinstance(step, Say):
        return f"text {step.text[:40]!r}"
    return f"lights {step.group}" if isinstance(step, Lights) else type(step).__name__


def bytes_of(step: Step) -> int:
    """Memory that a step takes, about."""
    if isinstance(step, (InTurn, Together)):
        return STEP_BYTES + sum(map(bytes_of, step.steps))
    if isinstance(step, Repeat):
        return STEP_BYTES + bytes_of(step.step)
    if isinstance(step, Joints):
        return STEP_BYTES + sum(STEP_BYTES + way.points.nbytes for way in step.ways.values())
    return STEP_BYTES + (sys.getsizeof(step.text) if isinstance(step, Say) else 0)


def takes_time(step: Step) -> bool:
    """Whether a step cannot be over at once: what is repeated without end must not be."""
    if isinstance(step, (InTurn, Together)):
        return any(map(takes_time, step.steps))
    if isinstance(step, Repeat):
        return takes_time(step.step)
    if isinstance(step, (Wait, Lights)):
        return step.duration > 0.0
    # Going to a posture that one is in takes a look or two, and what is spoken at least a breath.
    return not isinstance(step, Say)


def joints_of(step: Step) -> frozenset[str]:
    """Names of the joints that a step moves by key points."""
    if isinstance(step, (InTurn, Together)):
        return frozenset().union(*map(joints_of, step.steps))
    if isinstance(step, Repeat):
        return joints_of(step.step)
    return frozenset(step.ways) if isinstance(step, Joints) else frozenset()


def length_of(step: Step) -> float:
    """Time that the key points of a step take, s; what is spoken and ways to postures are not counted."""
    if isinstance(step, InTurn):
        return sum(map(length_of, step.steps))
    if isinstance(step, Together):
        return max(map(length_of, step.steps), default=0.0)
    if isinstance(step, Repeat):
        return length_of(step.step) * (step.times or 1)
    if isinstance(step, (Wait, Lights)):
        return step.duration
    return step.length if isinstance(step, Joints) else 0.0
