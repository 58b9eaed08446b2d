"""The types that the driver and its clients speak: those of this library, or the same by their names in older packages.

What goes over a topic is the same in both, but for few types of which the older packages have other fields. So nodes
and clients use the messages of this library; `spoken` gives them the names that others know, at the one place where a
topic, a service or an action is made.

ROS API:
    Parameter `nao_driver/messages` (auto; searched upwards): "nao_library", "naoqi_bridge", or "auto", by what is
    installed. Launch files of the driver set it to one of the first two.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import rospy
from roslib.message import get_message_class

from naoqi.errors import NaoError

from .type_names import AUTO, OURS, THEIRS, choose, installed, type_names, unfit

PARAMETER = "nao_driver/messages"
ACTION_SLOTS = {"action_goal", "action_result", "action_feedback"}


def spoken(kind: Any, namespace: str = "") -> Any:
    """The class to make a topic, a service or an action of the driver with. Any thread.

    Messages of `kind` can be published on such a topic, and those that come from it are of a class derived from `kind`;
    where the older packages have other fields, they have these fields alone. A type that the older packages of this
    computer lack, as those of another version, keeps its name: nobody here could look the other one up.

    Args:
        kind: A message, service or action of this library, or of anybody else: then it stays as it is.
        namespace: Of the driver, with a slash at both ends; empty: the nearest to this node, read once.

    Raises:
        NaoError: The parameter is none of its three words.
    """
    if kind._type not in type_names().theirs:
        return kind
    choice = _own_choice() if not namespace else _choice(rospy.get_param(namespace + PARAMETER, AUTO))
    if choice == OURS:
        return kind
    names = type_names()
    name = names.theirs[kind._type]
    is_only_a_name = names.sums[name] == kind._md5sum
    return kind if is_only_a_name and name in _not_here() else as_theirs(kind)


def require_types() -> None:
    """Have a driver begin only with types that other programs can have as well, and tell which names they have.

    Raises NaoError if the parameter asks for packages that are not there or do not fit, or is none of its words. A
    client needs no packages for the names, and is not held up by them.
    """
    choice = choose(_own_parameter())
    if choice.told:
        rospy.loginfo("%s", choice.told)
    if choice.problem:
        rospy.logwarn("%s", choice.problem)


def _own_parameter() -> Any:
    name = rospy.search_param(PARAMETER)
    return rospy.get_param(name, AUTO) if name else AUTO


@lru_cache(maxsize=None)
def _own_choice() -> str:
    return _choice(_own_parameter())


def _choice(wanted: Any) -> str:
    return wanted if wanted in (OURS, THEIRS) else choose(wanted).names


@lru_cache(maxsize=None)
def _not_here() -> frozenset[str]:
    """Types of theirs that the older packages of this computer lack or have otherwise; none if none are there."""
    found = installed()
    return frozenset(unfit(found) if found else ())


@lru_cache(maxsize=None)
def as_theirs(kind: Any) -> Any:
    """A type of this library by the name that it has in the older packages.

    The class is derived from `kind`; where its fields are others, from a type of this library with these fields.

    Raises:
        KeyError: It has no such name.
        NaoError: No type of this library has its fields.
    """
    names = type_names()
    name = names.theirs[kind._type]
    body: dict[str, Any] = {"_type": name, "_md5sum": names.sums[name], "__module__": __name__}
    if hasattr(kind, "_request_class"):  # a service; what it carries is never compared by name
        return type(kind.__name__, (kind,), body)
    text, is_action = names.their_definition(kind._full_text), set(kind.__slots__) == ACTION_SLOTS
    if names.sums[name] != kind._md5sum and not is_action:
        kind = _with_fields_of(name)
    body.update(_full_text=text, __slots__=())
    if is_action:  # actionlib takes the classes of its topics from what an action is made of
        body["__init__"] = lambda self: kind.__init__(
            self, *(as_theirs(type(part))() for part in (getattr(kind(), slot) for slot in kind.__slots__))
        )
    made: Any = type(kind.__name__, (kind,), body)
    made.__slots__ = kind.__slots__  # genpy reads the names of the fields there; the fields themselves are inherited
    return made


def _with_fields_of(name: str) -> Any:
    """A class of this library whose fields are those of a type of theirs; no class is ever generated from a definition.

    Raises NaoError if there is none.
    """
    names = type_names()
    wanted = names.sums[name]
    for own, theirs in names.theirs.items():
        kind = get_message_class(own) if names.sums[theirs] == wanted else None
        if kind is not None and kind._md5sum == wanted:
            return kind
    raise NaoError(f"{name} (md5 sum {wanted}): no message of this library has its fields; say messages:={OURS}")
