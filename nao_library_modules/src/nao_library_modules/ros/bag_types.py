"""Bags whose types of nao_robot's interface get the names of the older packages, or the other way round.

A rosbag is converted as it is: bytes of messages and times stay, and of each topic the first publisher. rosbag's own
way, a rule of migration for `rosbag fix`, would want both definitions of each type written down, and a function that
copies each field of messages.

A bag comes from others. The definitions in it are copied as bytes: rosbag would make Python of them and run it, where
a constant's name may be a program. Only classes that are installed here read messages.
"""

from __future__ import annotations

import importlib
import struct
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import Any

import genpy
import rosbag

from naoqi.errors import NaoError

from ..core.files import draft_in, move_whole, require_new
from .driver_types import as_theirs
from .type_names import OURS, type_names


@dataclass
class Conversion:
    """What became of a bag; numbers of messages by the name of the type that they had.

    Attributes:
        renamed: Those that only have another name now.
        refilled: Those that have other fields now: what both have was kept.
        kept: Those of other types, as they were.
        foreign: Those whose type is called as one of the table and is defined otherwise, as they were; with the sum.
    """

    renamed: Counter[str] = field(default_factory=Counter)
    refilled: Counter[str] = field(default_factory=Counter)
    kept: Counter[str] = field(default_factory=Counter)
    foreign: Counter[str] = field(default_factory=Counter)


def convert_bag(source: Path, target: Path, names: str, overwrite: bool = False) -> Conversion:
    """Write a bag with other names of types.

    Args:
        source: A bag.
        target: Where to; it is there only when it is whole.
        names: Which names its types are to have, OURS or THEIRS of `type_names`.
        overwrite: Whether `target` may be there.

    Raises:
        NaoError: `source` is no bag that can be read, or `target` cannot be written.
    """
    target = require_new(target, overwrite)
    if target.exists() and source.exists() and target.samefile(source):
        raise NaoError(f"{target} is the bag itself: another name for the new one")
    done = Conversion()
    with _told_in_words(source, "converted"), draft_in(target.parent) as draft:
        with rosbag.Bag(str(source)) as old, _no_generated_classes():
            compression = old.get_compression_info().compression
            with rosbag.Bag(str(draft), "w", compression=compression) as new:
                _copy(old, new, _Names(names), done)
        move_whole(draft, target, overwrite)
    return done


def read_bag(source: Path, topic: str, kind: type) -> Iterator[tuple[genpy.Time, Any]]:
    """The messages of a topic with the time of their arrival, as the installed class `kind` reads them.

    rosbag's own way runs what the bag says its types are.

    Raises:
        NaoError: `source` is no bag that can be read, or the topic has another type.
    """
    wanted = kind()
    with _told_in_words(source, "read"), rosbag.Bag(str(source)) as bag:
        messages = bag.read_messages(topic, raw=True)
        while True:
            with _no_generated_classes():  # not while the caller has the message: others read bags as well
                found = next(messages, None)
            if found is None:
                return
            _, (name, content, md5sum, *_), time = found
            if md5sum != wanted._md5sum:
                raise NaoError(f"{topic} of {source} is of {name} ({md5sum}), not of {wanted._type} as it is here")
            yield time, kind().deserialize(content)


@contextmanager
def _told_in_words(source: Path, what: str) -> Iterator[None]:
    """NaoError for what rosbag raises of a bag that cannot be `what`."""
    try:
        yield
    except rosbag.ROSBagUnindexedException:
        raise NaoError(f"{source} has no index, as one whose recording was cut off: rosbag reindex it first") from None
    except (rosbag.ROSBagException, OSError, genpy.MessageException) as error:
        raise NaoError(f"{source} cannot be {what}: {error}") from error
    except (ValueError, LookupError, EOFError, OverflowError, struct.error) as error:  # of bytes that are no bag's
        problem = f"{type(error).__name__}: {error}"
        raise NaoError(f"{source} cannot be {what}: it is damaged, or no bag ({problem})") from error


class _Raw:
    """What stands for the class of a message in a bag: its bytes, which nobody reads as fields."""

    def __init__(self, connection: Any) -> None:
        self._type, self._md5sum = connection.datatype, connection.md5sum
        self._full_text = connection.msg_def


@contextmanager
def _no_generated_classes() -> Iterator[None]:
    """Have rosbag read bytes alone; it generates and runs a class for each type even where raw messages are asked for.

    For one thread at a time. Raises AttributeError, before anything is read, where rosbag has no such function.
    """
    generate = rosbag.bag._get_message_type
    rosbag.bag._get_message_type = _Raw
    try:
        yield
    finally:
        rosbag.bag._get_message_type = generate


class _Names:
    """The new class of each type."""

    def __init__(self, names: str) -> None:
        self._table = type_names()
        self._to_ours = names == OURS
        self._classes: dict[str, tuple[Any, Any] | None] = {}

    def classes(self, name: str) -> tuple[Any, Any] | None:
        """The class of a type and the one that takes its place; None for a type that keeps its name."""
        if name not in self._classes:
            self._classes[name] = self._pair(name)
        return self._classes[name]

    def _pair(self, name: str) -> tuple[Any, Any] | None:
        own = self._own(name)
        package, _, word = own.partition("/")
        ours = getattr(importlib.import_module(f"{package}.msg"), word, None) if own else None
        if ours is None:
            return None
        theirs = as_theirs(ours)
        before, after = ours if own == name else theirs, ours if self._to_ours else theirs
        return (before, after) if after._type != name else None

    def _own(self, name: str) -> str:
        """Our name of a type; empty where it has none."""
        package, _, word = name.partition("/")
        if package in self._table.former:
            return self._table.ours.get(f"{self._table.former[package]}/{word}", "")
        return self._table.ours.get(name, name if name in self._table.theirs else "")


def _copy(old: Any, new: Any, names: _Names, done: Conversion) -> None:
    sums: dict[str, tuple[str, str]] = {}
    for topic, raw, time, header in old.read_messages(raw=True, return_connection_header=True):
        name, content, md5sum = raw[:3]
        known = sums.setdefault(topic, (name, md5sum))
        if known[1] != md5sum:  # rosbag writes one connection for each topic
            raise rosbag.ROSBagException(
                f"{topic} has messages of {known[0]} and of {name}: record each on a topic of its own"
            )
        pair = names.classes(name)
        if pair is None:
            done.kept[name] += 1
            new.write(topic, raw, time, raw=True, connection_header=header)
            continue
        before, after = pair
        if type_names().former_sums.get(md5sum, md5sum) != before._md5sum:
            done.foreign[f"{name} ({md5sum})"] += 1
            new.write(topic, raw, time, raw=True, connection_header=header)
            continue
        if before._md5sum == after._md5sum:
            done.renamed[name] += 1
        else:
            content = _refilled(before().deserialize(content), after)
            done.refilled[name] += 1
        new_header = {**header, **_described(after)}
        new.write(topic, (after._type, content, after._md5sum, after), time, raw=True, connection_header=new_header)


def _described(kind: Any) -> dict[str, str]:
    return {"type": kind._type, "md5sum": kind._md5sum, "message_definition": kind._full_text}


def _refilled(message: Any, kind: Any) -> bytes:
    buffer = BytesIO()
    _filled(kind(), message).serialize(buffer)
    return buffer.getvalue()


def _filled(empty: Any, message: Any) -> Any:
    """An empty message with all that another one has by the same names, through all messages in it."""
    for name in set(empty.__slots__) & set(message.__slots__):
        value, own = getattr(message, name), getattr(empty, name)
        setattr(empty, name, _filled(own, value) if isinstance(own, genpy.Message) else value)
    return empty
