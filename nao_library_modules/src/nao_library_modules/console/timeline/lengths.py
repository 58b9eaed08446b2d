"""How long the steps of a behaviour take, as far as that can be told before they run."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import yaml

from naoqi.errors import NaoError

from ...base.paths import config_file
from ...behaviors.language.preview import times_of
from ...behaviors.language.program import GoalNode, Node, OnTimeline, ParallelNode, Pause, RaceNode, RepeatNode
from ...motion.recorded_motion import motion_of

USUAL = 1.0
"""s of a goal of which nothing is known."""
AT_ONCE = 0.1
"""s of a goal that sets something."""
OF_CHARACTER, OF_SPEECH = 0.065, 0.4
"""s that a character takes to be said, and every speech beside that: as the simulator's voice speaks."""
OF_POSTURE = 2.0
WALK, TURN = 0.08, 0.3
"""m/s and rad/s of a walk with its first and last step."""
_SETTING = ("set", "on", "off", "reset", "stop", "enable", "disable", "get", "list")


class Length(NamedTuple):
    """How long a goal takes, s. `sure`: whether its fields say so, or it was measured; else it is a guess."""

    seconds: float
    sure: bool


class Lengths:
    """Lengths of the nodes of a program. `measured`: path -> s that a step took when it ran."""

    def __init__(self, measured: Mapping[str, float] | None = None) -> None:
        self._measured = dict(measured or {})

    def of(self, node: Node) -> float:
        """S that a node takes."""
        inside = self._inside(node)
        return inside if node.limit is None else min(inside, node.limit)

    def sure(self, node: Node) -> bool:
        """Whether that is more than a guess."""
        if isinstance(node, GoalNode):
            return node.where in self._measured or length_of_goal(node).sure
        return all(map(self.sure, node.parts))

    def begins(self, timeline: OnTimeline) -> dict[str, float]:
        """When the entries of a timeline begin, s from its beginning, by path."""
        begins, _ = times_of(timeline, self.of)
        return {timeline.nodes[i].where: begin for i, begin in begins.items()}

    def _inside(self, node: Node) -> float:
        if isinstance(node, Pause):
            return node.duration
        if isinstance(node, GoalNode):
            return self._measured.get(node.where, length_of_goal(node).seconds)
        lengths = [self.of(part) for part in node.parts] if not isinstance(node, OnTimeline) else []
        if isinstance(node, RepeatNode):
            return node.count * sum(lengths)
        if isinstance(node, RaceNode):
            return min(lengths, default=0.0)
        if isinstance(node, ParallelNode):
            return max(lengths, default=0.0)
        if isinstance(node, OnTimeline):
            return max(times_of(node, self.of)[1].values(), default=0.0)
        return sum(lengths)


def length_of_goal(node: GoalNode) -> Length:
    """How long a goal takes."""
    lengths = [_length(node.server, message) for message in getattr(node.goal, node.goal.__slots__[0])]
    return Length(sum(each.seconds for each in lengths), all(each.sure for each in lengths))


def _length(server: str, message: Any) -> Length:
    wait = message.time.to_sec()
    own = _own_length(server, message)
    return Length(own.seconds + wait, own.sure)


def _own_length(server: str, message: Any) -> Length:
    function = message.function
    duration, times = getattr(message, "duration", 0.0), getattr(message, "times", ())
    if getattr(message, "background", False):
        return Length(AT_ONCE, False)
    if duration > 0.0:
        return Length(duration, True)
    if times:
        return Length(max(times), True)
    points = getattr(getattr(message, "trajectory", None), "points", ())
    if points:
        return Length(points[-1].time_from_start.to_sec(), True)
    if function == "playMotion":
        motion = shipped_motion(message.str_param)
        return Length(motion / (message.speed or 1.0), True) if motion else Length(USUAL, False)
    if function.lower().endswith("say"):
        return Length(OF_SPEECH + OF_CHARACTER * len(message.str_param), False)
    if function in ("moveTo", "walkTo") and len(message.values) >= 3:
        x, y, theta = message.values[-3:]
        return Length(AT_ONCE + math.hypot(x, y) / WALK + abs(theta) / TURN, False)
    if function == "goToPosture":
        return Length(OF_POSTURE, False)
    return Length(AT_ONCE if server == "NaoLights" or function.startswith(_SETTING) else USUAL, False)


@lru_cache(maxsize=None)
def shipped_motion(name: str) -> float:
    """S that a motion takes which comes with the library; 0 for others, which only their server knows."""
    folder = config_file("motions")
    path = folder / f"{Path(name).name}.yaml"
    if not path.is_file():
        return 0.0
    try:
        return motion_of(yaml.safe_load(path.read_text(encoding="utf-8")), name).duration
    except (OSError, ValueError, yaml.YAMLError, NaoError):
        return 0.0
