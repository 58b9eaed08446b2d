"""Who has which resource of the robot: a tree of names, of which owners have some with all in them. No libqi."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Iterable, Iterator, Mapping, Sequence

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.naoqi.binding.arguments import known
from nao_sim_bridge.naoqi.binding.errors import NaoqiError


@dataclass
class _Resource:
    name: str
    parent: _Resource | None
    fixed: bool  # it is there from the start, and cannot be deleted
    children: dict[str, _Resource] = field(default_factory=dict)
    owner: str = ""
    callback: str = ""  # method of the owner, called when somebody else wants it; empty for none
    enabled: bool = True

    def above(self) -> Iterator[_Resource]:
        """This one and all that it is in."""
        one: _Resource | None = self
        while one is not None:
            yield one
            one = one.parent

    def below(self) -> Iterator[_Resource]:
        """All that is in it."""
        for child in self.children.values():
            yield child
            yield from child.below()


@dataclass(frozen=True)
class Conflict:
    """Why a resource cannot be had: `resource`, which it is in, is or has in it, belongs to `owner` or is disabled."""

    resource: str
    owner: str  # empty when it is disabled
    callback: str = ""  # of the owner

    def __str__(self) -> str:
        return f"{self.resource} belongs to {self.owner}" if self.owner else f"{self.resource} is disabled"


class ResourceTree:
    """Resources and their owners. Not thread-safe.

    Args:
        tree: Those that are there from the start: name -> the same of those in it.
    """

    def __init__(self, tree: Mapping[str, Any]) -> None:
        self._all: dict[str, _Resource] = {}
        self._plant(tree, None)

    # --- the tree ----------------------------------------------------------------------------------------------------

    def create(self, names: Sequence[str], parent: str) -> None:
        """Add resources to another one, or to none if that is an empty text.

        Raises:
            UnknownName: There is no such other one.
            BadValue: A name is empty or that of another one.
            NaoqiError: There would be too many.
        """
        above = self._get(parent) if parent else None
        most = load_sizes().kept.resources
        if len(self._all) + len(names) > most:
            raise NaoqiError(f"{most} resources are there at most")
        for i, name in enumerate(names):
            if not name or name in self._all or name in names[:i]:
                raise BadValue("resourceName", name, "a name that no resource has")
        for name in names:
            self._add(name, above, fixed=False)

    def delete(self, name: str, with_children: bool = False) -> list[str]:
        """Remove a resource that somebody has created and nobody has; its name and those of all that were in it.

        Raises:
            UnknownName: There is none of that name.
            NaoqiError: It comes with the robot, belongs to somebody, or has others in it.
        """
        resource = self._get(name)
        inside = list(resource.below())
        if resource.fixed:
            raise NaoqiError(f"{name} comes with the robot: only what was created can be deleted")
        owned = next((one for one in (*resource.above(), *inside) if one.owner), None)
        if owned is not None:
            raise NaoqiError(f"{owned.name} belongs to {owned.owner}, who has to release it first")
        if inside and not with_children:
            raise NaoqiError(f"{name} has {', '.join(one.name for one in inside)} in it, to be deleted first")
        gone = [one.name for one in (resource, *inside)]
        for each in gone:
            del self._all[each]
        if resource.parent is not None:
            del resource.parent.children[name]
        return gone

    def enable(self, name: str, enabled: bool) -> None:
        """Have a resource be had, or not."""
        self._get(name).enabled = enabled

    def is_in(self, group: str, name: str) -> bool:
        resource = self._get(name)
        return any(one is self._get(group) for one in resource.above() if one is not resource)

    def tree(self) -> list[list[Any]]:
        """[[name, those in it as the same], ...]."""
        return [_tree(one) for one in self._all.values() if one.parent is None]

    # --- owners ------------------------------------------------------------------------------------------------------

    def conflicts(self, names: Iterable[str], owner: str) -> list[Conflict]:
        """What keeps an owner from having all of these; an UnknownName when there is no such resource."""
        found: dict[Conflict, None] = {}
        for name in names:
            resource = self._get(name)
            for one in (*resource.above(), *resource.below()):
                if one.owner not in ("", owner):
                    found[Conflict(one.name, one.owner, one.callback)] = None
            for one in resource.above():
                if not one.enabled:
                    found[Conflict(one.name, "")] = None
        return list(found)

    def free(self, names: Iterable[str], owner: str) -> list[str]:
        """Those of these that an owner can have, each by itself; an UnknownName when there is no such resource."""
        return [name for name in names if not self.conflicts([name], owner)]

    def take(self, names: Iterable[str], owner: str, callback: str = "") -> None:
        """Have an owner have these, between whom and them there is no conflict."""
        for name in names:
            resource = self._get(name)
            resource.owner, resource.callback = owner, callback

    def require_owned(self, names: Iterable[str], owner: str) -> None:
        """An UnknownName or a NaoqiError unless an owner has all of these by name."""
        for name in names:
            has = self._get(name).owner
            if has != owner:
                raise NaoqiError(f"{name} belongs to {has or 'nobody'}, not to {owner}")

    def release(self, names: Iterable[str], owner: str) -> None:
        """Take these from their owner, who has all of them."""
        listed = list(names)
        self.require_owned(listed, owner)
        for name in listed:
            self._get(name).owner = ""

    def release_all(self, owner: str) -> bool:
        """Take everything from an owner; whether there was something."""
        owned = [one for one in self._all.values() if one.owner == owner]
        for one in owned:
            one.owner = ""
        return bool(owned)

    def owns(self, name: str, owner: str) -> bool:
        """Whether an owner has a resource, or one that it is in."""
        return any(one.owner == owner for one in self._get(name).above())

    def owners(self) -> list[list[str]]:
        """[[resource, owner], ...] of all that belong to somebody by name."""
        return [[one.name, one.owner] for one in self._all.values() if one.owner]

    def _get(self, name: str) -> _Resource:
        return self._all[known(name, "resource", self._all)]

    def _plant(self, tree: Mapping[str, Any], parent: _Resource | None) -> None:
        for name, inside in tree.items():
            self._plant(inside, self._add(name, parent, fixed=True))

    def _add(self, name: str, parent: _Resource | None, fixed: bool) -> _Resource:
        resource = self._all[name] = _Resource(name, parent, fixed)
        if parent is not None:
            parent.children[name] = resource
        return resource


def _tree(resource: _Resource) -> list[Any]:
    return [resource.name, [_tree(child) for child in resource.children.values()]]
