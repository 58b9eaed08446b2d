"""What a simulation was like at a moment, to be put back into the same objects later."""

from __future__ import annotations

import random
import weakref
from collections import deque
from functools import partial
from typing import Any, Callable, Iterable, Sequence

import numpy as np

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.core.shared_world import SharedWorld
from nao_sim_bridge.core.simulation import Simulation

OURS = "nao_sim_bridge."


class SavedState:
    """What a world and the robots in it were like; what the engine keeps of it is freed with it, or by `drop`."""

    def __init__(self, shared: SharedWorld, simulations: Sequence[Simulation]) -> None:
        self._shared = shared
        self._physics = shared.physics
        self._bodies = shared.physics.save()
        self._free = weakref.finalize(self, shared.physics.drop, self._bodies)
        self._free.atexit = False
        robots = [simulation.robot for simulation in simulations]
        physics = shared.physics
        left_out = [shared, shared.settings, shared.task_ids, shared.guard, physics, physics.engine, shared.things]
        for simulation in simulations:
            left_out += [simulation.model, simulation.led_layout, simulation.scene, simulation.physics]
        self._robots = Memento(robots, left_out)
        self._kept = [(one, one.robot, one.snapshot, one.physics.payload, one.physics.friction) for one in simulations]
        self._ticks, self._ways = shared.ticks, shared.things.under_way()
        self.restore(shared)  # the engine has forgotten how things touch then, now as at each restore

    def restore(self, shared: SharedWorld) -> None:
        """Put everything back, as often as one likes.

        Raises:
            BadValue: It is of another simulation, was dropped, or things have come or gone since.
        """
        if not self._free.alive:
            raise BadValue("state", "one that was dropped", "one that is kept")
        if shared is not self._shared or shared.physics is not self._physics:
            raise BadValue("state", "one of before", "one of this simulation, saved since its last reset")
        if not shared.physics.fits(self._bodies):
            raise BadValue("state", "one with other things", "one of a world in which nothing has come or gone since")
        for simulation, _, _, payload, friction in self._kept:  # first: they count where bodies touch
            simulation.physics.carry(payload)
            simulation.physics.scale_friction(friction)
        shared.physics.load(self._bodies)
        self._robots.restore()
        for simulation, robot, snapshot, _, _ in self._kept:
            simulation.robot, simulation.snapshot = robot, snapshot
            robot.tell_motors()
        shared.ticks = self._ticks
        shared.things.go_on(self._ways)

    def drop(self) -> None:
        """Free what the engine keeps of it, a quarter of a megabyte; it cannot be restored any more."""
        self._free()


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
