"""ALResourceManager of the simulated robot: programs agree on who has which part of it."""

from __future__ import annotations

import threading
from dataclasses import dataclass
from typing import Any, Sequence

from nao_sim_bridge.base.config import config_file, read_json
from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.system.resources import ResourceTree

FILE, MOTORS = "resources.json", "Motors"


@dataclass(frozen=True)
class _Request:
    """A call that waits for resources; `until` is in simulated time, s, None for ever."""

    task: Task
    names: tuple[str, ...]
    owner: str
    callback: str
    until: float | None


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
        self._callbacks: dict[str, str] = {}  # resource that somebody has -> method of the owner
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
                lost = [one for one in request.names if one in gone]
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

        def take_optional(_: Any) -> list[str]:
            with self._lock:
                free = [name for name in optional if not self._tree.conflicts([name], module)]
                self._take(free, module, callback)
                return free

        waiting = self._acquire(names, module, callback, timeout)
        return take_optional(None) if waiting is None else waiting.then(take_optional)

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
            request.task.kill()

    def _acquire(self, names: Sequence[str], owner: str, callback: str, timeout: int) -> Task | None:
        """Have a module own resources; a task when it has to wait for them. A NaoqiError when it may not."""
        if not owner:
            raise BadValue("moduleName", owner, "the name of the module that gets them")
        with self._lock:
            conflicts = self._tree.conflicts(names, owner)
            if not conflicts:
                self._take(names, owner, callback)
                return None
            for conflict in conflicts:
                told = self._callbacks.get(conflict.resource)
                if conflict.owner and told:
                    self._broker.call(conflict.owner, told, [conflict.resource, conflict.owner])
            if timeout == 0:
                raise NaoqiError("; ".join(map(str, conflicts)))
            task = Task("acquireResource", 0, ask=lambda asked: asked.kill())
            until = None if timeout < 0 else self._simulation.snapshot.time + timeout
            request = _Request(task, tuple(names), owner, callback, until)
            self._requests.append(request)
        task.add_done_callback(lambda _: self._forget(request))
        return task

    def _take(self, names: Sequence[str], owner: str, callback: str) -> None:
        self._tree.take(names, owner)
        self._callbacks.update(dict.fromkeys(names, callback))

    def _serve(self) -> None:
        """Give what is free to who waits for it, first come first served; with the lock held."""
        for request in list(self._requests):
            if not self._tree.conflicts(request.names, request.owner):
                self._take(request.names, request.owner, request.callback)
                self._forget(request)
                request.task.finish()

    def _forget(self, request: _Request) -> None:
        with self._lock:
            self._requests = [one for one in self._requests if one is not request]

    def _tick(self, snapshot: Snapshot) -> None:
        if not self._requests:
            return
        with self._lock:
            for request in list(self._requests):
                if request.until is not None and snapshot.time >= request.until:
                    conflicts = "; ".join(map(str, self._tree.conflicts(request.names, request.owner)))
                    request.task.finish(error=NaoqiError(f"{conflicts} still after the timeout"))
