"""The ROS side of behaviours: clients of the servers, the log of goals that anybody sends, and its recording."""

from __future__ import annotations

import threading
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import rospy
from actionlib_msgs.msg import GoalStatus

from nao_library_msgs.srv import DescribeFunctions, DescribeFunctionsRequest, DescribeFunctionsResponse
from naoqi.errors import NaoError

from ..core.errors import BadGoal
from ..core.goal_checks import GoalCheck
from ..core.server_types import DESCRIBE, ServerType, servers_among, those_in
from ..process_modules.plan_action_client import PlanActionClient
from ..ros.goal_client import NotAnswered, call_service, check_goals
from .behavior_store import step_of
from .server_functions import NotDescribed

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


# --- clients and the log of goals -------------------------------------------------------------------------------------

CLOCKS_APART = 1.0
"""s that the stamp of a goal may lie before its arrival, or after it where simulated time reaches one program later
than the other: what is further away was stamped by another clock."""


def describe(server: str, functions: Sequence[str] | None) -> DescribeFunctionsResponse:
    """Have a server that runs describe functions; see `server_functions.Describe`."""
    request = DescribeFunctionsRequest(
        functions=functions or [], without_arguments=not functions, without_functions=functions is None
    )
    try:
        return call_service(server + DESCRIBE, DescribeFunctions, request)
    except NotAnswered as error:
        raise NotDescribed(str(error)) from None


def running() -> list[str]:
    """Names of the servers that run in this node's namespace; none where there is no master."""
    here = rospy.resolve_name("")
    try:
        _, _, (_, _, services) = rospy.get_master().getSystemState()
    except OSError:
        return []
    return sorted(those_in(here, servers_among(name for name, _ in services)))


class ServerClient(PlanActionClient):
    """Client of a server whose goals are chains of functions; see `PlanActionClient.call` and `wait_for_server`."""

    def check(self, goals: Sequence[Any]) -> GoalCheck:
        """Have the server check goals without carrying them out. Raises NotValidated if it does not, or not in time."""
        return check_goals(self.name, *goals)


class Clients:
    """The clients, each made when it is needed first and then kept.

    `types`: gives the types of a server, or raises BadGoal.
    """

    def __init__(self, types: Callable[[str], ServerType]) -> None:
        self._types = types
        self._clients: dict[str, ServerClient] = {}
        self._lock = threading.Lock()

    def __call__(self, name: str) -> ServerClient:
        """The client of a server. Raises BadGoal if there is no server of that name."""
        with self._lock:
            if name not in self._clients:
                server = self._types(name)
                self._clients[name] = ServerClient(server.name, server.action)
            return self._clients[name]


class GoalLog:
    """Listens to what anybody sends to the servers: keeps the last goal of each, and passes on what is recorded.

    ROS API:
        Subscribes to `SERVER/goal` and `SERVER/result` of all servers that it listens to.

    `node`: with `subscribe` and `clock`, see `server_node`. `servers`: the servers that it listens to from the
    beginning.
    """

    def __init__(self, node: Any, servers: Iterable[ServerType]) -> None:
        self._node = node
        self._clock = node.clock
        self._heard: set[str] = set()
        self._last: dict[str, Any] = {}
        self._recording: BehaviorRecording | None = None
        self._lock = threading.Lock()
        for server in servers:
            self.listen(server)

    def listen(self, server: ServerType) -> None:
        with self._lock:
            if server.name in self._heard:
                return
            self._heard.add(server.name)
        action = server.action()
        self._node.subscribe(f"{server.name}/goal", type(action.action_goal), partial(self._sent, server.name))
        self._node.subscribe(f"{server.name}/result", type(action.action_result), self._ended)

    def last(self, server: str) -> Any:
        """The goal that a server got last; None if it got none."""
        with self._lock:
            return self._last.get(server)

    def record(self, recording: BehaviorRecording | None) -> None:
        """Tell a recording what is sent from now on; None ends that."""
        with self._lock:
            self._recording = recording

    def _sent(self, server: str, message: Any) -> None:
        now = self._clock.now()
        stamp = message.header.stamp.to_sec()
        # The stamp is when the client sent it, the truth if its clock is ours.
        time = stamp if abs(now - stamp) <= CLOCKS_APART else now
        with self._lock:
            self._last[server] = message.goal
            recording = self._recording
        if recording is not None:
            recording.sent(server, message.goal_id.id, message.goal, time)

    def _ended(self, message: Any) -> None:
        with self._lock:
            recording = self._recording
        if recording is not None:
            recording.ended(message.status.goal_id.id, message.status.status, self._clock.now())
