"""Recorded motions: their values, their files, and the functions that record, replay and keep them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import yaml

from nao_library_msgs.msg import FunctionResult

from ..core.chain import checked_by
from ..core.errors import BadGoal, did_you_mean
from ..core.files import give_name, tidy, write_whole, written
from ..core.memory_functions import values_of
from ..core.yaml_values import Budget, load_within
from .motion_fields import (
    RATE,
    Limp,
    Mirror,
    Motion,
    NewMotion,
    NewName,
    Overwrite,
    RecordingTime,
    ReplaySpeed,
    SampleRate,
    SomeJoints,
    Stiffness,
    require_name,
)
from .motion_plan import BODY, DEFAULT_SPEED, BodyPart, RobotBody

if TYPE_CHECKING:
    from ..nao_basic import NaoBasic


# Between two key frames of a replayed motion a joint may be off the recording by this, rad: what the encoders tell
# apart, several times over.
THINNING = math.radians(0.2)
# A joint that leans on its stop measures a little more than its limit, and the limits of the two sides differ by up to
# half a degree: so far, in rad, a recorded angle may be off the limits of the joint that replays it.
SLACK = math.radians(1.5)
# Of the files; a later one may hold more.
VERSION = 1
# Joints whose sign changes in the mirror, by the end of their names.
TURNED = ("Roll", "Yaw")


@dataclass(frozen=True)
class RecordedMotion:
    """Angles of joints over time."""

    joints: tuple[str, ...]
    times: tuple[float, ...]  # s, rising, the first is 0
    angles: tuple[tuple[float, ...], ...]  # of each time those of the joints, rad (hands 0..1)

    @property
    def duration(self) -> float:
        """Time of the last sample, s."""
        return self.times[-1]

    @property
    def start(self) -> dict[str, float]:
        """Joint -> angle at the start, rad."""
        return dict(zip(self.joints, self.angles[0]))

    def faster(self, factor: float) -> RecordedMotion:
        """The same motion at `factor` times the speed."""
        return replace(self, times=tuple(time / factor for time in self.times))

    def mirrored(self) -> RecordedMotion:
        """The motion with left and right exchanged."""
        joints = tuple(_other_side(joint) for joint in self.joints)
        signs = [_sign(joint) for joint in joints]
        return replace(
            self,
            joints=joints,
            angles=tuple(tuple(sign * angle for sign, angle in zip(signs, row)) for row in self.angles),
        )

    def within(self, limits: Mapping[str, tuple[float, float]], slack: float = SLACK) -> RecordedMotion:
        """The motion with angles that are beyond a limit by no more than `slack` put on the limit.

        `limits`: joint -> lowest and highest angle, rad. Joints that are not in it stay as they are. `slack`: rad. What
        is farther off stays as it is: it is no measurement of such a joint.
        """
        ranges = [limits.get(joint, (-math.inf, math.inf)) for joint in self.joints]
        return replace(
            self,
            angles=tuple(
                tuple(_put_within(angle, *range_, slack) for angle, range_ in zip(row, ranges)) for row in self.angles
            ),
        )

    def key_frames(self, tolerance: float = THINNING) -> RecordedMotion:
        """The motion with as few samples as keep every joint within `tolerance` (rad) between straight lines."""
        keep = {0, len(self.times) - 1}
        open_ = [(0, len(self.times) - 1)]
        while open_:
            first, last = open_.pop()
            worst, where = self._worst(first, last)
            if worst > tolerance:
                keep.add(where)
                open_ += [(first, where), (where, last)]
        chosen = sorted(keep)
        return replace(self, times=tuple(self.times[i] for i in chosen), angles=tuple(self.angles[i] for i in chosen))

    def _worst(self, first: int, last: int) -> tuple[float, int]:
        """Largest distance of a sample from the line between two others, and which one it is."""
        worst, where = 0.0, first
        begin, end = self.angles[first], self.angles[last]
        span = self.times[last] - self.times[first]
        for i in range(first + 1, last):
            share = (self.times[i] - self.times[first]) / span
            off = max(abs(a - b - share * (e - b)) for a, b, e in zip(self.angles[i], begin, end))
            if off > worst:
                worst, where = off, i
        return worst, where

    def to_content(self) -> dict[str, Any]:
        """As plain values, for a file."""
        samples = [[round(time, 4), *(round(angle, 5) for angle in row)] for time, row in zip(self.times, self.angles)]
        return {"version": VERSION, "joints": list(self.joints), "samples": samples}


def motion_of(content: Any, where: str) -> RecordedMotion:
    """The motion in the content of a file, as `to_content` gives it; BadGoal calls it `where` if it is none."""
    if not isinstance(content, Mapping) or not {"joints", "samples"} <= set(content):
        raise _broken(where, "it has no joints or no samples")
    if content.get("version") != VERSION:
        raise _broken(where, f"its version is {content.get('version')!r}; known: {VERSION}")
    joints, samples = content["joints"], content["samples"]
    if not isinstance(joints, list) or not joints or not all(isinstance(joint, str) for joint in joints):
        raise _broken(where, "joints is no list of names")
    if len(set(joints)) < len(joints):
        raise _broken(where, "a joint comes twice")
    if not isinstance(samples, list) or not samples:
        raise _broken(where, "samples is no list")
    for i, row in enumerate(samples):
        if not isinstance(row, list) or len(row) != len(joints) + 1 or not all(map(_is_number, row)):
            raise _broken(where, f"sample {i} is not a time and {len(joints)} angles")
    times = [row[0] for row in samples]
    if times[0] != 0.0 or any(b <= a for a, b in zip(times, times[1:])):
        raise _broken(where, "times do not rise from 0")
    return RecordedMotion(tuple(joints), tuple(times), tuple(tuple(row[1:]) for row in samples))


def _broken(where: str, problem: str) -> BadGoal:
    return BadGoal("str_param", where, "a recorded motion", problem=f"motion {where!r}: {problem}")


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def _put_within(angle: float, lower: float, upper: float, slack: float) -> float:
    nearest = min(max(angle, lower), upper)
    return nearest if abs(nearest - angle) <= slack else angle


def _other_side(joint: str) -> str:
    if joint.startswith("L"):
        return f"R{joint[1:]}"
    return f"L{joint[1:]}" if joint.startswith("R") else joint


def _sign(joint: str) -> float:
    return -1.0 if joint.endswith(TURNED) else 1.0


def recorded(joints: Sequence[str], samples: Iterable[tuple[float, Sequence[float]]]) -> RecordedMotion:
    """A motion from samples of time (s, the first is taken as 0) and angles (rad)."""
    rows = list(samples)
    began = rows[0][0]
    return RecordedMotion(tuple(joints), tuple(time - began for time, _ in rows), tuple(tuple(row) for _, row in rows))


SUFFIX = ".yaml"
MOST_VALUES, DEEPEST = 10_000_000, 10
"""Of a file: values, more than the longest recording of all joints has, and lists in each other."""


class MotionStore:
    """Recorded motions by name.

    `folder`: where they are; made when the first one is saved. `shipped`: where there are more that can only be
    replayed; those in `folder` stand before them.
    """

    def __init__(self, folder: Path, shipped: Path | None = None) -> None:
        self.folder = folder
        self._shipped = shipped
        tidy(folder)

    def names(self) -> list[str]:
        """Names of the motions in the folder, sorted."""
        return _names(self.folder)

    def load(self, name: str) -> RecordedMotion:
        """A motion. Raises BadGoal if there is none of that name, or its file is broken."""
        path: Path | None = self.path(name)
        if not path.is_file():
            path = self._shipped_file(name)
            if path is None:
                raise self._unknown(name)
        try:
            content = load_within(path.read_text(encoding="utf-8"), Budget(MOST_VALUES, DEEPEST))
        except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
            raise BadGoal("str_param", name, "a recorded motion", problem=f"motion {name!r}: {error}") from error
        return motion_of(content, name)

    def save(self, name: str, motion: RecordedMotion, numbered: bool = False) -> Path:
        """Write a motion; one of that name is replaced as a whole, never left half written.

        `motion`: what to write. `numbered`: whether, where there is one of that name, it becomes name-2, name-3, ...
        and replaces none. Raises BadGoal if the name will not do, FileTrouble if the file cannot be written.
        """
        path = self.path(name)
        text = yaml.safe_dump(motion.to_content(), default_flow_style=None, sort_keys=False, width=10**6)
        return write_whole(path, text, numbered)

    def rename(self, name: str, new_name: str) -> Path:
        """Give a motion another name; answers its file.

        Raises BadGoal if there is none of that name, it comes with the library, there is one of the new name already,
        or the file cannot be renamed.
        """
        path, target = self.require(name), self.require_free(new_name)
        try:
            given = give_name(path, target)
        except OSError as error:
            problem = f"{path} cannot be renamed to {target.name}: {error.strerror or error}"
            raise BadGoal("texts", new_name, "a folder to write to", problem) from error
        return target if given else self.rename(name, new_name)  # one of that name came a moment ago

    def delete(self, name: str) -> None:
        """Delete a motion.

        Raises BadGoal if there is none of that name, it comes with the library, or the file cannot be deleted.
        """
        path = self.require(name)
        try:
            path.unlink()
        except OSError as error:
            problem = f"{path} cannot be deleted: {error.strerror or error}"
            raise BadGoal("str_param", name, "a folder to write to", problem) from error

    def require_free(self, name: str, field: str = "texts") -> Path:
        """File of a new motion, whose name is in `field` of the message.

        Raises BadGoal if the name will not do, or there is a motion of that name already.
        """
        path = self.path(name, field)
        if path.exists():
            allowed = "a name that is free, or overwrite" if field == "str_param" else "a name that is free"
            raise BadGoal(field, name, allowed, problem=f"there is a motion {name!r} already: {path}")
        return path

    def path(self, name: str, field: str = "str_param") -> Path:
        """File of a motion of that name, whether it is there or not. Raises BadGoal if the name will not do."""
        require_name(field, name)
        return self.folder / f"{name}{SUFFIX}"

    def require(self, name: str) -> Path:
        """File of a motion that can be renamed and deleted.

        Raises BadGoal if there is none of that name, or it comes with the library.
        """
        path = self.path(name)
        if not path.is_file():
            if self._shipped_file(name) is not None:
                problem = f"motion {name!r} comes with the library"
                raise BadGoal("str_param", name, "one that was recorded", problem=problem)
            raise self._unknown(name)
        return path

    def _shipped_file(self, name: str) -> Path | None:
        path = self._shipped / f"{name}{SUFFIX}" if self._shipped is not None else None
        return path if path is not None and path.is_file() else None

    def _unknown(self, name: str) -> BadGoal:
        known = sorted({*self.names(), *(_names(self._shipped) if self._shipped is not None else ())})
        allowed = f"one of {', '.join(known)}" if known else f"none is recorded in {self.folder} yet"
        return BadGoal("str_param", name, allowed, problem=f"there is no motion {name!r}{did_you_mean(name, known)}")


def _names(folder: Path) -> list[str]:
    return sorted(path.stem for path in folder.glob(f"*{SUFFIX}")) if folder.is_dir() else []


# The way to the first pose of a motion takes that long at least, s.
APPROACH = 0.5


class MotionRecording(BodyPart):
    """Recorded motions.

    `store`: recorded motions by name. `cut_short`: what recordings that were interrupted have left, for the result of
    the chain.
    """

    left_by_goals = frozenset({"store"})

    def __init__(self, module: NaoBasic, body: RobotBody, store: MotionStore) -> None:
        super().__init__(body)
        self._module = module
        self.store = store
        self.begin_chain()

    def begin_chain(self) -> None:
        self._new_names: set[str] = set()  # of motions that the chain records or renames
        self.cut_short: list[FunctionResult] = []

    prepare_for_checks = begin_chain

    def _check_recording(self, str_param: str, names: Sequence[str], duration: float, overwrite: bool) -> None:
        if not overwrite:
            self._require_free(str_param, "str_param")
        self.body.plan.leave_to_robot(self.body.joints(names or [BODY]), duration)
        self._new_names.add(str_param)

    @checked_by(_check_recording)
    def record_motion(
        self,
        str_param: NewMotion,
        names: SomeJoints,
        duration: RecordingTime,
        rate: SampleRate,
        limp: Limp,
        overwrite: Overwrite,
    ) -> dict[str, Any]:
        """Record joints for a time, or until the goal is cancelled; with `limp` they can be moved by hand."""
        joints = self.body.joints(names or [BODY])
        if limp:
            self._let_go(joints)
        samples: list[tuple[float, list[float]]] = []
        try:
            self._sample(joints, duration, 1.0 / (rate or RATE), samples)
        except BaseException:
            # Whoever teaches by hand does not know beforehand how long it takes, and cancels at the end. What came
            # until then is kept in any case; why it ends is what the goal tells.
            if samples:
                answer, told = self._save(str_param, joints, samples, overwrite)
                self.cut_short.append(FunctionResult(function="recordMotion", values=[*values_of(answer), told]))
            raise
        answer, told = self._save(str_param, joints, samples, overwrite)
        self._module.remark(told)
        return answer

    def _check_replay(self, str_param: str, speed: float, mirror: bool, stiffness: float) -> None:
        if str_param in self._new_names:
            return  # recorded by an earlier function of this chain: nothing is known of it yet
        plan = self.body.plan
        motion = self.replay(str_param, speed, mirror)
        where = f"str_param ({str_param})"
        self.body.joints(motion.joints, where)
        plan.require_stiff(motion.joints, stiffness)
        plan.move_with_speed(dict(motion.start), dict.fromkeys(motion.joints, DEFAULT_SPEED))
        if len(motion.times) > 1:
            values = {joint: [row[i] for row in motion.angles[1:]] for i, joint in enumerate(motion.joints)}
            plan.follow(values, motion.times[1:], False, where)

    @checked_by(_check_replay)
    def play_motion(self, str_param: Motion, speed: ReplaySpeed, mirror: Mirror, stiffness: Stiffness) -> float:
        """Replay a recorded motion, from wherever the joints are; answers how long it took, s."""
        motion = self.replay(str_param, speed, mirror)
        joints = list(motion.joints)
        self.body.stiffen(joints, stiffness)
        began = self._module.clock.now()
        self._approach(motion)
        if len(motion.times) > 1:
            paths = [[row[i] for row in motion.angles[1:]] for i in range(len(joints))]
            self.motion("angleInterpolation", joints, paths, [list(motion.times[1:])] * len(joints), True)
        self.body.require_reached(dict(zip(joints, motion.angles[-1])))
        return self._module.clock.now() - began

    def list_motions(self) -> list[str]:
        """Names of the recorded motions."""
        return self.store.names()

    def _check_deletion(self, str_param: str) -> None:
        if str_param in self._new_names:
            self._new_names.remove(str_param)
        else:
            self.store.require(str_param)

    def _check_rename(self, str_param: str, texts: Sequence[str]) -> None:
        self._check_deletion(str_param)
        self._require_free(texts[0], "texts")
        self._new_names.add(texts[0])

    def _require_free(self, name: str, field: str) -> None:
        if name in self._new_names:
            raise BadGoal(field, name, "a name that is free", problem=f"the chain makes a motion {name!r} before")
        self.store.require_free(name, field)

    @checked_by(_check_rename)
    def rename_motion(self, str_param: Motion, texts: NewName) -> None:
        """Give a recorded motion the name in `texts`."""
        self._module.remark(f"written: {self.store.rename(str_param, texts[0])}")

    @checked_by(_check_deletion)
    def delete_motion(self, str_param: Motion) -> None:
        """Delete a recorded motion."""
        self.store.delete(str_param)

    def replay(self, name: str, speed: float, mirror: bool) -> RecordedMotion:
        """A recorded motion as a message wants it, thinned out to key frames, measured angles put within limits."""
        motion = self.store.load(name).key_frames().faster(speed or 1.0)
        limits = {joint: (each.lower, each.upper) for joint, each in self.body.facts.limits.items()}
        return (motion.mirrored() if mirror else motion).within(limits)

    def _let_go(self, joints: list[str]) -> None:
        before = self.motion("getStiffnesses", joints)

        def stiffen() -> None:
            # Where the hand left them: stiffened joints must not jump back.
            self.body.motion_now("setAngles", joints, self.body.motion_now("getAngles", joints, True), 1.0)
            self.body.motion_now("setStiffnesses", joints, list(before))

        self._module.after_wait(stiffen)
        self.motion("setStiffnesses", joints, [0.0] * len(joints))

    def _sample(
        self, joints: list[str], duration: float, period: float, samples: list[tuple[float, list[float]]]
    ) -> None:
        began = self._module.clock.now()
        while True:
            now = self._module.clock.now() - began
            samples.append((now, list(self.motion("getAngles", joints, True))))
            if now >= duration:
                return
            # Counted from the start, so that the samples do not drift.
            due = (math.floor(now / period + 0.5) + 1) * period
            self._module.wait(max(0.0, min(due, duration) - (self._module.clock.now() - began)))

    def _save(
        self, name: str, joints: list[str], samples: list[tuple[float, list[float]]], overwrite: bool
    ) -> tuple[dict[str, Any], str]:
        """Keep a motion; what the function answers, and where the motion is."""
        rising = [row for i, row in enumerate(samples) if i == 0 or row[0] > samples[i - 1][0]]
        motion = recorded(joints, rising)
        path = self.store.save(name, motion, numbered=not overwrite)
        answer = {"motion": path.stem, "samples": len(motion.times), "duration": round(motion.duration, 3)}
        return answer, written(path, self.store.path(name))

    def _approach(self, motion: RecordedMotion) -> None:
        now = self.motion("getAngles", list(motion.joints), False)
        limits = self.body.facts.limits
        slowest = max(
            abs(angle - before) / (DEFAULT_SPEED * limits[joint].max_speed)
            for (joint, angle), before in zip(motion.start.items(), now)
        )
        time = max(APPROACH, slowest)
        angles = [[angle] for angle in motion.start.values()]
        self.motion("angleInterpolation", list(motion.joints), angles, [[time]] * len(angles), True)

    functions = {
        "recordMotion": record_motion,
        "playMotion": play_motion,
        "listMotions": list_motions,
        "renameMotion": rename_motion,
        "deleteMotion": delete_motion,
    }
