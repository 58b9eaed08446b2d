"""The animations that a robot knows: those of `config/animations.json`, those of families, and those of clients."""

from __future__ import annotations

import threading
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Iterable, Mapping, Sequence, Tuple

from nao_sim_bridge.base.config import array, check_keys, config_file, read_json
from nao_sim_bridge.base.errors import ConfigError, NotAllowed
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.control.balance.posture_recognition import CROUCHING, ON_CHAIR, SITTING, STANDING
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.speech.gesture import Animation, KeyFrames, is_of_legs

FILE = "animations.json"
ANIMATIONS = "animations/"
# What NAOqi writes for the posture that the robot is in, and for its kind.
POSTURE_PATTERN, ROBOT_PATTERN = "[posture]", "[robot]"
ROBOTS = ("Nao", "NAO")
# The folder of animations for each family of postures; NAOqi has none for crouching.
FOLDERS = {STANDING: "Stand", CROUCHING: "Stand", SITTING: "Sit", ON_CHAIR: "SitOnPod"}
POSTURE = FOLDERS[STANDING]


def folder_of(family: str) -> str:
    """The folder of animations for a family of postures."""
    return FOLDERS.get(family, POSTURE)


def is_for(name: str, posture: str) -> bool:
    """Whether an animation is made for a posture; what lies in other folders than NAOqi's is for all of them."""
    return not name.startswith(ANIMATIONS) or f"/{posture}/" in name


def paths_of(path: str, posture: str) -> list[str]:
    """What a path with NAOqi's patterns may stand for; one without stands for itself."""
    path = path.strip().replace(POSTURE_PATTERN, posture)
    return list(dict.fromkeys(path.replace(ROBOT_PATTERN, robot) for robot in ROBOTS))


class _Index:
    """Animations by name and by tag.

    Attributes:
        tags: Name to the tags of an animation, each once.
        names: Tag, in lower case, to the names of those that have it.
    """

    def __init__(self, tags: Mapping[str, Iterable[str]]) -> None:
        self.tags: dict[str, Tuple[str, ...]] = {}
        self.names: dict[str, list[str]] = {}
        for name, own in tags.items():
            once: dict[str, str] = {}
            for tag in own:
                once.setdefault(tag.strip().lower(), tag)
            self.tags[name] = tuple(once.values())
            for tag in once:
                self.names.setdefault(tag, []).append(name)


class AnimationLibrary:
    """The animations that a robot knows, and the tags that words, in lower case, call for. Any thread.

    Names, tags and words are read when somebody first asks, and a gesture of a family is built then.

    Attributes:
        revision: Counts what has been added to it.
    """

    def __init__(self) -> None:
        self.revision = 0
        self._tags_added = self._words_added = 0
        self._added: Mapping[str, Animation] = {}
        self._changing = threading.Lock()

    @property
    def names(self) -> list[str]:
        return list(self._index.tags)

    @property
    def body_language(self) -> str:
        """The tag of those animations that go with any text."""
        return _tables()["body_language"]

    def tags_of(self, name: str) -> Tuple[str, ...]:
        return self._index.tags[name]

    def get(self, name: str) -> Animation | None:
        """An animation by exactly its name."""
        from nao_sim_bridge.speech import gesture_families  # a robot that does not talk needs nothing of it

        own = self._added.get(name) or _shipped().get(name)
        if own is None and name in gesture_families.names():
            return gesture_families.build(name)
        return own

    def find(self, name: str, posture: str = POSTURE) -> Animation | None:
        """An animation by its path, or by the end of it; of a family ("Explain_9") one that is there ("Explain_1").

        Of several that fit, one for the posture goes first.
        """
        names = self._index.tags
        for path in paths_of(name, posture):
            if path in names:
                return self.get(path)
        family = path.rsplit("/", 1)[-1].rsplit("_", 1)[0]
        ends = [known for known in names if known.endswith("/" + path)] or [
            known for known in names if known.rsplit("/", 1)[-1].rsplit("_", 1)[0] == family
        ]
        ends.sort(key=lambda known: not is_for(known, posture))  # a stable sort
        return self.get(ends[0]) if ends else None

    def tagged(self, tag: str, posture: str = POSTURE) -> list[Animation]:
        """Those with a tag that are made for a posture."""
        return [self.get(name) for name in self._with(tag) if is_for(name, posture)]

    def below(self, path: str, tag: str, posture: str = POSTURE) -> list[Animation]:
        """Those with a tag whose name begins with a path, which may have NAOqi's patterns."""
        return [self.get(name) for name in self._with(tag) if name.startswith(tuple(paths_of(path, posture)))]

    def of_word(self, word: str, posture: str = POSTURE) -> list[Animation]:
        """Those that a word calls for: by tags that it is linked to, and by the tag that it is itself."""
        word = word.lower()
        tags = [*self._words.get(word, ()), word]
        return list(dict.fromkeys(animation for tag in tags for animation in self.tagged(tag, posture)))

    def of_sentence(self, sentence: str, posture: str = POSTURE) -> list[Animation]:
        """Those that go with any part of a sentence, by its ending: a question, an exclamation, or any other."""
        tag = _tables()["endings"].get(sentence.rstrip()[-1:], self.body_language)
        return self.tagged(tag, posture) or self.tagged(self.body_language, posture)

    def add(self, animations: Iterable[Animation]) -> None:
        """Know further ones, or others of the same names.

        Raises:
            NotAllowed: Clients would have too many.
        """
        added = {animation.name: animation for animation in animations}
        with self._changing:
            _require_few(len({*self._added, *added}), load_sizes().speech.animations, "animations")
            self._added = {**self._added, **added}
            self._change({name: animation.tags for name, animation in added.items()})

    def add_tag(self, tag: str, names: Iterable[str]) -> None:
        """Give animations one more tag; a KeyError where there is none of that name.

        Raises:
            NotAllowed: Clients would have too many tags.
        """
        with self._changing:
            known, tagged, names = self._index.tags, set(self._with(tag)), list(dict.fromkeys(names))
            new = {name: (*known[name], tag) for name in names if name not in tagged}
            _require_few(self._tags_added + len(new), load_sizes().speech.tags, "tags of animations")
            self._tags_added += len(new)
            self._change(new)

    def _change(self, tags: Mapping[str, Sequence[str]]) -> None:
        """Readers have what was before, or all of what is now."""
        self._index = _Index({**self._index.tags, **tags})
        self.revision += 1

    def _with(self, tag: str) -> Sequence[str]:
        return self._index.names.get(tag.strip().lower(), ())

    def add_words(self, tag: str, words: Sequence[str]) -> None:
        """Let words call for a tag.

        Raises:
            NotAllowed: Clients would have too many words.
        """
        with self._changing:
            known = self._words
            new = [w for w in dict.fromkeys(word.strip().lower() for word in words) if tag not in known.get(w, ())]
            _require_few(self._words_added + len(new), load_sizes().speech.words, "words with tags")
            self._words_added += len(new)
            for word in new:
                known.setdefault(word, []).append(tag)

    def forget_words(self) -> None:
        """Have words call for what they call for on a new robot."""
        with self._changing:
            self.__dict__.pop("_words", None)
            self._words_added = 0

    @cached_property
    def _index(self) -> _Index:
        from nao_sim_bridge.speech import gesture_families  # as above

        tags = {name: animation.tags for name, animation in _shipped().items()}
        for name, naming in gesture_families.names().items():
            tags[name] = (*tags.get(name, ()), *naming.tags)
        return _Index(tags)

    @cached_property
    def _words(self) -> dict[str, list[str]]:
        words: dict[str, list[str]] = {}
        for tag, linked in _tables()["words"].items():
            for word in linked:
                words.setdefault(word, []).append(tag)
        return words


def _require_few(count: int, most: int, what: str) -> None:
    if count > most:
        raise NotAllowed(f"clients would have {count} {what}: {most} at most")


def load_animations() -> AnimationLibrary:
    """A library of the animations that come with the robot, which its owner may add to."""
    return AnimationLibrary()


def read_animations(path: Path) -> dict[str, Animation]:
    """The animations in a file: an object whose `animations` are as in the robot's own file.

    Raises:
        ConfigError: It has a wrong, unknown or missing entry.
    """
    tables = check_keys(read_json(path), path.name, ("animations",), ("_meta", "body_language", "endings", "words"))
    return {name: _animation(name, entry, path.name) for name, entry in tables["animations"].items()}


@lru_cache(maxsize=None)
def _shipped() -> Mapping[str, Animation]:
    return read_animations(config_file(FILE))


@lru_cache(maxsize=None)
def _tables() -> Mapping:
    return check_keys(
        read_json(config_file(FILE)), FILE, ("animations", "body_language", "endings", "words"), ("_meta",)
    )


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
    if joint not in model.joint_index or is_of_legs(joint):
        raise ConfigError(where, "is no joint of arms, hands or head")
    times = tuple(array(frames["times"], where, (-1,)).tolist())
    angles = tuple(array(frames["angles"], where, (len(times),)).tolist())
    if not times or any(b <= a for a, b in zip((0.0, *times), (*times, length))):
        raise ConfigError(where, f"times {list(times)} do not rise between 0 and {length:g} s")
    limits = model.joints[model.joint_index[joint]]
    if not joint.startswith("Head") and not all(limits.lower <= angle <= limits.upper for angle in angles):
        raise ConfigError(where, f"angles {list(angles)} are not all within {limits.lower:g} to {limits.upper:g}")
    return KeyFrames(times, angles)
