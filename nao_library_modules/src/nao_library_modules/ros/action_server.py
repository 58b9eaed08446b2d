"""Action servers: actionlib's, for actionlib's own clients, and one for goals side by side."""

from __future__ import annotations

import copy
import ctypes
import logging
import math
import os
import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import actionlib
import rospy
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray

from naoqi.errors import NaoError
from naoqi.limits import START_PATIENCE

from ..core.errors import Preempted, with_code
from ..core.fields import limit
from ..core.health import GoalCounter
from ..core.robot import StartupGrace
from ..core.server_types import names_of
from ..core.waiting import CancellationToken

log = logging.getLogger(__name__)

PERIOD = 5.0
"""s between two returns: one takes some ms where there are many holes."""


class Heap:
    """Returns free memory of C's heap now and then. For one thread.

    glibc keeps what is below the last block in use; others do not, and have no `malloc_trim`.
    """

    def __init__(self) -> None:
        self._trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
        self._due = time.monotonic()

    def tidy(self) -> None:
        now = time.monotonic()
        if self._trim is not None and now >= self._due:
            self._due = now + PERIOD
            self._trim(0)


LOAD = Path("/proc/loadavg")
"""Linux: three averages, then `runnable threads/all threads`."""


def processors_are_short() -> bool:
    """Whether more threads are runnable now than there are processors; False where the system does not report it."""
    try:
        runnable = int(LOAD.read_text("ascii").split()[3].split("/")[0])
    except (OSError, ValueError, IndexError):
        return False
    return runnable > (os.cpu_count() or 1)


SOONEST_END = 0.005
"""Least time, s, from a goal to the first message about it and to its end; docs/functions.md has the cost."""
LATEST_END = 0.1
"""s after which a server publishes, however busy the computer is."""
LOOK_AGAIN = 0.002
"""s between two looks whether a busy computer has a processor for the client."""
RESULT_FIRST = 0.02
"""s from a result to the first status with the end: who sees the end in the state of a goal finds its result."""
SHUTDOWN_POLL = 0.1
"""s between two looks whether the node has ended, for nothing wakes the waiting thread then."""
REMEMBERED = 10
"""Goals that are over and still in the status; by actionlib's rule, 5 s, it gets long when goals are short."""
LISTED_FOR = 0.3
"""s for which a goal that is over stays in the status: a client that misses it there before it has read the result
calls it lost."""
REPLACED = "a newer goal came before this one began"
OVER = frozenset(
    (GoalStatus.SUCCEEDED, GoalStatus.ABORTED, GoalStatus.PREEMPTED, GoalStatus.RECALLED, GoalStatus.REJECTED)
)
"""States of goals that have ended."""


class _Topics:
    """Topics of one server under its names, used as one publisher or subscriber."""

    def __init__(self, *topics: Any) -> None:
        self._topics = topics

    def publish(self, message: Any) -> None:
        for topic in self._topics:
            topic.publish(message)

    def unregister(self) -> None:
        for topic in self._topics:
            topic.unregister()


class Results(_Topics, rospy.SubscribeListener):
    """Results of goals; one whose client does not listen yet is sent to it when it does.

    rospy connects the topics of a client one by one: on a busy computer a goal may come, and be over, before its client
    listens to results. That one would wait for ever.
    """

    def __init__(self, *topics: rospy.Publisher) -> None:
        super().__init__(*topics)
        self._lock = threading.Lock()
        self._senders: dict[str, str] = {}  # id of a goal -> node that sent it
        self._missed: deque[tuple[str, Any]] = deque(maxlen=REMEMBERED)  # node, result
        for topic in topics:
            topic.impl.add_subscriber_listener(self)

    def note(self, goal: Any) -> None:
        """Note which node sent a goal."""
        with self._lock:
            self._senders[goal.goal_id.id] = _sender(goal)

    def is_from_sender(self, cancel: GoalID) -> bool:
        """Whether the node that cancels a goal is the one that sent it."""
        with self._lock:
            return bool(_sender(cancel)) and self._senders.get(cancel.id) == _sender(cancel)

    def publish(self, message: Any) -> None:
        with self._lock:
            sender = self._senders.pop(message.status.goal_id.id, "")
            missed = sender and not self._connections(sender)
            super().publish(message)
            if missed:
                self._missed.append((sender, message))

    # The names are rospy's.

    def peer_subscribe(self, *_: Any) -> None:
        """Send what a node has missed that listens now; in a thread of rospy."""
        with self._lock:
            for missed in list(self._missed):
                node, message = missed
                connections = self._connections(node)
                for topic, connection in connections:
                    with topic.publock:
                        topic.publish(message, connection_override=connection)
                if connections:
                    self._missed.remove(missed)

    def peer_unsubscribe(self, *_: Any) -> None:
        pass

    def _connections(self, node: str) -> list[tuple[Any, Any]]:
        """Where a node listens: topic of rospy, connection."""
        impls = [topic.impl for topic in self._topics if topic.impl is not None]  # None: unregistered
        return [(impl, each) for impl in impls for each in impl.connections if each.endpoint_id == node]


def _sender(message: Any) -> str:
    """Name of the node that sent a message; empty: not known."""
    return getattr(message, "_connection_header", {}).get("callerid", "")


def can_have_noted(came: float, soonest: float = SOONEST_END) -> bool:
    """Whether actionlib's SimpleActionClient can have noted a goal that came then, by `time.monotonic`.

    It takes it a moment, `soonest` (s), and a processor. On a computer where none is free it may have to wait for one:
    beside eight busy processes on two processors, 5 of 1,500 waited for longer than 5 ms, and one of them 67 ms. With
    `soonest` 0 it is not waited for.
    """
    age = time.monotonic() - came
    return age >= LATEST_END or (age >= soonest and not (soonest and processors_are_short()))


def let_the_client_note_the_goal(came: float, soonest: float = SOONEST_END) -> None:
    """Wait until the client of a goal can have noted it."""
    time.sleep(max(0.0, came + soonest - time.monotonic()))
    while not can_have_noted(came, soonest):
        time.sleep(LOOK_AGAIN)


class ActionServer(actionlib.ActionServer):
    """actionlib's, under a second name as well where `SECOND_NAMES` has one: clients of both share its goals.

    Its status and feedback wait until the clients can have noted their goals, and its timer does not raise when the
    node closes its topics while it tells of its goals. A client that listens to results only after its goal is over
    gets its result.
    """

    def __init__(self, *arguments: Any, soonest: float = SOONEST_END, **options: Any) -> None:
        """As actionlib's. `soonest`: s of wall time from when a goal comes to the first message about it."""
        self._soonest = soonest
        self._came: dict[str, float] = {}  # id of a goal that is not over -> when it came, by time.monotonic
        self._newest = self._last_end = -math.inf  # when the last goal came, and when a result was published last
        self._status_waits_since = math.inf  # when there was a first status that waits
        self._pending: deque[tuple[float, Any, Any]] = deque()  # when the goal came, its status, feedback to publish
        self._next_look = math.inf  # when to look at what waits, by time.monotonic
        self._later: threading.Thread | None = None  # which looks, as long as anything waits
        super().__init__(*arguments, **options)

    def initialize(self) -> None:
        """Make the topics of all names, and one timer."""
        with self.lock:  # goals wait until all of it is there
            super().initialize()
            results = [self.result_pub]
            for name in names_of(rospy.remap_name(self.ns))[1:]:
                sizes = {"queue_size": self.pub_queue_size}
                status = rospy.Publisher(f"{name}/status", GoalStatusArray, latch=True, **sizes)
                self.status_pub = _Topics(self.status_pub, status)
                results.append(rospy.Publisher(f"{name}/result", self.ActionResult, **sizes))
                feedback = rospy.Publisher(f"{name}/feedback", self.ActionFeedback, **sizes)
                self.feedback_pub = _Topics(self.feedback_pub, feedback)
                sizes = {"queue_size": self.sub_queue_size}
                goal = rospy.Subscriber(f"{name}/goal", self.ActionGoal, self.internal_goal_callback, **sizes)
                self.goal_sub = _Topics(self.goal_sub, goal)
                cancel = rospy.Subscriber(f"{name}/cancel", GoalID, self.internal_cancel_callback, **sizes)
                self.cancel_sub = _Topics(self.cancel_sub, cancel)
            self.result_pub = Results(*results)

    def internal_goal_callback(self, goal: Any) -> None:
        with self.lock:
            self._newest = self._came[goal.goal_id.id] = time.monotonic()
            self.result_pub.note(goal)
            super().internal_goal_callback(goal)

    def internal_cancel_callback(self, goal_id: GoalID) -> None:
        with self.lock:
            if goal_id.id in self._came and self.result_pub.is_from_sender(goal_id):
                self._came[goal_id.id] = -math.inf  # a client that cancels its goal has noted it
            super().internal_cancel_callback(goal_id)

    def came(self, goal_id: GoalID) -> float:
        """When a goal came, by `time.monotonic`; -inf: its client has noted it for certain, or it is over."""
        with self.lock:
            return self._came.get(goal_id.id, -math.inf)

    def publish_result(self, status: Any, result: Any) -> None:
        """Publish how a goal ended, after all feedback of it."""
        with self.lock:
            self._came.pop(status.goal_id.id, None)
            pending, self._pending = self._pending, deque()
            for came, before, feedback in pending:
                if before.goal_id.id == status.goal_id.id:
                    super().publish_feedback(before, feedback)
                else:
                    self._pending.append((came, before, feedback))
            self._last_end = time.monotonic()
            super().publish_result(status, result)

    def publish_feedback(self, status: Any, feedback: Any) -> None:
        """Publish feedback of a goal, or have it published when its client can have noted it."""
        with self.lock:
            self._pending.append((self.came(status.goal_id), copy.copy(status), feedback))
            self._publish_pending_feedback()

    def publish_status(self) -> None:
        """Publish the status of all goals, or have it published in a moment: one without the newest would be wrong."""
        with self.lock:
            now = time.monotonic()
            self._status_waits_since = min(self._status_waits_since, now)
            waited_too_long = now - self._status_waits_since >= LATEST_END  # where one goal follows the other
            due = can_have_noted(self._newest, self._soonest) and now - self._last_end >= RESULT_FIRST
            if waited_too_long or due:
                self._status_waits_since = math.inf
                unless_closed(super().publish_status)
            else:
                self._look_again(max(self._newest + self._soonest, self._last_end + RESULT_FIRST))

    def _publish_pending_feedback(self) -> None:
        while self._pending:
            came, status, feedback = self._pending[0]
            if not can_have_noted(came, self._soonest):
                self._look_again(came + self._soonest)
                return
            self._pending.popleft()
            unless_closed(super().publish_feedback, status, feedback)

    def _look_again(self, moment: float) -> None:
        """Look at what waits once more, at a moment of `time.monotonic`."""
        self._next_look = min(self._next_look, moment)
        if self._later is None or not self._later.is_alive():
            self._later = threading.Thread(target=self._publish_late, name="late status and feedback", daemon=True)
            self._later.start()

    def _publish_late(self) -> None:
        while True:
            time.sleep(max(LOOK_AGAIN, self._next_look - time.monotonic()))
            with self.lock:
                self._next_look = math.inf
                self._publish_pending_feedback()
                if self._status_waits_since < math.inf:
                    self.publish_status()
                if self._next_look == math.inf:
                    self._later = None
                    return


def unless_closed(publish: Callable[..., None], *arguments: Any) -> None:
    """Publish a status or feedback, if the node has not closed its topics meanwhile."""
    try:
        publish(*arguments)
    except rospy.ROSException:
        if not rospy.core.is_shutdown_requested():
            raise


class PromptActionServer(actionlib.SimpleActionServer):
    """Takes up a goal as soon as the one before is over.

    The loop it replaces waits before it looks: a goal that came while the last one was being ended was announced to
    nobody, and lies there for a tenth of a second. This one looks under the lock that announcements are made under.

    The goal that came last counts. actionlib cancels one whose stamp is older than that of the last, even if that one
    is over: after one goal of a client whose clock is ahead (of another computer, of a simulation before it was started
    again, or the wall's beside simulated time), nobody else would have a goal carried out for as long.

    It also forgets what was in a goal when that is over. actionlib tells of such a goal for 5 s more and keeps all of
    it for longer, in a ring of objects that Python finds some day: hundreds of goals with long lists in them are
    hundreds of megabytes. Their ids and states are enough. The room that they took is given back to the system. And of
    goals that are over only the last ones are told of at all: with hundreds of short ones in it, each status takes
    clients so long to read that they have no time for what comes of their goals.

    A goal that would be over at once ends `soonest_end` after it came: see `let_the_client_note_the_goal`.

    Everything else is actionlib's.
    """

    def __init__(
        self, name: str, action: type, execute: Callable[[Any], None], soonest_end: float = SOONEST_END
    ) -> None:
        """Make a server that is not started. `execute`: carries out a goal. `soonest_end`: s of wall time."""
        self._soonest_end = soonest_end
        self._over: dict[Any, float] = {}  # goals in the status that are over -> since when, by time.monotonic
        self._no_goal = type(action().action_goal)()
        self._heap = Heap()
        super().__init__(name, action, execute, auto_start=False)
        self.action_server = ActionServer(
            name,
            action,
            self.internal_goal_callback,
            self.internal_preempt_callback,
            auto_start=False,
            soonest=self._soonest_end,
        )

    # The name is actionlib's: the constructor starts a thread with it.
    def executeLoop(self) -> None:  # noqa: N802
        """Carry out goals, one after the other, until the server or the node ends."""
        while not rospy.is_shutdown() and not self._terminated():
            with self.execute_condition:
                if not self.is_new_goal_available():
                    self.execute_condition.wait(SHUTDOWN_POLL)
                    continue
            goal = self.accept_new_goal()
            self._carry_out(goal)
            self._empty_goals()
            self._heap.tidy()

    # Called under the lock of actionlib's ActionServer.
    def internal_goal_callback(self, goal: Any) -> None:
        """Keep a new goal until it is taken up, and end one that waits."""
        with self.execute_condition:
            if self.new_goal:
                self.next_goal.set_canceled(None, REPLACED)
            self.next_goal, self.new_goal, self.new_goal_preempt_request = goal, True, False
            if self.is_active():
                self.preempt_request = True
                if self.preempt_callback:
                    self.preempt_callback()
            self.execute_condition.notify()
        self._empty_goals()

    def _empty_goals(self) -> None:
        """Put an empty goal in the place of each one that is over, and forget all of these but the last ones."""
        server, now = self.action_server, time.monotonic()
        with server.lock:
            over = [tracker for tracker in server.status_list if tracker.status.status in OVER]
            for tracker in over:
                tracker.goal = self._no_goal
            self._over = {tracker: self._over.get(tracker, now) for tracker in over}
            forgotten = {tracker for tracker in over[:-REMEMBERED] if now - self._over[tracker] > LISTED_FOR}
            server.status_list = [tracker for tracker in server.status_list if tracker not in forgotten]
            for handle in (self.current_goal, self.next_goal):
                if handle.status_tracker is not None and handle.status_tracker.status.status in OVER:
                    handle.goal = self._no_goal

    # The names are actionlib's.

    def set_succeeded(self, *arguments: Any, **options: Any) -> None:
        self._let_the_client_note_the_goal()
        super().set_succeeded(*arguments, **options)

    def set_aborted(self, *arguments: Any, **options: Any) -> None:
        self._let_the_client_note_the_goal()
        super().set_aborted(*arguments, **options)

    def set_preempted(self, *arguments: Any, **options: Any) -> None:
        self._let_the_client_note_the_goal()
        super().set_preempted(*arguments, **options)

    def _let_the_client_note_the_goal(self) -> None:
        came = self.action_server.came(self.current_goal.get_goal_id())
        let_the_client_note_the_goal(came, self._soonest_end)

    def _terminated(self) -> bool:
        with self.terminate_mutex:
            return self.need_to_terminate

    def _carry_out(self, goal: Any) -> None:
        try:
            self.execute_callback(goal)
            problem = "no end state was set"
        except Exception as error:
            log.exception("a goal failed")
            problem = f"unexpected error: {error!r}"
        if self.is_active():
            self.set_aborted(None, problem)


NEWER_GOAL = "a newer goal needs {}"
CANCELED = "canceled"
MOST = int(limit("goals").highest)
FULL = f"{MOST} goals of this action are under way: no more are taken at once"


class Replaced(Preempted):  # a signal, like Preempted
    """A newer goal takes over what this one has: an executor that walks need not stop for it."""


@dataclass
class GoalOutcome:
    """How a goal ended, as its executor tells it."""

    result: Any  # result message
    preempted: bool = False  # whether it was ended before time
    error: str = ""  # why it failed, for goals whose result says more; empty if it did not


@dataclass(eq=False)
class _Member:
    """A goal under way."""

    handle: Any
    interrupt: CancellationToken = field(default_factory=CancellationToken)
    ended: threading.Event = field(default_factory=threading.Event)
    claims: frozenset[str] = frozenset()
    reason: str = CANCELED


class ConcurrentActionServer:
    """Carries out every goal in a thread of its own; one that claims what older ones have ends these first.

    A client of nao_robot that sends a goal for the same joints ends its goal before, as ever. Clients that move
    different joints do not know of each other.

    Threads: goals and cancels come under actionlib's lock, so they start a thread or set a flag and no more. The lock
    here guards the list of goals.
    """

    def __init__(
        self,
        claims: Callable[[Any], frozenset[str]],
        execute: Callable[..., GoalOutcome],
        with_feedback: bool = False,
        robot: Any = None,
    ) -> None:
        """Take no goals yet; an action server hands them over.

        Args:
            claims: What a goal needs for itself, the names of joints. Raises NaoError for a goal that will not do.
            execute: Carries out a goal until its interrupt comes: it gets both. Raises NaoError if it fails.
            with_feedback: Whether `execute` gets, as a third argument, what publishes a feedback message.
            robot: The robot that goals need: one that was never reached yet is waited for, for a while.
        """
        self._claims = claims
        self._execute = execute
        self._with_feedback = with_feedback
        self._startup_grace = None if robot is None else StartupGrace(robot, START_PATIENCE)
        self._lock = threading.Lock()
        self._members: list[_Member] = []
        self._closed = False
        self.counter = GoalCounter()

    def on_goal(self, handle: Any) -> None:
        """Take a goal, or abort it where too many are under way; called by actionlib."""
        member = _Member(handle)
        with self._lock:
            full = len(self._members) >= MOST
            if not full:
                self._members.append(member)
            if self._closed:
                member.interrupt.trigger()
        handle.set_accepted()
        run = self._refuse if full else self._run
        threading.Thread(target=run, args=(member,), name="goal", daemon=True).start()

    def on_cancel(self, handle: Any) -> None:
        """End a goal; called by actionlib."""
        with self._lock:
            members = [m for m in self._members if m.handle == handle]
        for member in members:
            member.interrupt.trigger()

    def interrupt_all(self, reason: Exception | None = None) -> None:
        """End all goals. `reason`: what their executors get; Preempted if none is given."""
        with self._lock:
            members = list(self._members)
        for member in members:
            member.interrupt.trigger(reason)

    def close(self, limit: float) -> None:
        """End all goals, those that come later too, and wait for it. `limit`: s, for all together."""
        with self._lock:
            self._closed = True
            members = list(self._members)
        self.interrupt_all()
        for member in members:
            member.ended.wait(limit / max(1, len(members)))

    def _refuse(self, member: _Member) -> None:
        """Abort a goal that is one too many; takes no longer than a client needs to note it."""
        let_the_client_note_the_goal(time.monotonic())
        self.counter.ended("aborted", FULL)
        member.handle.set_aborted(None, FULL)

    def _run(self, member: _Member) -> None:
        taken_up = time.monotonic()
        try:
            end, result, text = self._carry_out(member)
            let_the_client_note_the_goal(taken_up)
            handle = member.handle
            tell = {"succeeded": handle.set_succeeded, "preempted": handle.set_canceled, "aborted": handle.set_aborted}
            self.counter.ended(end, text)
            tell[end](result, text)
        finally:
            with self._lock:
                self._members.remove(member)
            member.ended.set()

    def _carry_out(self, member: _Member) -> tuple[str, Any, str]:
        """End state, result and text."""
        try:
            if self._startup_grace is not None:
                self._startup_grace.wait(member.interrupt, lambda _: None)
            member.interrupt.check()
            goal = member.handle.get_goal()
            self._make_room(member, self._claims(goal))
            member.interrupt.check()
            more = (member.handle.publish_feedback,) if self._with_feedback else ()
            outcome = self._execute(goal, member.interrupt, *more)
        except Preempted:
            return "preempted", None, member.reason
        except NaoError as error:
            return "aborted", None, with_code(error)
        except Exception as error:
            log.exception("a goal failed")
            return "aborted", None, f"unexpected error: {error!r}"
        if outcome.preempted:
            return "preempted", outcome.result, member.reason
        if outcome.error:
            return "aborted", outcome.result, outcome.error
        return "succeeded", outcome.result, ""

    def _make_room(self, member: _Member, claims: frozenset[str]) -> None:
        """End older goals on the same joints. Of two that come at once, the later one in the list wins."""
        with self._lock:
            member.claims = claims
            older = self._members[: self._members.index(member)]
            younger = self._members[self._members.index(member) + 1 :]
            overtaken = [m for m in younger if m.claims & claims]
            in_the_way = [m for m in older if m.claims & claims]
        for other in in_the_way:
            other.reason = NEWER_GOAL.format(", ".join(sorted(other.claims & claims)))
            other.interrupt.trigger(Replaced())
        if overtaken:  # its thread was slower than that of the goal after it
            member.reason = NEWER_GOAL.format(", ".join(sorted(overtaken[0].claims & claims)))
            raise Preempted()
        for other in in_the_way:
            other.ended.wait()
