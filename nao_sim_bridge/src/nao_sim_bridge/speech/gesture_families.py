"""NAOqi's animations, built from families of gestures in `config/gestures.json` when somebody asks for one."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache
from typing import Callable, Iterator, Mapping, Sequence, Tuple

import numpy as np

from nao_sim_bridge.base.config import check_keys, config_file, read_json, section
from nao_sim_bridge.base.errors import ConfigError
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.speech.gesture import Animation, KeyFrames

FILE = "gestures.json"
TABLES = ("poses", "heads", "leans", "tempi", "play", "families", "names", "older")
ARM = ("ShoulderPitch", "ShoulderRoll", "ElbowYaw", "ElbowRoll", "WristYaw", "Hand")
# Which way a positive angle of a pose turns the joints of each arm.
SIGNS = {"L": (1.0, 1.0, -1.0, -1.0, -1.0, 1.0), "R": (1.0, -1.0, 1.0, 1.0, 1.0, 1.0)}
OTHER_ARM = {"L": "R", "R": "L"}
SIDES = {"Left": "L", "Right": "R"}
HANG = "hang"
# Angles stay so far from the limits of their joints, rad.
MARGIN = 0.03
# Joints take no more than this share of their top speed, also when speech has the gesture done as quickly as it may be.
SPEED_SHARE = 0.55
# The top speed of a smooth curve between two points at rest, times its mean speed.
PEAK = 1.5
# A trunk that leans by the hips goes back by the ankles by this share: its centre of mass stays over the soles.
ANKLE_SHARE = 0.35
# Multiples of these fill a cube of five dimensions evenly: gestures of a family that follow each other lie far apart.
# Source: M. Roberts' generalisation of the golden ratio.
SPREAD = np.array([0.875, 0.7656, 0.6699, 0.5862, 0.5129])
NAME = re.compile(r"(?:(Left|Right|Center)_(Slow|Neutral|Strong)_)?(\w+)_\d+")


@dataclass(frozen=True)
class Tempo:
    """How quick and how large gestures are.

    Attributes:
        begin: From the start to the first pose, s.
        beat: From one pose to the next, s.
        end: From the last pose back to where the gesture began, s.
        size: How far poses are from hanging arms, times what the table says.
        again: How often the last two poses are done once more.
    """

    begin: float
    beat: float
    end: float
    size: float
    again: int


@dataclass(frozen=True)
class Play:
    """How far gestures of a family are spread around what their strokes say.

    Attributes:
        height: Of the upper arm, up and down, rad.
        out: Of the upper arm, only outwards, lest hands touch, rad.
        forearm: Of the elbow, rad.
        beat: Share of the time between poses.
        size: Share of the way from hanging arms.
    """

    height: float
    out: float
    forearm: float
    beat: float
    size: float

    def of(self, rank: int, begin: float, share: float) -> Play:
        """What the gesture of a rank has of it, up to `share` of it; each family begins elsewhere."""
        places = (SPREAD * (rank + 0.618 * begin)) % 1.0 * 2.0 - 1.0
        whole = (self.height, self.out, self.forearm, self.beat, self.size)
        height, out, forearm, beat, size = (share * place * width for place, width in zip(places.tolist(), whole))
        return Play(height, (out + share * self.out) / 2.0, forearm, beat, size)


@dataclass(frozen=True)
class Family:
    """Gestures of one meaning: of each list a further name takes the next entry, and so on in circles.

    Attributes:
        strokes: Names of poses of the arm that leads; behind a slash those of the other one.
        others: What the other arm does where a stroke does not say it: same, late, swap, none, or a pose.
        sided: As `others`, of gestures to one side.
        heads: How the head moves.
        leans: How the trunk of a standing robot leans.
        tempi: How quick gestures are whose name does not say it.
        leads: Arms that lead, L or R, where the name does not say it.
        rest: The pose in which the other arm waits.
        calm: Share of the spread of other families, where hands are to be in one place.
    """

    strokes: Tuple[str, ...]
    others: Tuple[str, ...]
    heads: Tuple[str, ...]
    sided: Tuple[str, ...] = ("none",)
    leans: Tuple[str, ...] = ("none",)
    tempi: Tuple[str, ...] = ("Neutral",)
    leads: Tuple[str, ...] = ("R",)
    rest: str = HANG
    calm: float = 1.0


@dataclass(frozen=True)
class Naming:
    """What the table of names says of one animation; its rank is that among the names of its family.

    Those of robots before NAOqi 2.8 have no tags: programs name them, and nothing else chooses them.
    """

    tags: Tuple[str, ...]
    family: str
    side: str | None
    tempo: str | None
    rank: int


class _Tables:
    """The file, read into what is needed; the numbers of its poses are checked when the arms take them."""

    def __init__(self) -> None:
        tables = check_keys(read_json(config_file(FILE)), FILE, TABLES, ("_meta",))
        self.poses: Mapping[str, Sequence[float]] = tables["poses"]
        self.heads: Mapping[str, Sequence[Sequence[float]]] = tables["heads"]
        self.leans: Mapping[str, Sequence[Sequence[float]]] = tables["leans"]
        self.tempi = {n: section(Tempo, entry, f"{FILE}: tempi: {n}") for n, entry in tables["tempi"].items()}
        self.play = section(Play, tables["play"], f"{FILE}: play")
        self.families = {name: _family(name, entry) for name, entry in tables["families"].items()}
        self._ranks: dict[tuple[str, str], int] = {}
        self.names = dict(self._named(tables["names"], lambda tags: tuple(tags.split(", "))))
        self.names.update(self._named(tables["older"], lambda _: ()))

    def _named(
        self, folders: Mapping[str, Mapping[str, str]], tags_of: Callable[[str], Tuple[str, ...]]
    ) -> Iterator[Tuple[str, Naming]]:
        for folder, rows in folders.items():
            for written, said in rows.items():
                for group in written.split(", "):
                    yield from self._group(folder, group, said, tags_of(said))

    def _group(self, folder: str, group: str, said: str, tags: Tuple[str, ...]) -> Iterator[Tuple[str, Naming]]:
        stem, *numbers = group.split(" ")
        for number in _numbers(numbers):
            names = [f"{stem}_{number}".replace("Side", side) for side in (SIDES if stem.startswith("Side") else [""])]
            side, tempo, base = NAME.fullmatch(names[0]).groups()
            posture = folder.split("/")[1]
            candidates = [f"{posture}/{base}", base, *tags] if tags else [said]
            family = next((name for name in candidates if name in self.families), None)
            if family is None:
                raise ConfigError(f"{FILE}: {folder}/{names[0]}", f"has no family, which is one of {candidates}")
            kind = (family, "one" if side in SIDES else "both")
            self._ranks[kind] = self._ranks.get(kind, -1) + 1
            for name in names:
                side = NAME.fullmatch(name).group(1)
                yield f"{folder}/{name}", Naming(tags, family, side, tempo, self._ranks[kind])


@lru_cache(maxsize=None)
def _tables() -> _Tables:
    return _Tables()


def names() -> Mapping[str, Naming]:
    """All animations of the table by name."""
    return _tables().names


@lru_cache(maxsize=None)
def build(name: str) -> Animation:
    """The animation of a name of the table; the same object each time."""
    tables, naming = _tables(), _tables().names[name]
    return _Builder(tables, naming).build(name)


class _Builder:
    """Puts one gesture together."""

    def __init__(self, tables: _Tables, naming: Naming) -> None:
        self._tables, self._naming = tables, naming
        self._family = family = tables.families[naming.family]
        rank = naming.rank
        # Where a stroke comes again, the next of the other lists goes with it.
        lap, place = divmod(rank, len(family.strokes))
        self._stroke = family.strokes[place]
        self._lead = SIDES.get(naming.side or "") or _turn(family.leads, rank)
        self._other = _turn(family.sided if naming.side in SIDES else family.others, place + lap)
        self._head, self._lean = _turn(family.heads, place + lap), _turn(family.leans, rank)
        self._tempo = tables.tempi[naming.tempo or _turn(family.tempi, place + lap)]
        begin = list(tables.families).index(naming.family) + 0.37 * (naming.side in SIDES)
        self._play = tables.play.of(rank, begin, family.calm)
        self._size = self._tempo.size * (1.0 + self._play.size)

    def build(self, name: str) -> Animation:
        leading, other = self._arms()
        poses = {self._lead: leading}
        if other:
            poses[OTHER_ARM[self._lead]] = other
        ways = {arm: np.array([self._pose(pose, arm) for pose in way]) for arm, way in poses.items()}
        times = self._times(ways)
        joints = {
            f"{arm}{part}": KeyFrames(times[:-1], tuple(way[:, i].round(4).tolist()))
            for arm, way in ways.items()
            for i, part in enumerate(ARM)
        }
        joints.update(self._head_frames(times))
        joints.update(self._lean_frames(times))
        return Animation(name, times[-1], self._naming.tags, joints)

    def _arms(self) -> tuple[list[str], list[str]]:
        """Names of the poses of the arm that leads and of the other one, which may have none."""
        leading, _, written = self._stroke.partition(" / ")
        way = leading.split()
        if written and self._naming.side not in SIDES:
            other = written.split()
        elif self._other == "same":
            other = way
        elif self._other == "late":
            other = [self._family.rest, *way[:-1]]
        elif self._other == "swap":
            other = way[1:] + way[:1]
        else:
            other = [] if self._other == "none" else [self._other] * len(way)
        again = self._tempo.again if len(way) > 1 else 0
        return way + way[-2:] * again, other + other[-2:] * again

    def _pose(self, name: str, arm: str) -> list[float]:
        """Angles of an arm, as far from hanging as this gesture is large, within the limits of its joints."""
        rest, pose = np.array(self._tables.poses[HANG]), np.array(self._tables.poses[name])
        angles = rest + (pose - rest) * np.array([self._size, self._size, 1.0, 1.0, 1.0, 1.0])
        if name in self._stroke.split():
            angles[[0, 1, 3]] += self._play.height, self._play.out, self._play.forearm
        model = load_model()
        limited = []
        for part, sign, angle in zip(ARM, SIGNS[arm], angles.tolist()):
            limits = model.joint(arm + part)
            margin = 0.0 if part == "Hand" else MARGIN
            limited.append(min(max(sign * angle, limits.lower + margin), limits.upper - margin))
        return limited

    def _times(self, ways: Mapping[str, np.ndarray]) -> Tuple[float, ...]:
        """Times of the poses and of the end, s: as the tempo says, or as slow as the joints need."""
        tempo, model = self._tempo, load_model()
        count = len(next(iter(ways.values())))
        steps = np.array([tempo.begin, *[tempo.beat * (1.0 + self._play.beat)] * (count - 1), tempo.end])
        for arm, way in ways.items():
            home = np.array(self._tables.poses[HANG]) * SIGNS[arm]
            top = np.array([model.joint(arm + part).max_velocity for part in ARM])
            ends = np.vstack([home, way, home])
            steps = np.maximum(steps, (np.abs(np.diff(ends, axis=0)) * PEAK / (SPEED_SHARE * top)).max(axis=1))
        return tuple(np.cumsum(steps).round(3).tolist())

    def _head_frames(self, times: Sequence[float]) -> dict[str, KeyFrames]:
        mirror = 1.0 if self._lead == "L" else -1.0
        points = [(mirror * yaw, pitch) for yaw, pitch in self._tables.heads[self._head]]
        return _frames(("HeadYaw", "HeadPitch"), points, 0.6 * times[0], times[-2])

    def _lean_frames(self, times: Sequence[float]) -> dict[str, KeyFrames]:
        mirror = 1.0 if self._lead == "L" else -1.0
        points = [(pitch, mirror * roll) for pitch, roll in self._tables.leans[self._lean]]
        moved = {}
        for side in "LR":
            legs = [(-pitch, ANKLE_SHARE * pitch, -roll, roll) for pitch, roll in points]
            names = [f"{side}{joint}" for joint in ("HipPitch", "AnklePitch", "HipRoll", "AnkleRoll")]
            moved.update(_frames(names, legs, times[0], times[-2]))
        return moved


def _frames(joints: Sequence[str], points: Sequence[Sequence[float]], begin: float, end: float) -> dict[str, KeyFrames]:
    """Key frames at even times from `begin` to `end`, s, of those joints that move at all."""
    times = tuple(np.linspace(begin, end, len(points)).round(3).tolist()) if len(points) > 1 else (round(begin, 3),)
    columns = zip(joints, zip(*points))
    return {joint: KeyFrames(times, tuple(angles)) for joint, angles in columns if any(angles)}


def _family(name: str, entry: Mapping) -> Family:
    fields = check_keys(entry, f"{FILE}: families: {name}", ("strokes", "others", "heads"), Family.__annotations__)
    single = {key: fields[key] for key in ("rest", "calm") if key in fields}
    lists = {key: tuple(fields[key].split()) for key in fields if key not in ("strokes", *single)}
    return Family(strokes=tuple(fields["strokes"]), **lists, **single)


def _numbers(written: Sequence[str]) -> Iterator[str]:
    """Numbers as they are in names: those of "01", "04-06" are "01", "04", "05", "06"."""
    for part in written:
        first, _, last = part.partition("-")
        for number in range(int(first), int(last or first) + 1):
            yield f"{number:0{len(first)}d}"


def _turn(choices: Sequence[str], number: int) -> str:
    return choices[number % len(choices)]
