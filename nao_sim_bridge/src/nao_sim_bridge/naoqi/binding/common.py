"""The methods that every NAOqi module has: help about itself, and posted calls with an id."""

from __future__ import annotations

import itertools
import threading
from collections import OrderedDict
from typing import Any, Callable, Mapping

import qi

from nao_sim_bridge.base.errors import BadValue, UnknownName
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.naoqi.binding.api import Method
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.binding.unfinished import Unfinished

VERSION = "2.8.5.10"
# Finished posted calls that `wait` and `isRunning` still know.
REMEMBERED = 1000


class CommonModule:
    """What NAOqi's module base class offers; `broker` has `name` and `unregister(module)`."""

    def __init__(self, module: str, table: Mapping[str, Method], broker: Any) -> None:
        self.targets: dict[str, Callable[..., Any]] = {}
        self._module = module
        self._table = table
        self._broker = broker
        self._ids = itertools.count(1)
        self._posted: OrderedDict[int, Task | None] = OrderedDict()
        self._unfinished = Unfinished()
        self._lock = threading.Lock()

    def ping(self) -> bool:
        return True

    def version(self) -> str:
        return VERSION

    def getBrokerName(self) -> str:
        return self._broker.name

    def exit(self) -> None:
        self._broker.unregister(self._module)

    def getMethodList(self) -> list[str]:
        return sorted(self.targets)

    def getMethodHelp(self, name: str) -> list:
        """[name, [[parameter, type], ...], return type, summary] of a method; the overload with most parameters."""
        method = self._method(name)
        longest = max(method.overloads, key=lambda o: len(o.types))
        return [method.name, [list(p) for p in zip(longest.names, longest.types)], method.returns, method.summary]

    def getModuleHelp(self) -> list:
        """[description, [[language, example], ...]]."""
        example = f'ALProxy("{self._module}", "127.0.0.1", 9559).ping()'
        return [f"{self._module} of the simulated NAO, {len(self.targets)} methods", [["python", example]]]

    def getUsage(self, name: str) -> str:
        return self._method(name).usage()

    def pCall(self, *call: Any) -> int:
        """Call a method, its name and its arguments, without waiting; the id is for `wait`, `isRunning` and `stop`."""
        if not call or not isinstance(call[0], str):
            raise BadValue("method", call[0] if call else None, "the name of a method, and its arguments after it")
        name, *args = call
        self._method(name)
        self._unfinished.require_room(name)
        result = self.targets[name](*args)
        if isinstance(result, Task):
            self._unfinished.note(result)
        with self._lock:
            call_id = next(self._ids)
            self._posted[call_id] = result if isinstance(result, Task) else None
            self._forget_finished()
        if isinstance(result, Task):
            result.add_done_callback(lambda done: self._drop_result(call_id, done))
        return call_id

    def isRunning(self, call_id: int) -> bool:
        return _runs(self._task(call_id))

    def stop(self, call_id: int) -> None:
        task = self._task(call_id)
        if task is not None:
            task.request_kill()

    def wait(self, call_id: int, timeout: int = 0) -> Any:
        """Wait for a posted call, at most `timeout` ms (0: for ever); true when the time was up first."""
        task = self._task(call_id)
        if not _runs(task):
            return False
        ended = Task("wait", call_id, ask=lambda asked: asked.kill())
        awaited = [task]

        def settle(done: Task) -> None:
            if isinstance(done.value, Task):
                awaited[0] = done.value
                done.value.add_done_callback(settle)
            else:
                ended.finish(False)

        task.add_done_callback(settle)
        ended.add_done_callback(lambda _: awaited[0].remove_done_callback(settle))
        if timeout > 0:
            time_is_up = qi.runAsync(ended.finish, True, delay=int(timeout * 1000))  # a timer in a thread of libqi
            ended.add_done_callback(lambda _: time_is_up.cancel())
        return ended

    def _method(self, name: str) -> Method:
        if name not in self.targets:
            raise UnknownName("method", name, self.targets)
        return self._table[name]

    def _task(self, call_id: int) -> Task | None:
        """What a posted call started; None when it took no time."""
        with self._lock:
            if call_id not in self._posted:
                raise NaoqiError(f"no posted call has the id {call_id}")
            return self._posted[call_id]

    def _drop_result(self, call_id: int, done: Task) -> None:
        """Nobody can ask for what a posted call has given, and pictures are large; that it has ended is remembered."""
        if not isinstance(done.value, Task):
            with self._lock:
                if call_id in self._posted:
                    self._posted[call_id] = None

    def _forget_finished(self) -> None:
        """Keep no more than `REMEMBERED` calls, but all that still run."""
        for call_id in list(self._posted):
            if len(self._posted) <= REMEMBERED:
                return
            if not _runs(self._posted[call_id]):
                del self._posted[call_id]


def _runs(task: Task | None) -> bool:
    """Whether a task, or the one at the end of the chain that it began, has not ended."""
    while task is not None and task.finished and isinstance(task.value, Task):
        task = task.value
    return task is not None and not task.finished
