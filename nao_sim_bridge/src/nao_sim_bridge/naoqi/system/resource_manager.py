"""ALResourceManager of the simulated robot: programs agree on who has which part of it."""

from __future__ import annotations

import threading
from dataclasses import dataclass
from typing import Any, Sequence

from nao_sim_bridge.base.config import config_file, read_json
from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.system.resources import ResourceTree

FILE, MOTORS = "resources.json", "Motors"
# Calls that wait; with one more the oldest is given up, as libqi does not tell when who waits has gone.
MOST_WAITING = load_sizes().clients.resource_calls


@dataclass(frozen=True)
class _Request:
    """A call that wants resources; `until` is in simulated time, s, None for ever.

    Whoever ends it holds the lock. Of the `optional` ones it gets those that are free when it ends, and
    answers their names; with None it answers nothing.
    """

    task: Task
    names: tuple[str, ...]
    owner: str
    callback: str
    until: float | None
    optional: tuple[str, ...] | None


class ALResourceManager:
    """ALResourceManager as the simulated robot offers it.

    Nobody but programs that ask here takes notice of owners. When a program wants what another one has, the callback of
    that one is called with the resource and its own name: it may release it. `broker` calls modules of clients.
    """

    def __init__(self, simulation: Simulation, broker: Any) -> None:
        self._simulation = simulation
        self._broker = broker
        self._lock = threading.RLock()  # time passes in another thread
        model = simulation.model
        tree = read_json(config_file(FILE))["tree"]
        tree[MOTORS] = {chain: {joint: {} for joint in model.chains[chain]} for chain in model.chain_names}
        self._tree = ResourceTree(tree)
        self._requests: list[_Request] = []
        simulation.after_tick.append(self._tick)

    # --- the tree ----------------------------------------------------------------------------------------------------

    def getResources(self) -> list[Any]:
        """[[name, those in it as the same], ...]."""
        return self._tree.tree()

    def createResource(self, name: str, parent: str) -> None:
        self.createResourcesList([name], parent)

    def createResourcesList(self, names: list[str], parent: str) -> None:
        with self._lock:
            self._tree.create(names, parent)

    def deleteResource(self, name: str, with_children: bool = False) -> None:
        with self._lock:
            gone = self._tree.delete(name, bool(with_children))
            for request in list(self._requests):
                lost = [one for one in (*request.names, *(request.optional or ())) if one in gone]
                if lost:
                    request.task.finish(error=NaoqiError(f"deleted meanwhile: {', '.join(lost)}"))

    def enableStateResource(self, name: str, enabled: bool) -> None:
        with self._lock:
            self._tree.enable(name, bool(enabled))
            self._serve()

    def isInGroup(self, group: str, name: str) -> bool:
        return self._tree.is_in(group, name)

    # --- owners ------------------------------------------------------------------------------------------------------

    def ownersGet(self) -> list[list[str]]:
        """[[resource, owner], ...] of those that somebody has."""
        with self._lock:
            return self._tree.owners()

    def areResourcesFree(self, names: list[str]) -> bool:
        with self._lock:
            return not self._tree.conflicts(names, "")

    checkStateResourceFree = areResourcesFree

    def isResourceFree(self, name: str) -> bool:
        return self.areResourcesFree([name])

    def areResourcesOwnedBy(self, names: list[str], owner: str) -> bool:
        with self._lock:
            return all([self._tree.owns(name, owner) for name in names])

    def acquireResource(self, name: str, module: str, callback: str, timeout: int) -> Task | None:
        return self._acquire([name], module, callback, timeout)

    waitForResource = acquireResource

    def acquireResourcesTree(self, names: list[str], module: str, callback: str, timeout: int) -> Task | None:
        """All of them at once."""
        return self._acquire(names, module, callback, timeout)

    waitForResourcesTree = acquireResourcesTree

    def waitForOptionalResourcesTree(
        self, names: list[str], module: str, callback: str, timeout: int, optional: list[str]
    ) -> Any:
        """Of the `optional` ones those that are free when the others are there; their names."""
        return self._acquire(names, module, callback, timeout, tuple(optional))

    def releaseResource(self, name: str, owner: str) -> None:
        self.releaseResources([name], owner)

    def releaseResources(self, names: list[str], owner: str) -> None:
        with self._lock:
            self._tree.release(names, owner)
            self._serve()

    def client_gone(self, module: str) -> None:
        """A module of a client has left: what it had is free, and it waits for nothing."""
        with self._lock:
            for request in [one for one in self._requests if one.owner == module]:
                request.task.kill()
            if self._tree.release_all(module):
                self._serve()

    def close(self) -> None:
        """Nobody waits any more."""
        for request in list(self._requests):
            self._cancel(request.task)

    def _acquire(
        self,
        names: Sequence[str],
        owner: str,
        callback: str,
        timeout: int,
        optional: tuple[str, ...] | None = None,
    ) -> Any:
        """What a call answers, or a task when it has to wait. A NaoqiError when it may not."""
        if not owner:
            raise BadValue("moduleName", owner, "the name of the module that gets them")
        task = Task("acquireResource", 0, ask=self._cancel)
        until = None if timeout < 0 else self._simulation.snapshot.time + timeout
        request = _Request(task, tuple(names), owner, callback, until, optional)
        with self._lock:
            self._tree.free(optional or (), owner)  # unknown ones are refused before there is a wait
            conflicts = self._tree.conflicts(names, owner)
            if not conflicts:
                return self._take(request)
            for conflict in conflicts:
                if conflict.callback:
                    self._broker.call(conflict.owner, conflict.callback, [conflict.resource, conflict.owner])
            if timeout == 0:
                raise NaoqiError("; ".join(map(str, conflicts)))
            if len(self._requests) >= MOST_WAITING:
                given_up = NaoqiError(f"given up: more than {MOST_WAITING} calls wait for resources")
                self._requests[0].task.finish(error=given_up)
            self._requests.append(request)
            task.add_done_callback(lambda _: self._requests.remove(request))
        return task

    def _take(self, request: _Request) -> list[str] | None:
        """Give a call what it wants; its answer."""
        free = None if request.optional is None else self._tree.free(request.optional, request.owner)
        self._tree.take((*request.names, *(free or ())), request.owner, request.callback)
        return free

    def _serve(self) -> None:
        """Give what is free to who waits for it, first come first served; with the lock held."""
        for request in list(self._requests):
            if not self._tree.conflicts(request.names, request.owner):
                request.task.finish(self._take(request))

    def _cancel(self, task: Task) -> None:
        with self._lock:
            task.kill()

    def _tick(self, snapshot: Snapshot) -> None:
        if not self._requests:
            return
        with self._lock:
            for request in list(self._requests):
                if request.until is not None and snapshot.time >= request.until:
                    conflicts = "; ".join(map(str, self._tree.conflicts(request.names, request.owner)))
                    request.task.finish(error=NaoqiError(f"{conflicts} still after the timeout"))
