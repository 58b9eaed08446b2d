"""What was sent to the servers, as a timeline that sends it again."""

from __future__ import annotations

import threading
from collections.abc import Callable, Collection
from dataclasses import dataclass
from typing import Any

from actionlib_msgs.msg import GoalStatus

from naoqi.errors import NaoError

from ...base.errors import BadGoal
from ..language.writer import step_of

DIGITS = 3
"""Of times in s."""
CUT_SHORT = (GoalStatus.PREEMPTED, GoalStatus.RECALLED)
MOST_GOALS = 10_000


@dataclass
class HeardGoal:
    """A goal that was sent."""

    server: str
    goal: Any
    time: float  # when it was sent, s
    ended: float | None = None  # when it ended; None if that did not come
    status: int = GoalStatus.PENDING  # how it ended, of GoalStatus


class BehaviorRecording:
    """A recording that goes on. Any thread may call its methods.

    `tell`: called with the server and each goal that counts, in the thread that it comes in.
    """

    def __init__(
        self,
        name: str,
        servers: Collection[str],
        overwrite: bool = False,
        tell: Callable[[str, Any], None] = lambda server, goal: None,
    ) -> None:
        self.name = name
        self.overwrite = overwrite
        self._tell = tell
        self._servers = frozenset(servers)
        self._heard: dict[str, HeardGoal] = {}
        self._lock = threading.Lock()

    def sent(self, server: str, goal_id: str, goal: Any, time: float) -> None:
        """A goal was sent. `time`: s of ROS time."""
        with self._lock:
            if server not in self._servers or goal_id in self._heard or len(self._heard) >= MOST_GOALS:
                return
            self._heard[goal_id] = HeardGoal(server, goal, time)
        self._tell(server, goal)

    def ended(self, goal_id: str, status: int, time: float) -> None:
        with self._lock:
            heard = self._heard.get(goal_id)
            if heard is not None and heard.ended is None:
                heard.ended, heard.status = time, status

    @staticmethod
    def _entry(heard: HeardGoal, check: Callable[[dict[str, Any]], None]) -> dict[str, Any]:
        """A goal as a step that `check` lets pass; what it raises otherwise."""
        entry = step_of(heard.server, heard.goal)
        try:
            check(entry)
        except NaoError:  # who sent it meant its numbers, usual or not
            entry = step_of(heard.server, heard.goal, unusual=True)
            check(entry)
        return entry

    def timeline(self, check: Callable[[dict[str, Any]], None]) -> tuple[list[dict[str, Any]], list[str]]:
        """Entries of a timeline that begins with the first goal; and what was left out, and why.

        `check`: raises NaoError for a step that could not be stored. Raises BadGoal if no goal came.
        """
        with self._lock:
            heard = sorted(self._heard.values(), key=lambda each: each.time)
        entries: list[dict[str, Any]] = []
        left_out: list[str] = []
        for i, each in enumerate(heard):
            try:
                entry = self._entry(each, check)
            except NaoError as error:
                left_out.append(f"left out, a goal of {each.server} at {each.time - heard[0].time:.3f} s: {error}")
                continue
            entry["at"] = round(each.time - heard[0].time, DIGITS)
            if each.status == GoalStatus.ABORTED:
                entry["on_error"] = "skip"  # it failed, and what came next came nevertheless
            if each.status in CUT_SHORT and each.ended is not None:
                following = [later.time for later in heard[i + 1 :] if later.server == each.server][:1]
                entry["for"] = round(max(min([each.ended, *following]) - each.time, 0.0), DIGITS)
            entries.append(entry)
        if not entries:
            reason = "; ".join(left_out) or "nothing was sent to the servers meanwhile"
            raise BadGoal("str_param", self.name, "a recording with goals", f"nothing is stored: {reason}")
        return entries, left_out
