"""Goals of a robot: those of this console and of other programs, presses that failed, and how far the last stop is."""

from __future__ import annotations

import itertools
import threading
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, Tuple

import rospy
from actionlib_msgs.msg import GoalID, GoalStatusArray

from ...cli.output import plain, progress_text
from ...core.server_types import ACTIONS, server_type
from ...core.waiting import Listeners


@dataclass(frozen=True)
class GoalEnd:
    """A way in which a goal ends.

    Attributes:
        state: Its name in logs.
        status: Of actionlib_msgs/GoalStatus; None: the goal was never sent.
        word: What a button and a line say of it; empty: nothing.
    """

    state: str
    status: int | None
    word: str = ""

    @property
    def failed(self) -> bool:
        """Whether it is told until somebody has looked."""
        return bool(self.word)


SUCCEEDED = GoalEnd("succeeded", 3)
PREEMPTED = GoalEnd("preempted", 2, "stopped")
ABORTED = GoalEnd("aborted", 4, "failed")
REJECTED = GoalEnd("rejected", 5, "refused")
RECALLED = GoalEnd("recalled", 8, "stopped before it began")
LOST = GoalEnd("lost", 9, "lost")
NOT_SENT = GoalEnd("not sent", None, "not sent")
GOAL_ENDS = (SUCCEEDED, PREEMPTED, ABORTED, REJECTED, RECALLED, LOST, NOT_SENT)
"""All ways in which a goal ends, for logs and pages alike."""
ENDS = {end.status: end for end in GOAL_ENDS if end.status is not None}
STATES = {0: "pending", 1: "active", 6: "active", 7: "pending", **{status: end.state for status, end in ENDS.items()}}
"""States of actionlib_msgs/GoalStatus by their names in logs."""


def end_of(state: str) -> GoalEnd:
    """The end of a name. Raises KeyError where it is none."""
    return {end.state: end for end in GOAL_ENDS}[state]


@dataclass(eq=False)
class Run:
    """One goal, of this console or of another program. Any thread.

    Attributes:
        progress: The newest feedback, for people.
        result: Its fields as plain values; empty before the end, and for goals of others.
        sent: s of ROS time.
        state: pending, active, or the state of one of GOAL_ENDS.
    """

    id: str
    robot: str  # namespace
    server: str  # relative name of the action
    functions: Sequence[str]  # of its chain
    label: str
    by: str  # who sent it at this console; empty: another program
    sent: float
    cancel_goal: Callable[[], None] = field(repr=False, default=lambda: None)
    state: str = "pending"
    text: str = ""
    progress: str = ""
    result: Mapping[str, Any] = field(default_factory=dict)
    feedback: Mapping[str, Any] = field(default_factory=dict)
    _over: threading.Event = field(default_factory=threading.Event, repr=False)
    _lock: threading.Lock = field(default_factory=threading.Lock, repr=False)
    _listeners: list[Callable[[Run], None]] = field(default_factory=list, repr=False)

    @property
    def done(self) -> bool:
        return self._over.is_set()

    @property
    def succeeded(self) -> bool:
        return self.state == SUCCEEDED.state

    def cancel(self) -> None:
        """Have it ended, unless it is over."""
        if not self.done:
            self.cancel_goal()

    def on_end(self, listener: Callable[[Run], None]) -> None:
        """Have its end told, in the thread that learns of it; at once if it is over."""
        with self._lock:
            if not self.done:
                self._listeners.append(listener)
                return
        listener(self)

    def wait(self, timeout: float | None = None) -> bool:
        """Wait for its end, s of this computer; whether it is over. Not for the event loop of pages."""
        return self._over.wait(timeout)

    def end(self, end: GoalEnd, text: str = "", result: Mapping[str, Any] | None = None) -> None:
        """It is over; the first end counts."""
        with self._lock:
            if self.done:
                return
            self.state, self.text, self.result = end.state, text, result or {}
            self._over.set()
            listeners, self._listeners = self._listeners, []
        for listener in listeners:
            listener(self)


PATIENCE = 2.0
"""s for which a press waits for a server that has gone: others wait behind it."""
MOST = 50
"""Failed presses that are kept of a user; the oldest goes for a new one."""
FAILED = "failed"
"""Kind of the event that a press has failed."""
LONGEST_REASON = 2000
MOST_IDS = 1000
"""Ids of presses that are known; the oldest goes for a new one."""


@dataclass(frozen=True)
class Press:
    """A button that a user presses.

    Attributes:
        label: What stands on the button.
        by: The user.
        page: Path of the page that it is on.
        robot: Namespace of the robot that it is for.
        group: Title of the button's group, on the wizard's page.
        via: click or key.
        streams: Events of the robots that are told of it: that of the page, and that of the button.
    """

    label: str
    by: str
    page: str = ""
    robot: str = "/"
    group: str = ""
    via: str = "click"
    streams: Tuple[Any, ...] = ()

    @property
    def place(self) -> tuple[str, str, str]:
        """Robot, group and label: which button it is."""
        return self.robot, self.group, self.label

    def log(self, kind: str, text: str, **data: Any) -> None:
        """Add an event to the logs of its robots."""
        about = {"group": self.group, "button": self.label, "via": self.via, "page": self.page, "of": self.robot}
        for events in dict.fromkeys(self.streams):
            events.add(kind, text, self.by, **{**about, **data})


@dataclass(frozen=True)
class FailedPress:
    """A press whose goal has not succeeded. `when`: s since 1970, of the last of `count` that failed alike."""

    id: int
    press: Press
    end: GoalEnd
    reason: str
    when: float
    count: int = 1

    @property
    def text(self) -> str:
        """For people: when, which button, how it ended and why."""
        clock = time.strftime("%H:%M:%S", time.localtime(self.when))
        what = ", ".join(filter(None, (self.press.group, self.press.label, self.press.robot.strip("/"))))
        times = f" ({self.count} times)" if self.count > 1 else ""
        return f"{clock}  {what or 'A press'}: {self.end.word}{times}" + (f": {self.reason}" if self.reason else "")


class Presses:
    """The presses of all pages that have failed and that their users have not looked at. Any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._numbers = itertools.count(1)
        self._failed: dict[str, dict[int, FailedPress]] = {}  # by user, the newest last
        self._listeners = Listeners()
        self._ids: dict[str, None] = {}  # the newest last

    def is_new(self, press_id: str) -> bool:
        """Whether nothing was heard yet of a press: it may arrive, and be told as not sent, in any order.

        `press_id`: of the page that it is on; empty: it has none, and is new.
        """
        if not press_id:
            return True
        with self._lock:
            if press_id in self._ids:
                return False
            self._ids[press_id] = None
            if len(self._ids) > MOST_IDS:
                del self._ids[next(iter(self._ids))]
            return True

    def follow(self, press: Press, run: Run) -> None:
        """Report how the goal of a press ends."""
        run.on_end(lambda over: self.report(press, end_of(over.state), over.text, goal=over.id))

    def report(self, press: Press, end: GoalEnd, reason: str = "", keep: bool = True, **data: Any) -> None:
        """Log that a press has not succeeded, and keep it unless its user has looked. `data`: further fields to log."""
        if not end.failed:
            return
        reason = reason[:LONGEST_REASON]
        text = f"{press.label}: {end.word}" + (f": {reason}" if reason else "")
        press.log(FAILED, text, state=end.state, reason=reason, **data)
        if not keep:
            return
        with self._lock:
            failed = self._failed.setdefault(press.by, {})
            alike = (press.place, press.page, end, reason)
            for kept in list(failed.values()):
                if (kept.press.place, kept.press.page, kept.end, kept.reason) == alike:
                    del failed[kept.id]
                    failed[kept.id] = replace(kept, when=time.time(), count=kept.count + 1)
                    break
            else:
                number = next(self._numbers)
                failed[number] = FailedPress(number, press, end, reason, time.time())
                if len(failed) > MOST:
                    del failed[next(iter(failed))]
        self._tell()

    def unseen(self, user: str) -> list[FailedPress]:
        """Failed presses that a user has not looked at, the newest first."""
        with self._lock:
            return list(reversed(self._failed.get(user, {}).values()))

    def seen(self, user: str, number: int | None = None) -> None:
        """A user has looked at a failed press, or at all of them."""
        with self._lock:
            failed = self._failed.get(user, {})
            failed.clear() if number is None else failed.pop(number, None)
        self._tell()

    def ends(self, user: str) -> Mapping[tuple[str, str, str], GoalEnd]:
        """Places of buttons -> how the newest press of a user has failed."""
        with self._lock:
            return {kept.press.place: kept.end for kept in self._failed.get(user, {}).values()}

    def subscribe(self, callback: Callable[[], None]) -> Callable[[], None]:
        """Have changes told, in the thread that makes them; what comes back ends that."""
        return self._listeners.add(callback)

    def _tell(self) -> None:
        for listener in self._listeners:
            listener()


STOPPING, STOPPED = "stopping", "stopped"
"""What was going on has not ended yet; all of it has, and nothing has begun since."""


class LastStop:
    """What the last stop has to end: the goals that ran, and steps of its own. Any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._goals: set[Run] = set()
        self._steps: set[object] = set()
        self._past = True  # whether there was none, or something has begun since

    def begin(self, runs: Iterable[Run], *steps: Callable[[], None]) -> list[Callable[[], None]]:
        """A stop begins. Returns its steps, to be called by threads of their own."""
        keys = [object() for _ in steps]
        with self._lock:
            self._goals, self._steps, self._past = set(runs), set(keys), False
        return [self._counted(key, step) for key, step in zip(keys, steps)]

    def has_begun(self) -> None:
        """Something has begun that is no goal."""
        with self._lock:
            self._past = True

    def state(self, runs: Iterable[Run]) -> str:
        """STOPPING, STOPPED, or empty: nothing was stopped, or something has begun since. `runs`: that go on now."""
        with self._lock:
            going = set(runs)
            self._past = self._past or bool(going - self._goals)
            if self._steps or going & self._goals:
                return STOPPING
            return "" if self._past else STOPPED

    def _counted(self, key: object, step: Callable[[], None]) -> Callable[[], None]:
        def carry_out() -> None:
            try:
                step()
            finally:
                with self._lock:
                    self._steps.discard(key)

        return carry_out


class ForeignGoals:
    """Follows the goals of some servers that are not this console's. Any thread.

    `is_own`: whether this console has sent the goal of an id.

    ROS API:
        Subscribes to `SERVER/goal`, `SERVER/status`, `SERVER/feedback`. Publishes `SERVER/cancel`.
    """

    def __init__(self, namespace: str, is_own: Callable[[str], bool]) -> None:
        self._namespace = namespace
        self._is_own = is_own
        self._lock = threading.Lock()
        self._cancels: dict[str, rospy.Publisher] = {}
        self._topics: dict[str, list[Any]] = {}
        self._runs: dict[str, dict[str, Run]] = {}

    def follow(self, servers: Iterable[str]) -> None:
        """Follow these servers of the package, and no others."""
        wanted = {server for server in servers if server in ACTIONS}
        for server in wanted - set(self._topics):
            action = server_type(server).action()
            name = self._namespace + server
            cancels = rospy.Publisher(f"{name}/cancel", GoalID, queue_size=2)
            with self._lock:  # a page may be reading them
                self._cancels[server], self._runs[server] = cancels, {}
            self._topics[server] = [  # whose messages may come before the last of them is made
                rospy.Subscriber(f"{name}/goal", type(action.action_goal), partial(self._sent, server)),
                rospy.Subscriber(f"{name}/status", GoalStatusArray, partial(self._status, server)),
                rospy.Subscriber(f"{name}/feedback", type(action.action_feedback), partial(self._feedback, server)),
            ]
        for server in set(self._topics) - wanted:
            for topic in self._topics.pop(server):
                topic.unregister()
            with self._lock:
                self._runs.pop(server, None)
                publisher = self._cancels.pop(server)
            publisher.unregister()

    def runs(self) -> list[Run]:
        """Those that go on."""
        with self._lock:
            return [run for runs in self._runs.values() for run in runs.values()]

    def _sent(self, server: str, message: Any) -> None:
        names = [function.function for function in message.goal.functions]
        self._known(server, message.goal_id.id, names)

    def _status(self, server: str, message: Any) -> None:
        going = {each.goal_id.id: each for each in message.status_list if each.status not in ENDS}
        for goal, status in going.items():
            run = self._known(server, goal, [])
            if run is not None:
                run.state = STATES.get(status.status, run.state)
        over = {each.goal_id.id: each for each in message.status_list if each.status in ENDS}
        with self._lock:
            ended = [run for goal, run in self._runs.get(server, {}).items() if goal in over]
            for run in ended:
                del self._runs[server][run.id]
        for run in ended:
            run.end(ENDS[over[run.id].status], over[run.id].text)

    def _feedback(self, server: str, message: Any) -> None:
        run = self._known(server, message.status.goal_id.id, [])
        if run is not None:
            run.feedback = plain(message.feedback)
            run.progress = progress_text(run.feedback)

    def _known(self, server: str, goal: str, names: list[str]) -> Run | None:
        """The goal, new or known; None for one of this console."""
        if self._is_own(goal):
            return None
        with self._lock:
            runs = self._runs.get(server)
            if runs is None:
                return None
            if goal not in runs:
                cancel = partial(self._cancels[server].publish, GoalID(id=goal))
                label = ", ".join(names) or "a goal"
                runs[goal] = Run(goal, self._namespace, server, names, label, "", rospy.get_time(), cancel)
            elif names and not runs[goal].functions:
                runs[goal].functions, runs[goal].label = names, ", ".join(names)
            return runs[goal]


def hear_stops(robot: Any) -> Callable[[], None]:
    """Have the stops of other programs among the events of a robot, as its own; what comes back ends that.

    Who stops everything cancels all goals of each action of the robot, which are known by their topics. This program
    has such a topic of its own: on one of an action it could take the place of the server, which must not miss it.

    `robot`: a `RobotClient`.

    ROS API:
        Subscribes to `NODE/cancel` in the robot's namespace, with the name of this node.
    """

    def take(message: Any) -> None:
        sender = message._connection_header.get("callerid", "")
        if not message.id and message.stamp.is_zero() and sender != rospy.get_name():
            robot.was_stopped(sender)

    return robot.topic(f"{rospy.get_name().strip('/').replace('/', '_')}/cancel", GoalID, take, queue_size=10)
