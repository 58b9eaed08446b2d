"""Reads behaviours strictly from YAML files (JSON is YAML, too). Units: s, rad (hands 0..1).

A file has `behaviors`, a mapping of names to behaviours. A behaviour has `do`, a list of steps that follow each other,
and may have `help`, `nature` (solitary, interactive, no nature) and `tags`. A step is one of

    frames: [{time: 0.5, angles: {HeadYaw: 0.3}}, ...]       key frames of joints; time is that since the frame before
    joints: {HeadYaw: {times: [...], angles: [...]}}         the same by joint, times since the begin of the step
    gesture: animations/Stand/Gestures/Hey_1                 an animation of ALAnimatedSpeech
    posture: Stand, speed: 0.8                               goes to a posture
    lights: FaceLeds, color: red | "#ff8800", duration: 0.5  fades LEDs; intensity: 0.3 in place of the colour
    say: "Hello!", animated: true                            speaks
    wait: 1.0                                                does nothing
    together: [step or list of steps, ...]                   begins all at once, ends with the last
    repeat: 3, do: [...]                                     again and again; 0: until it is stopped
"""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any, Callable, Mapping, Tuple

import yaml

from nao_sim_bridge.base.config import array, check_keys, number, read_bounded
from nao_sim_bridge.base.errors import ConfigError
from nao_sim_bridge.base.yaml_values import load_yaml
from nao_sim_bridge.behaviors.steps import (
    NO_NATURE,
    Behavior,
    Gesture,
    GoToPosture,
    InTurn,
    Joints,
    JointWay,
    Lights,
    Repeat,
    Say,
    Step,
    Together,
    Wait,
    takes_time,
)
from nao_sim_bridge.body.led_animations import COLOR_NAMES, color_of_int
from nao_sim_bridge.control.joints.bezier import KeyPoint, PackedKeyPoints
from nao_sim_bridge.model.leds_layout import load_leds
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.postures import load_postures

NATURES = ("solitary", "interactive", NO_NATURE)
# A file larger than this, in bytes, is no behaviour; nor is what nests deeper, has longer steps or more of them.
LARGEST_FILE, DEEPEST, LONGEST_STEP, MOST_STEPS = 4_000_000, 20, 3600.0, 5000
MOST_REPEATS, LONGEST_TEXT = 100_000, 5000
NAME = re.compile(r"[\w.\-]+(/[\w.\- ]+)*")


def read_behaviors(path: Path) -> dict[str, Behavior]:
    """The behaviours of a file by name.

    Raises:
        ConfigError: It cannot be read, or has a wrong, unknown or missing entry.
    """
    try:
        content = load_yaml(read_bounded(path, LARGEST_FILE).decode("utf-8"))
    except (OSError, ValueError, yaml.YAMLError) as error:
        raise ConfigError(path.name, f"cannot be read: {error}") from error
    return behaviors_of(content, path.name)


def behaviors_of(content: Any, file: str) -> dict[str, Behavior]:
    """The behaviours that the content of a file describes, as `read_behaviors`."""
    tables = check_keys(content, file, ["behaviors"], ["_meta"])["behaviors"]
    if not isinstance(tables, Mapping) or not tables:
        raise ConfigError(f"{file}: behaviors", f"is {tables!r}, not a mapping of names to behaviours")
    return {name: _behavior(name, entry, f"{file}: {name}") for name, entry in tables.items()}


def checked_name(name: Any, where: str) -> str:
    """A name that a behaviour may have; else a ConfigError."""
    if not isinstance(name, str) or not NAME.fullmatch(name) or {".", ".."} & set(name.split("/")):
        raise ConfigError(where, f"{name!r} is no name: letters, digits, _ - and . are, in parts divided by /")
    return name


def _behavior(name: Any, entry: Any, where: str) -> Behavior:
    fields = check_keys(entry, where, ["do"], ["help", "nature", "tags"])
    nature = fields.get("nature", NO_NATURE)
    if nature not in NATURES:
        raise ConfigError(f"{where}: nature", f"is {nature!r}, allowed is {', '.join(NATURES)}")
    tags = fields.get("tags", [])
    if not isinstance(tags, list) or not all(isinstance(tag, str) for tag in tags):
        raise ConfigError(f"{where}: tags", f"is {tags!r}, not a list of texts")
    step = _Reader().steps(fields["do"], f"{where}: do", 0)
    return Behavior(checked_name(name, where), step, str(fields.get("help", "")), nature, tuple(tags))


class _Reader:
    """Reads the steps of one behaviour and counts them."""

    def __init__(self) -> None:
        self._count = 0
        self._kinds: dict[str, Tuple[Callable[[Mapping, str, int], Step], Tuple[str, ...]]] = {
            "frames": (self._frames, ()),
            "joints": (self._joints, ()),
            "gesture": (self._gesture, ()),
            "posture": (self._posture, ("speed",)),
            "lights": (self._lights, ("color", "intensity", "duration")),
            "say": (self._say, ("animated",)),
            "wait": (self._wait, ()),
            "together": (self._together, ()),
            "repeat": (self._repeat, ("do",)),
        }

    def steps(self, entry: Any, where: str, depth: int) -> Step:
        """Steps that follow each other."""
        if not isinstance(entry, list) or not entry:
            raise ConfigError(where, f"is {entry!r}, not a list of steps, at least one")
        return InTurn(tuple(self._step(each, f"{where}[{i}]", depth) for i, each in enumerate(entry)))

    def _step(self, entry: Any, where: str, depth: int) -> Step:
        self._count += 1
        self._check_count(where, depth)
        if isinstance(entry, list):
            return self.steps(entry, where, depth + 1)
        kinds = [kind for kind in self._kinds if isinstance(entry, Mapping) and kind in entry]
        if len(kinds) != 1:
            raise ConfigError(where, f"is {str(entry)[:200]!r}, which has not one of {', '.join(self._kinds)}")
        read, options = self._kinds[kinds[0]]
        return read(check_keys(entry, where, kinds, options), where, depth + 1)

    def _check_count(self, where: str, depth: int) -> None:
        if depth > DEEPEST or self._count > MOST_STEPS:
            raise ConfigError(where, f"nests deeper than {DEEPEST}, or is beyond step {MOST_STEPS}")

    def _frames(self, fields: Mapping, where: str, _: int) -> Step:
        if not isinstance(fields["frames"], list) or not fields["frames"]:
            raise ConfigError(f"{where}.frames", "is no list of key frames, at least one")
        now, points = 0.0, {}
        for i, frame in enumerate(fields["frames"]):
            place = f"{where}.frames[{i}]"
            check_keys(frame, place, ["time", "angles"])
            now += _number(frame["time"], f"{place}.time", 0.01, LONGEST_STEP)
            if not isinstance(frame["angles"], Mapping):
                raise ConfigError(f"{place}.angles", "is no mapping of joints to angles")
            for joint, angle in frame["angles"].items():
                points.setdefault(joint, []).append((now, angle))
        return _joint_ways(points, where)

    def _joints(self, fields: Mapping, where: str, _: int) -> Step:
        if not isinstance(fields["joints"], Mapping) or not fields["joints"]:
            raise ConfigError(f"{where}.joints", "is no mapping of joints")
        points = {}
        for joint, frames in fields["joints"].items():
            place = f"{where}.{joint}"
            check_keys(frames, place, ["times", "angles"])
            times = array(frames["times"], place, (-1,)).tolist()
            points[joint] = list(zip(times, array(frames["angles"], place, (len(times),)).tolist()))
        return _joint_ways(points, where)

    def _gesture(self, fields: Mapping, where: str, _: int) -> Step:
        return Gesture(_text(fields["gesture"], f"{where}.gesture"))

    def _posture(self, fields: Mapping, where: str, _: int) -> Step:
        names = load_postures().by_name
        if fields["posture"] not in names:
            raise ConfigError(f"{where}.posture", f"is {fields['posture']!r}, allowed is {', '.join(names)}")
        return GoToPosture(fields["posture"], _number(fields.get("speed", 0.8), f"{where}.speed", 0.05, 1.0))

    def _lights(self, fields: Mapping, where: str, _: int) -> Step:
        layout, group = load_leds(), fields["lights"]
        if group not in layout.groups and group not in layout.short_names:
            raise ConfigError(f"{where}.lights", f"{group!r} is no LED and no group")
        if ("color" in fields) == ("intensity" in fields):
            raise ConfigError(where, "needs a color or an intensity, one of them")
        duration = _number(fields.get("duration", 0.0), f"{where}.duration", 0.0, LONGEST_STEP)
        if "intensity" in fields:
            color = (_number(fields["intensity"], f"{where}.intensity", 0.0, 1.0),) * 3
        else:
            color = _color(fields["color"], f"{where}.color")
        return Lights(group, color, duration)

    def _say(self, fields: Mapping, where: str, _: int) -> Step:
        animated = fields.get("animated", False)
        if not isinstance(animated, bool):
            raise ConfigError(f"{where}.animated", f"is {animated!r}, not true or false")
        return Say(_text(fields["say"], f"{where}.say"), animated)

    def _wait(self, fields: Mapping, where: str, _: int) -> Step:
        return Wait(_number(fields["wait"], f"{where}.wait", 0.0, LONGEST_STEP))

    def _together(self, fields: Mapping, where: str, depth: int) -> Step:
        branches = fields["together"]
        if not isinstance(branches, list) or not branches:
            raise ConfigError(f"{where}.together", "is no list of steps, at least one")
        return Together(tuple(self._step(b, f"{where}.together[{i}]", depth) for i, b in enumerate(branches)))

    def _repeat(self, fields: Mapping, where: str, depth: int) -> Step:
        times = fields["repeat"]
        if isinstance(times, bool) or not isinstance(times, int) or not 0 <= times <= MOST_REPEATS:
            raise ConfigError(f"{where}.repeat", f"is {times!r}, allowed is 0 (until it is stopped) to {MOST_REPEATS}")
        before = self._count
        step = self.steps(check_keys(fields, where, ["repeat", "do"])["do"], f"{where}.do", depth)
        if not takes_time(step):  # everybody waits for all of its rounds: each counts
            if not times:
                raise ConfigError(where, "repeats without end what takes no time")
            self._count += (times - 1) * (self._count - before)
            self._check_count(where, depth)
        return Repeat(step, times or None)


def _joint_ways(points: Mapping[Any, list], where: str) -> Joints:
    if not points:
        raise ConfigError(where, "moves no joint")
    return Joints({joint: _way(joint, frames, f"{where}.{joint}") for joint, frames in points.items()})


def _way(joint: Any, frames: list, where: str) -> JointWay:
    model = load_model()
    if joint not in model.joint_index:
        raise ConfigError(where, "is no joint of the robot")
    limits = model.joint(joint)
    times = [time for time, _ in frames]
    if not times or any(b <= a for a, b in zip((0.0, *times), times)) or times[-1] > LONGEST_STEP:
        raise ConfigError(where, f"times {times} do not rise from above 0 to at most {LONGEST_STEP:g} s")
    checked = [_number(angle, where, limits.lower - 1e-6, limits.upper + 1e-6) for _, angle in frames]
    return JointWay(PackedKeyPoints(KeyPoint(time, angle) for time, angle in zip(times, checked)))


def _number(value: Any, where: str, low: float, high: float) -> float:
    if not math.isfinite(number(value, where)):
        raise ConfigError(where, f"is {value!r}, not a number")
    if not low <= value <= high:
        raise ConfigError(where, f"is {value:g}, allowed is {low:g} to {high:g}")
    return float(value)


def _text(value: Any, where: str) -> str:
    if not isinstance(value, str) or not value or len(value) > LONGEST_TEXT:
        raise ConfigError(where, f"is {str(value)[:80]!r}, not a text of 1 to {LONGEST_TEXT} characters")
    return value


def _color(value: Any, where: str) -> Tuple[float, float, float]:
    if isinstance(value, str) and value in COLOR_NAMES:
        return tuple(COLOR_NAMES[value])
    if isinstance(value, str) and re.fullmatch(r"#[0-9a-fA-F]{6}", value):
        return tuple(color_of_int(int(value[1:], 16)))
    raise ConfigError(where, f"is {value!r}, allowed is #rrggbb, {', '.join(COLOR_NAMES)}")
