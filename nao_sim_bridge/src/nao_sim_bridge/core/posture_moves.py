"""Moves between postures: key frames from `config/posture_moves.json`, and straight ones where these are safe.

A *move* leads from a posture, or from any pose of a family, to a predefined posture. Those of the file are dynamic:
they run at their own speed. A *direct* move takes every joint straight to its goal, as fast as the caller likes.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Mapping, Sequence, Tuple

from nao_sim_bridge.base.config import check_keys, config_file, number, read_json
from nao_sim_bridge.base.errors import ConfigError
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.control.balance.posture_recognition import BACK, BELLY, CROUCHING, FAMILIES, SITTING, STANDING
from nao_sim_bridge.control.joints.curves import SmoothCurve
from nao_sim_bridge.core.robot import SimulatedRobot
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.postures import load_postures, posture
from nao_sim_bridge.model.robot_model import RobotModel

FILE = "posture_moves.json"


@dataclass(frozen=True)
class Ground:
    """Families within which straight moves are safe: from any of their poses to the postures of these families.

    Attributes:
        families: Names of the families.
        least: Time a move takes at full speed at least, s.
        arms_aside: Whether the arms make way for the legs: hands that lie on the legs do not come past them.
    """

    families: Tuple[str, ...]
    least: float
    arms_aside: bool = False


# Tried under physics: standing moves stay on both feet even at the top speed of the joints, 0.5 s; the times are those
# of a robot that does not shake.
ON_THE_FEET = Ground((STANDING, CROUCHING), 0.8)
ON_THE_BACK = Ground((BACK,), 1.5)
GROUNDS = (ON_THE_FEET, Ground((SITTING,), 0.6, arms_aside=True), Ground((BELLY,), 1.5), ON_THE_BACK)
# Angles of arms that make way, rad, on the left; the right ones are mirrored.
ASIDE = {"ShoulderRoll": 0.9, "ElbowRoll": -0.3}
# Hands come to the floor from above: slid along it, they would stick.
BENT = {"ElbowRoll": -1.5}
SIDES = (("L", 1), ("R", -1))
# The peak speed of a smooth curve from rest to rest is this times its mean.
PEAK = 1.5


@dataclass(frozen=True)
class KeyFrame:
    """A pose of a move.

    Attributes:
        duration: Time to reach it from the one before, s.
        angles: Joint index to angle, rad (hands 0..1).
    """

    duration: float
    angles: Mapping[int, float]


@dataclass(frozen=True)
class Move:
    """A way from one posture to another.

    Attributes:
        start: Posture or family it begins in.
        goal: Posture it ends in.
        frames: Its poses, the last of them the goal.
        dynamic: True when it goes at its own speed, not through rest; False for a direct one.
        certainty: Share of trials under physics, with noise, in which it led where it should; above 0 to 1.
    """

    start: str
    goal: str
    frames: Tuple[KeyFrame, ...]
    dynamic: bool = True
    certainty: float = 1.0

    @property
    def duration(self) -> float:
        """Time of the whole move, s."""
        return sum(frame.duration for frame in self.frames)

    @property
    def expected_duration(self) -> float:
        """Time until it has led where it should, s, when it may have to be repeated."""
        return self.duration / self.certainty

    @property
    def goal_family(self) -> str:
        return load_postures().by_name[self.goal].family

    def __str__(self) -> str:
        return f"{self.start} -> {self.goal}"


@lru_cache(maxsize=None)
def load_moves() -> Tuple[Move, ...]:
    """The moves of the file, read once.

    Raises:
        ConfigError: A move has a wrong, unknown or missing entry.
    """
    return moves_of(read_json(config_file(FILE)))


def moves_of(content: Any) -> Tuple[Move, ...]:
    """The moves that the content of a file describes.

    Raises:
        ConfigError: A move has a wrong, unknown or missing entry.
    """
    check_keys(content, FILE, ["moves"], ["_meta"])
    if not isinstance(content["moves"], list):
        raise ConfigError(f"{FILE}: moves", f"is a {type(content['moves']).__name__}, not a list")
    model = load_model()
    return tuple(_move(entry, f"{FILE}: moves[{i}]", model) for i, entry in enumerate(content["moves"]))


def play(robot: SimulatedRobot, name: str, move: Move) -> Task:
    """Run a move on the whole body, which must be stiff: one smooth curve for each joint through all key frames.

    A joint that no frame names stays where it is told to be.
    """
    body = range(len(robot.model.joints))

    def curves(commands: Sequence[float]) -> dict[int, SmoothCurve]:
        return {i: _curve(move, i, commands[i]) for i in body}

    # Found by search with joints that lag behind where the frames ask for more than they can: no news.
    return robot.motion.follow(name, body, curves, noticed=not move.dynamic)


def direct(model: RobotModel, start: str, goal: str, angles: Sequence[float], fraction: float, ground: Ground) -> Move:
    """The straight move to a posture.

    Args:
        angles: (26,) command angles it begins at, rad.
        fraction: Share of the joints' top speeds, above 0 to 1.
        ground: What makes the move safe.
    """
    aims = posture(model, goal)
    poses = [aims]
    if ground.arms_aside:
        aside, bent = _both_arms(model, ASIDE), _both_arms(model, BENT)
        poses = [_with(angles, aside), _with(aims, aside), _with(aims, bent), aims]
    frames = []
    for pose, before in zip(poses, [angles, *poses]):
        slowest = max(abs(a - b) / joint.max_velocity for a, b, joint in zip(pose, before, model.joints))
        frames.append(KeyFrame(max(PEAK * slowest, ground.least) / fraction, dict(enumerate(pose))))
    return Move(start, goal, tuple(frames), dynamic=False)


def _both_arms(model: RobotModel, left: Mapping[str, float]) -> dict[int, float]:
    """Angles by joint index of both arms, from those of the left one (rolls only, which the right one mirrors)."""
    return {model.joint_index[f"{side}{joint}"]: sign * a for joint, a in left.items() for side, sign in SIDES}


def _with(pose: Sequence[float], changes: Mapping[int, float]) -> Sequence[float]:
    return [changes.get(index, angle) for index, angle in enumerate(pose)]


def _curve(move: Move, index: int, command: float) -> SmoothCurve:
    times, values, now = [0.0], [command], 0.0
    for frame in move.frames:
        now += frame.duration
        if index in frame.angles:
            times.append(now)
            values.append(frame.angles[index])
    if times[-1] < now:
        times.append(now)
        values.append(values[-1])
    return SmoothCurve(tuple(times), tuple(values))


def _move(entry: Any, where: str, model: RobotModel) -> Move:
    check_keys(entry, where, ["from", "to", "frames"], ["checked", "note"])
    postures = load_postures().by_name
    _one_of(entry["from"], f"{where}.from", [*postures, *FAMILIES])
    _one_of(entry["to"], f"{where}.to", postures)
    if not isinstance(entry["frames"], list) or not entry["frames"]:
        raise ConfigError(f"{where}.frames", "is no list of key frames, at least one")
    frames = (_frame(frame, f"{where}.frames[{i}]", model) for i, frame in enumerate(entry["frames"]))
    return Move(entry["from"], entry["to"], tuple(frames), certainty=_certainty(entry.get("checked"), where))


def _certainty(checked: Any, where: str) -> float:
    """Share of the trials that led where they should; a move that nobody has tried is believed."""
    if checked is None:
        return 1.0
    if not isinstance(checked, Mapping):
        raise ConfigError(f"{where}.checked", f"is {checked!r}, not a mapping with runs and reached")
    runs, reached = (number(checked.get(key), f"{where}.checked.{key}") for key in ("runs", "reached"))
    if not 0 < reached <= runs:
        raise ConfigError(f"{where}.checked", f"reached is {reached:g} of {runs:g} runs, allowed is above 0 to all")
    return reached / runs


def _frame(entry: Any, where: str, model: RobotModel) -> KeyFrame:
    check_keys(entry, where, ["time", "angles"])
    check_keys(entry["angles"], f"{where}.angles", [], model.joint_index)
    angles = {
        model.joint_index[joint]: float(number(value, f"{where}.angles.{joint}"))
        for joint, value in entry["angles"].items()
    }
    duration = float(number(entry["time"], f"{where}.time"))
    if not duration > 0.0:
        raise ConfigError(f"{where}.time", f"is {duration}, not above 0")
    return KeyFrame(duration, angles)


def _one_of(value: Any, where: str, allowed: Any) -> None:
    if value not in allowed:
        raise ConfigError(where, f"is {value!r}, allowed is {', '.join(allowed)}")
