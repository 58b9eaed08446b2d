"""Keys of the robot's memory: patterns, and names of their topics. No ROS."""

from __future__ import annotations

import fnmatch
import re
from collections.abc import Iterable

FIRST = "key_"
"""Before a name that does not begin with a letter, which ROS asks for."""


def is_pattern(text: str) -> bool:
    return "*" in text or "?" in text


def matches(key: str, pattern: str) -> bool:
    """Whether a key matches a pattern or equals it; upper and lower case matter."""
    # Brackets are no wildcards here: keys may have some.
    return fnmatch.fnmatchcase(key, pattern.replace("[", "[[]"))


def matching(keys: Iterable[str], pattern: str) -> list[str]:
    """The keys that match a pattern, sorted; an empty one matches all."""
    return sorted(key for key in keys if not pattern or matches(key, pattern))


def topic_of(key: str) -> str:
    """A legal name of ROS that resembles a key: illegal characters become underscores."""
    parts = [re.sub(r"[^A-Za-z0-9_]", "_", part) for part in key.split("/") if part]
    name = "/".join(parts) or "_"
    return name if name[0].isascii() and name[0].isalpha() else FIRST + name


def topics_of(keys: Iterable[str], taken: Iterable[str]) -> dict[str, str]:
    """A topic for each key, distinct from each other and from `taken`."""
    used = set(taken)
    topics = {}
    for key in keys:
        plain = name = topic_of(key)
        count = 1
        while name in used:
            count += 1
            name = f"{plain}_{count}"
        used.add(name)
        topics[key] = name
    return topics
