"""Gestures that go with speech, from `config/animations.json` and files of clients in the same form."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Iterable, Mapping, Sequence, Tuple

from nao_sim_bridge.base.config import array, check_keys, config_file, read_json
from nao_sim_bridge.base.errors import ConfigError
from nao_sim_bridge.control.joints.curves import SmoothCurve
from nao_sim_bridge.model.model_reader import load_model

FILE = "animations.json"
# What NAOqi writes for the posture that the robot is in.
POSTURE_PATTERN, POSTURE = "[posture]", "Stand"


@dataclass(frozen=True)
class KeyFrames:
    """Where one joint goes: angles, rad (hands 0..1), of the head added to where it looks.

    Their times are in s from the beginning, rising, between 0 and the length of the animation.
    """

    times: Tuple[float, ...]
    angles: Tuple[float, ...]


@dataclass(frozen=True, eq=False)
class Animation:
    """A gesture of arms, hands and head, `length` s long; it ends where it began.

    Its name is NAOqi's path, for example "animations/Stand/Gestures/Hey_1".
    """

    name: str
    length: float
    tags: Tuple[str, ...]
    joints: Mapping[str, KeyFrames]

    def curve(self, joint: str, start: float, home: float, stretch: float) -> SmoothCurve:
        """The way of a joint that is at `start` and belongs at `home`, rad, with all times `stretch` times as long."""
        frames = self.joints[joint]
        base = home if joint.startswith("Head") else 0.0
        times = [0.0, *(time * stretch for time in frames.times), self.length * stretch]
        return SmoothCurve(times, [start, *(base + angle for angle in frames.angles), home])


@dataclass(eq=False)
class AnimationLibrary:
    """The animations that a robot knows, and the tags that words, in lower case, call for. Any thread.

    `body_language` is the tag of those that go with any text.
    """

    animations: dict[str, Animation]
    body_language: str
    words: dict[str, list[str]] = field(default_factory=dict)
    _tags: dict[str, list[str]] = field(default_factory=dict)
    _own_words: dict[str, list[str]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for animation in self.animations.values():
            for tag in animation.tags:
                self._tags.setdefault(tag.lower(), []).append(animation.name)

    def find(self, name: str) -> Animation | None:
        """An animation by its path, or by the end of it; of a family ("Explain_9") one that is there ("Explain_1")."""
        path = name.strip().replace(POSTURE_PATTERN, POSTURE)
        for known in self.animations:
            if known == path or known.endswith("/" + path):
                return self.animations[known]
        family = path.rsplit("/", 1)[-1].rsplit("_", 1)[0]
        return next(
            (a for known, a in self.animations.items() if known.rsplit("/", 1)[-1].startswith(family + "_")), None
        )

    def tagged(self, tag: str) -> list[Animation]:
        return [self.animations[name] for name in self._tags.get(tag.strip().lower(), ()) if name in self.animations]

    def of_word(self, word: str) -> list[Animation]:
        return [animation for tag in self.words.get(word.lower(), ()) for animation in self.tagged(tag)]

    def add(self, animations: Iterable[Animation]) -> None:
        for animation in animations:
            self.animations[animation.name] = animation
            for tag in animation.tags:
                self.add_tag(tag, [animation.name])

    def add_tag(self, tag: str, names: Sequence[str]) -> None:
        known = self._tags.setdefault(tag.strip().lower(), [])
        known.extend(name for name in names if name not in known)

    def add_words(self, tag: str, words: Sequence[str]) -> None:
        """Let words call for a tag."""
        for word in words:
            tags = self.words.setdefault(word.strip().lower(), [])
            if tag not in tags:
                tags.append(tag)

    def keep_words(self) -> None:
        """What words call for now is what `forget_words` goes back to."""
        self._own_words = {word: list(tags) for word, tags in self.words.items()}

    def forget_words(self) -> None:
        """Forget what words have been made to call for."""
        self.words = {word: list(tags) for word, tags in self._own_words.items()}


def load_animations() -> AnimationLibrary:
    """A library of the animations that come with the robot, which its owner may add to."""
    tables = _tables()
    library = AnimationLibrary(dict(_shipped()), tables["body_language"])
    for tag, words in tables["words"].items():
        library.add_words(tag, words)
    library.keep_words()
    return library


def read_animations(path: Path) -> dict[str, Animation]:
    """The animations in a file: an object whose `animations` are as in the robot's own file.

    Raises:
        ConfigError: It has a wrong, unknown or missing entry.
    """
    tables = check_keys(read_json(path), path.name, ("animations",), ("_meta", "body_language", "words"))
    return {name: _animation(name, entry, path.name) for name, entry in tables["animations"].items()}


@lru_cache(maxsize=None)
def _shipped() -> Mapping[str, Animation]:
    return read_animations(config_file(FILE))


@lru_cache(maxsize=None)
def _tables() -> Mapping:
    return check_keys(read_json(config_file(FILE)), FILE, ("animations", "body_language", "words"), ("_meta",))


def _animation(name: str, entry: object, file: str) -> Animation:
    where = f"{file}: {name}"
    fields = check_keys(entry, where, ("length", "joints"), ("tags",))
    length = float(array(fields["length"], f"{where}: length", ()))
    joints = {}
    for joint, frames in fields["joints"].items():
        check_keys(frames, f"{where}: {joint}", ("times", "angles"))
        joints[joint] = _key_frames(joint, frames, length, f"{where}: {joint}")
    if not joints:
        raise ConfigError(where, "moves no joint")
    return Animation(name, length, tuple(fields.get("tags", ())), joints)


def _key_frames(joint: str, frames: Mapping, length: float, where: str) -> KeyFrames:
    model = load_model()
    if joint not in model.joint_index or any(part in joint for part in ("Hip", "Knee", "Ankle")):
        raise ConfigError(where, "is no joint of arms, hands or head")
    times = tuple(array(frames["times"], where, (-1,)).tolist())
    angles = tuple(array(frames["angles"], where, (len(times),)).tolist())
    if not times or any(b <= a for a, b in zip((0.0, *times), (*times, length))):
        raise ConfigError(where, f"times {list(times)} do not rise between 0 and {length:g} s")
    limits = model.joints[model.joint_index[joint]]
    if not joint.startswith("Head") and not all(limits.lower <= angle <= limits.upper for angle in angles):
        raise ConfigError(where, f"angles {list(angles)} are not all within {limits.lower:g} to {limits.upper:g}")
    return KeyFrames(times, angles)
