"""What objects were like at a moment, to be put back into the same objects later."""

from __future__ import annotations

import random
from collections import deque
from functools import partial
from typing import Any, Callable, Iterable

import numpy as np

OURS = "nao_sim_bridge."


class Memento:
    """Remembers everything that can change in a tree of objects of this package; `restore` puts it back.

    Objects stay the same, so that whoever holds one of them goes on with it. What is not of this package is left alone,
    but for lists, sets, mappings, arrays and sources of chance. Closures are not looked into: whatever lives in one
    must not be under way.

    Args:
        roots: Where the tree begins.
        left_out: Objects that stay as they are, with everything that only they lead to.
    """

    def __init__(self, roots: Iterable[object], left_out: Iterable[object] = ()) -> None:
        self._steps: list[Callable[[], None]] = []
        self._seen: set[int] = {id(one) for one in left_out}
        self._alive = [*left_out]  # so that no other object gets the identity of one that was seen
        waiting = [*roots]
        while waiting:
            one = waiting.pop()
            if id(one) not in self._seen:
                self._seen.add(id(one))
                self._alive.append(one)
                waiting += self._remember(one)

    def restore(self) -> None:
        """Put everything back; as often as one likes."""
        for step in self._steps:
            step()

    def _remember(self, one: Any) -> Iterable[object]:
        """Keep one object; what it leads to."""
        if isinstance(one, (list, deque)):
            self._steps.append(partial(_refill, one, one.extend, tuple(one)))
            return one
        if isinstance(one, set):
            self._steps.append(partial(_refill, one, one.update, frozenset(one)))
            return ()
        if isinstance(one, dict):
            self._steps.append(partial(_refill, one, one.update, dict(one)))
            return one.values()
        if isinstance(one, tuple):
            return one
        if isinstance(one, np.ndarray):
            if one.flags.writeable:
                self._steps.append(partial(np.copyto, one, one.copy()))
            return ()
        if isinstance(one, random.Random):
            self._steps.append(partial(one.setstate, one.getstate()))
            return ()
        if isinstance(one, type) or not type(one).__module__.startswith(OURS):
            return ()
        fields = getattr(one, "__dict__", None)
        if fields is None:
            return ()
        self._steps.append(partial(_refill, fields, fields.update, dict(fields)))
        return fields.values()


def _refill(container: Any, fill: Callable[[Any], None], content: Any) -> None:
    container.clear()
    fill(content)
