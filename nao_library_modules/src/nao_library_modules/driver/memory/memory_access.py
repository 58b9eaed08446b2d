"""Access to the robot's memory in few calls. No ROS."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from naoqi.limits import ANSWER_LIMIT

from ...base.errors import BadGoal
from ...base.suggestion import did_you_mean
from .memory_names import is_pattern, matching

MEMORY = "ALMemory"
BATCH = 500
"""Keys in one question."""


class MemoryAccess:
    """Calls ALMemory; raises NaoError if that fails. Any thread may call."""

    def __init__(self, robot: Any) -> None:
        self._robot = robot

    def ask(self, method: str, *arguments: Any) -> Any:
        return self._robot.proxy(MEMORY).call_async(method, *arguments).result(timeout=ANSWER_LIMIT)

    def values(self, keys: Sequence[str]) -> list[Any]:
        """Values of keys, in order; None for one without."""
        found: list[Any] = []
        for begin in range(0, len(keys), BATCH):
            found += self.ask("getListData", list(keys[begin : begin + BATCH]))
        return found

    def known(self) -> dict[str, bool]:
        """Key -> whether it is an event, of all keys of the robot."""
        methods = ("getDataListName", "getEventList", "getMicroEventList")
        calls = [self._robot.proxy(MEMORY).call_async(method) for method in methods]
        keys, *events = [call.result(timeout=ANSWER_LIMIT) for call in calls]
        told = {name for names in events for name in names}
        return {name: name in told for name in (*keys, *sorted(told))}

    def write(self, key: str, value: Any, as_event: bool) -> None:
        if as_event:
            self.ask("raiseEvent", key, value)
        else:
            self.ask("insertListData", [[key, value]])  # insertData has overloads, and would make 1 of true

    def find(self, pattern: str) -> dict[str, Any]:
        """Key -> value, of the keys that match a pattern; None for one without. Raises BadGoal if none matches."""
        known = self.known()
        keys = matching(known, check_pattern(pattern))
        if not keys:
            several = is_pattern(pattern)
            problem = f"no key is like {pattern!r}" if several else f"there is no key {pattern!r}"
            raise BadGoal("pattern", pattern, "keys of the robot's memory", problem + did_you_mean(pattern, known))
        return dict(zip(keys, self.values(keys)))


def check_pattern(pattern: str, field: str = "pattern") -> str:
    """The pattern or key itself; raises BadGoal if it is empty."""
    if not pattern.strip():
        raise BadGoal(field, pattern, "a key, or several with * and ?", problem="it is empty")
    return pattern
