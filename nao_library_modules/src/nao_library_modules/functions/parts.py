"""Parts of a module: groups of library functions, each an object that is built with what it needs. No ROS."""

from __future__ import annotations

import copy
from collections.abc import Iterable, Mapping
from typing import Any, Callable, ClassVar


class Part:
    """A group of library functions with the state that they share; without functions, state that other parts share.

    A module builds its parts and takes them in with `NaoBasic.add_parts`. The check of a function gets the part that
    the function belongs to as its first argument. Checks of goals that are not carried out get copies of all parts,
    which refer to each other as the parts do.
    """

    functions: ClassVar[Mapping[str, Callable[..., Any]]] = {}
    """NAOqi function name -> function of the class."""
    left_by_goals: ClassVar[frozenset[str]] = frozenset()
    """Attributes that checks read and goals change: what is stored, loaded, running."""

    def prepare_for_checks(self) -> None:
        """Called on a copy: replace what checks change by something of the copy's own."""


def bound(owner: Any, functions: Mapping[str, Callable[..., Any]]) -> dict[str, Callable[..., Any]]:
    """Functions of the owner's class as its methods, any others as they are."""
    members: dict[int, str] = {}
    for kind in type(owner).__mro__:
        for name, member in vars(kind).items():
            members.setdefault(id(member), name)
    return {
        name: getattr(owner, members[id(function)]) if id(function) in members else function
        for name, function in functions.items()
    }


def joined(kinds: Iterable[type[Part]]) -> dict[str, Callable[..., Any]]:
    """The functions of several parts. Raises TypeError if two parts declare functions of the same name."""
    found: dict[str, Callable[..., Any]] = {}
    for kind in kinds:
        twice = found.keys() & kind.functions.keys()
        if twice:
            raise TypeError(f"{kind.__name__} declares {', '.join(sorted(twice))}, and another part does so, too")
        found.update(kind.functions)
    return found


def copied(owners: Iterable[Any]) -> dict[int, Any]:
    """Copies of objects that refer to each other, by the identity of the original: the copies refer to each other."""
    copies = {id(owner): copy.copy(owner) for owner in owners}
    for each in copies.values():
        vars(each).update({name: copies[id(value)] for name, value in vars(each).items() if id(value) in copies})
    return copies
