"""The store as it will be when the functions of a chain before this one have been carried out."""

from __future__ import annotations

from typing import Any

from ...base.errors import BadGoal
from .errors import NoSuchBehavior
from .model import Behavior
from .reader import read
from .store import BehaviorStore

KEY = "behaviors"
_UNKNOWN, _GONE = object(), object()


class UnknownYet(Exception):
    """A behaviour will be recorded by a function of the chain: nothing is known of it yet."""


class PlannedStore:
    """What checks ask instead of the store."""

    def __init__(self, store: BehaviorStore) -> None:
        self._store = store
        self._changes: dict[str, Any] = {}

    @classmethod
    def of(cls, store: BehaviorStore, context: dict[str, Any]) -> PlannedStore:
        """The one that belongs to the check of a chain. `context`: lives as long as the check."""
        return context.setdefault(KEY, cls(store))

    def load(self, name: str) -> Behavior:
        """A behaviour. Raises UnknownYet if it will be recorded, NaoError as `BehaviorStore.load`."""
        change = self._changes.get(name)
        if change is _UNKNOWN:
            raise UnknownYet(name)
        return self._store.load(name) if change is None else read(self.text(name) or "", name)

    def text(self, name: str) -> str | None:
        """The text of a behaviour; None if it will be recorded."""
        change = self._changes.get(name)
        if change is _UNKNOWN:
            return None
        if isinstance(change, str):
            return change
        if change is None:
            return self._store.text(name)
        if self._store.is_shipped(name):
            return self._store.shipped_text(name)
        raise self._unknown(name)

    def require_of_user(self, name: str) -> None:
        """See that one can be changed. Raises NaoError as `BehaviorStore.require_of_user`."""
        change = self._changes.get(name)
        if change is _GONE:
            raise self._unknown(name)
        if change is None:
            self._store.require_of_user(name)

    def require_free(self, name: str, overwrite: bool, field: str = "str_param") -> None:
        """See that a name can be given to a behaviour. Raises BadGoal if it will not do, or is taken."""
        self._store.path(name, field)
        change = self._changes.get(name)
        if overwrite or change is _GONE:
            return
        if change is not None:
            raise BadGoal(
                field, name, "a name that is free, or overwrite", f"the chain makes a behavior {name!r} before"
            )
        self._store.require_free(name, field)

    def put(self, name: str, text: str | None) -> None:
        """A behaviour will be there. `text`: None if it is recorded."""
        self._changes[name] = _UNKNOWN if text is None else text

    def remove(self, name: str) -> None:
        """The user's behaviour of a name will not be there any more."""
        self._changes[name] = _GONE

    def _unknown(self, name: str) -> NoSuchBehavior:
        gone = {each for each, change in self._changes.items() if change is _GONE and not self._store.is_shipped(each)}
        return NoSuchBehavior(name, {*self._store.names(), *self._changes} - gone)
