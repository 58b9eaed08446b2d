"""The robot's memory, asked in as few questions as can be. No ROS."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ...base.errors import BadGoal
from ...base.suggestion import did_you_mean
from .memory_names import is_pattern, matching

MEMORY = "ALMemory"
ANSWER_LIMIT = 5.0
BATCH = 500
"""Keys in one question."""


class MemoryAccess:
    """Asks. Any thread may call."""

    def __init__(self, robot: Any) -> None:
        """Keep the robot; it need not be there yet.

        Args:
            robot: Its proxies, see `nao_library_modules.robot`.
        """
        self._robot = robot

    def ask(self, method: str, *arguments: Any) -> Any:
        """Call a method of the memory.

        Raises:
            NaoError: If the call fails.
        """
        return self._robot.proxy(MEMORY).call_async(method, *arguments).result(timeout=ANSWER_LIMIT)

    def values(self, keys: Sequence[str]) -> list[Any]:
        """Values of keys, in order; None for one without.

        Raises:
            NaoError: If the robot cannot be asked.
        """
        found: list[Any] = []
        for begin in range(0, len(keys), BATCH):
            found += self.ask("getListData", list(keys[begin : begin + BATCH]))
        return found

    def known(self) -> dict[str, bool]:
        """All keys of the robot, and of each whether it is an event.

        Raises:
            NaoError: If the robot cannot be asked.
        """
        methods = ("getDataListName", "getEventList", "getMicroEventList")
        calls = [self._robot.proxy(MEMORY).call_async(method) for method in methods]
        keys, *events = [call.result(timeout=ANSWER_LIMIT) for call in calls]
        told = {name for names in events for name in names}
        return {name: name in told for name in (*keys, *sorted(told))}

    def write(self, key: str, value: Any, as_event: bool) -> None:
        """Write a key, or raise an event.

        Raises:
            NaoError: If the robot refuses or cannot be asked.
        """
        if as_event:
            self.ask("raiseEvent", key, value)
        else:
            self.ask("insertListData", [[key, value]])  # insertData has overloads, and would make 1 of true

    def find(self, pattern: str) -> dict[str, Any]:
        """Key -> value, of the keys that a pattern stands for; None for one without a value.

        Raises:
            BadGoal: If it stands for none.
            NaoError: If the robot cannot be asked.
        """
        known = self.known()
        keys = matching(known, check_pattern(pattern))
        if not keys:
            several = is_pattern(pattern)
            problem = f"no key is like {pattern!r}" if several else f"there is no key {pattern!r}"
            raise BadGoal("pattern", pattern, "keys of the robot's memory", problem + did_you_mean(pattern, known))
        return dict(zip(keys, self.values(keys)))


def check_pattern(pattern: str, field: str = "pattern") -> str:
    """A pattern, or a key.

    Raises:
        BadGoal: If it is empty.
    """
    if not pattern.strip():
        raise BadGoal(field, pattern, "a key, or several with * and ?", problem="it is empty")
    return pattern
