"""Keys of the robot's memory: patterns that match them, and topics that are named after them. No ROS."""

from __future__ import annotations

import fnmatch
import re
from collections.abc import Iterable

FIRST = "key_"
"""Before a name that does not begin with a letter, which ROS asks for."""


def is_pattern(text: str) -> bool:
    """Whether a text stands for several keys."""
    return "*" in text or "?" in text


def matches(key: str, pattern: str) -> bool:
    """Whether a pattern, or a key itself, stands for a key; upper and lower case matter."""
    # Brackets are no wildcards here: keys may have some.
    return fnmatch.fnmatchcase(key, pattern.replace("[", "[[]"))


def matching(keys: Iterable[str], pattern: str) -> list[str]:
    """The keys that a pattern stands for, sorted; an empty one stands for all."""
    return sorted(key for key in keys if not pattern or matches(key, pattern))


def topic_of(key: str) -> str:
    """A legal name of ROS that looks like a key: what is not allowed in it becomes an underscore."""
    parts = [re.sub(r"[^A-Za-z0-9_]", "_", part) for part in key.split("/") if part]
    name = "/".join(parts) or "_"
    return name if name[0].isascii() and name[0].isalpha() else FIRST + name


def topics_of(keys: Iterable[str], taken: Iterable[str]) -> dict[str, str]:
    """A topic for each key, none twice.

    Args:
        keys: The keys.
        taken: Topics that others have already.
    """
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
