"""ALNotificationManager of the simulated robot: short messages for people, which it says when its chest is pressed."""

from __future__ import annotations

import itertools
import threading
from dataclasses import dataclass
from typing import Any, Callable

from nao_sim_bridge.base.errors import BadValue, UnknownName
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.naoqi.binding.arguments import map_or_pairs, one_of, text
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.body.touch import CLICKED
from nao_sim_bridge.naoqi.memory.store import MemoryStore

NAME = "ALNotificationManager"
ADDED, REMOVED = "notificationAdded", "notificationRemoved"
SEVERITIES = ("info", "warning", "error")
KEYS = ("id", "message", "severity", "removeOnRead")


@dataclass(frozen=True)
class _Notification:
    message: str
    severity: str
    remove_on_read: bool


class ALNotificationManager:
    """ALNotificationManager as the simulated robot offers it.

    A click on the chest button has the robot `say` what is pending; what is to be removed when it was read goes then.
    """

    def __init__(self, memory: MemoryStore, say: Callable[[str], Task]) -> None:
        self._memory = memory
        self._say = say
        self._lock = threading.Lock()  # clicks come in another thread than calls
        self._ids = itertools.count(1)
        self._pending: dict[int, _Notification] = {}
        for event in (ADDED, REMOVED):
            memory.declare_event(event, NAME)
        memory.listen(CLICKED[1], lambda _: self._read(), declare=False)

    def add(self, notification: Any) -> int:
        """`notification` has a message, severity and removeOnRead by these names, as a map or pairs; returns its id."""
        added = _notification(notification)
        with self._lock:
            most = load_sizes().kept.notifications
            if len(self._pending) >= most:
                raise NaoqiError(f"{most} notifications are pending at most: remove some first")
            number = next(self._ids)
            self._pending[number] = added
        self._memory.raise_event(ADDED, number)
        return number

    def remove(self, number: int) -> None:
        with self._lock:
            self._get(number)
            del self._pending[number]
        self._memory.raise_event(REMOVED, number)

    def notification(self, number: int) -> list[list[Any]]:
        with self._lock:
            return _pairs(number, self._get(number))

    def notifications(self) -> list[list[list[Any]]]:
        with self._lock:
            return [_pairs(*entry) for entry in self._pending.items()]

    def _get(self, number: int) -> _Notification:
        if number not in self._pending:
            raise UnknownName("notification", number, map(str, self._pending))
        return self._pending[number]

    def _read(self) -> None:
        with self._lock:
            pending = dict(self._pending)
        for number, one in pending.items():
            said = self._say(one.message)
            if one.remove_on_read:
                said.add_done_callback(lambda done, read=number: self._was_read(read, done))

    def _was_read(self, number: int, said: Task) -> None:
        if isinstance(said.value, Task):  # the text has its turn
            said.value.add_done_callback(lambda done: self._was_read(number, done))
            return
        if said.error is not None or said.killed:
            return
        with self._lock:
            there = self._pending.pop(number, None)
        if there is not None:
            self._memory.raise_event(REMOVED, number)


def _pairs(number: int, one: _Notification) -> list[list[Any]]:
    """[["id", number], ["message", text], ["severity", word], ["removeOnRead", whether]]."""
    return [list(pair) for pair in zip(KEYS, (number, one.message, one.severity, one.remove_on_read))]


def _notification(value: Any) -> _Notification:
    right = '{"message": text, "severity": "info", "removeOnRead": true}, or these as pairs'
    given = map_or_pairs(value, "notification", right)
    message, remove = given.get("message", ""), given.get("removeOnRead", True)
    if set(given) - set(KEYS) or not isinstance(message, str) or not isinstance(remove, (bool, int)):
        raise BadValue("notification", value, right)
    text(message, "message", load_sizes().speech.text_characters)
    return _Notification(message, one_of(given.get("severity") or SEVERITIES[0], "severity", SEVERITIES), bool(remove))
