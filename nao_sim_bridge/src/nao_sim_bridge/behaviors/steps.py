"""What a behaviour is made of. Pure data; `player.py` plays it."""

from __future__ import annotations

import sys
from dataclasses import dataclass, field
from enum import Enum
from heapq import heappop, heappush
from typing import Iterator, Mapping, Tuple, Union

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
    """A text that is spoken, animated by gestures or not; with `given`, what the box before sends comes after it."""

    text: str
    animated: bool = False
    given: bool = False


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


@dataclass(frozen=True)
class Text:
    """A text that is sent to the next box: one for each language of ALTextToSpeech, or one under "" for all."""

    by_language: Mapping[str, str]


@dataclass(frozen=True)
class Language:
    """The language in which the robot speaks and listens from now on."""

    name: str


class Act(Enum):
    """What a signal does where it arrives."""

    START = "start"  # begins a box
    STOP = "stop"  # stops a box
    PASS = "pass"  # goes on inside of a box that was begun before
    OUT = "out"  # leaves the diagram by an output


@dataclass(frozen=True)
class Link:
    """Where a signal goes: to an input of a box, which is counted in its diagram, or to an output of the diagram."""

    act: Act
    port: str
    box: int = -1


@dataclass(frozen=True)
class Box:
    """A box of a diagram of Choregraphe.

    Attributes:
        step: What it does; None for nothing, and nothing that follows.
        links: Where the signals of each output go, by the id of the output.
        done: Outputs that send a signal at its end, `failed` when it fails, `stopped` when a link stops it; those of
            diagrams and timelines are in `step`.
        restarts: Whether it begins anew when it is begun while it runs; others run once more beside.
    """

    name: str
    step: Step | None
    links: Mapping[str, Tuple[Link, ...]]
    done: Tuple[str, ...] = ()
    failed: Tuple[str, ...] = ()
    stopped: Tuple[str, ...] = ()
    restarts: bool = False


@dataclass(frozen=True)
class Diagram:
    """Boxes that begin and stop one another.

    Attributes:
        links: Where the signals of each of its inputs go, by the id of the input; `starts` are those that begin it.
        loaded: Where the signal goes that it is loaded.
        events: Where the signals of events of ALMemory go, by their keys.
        ends: Outputs that end it.
    """

    boxes: Tuple[Box, ...]
    links: Mapping[str, Tuple[Link, ...]]
    starts: Tuple[str, ...] = ()
    loaded: Tuple[Link, ...] = ()
    events: Mapping[str, Tuple[Link, ...]] = field(default_factory=dict)
    ends: Tuple[str, ...] = ()


@dataclass(frozen=True)
class KeyFrame:
    """A diagram of a timeline, loaded after `begin`, s, until the next one of its layer or the end of the timeline."""

    begin: float
    layer: int
    diagram: Diagram


@dataclass(frozen=True)
class Timeline:
    """Joints that move, and diagrams that begin meanwhile.

    Attributes:
        end: When it ends, s, whatever runs; None: when nothing of it is left to happen.
        ends: Outputs that send a signal at its end.
        concludes: Whether it comes to an end by itself; on a robot others stay until they are stopped.
    """

    joints: Joints | None
    frames: Tuple[KeyFrame, ...]
    end: float | None
    ends: Tuple[str, ...] = ()
    concludes: bool = True


@dataclass(frozen=True)
class Refused:
    """A behaviour of a package that cannot be played, for this reason."""

    reason: str


Step = Union[
    Joints,
    Gesture,
    Lights,
    Say,
    GoToPosture,
    Wait,
    InTurn,
    Together,
    Repeat,
    Text,
    Language,
    Diagram,
    Timeline,
    Refused,
]


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
    if isinstance(step, Refused):
        return "which is not played"
    return f"lights {step.group}" if isinstance(step, Lights) else type(step).__name__


def parts_of(step: Step) -> Iterator[Step]:
    """The steps that a step is made of, one level down."""
    if isinstance(step, (InTurn, Together)):
        yield from step.steps
    elif isinstance(step, Repeat):
        yield step.step
    elif isinstance(step, Diagram):
        yield from (box.step for box in step.boxes if box.step is not None)
    elif isinstance(step, Timeline):
        yield from () if step.joints is None else (step.joints,)
        yield from (frame.diagram for frame in step.frames)


def bytes_of(step: Step) -> int:
    """Memory that a step takes, about."""
    own = STEP_BYTES
    if isinstance(step, Joints):
        own += sum(STEP_BYTES + way.points.nbytes for way in step.ways.values())
    elif isinstance(step, (Say, Refused)):
        own += sys.getsizeof(step.text if isinstance(step, Say) else step.reason)
    elif isinstance(step, Text):
        own += sum(map(sys.getsizeof, step.by_language.values()))
    elif isinstance(step, Diagram):
        own += STEP_BYTES * len(step.boxes)
    return own + sum(map(bytes_of, parts_of(step)))


def takes_time(step: Step) -> bool:
    """Whether a step cannot be over at once: what is repeated without end must not be."""
    if isinstance(step, (InTurn, Together, Repeat)):
        return any(map(takes_time, parts_of(step)))
    if isinstance(step, (Wait, Lights)):
        return step.duration > 0.0
    # Going to a posture that one is in takes a look or two, and what is spoken at least a breath.
    return not isinstance(step, Say)


def joints_of(step: Step) -> frozenset[str]:
    """Names of the joints that a step moves by key points."""
    return frozenset(step.ways) if isinstance(step, Joints) else frozenset().union(*map(joints_of, parts_of(step)))


def length_of(step: Step) -> float:
    """Time that the key points of a step take, s; what is spoken and ways to postures are not counted."""
    if isinstance(step, InTurn):
        return sum(map(length_of, step.steps))
    if isinstance(step, Together):
        return max(map(length_of, step.steps), default=0.0)
    if isinstance(step, Repeat):
        return length_of(step.step) * (step.times or 1)
    if isinstance(step, Diagram):
        return _length_of_diagram(step)
    if isinstance(step, Timeline):
        moving = 0.0 if step.joints is None else step.joints.length
        frames = (frame.begin + length_of(frame.diagram) for frame in step.frames)
        return max(moving, *frames, 0.0) if step.end is None else step.end
    if isinstance(step, (Wait, Lights)):
        return step.duration
    return step.length if isinstance(step, Joints) else 0.0


def _length_of_diagram(diagram: Diagram) -> float:
    """Until each box that begins has been played once."""
    begins = [link for port in diagram.starts for link in diagram.links.get(port, ())]
    due = [(0.0, link.box) for link in (*begins, *diagram.loaded) if link.act is Act.START]
    seen: set[int] = set()
    end = 0.0
    while due:
        time, number = heappop(due)
        box = diagram.boxes[number]
        if number in seen or box.step is None:
            continue
        seen.add(number)
        over = time + length_of(box.step)
        end = max(end, over)
        for links in box.links.values():
            for link in links:
                if link.act is Act.START:
                    heappush(due, (over, link.box))
    return end
