"""The behaviours that are installed on the robot. Any thread."""

from __future__ import annotations

import sys
import threading
from dataclasses import replace
from functools import lru_cache
from typing import Collection, Iterable, Mapping

from nao_sim_bridge.base.config import config_file
from nao_sim_bridge.base.errors import BadValue, ConfigError, NotAllowed, UnknownName
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.behaviors.reader import read_behaviors
from nao_sim_bridge.behaviors.steps import Behavior, Gesture, Step, bytes_of
from nao_sim_bridge.speech.animations import POSTURE, POSTURE_PATTERN, AnimationLibrary

FOLDER = "behaviors"
# What old programs write in front of a name.
PREFIXES = ("User/", "System/", "user/", "system/")
# What stands for the first behaviour of a package.
PACKAGE_END = "/."


class InstalledBehaviors:
    """Behaviours by name: those that come with the robot, each gesture of arms and head too, and those of its users."""

    def __init__(self, gestures: AnimationLibrary) -> None:
        self._lock = threading.Lock()
        self._gestures = gestures
        self._user: dict[str, Behavior] = {}
        # Bytes of what clients have: installed behaviours by name, and others by what they are kept under.
        self._held: dict[str, int] = {}
        # Those of the system, and the revision of the gestures of which they are.
        self._system: tuple[dict[str, Behavior] | None, int] = (None, 0)

    @property
    def system(self) -> dict[str, Behavior]:
        """Those that come with the robot, and gestures that somebody has declared since."""
        library = self._gestures
        known, revision = self._system
        if known is None or revision != library.revision:
            revision, known = library.revision, dict(shipped_behaviors())
            for name in library.names:
                tags = library.tags_of(name)
                own = known.get(name)
                if own is None:
                    known[name] = Behavior(name, Gesture(name), "a gesture", tags=tags)
                else:  # it does more than the gesture of its name
                    known[name] = replace(own, tags=tuple(dict.fromkeys((*own.tags, *tags))))
            self._system = known, revision
        return known

    @property
    def user(self) -> dict[str, Behavior]:
        """Those that somebody has installed."""
        with self._lock:
            return dict(self._user)

    @property
    def all(self) -> dict[str, Behavior]:
        return dict(sorted({**self.system, **self.user}.items()))

    def knows(self, name: str) -> bool:
        """Whether there is a behaviour of exactly this name."""
        return _plain(name) in self.all

    def resolve(self, name: str) -> Behavior:
        """A behaviour by its name, by the end of it, or by that of a package that holds only one.

        Raises:
            UnknownName: There is no such behaviour.
            BadValue: The name could be that of several.
        """
        known, path = self.all, _plain(name)
        if path in known:
            return known[path]
        fitting = [
            b for full, b in known.items() if path and (full.endswith("/" + path) or full.startswith(path + "/"))
        ]
        if len(fitting) == 1:
            return fitting[0]
        if fitting:
            names = ", ".join(behavior.name for behavior in fitting[:5])
            raise BadValue("behavior", name, f"one of {len(fitting)} behaviours in full: {names}...")
        raise UnknownName("behavior", name, known)

    def install(
        self, behaviors: Iterable[Behavior], overwrite: bool = True, gone: Collection[str] = ()
    ) -> tuple[list[str], list[str]]:
        """Add behaviours and remove those of users named in `gone`; names of the new, and of those that were there.

        Raises:
            BadValue: A name is that of a behaviour of the system, or, without `overwrite`, of any other.
            NotAllowed: There would be too many, or they would take too much memory.
        """
        new, system = {behavior.name: behavior for behavior in behaviors}, self.system
        with self._lock:
            for name in new:
                if name in system or (name in self._user and not overwrite):
                    raise BadValue("behavior", name, "a name that is free")
            most = load_sizes().behaviors.installed
            kept = {name: behavior for name, behavior in self._user.items() if name not in gone}
            if len({*kept, *new}) > most:
                raise NotAllowed(f"{most} behaviors are installed at most: removeBehavior first")
            self._hold({name: _bytes(behavior) for name, behavior in new.items()}, gone)
            replaced = [name for name in new if name in kept]
            self._user = {**kept, **new}
        return [name for name in new if name not in replaced], replaced

    def hold(self, key: str, step: Step) -> None:
        """Count a step that is kept under `key` beside the installed behaviours, which no behaviour is called.

        Raises:
            NotAllowed: All behaviours of clients would take too much memory.
        """
        with self._lock:
            self._hold({key: bytes_of(step)})

    def release(self, keys: Iterable[str]) -> None:
        """Count these no more."""
        with self._lock:
            for key in keys:
                self._held.pop(key, None)

    def _hold(self, new: Mapping[str, int], gone: Collection[str] = ()) -> None:
        held = {**{key: size for key, size in self._held.items() if key not in gone}, **new}
        most = load_sizes().behaviors.bytes
        if sum(held.values()) > most:
            raise NotAllowed(
                f"behaviors of clients would take {sum(held.values())} bytes, {most} at most: removeBehavior, "
                "deleteBehavior or cleanBehaviors first"
            )
        self._held = held

    def remove(self, name: str) -> list[str]:
        """Take a behaviour of a user away, or all of a package; their names.

        Raises:
            BadValue: It comes with the robot.
            UnknownName: There is no such behaviour.
        """
        path = _plain(name)
        with self._lock:
            gone = [full for full in self._user if full == path or full.startswith(path + "/")]
            for full in gone:
                del self._user[full]
                self._held.pop(full, None)
        if gone:
            return gone
        if path in self.system:
            raise BadValue("behavior", name, "one that somebody has installed, not one of the robot")
        raise UnknownName("behavior that somebody has installed", name, self.user)


@lru_cache(maxsize=None)
def shipped_behaviors() -> Mapping[str, Behavior]:
    """The behaviours of the files that come with the simulator, read once; a ConfigError for what is wrong in them."""
    found: dict[str, Behavior] = {}
    for path in sorted(config_file(FOLDER).glob("*.yaml")):
        for name, behavior in read_behaviors(path).items():
            if name in found:
                raise ConfigError(path.name, f"{name} is in another file, too")
            found[name] = behavior
    return found


def _bytes(behavior: Behavior) -> int:
    texts = (behavior.name, behavior.help, *behavior.tags)
    return bytes_of(behavior.step) + sum(map(sys.getsizeof, texts))


def _plain(name: str) -> str:
    path = name.strip().strip("/")
    if path.endswith(PACKAGE_END):
        path = path[: -len(PACKAGE_END)]
    for prefix in PREFIXES:
        if path.startswith(prefix):
            path = path[len(prefix) :]
    return path.replace(POSTURE_PATTERN, POSTURE)
