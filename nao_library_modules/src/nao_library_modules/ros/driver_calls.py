"""Calls of a driver's actions and services, which can be waited for and cancelled as calls of the robot."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from concurrent import futures
from concurrent.futures import Future, InvalidStateError
from contextlib import suppress
from typing import Any

import actionlib
import rospy

from naoqi.errors import NaoError
from naoqi.limits import wait_while_answering

from .driver_types import spoken
from .goal_tracker import GoalTracker, server_connection

CONNECT_LOOK_PERIOD = 0.005
"""s of this computer between two looks whether a server is connected."""


class DriverCall:
    """A call under way; see `naoqi.calls.Call`. Any thread.

    `clock`: by which limits are counted; that of a robot's answers stands still while it is silent.
    """

    def __init__(self) -> None:
        self.clock: Callable[[], float] = time.monotonic
        self._answer: Future = Future()

    def done(self) -> bool:
        return self._answer.done()

    def wait(self, timeout: float | None = None) -> bool:
        """Wait for its end, at most so many s; whether it is over."""
        return bool(futures.wait([self._answer], timeout).done)

    def result(self, timeout: float | None = None) -> Any:
        """Wait for its end, and what it answered. Raises NaoError if it failed, or is not over in time."""
        if timeout is None:
            self.wait()
        elif not wait_while_answering(self.wait, self.clock, timeout):
            raise NaoError(f"{self}: no answer within {timeout:g} s")
        return self._answer.result()

    def add_done_callback(self, callback: Callable[[Any], None]) -> None:
        """Have a function called with this call at its end, at once if it is over."""
        self._answer.add_done_callback(lambda _: callback(self))

    def cancel(self) -> None:
        self.end(error=NaoError(f"{self} was given up"))

    def end(self, value: Any = None, error: NaoError | None = None) -> None:
        """It is over; the first end counts."""
        with suppress(InvalidStateError):
            if error is None:
                self._answer.set_result(value)
            else:
                self._answer.set_exception(error)

    def end_by(self, read: Callable[[], Any]) -> None:
        """It is over: with what a function answers, or with the error that it raises."""
        try:
            value = read()
        except NaoError as error:
            self.end(error=NaoError(f"{self}: {error}"))
        else:
            self.end(value)

    def __str__(self) -> str:
        return "a call of the driver"


class ServiceCall(DriverCall):
    """A service that is called in a thread of its own; it cannot be taken back.

    `read`: what the call answers, of the text of the error, which is empty if there is none; may raise NaoError.
    """

    def __init__(self, name: str, kind: type, read: Callable[[str], Any], *arguments: Any) -> None:
        super().__init__()
        self._name = rospy.resolve_name(name)
        self._read = read
        service = rospy.ServiceProxy(name, kind)
        threading.Thread(target=self._run, args=(service, arguments), name=name, daemon=True).start()

    def _run(self, service: Any, arguments: Sequence[Any]) -> None:
        problem = ""
        try:
            service(*arguments)
        except Exception as error:  # of a connection that breaks as well: the call has to end
            problem = str(error) or repr(error)
        self.end_by(lambda: self._read(problem))

    def __str__(self) -> str:
        return f"the service {self._name}"


class GoalCall(DriverCall):
    """A goal.

    Attributes:
        server: The connection that it went through.

    Args:
        action: Whose goal it is.
        read: What the call answers, of the end state and the text; may raise NaoError.
    """

    def __init__(self, action: DriverAction, read: Callable[[int, str], Any]) -> None:
        super().__init__()
        self.server = server_connection(action.client)
        self._action = action
        self._read = read
        self._watch = GoalTracker()
        self._handle: Any = None

    def send(self, goal: Any) -> None:
        self._handle = self._action.client.send_goal(goal, self._look)

    def cancel(self) -> None:
        """Cancel the goal; the call is over when it has ended."""
        # Not here: the server's acknowledgement is waited for, and whoever cancels cancels many.
        threading.Thread(target=self._watch.cancel, args=(self._handle,), name="cancel", daemon=True).start()

    def lose(self) -> None:
        """The server is gone."""
        self._watch.acknowledged.set()
        self._watch.over.set()
        self.end(error=NaoError(f"{self}: the driver has gone, and the goal with it"))

    def _look(self, handle: Any) -> None:
        self._watch.look(handle)
        if self._watch.over.is_set():
            self.end_by(lambda: self._read(handle.get_terminal_state(), handle.get_goal_status_text()))

    def __str__(self) -> str:
        return f"the action {self._action.name}"


class DriverAction(rospy.SubscribeListener):
    """An action of the driver.

    Attributes:
        name: Full name.
        client: actionlib's.

    Args:
        name: Relative name.
        action: Its type.
    """

    def __init__(self, name: str, action: type) -> None:
        super().__init__()
        self.name = rospy.resolve_name(name)
        self.client = actionlib.ActionClient(name, spoken(action))
        self._lock = threading.Lock()
        self._running: list[GoalCall] = []
        self.client.pub_goal.impl.add_subscriber_listener(self)

    @property
    def running(self) -> list[GoalCall]:
        with self._lock:
            self._running = [call for call in self._running if not call.done()]
            return list(self._running)

    def there(self) -> bool:
        """Whether there is a server, goals get to it, and all that it says comes back."""
        client = self.client
        ways = (client.pub_cancel, client.status_sub, client.result_sub, client.feedback_sub)
        return server_connection(client) is not None and all(way.get_num_connections() > 0 for way in ways)

    def wait(self, limit: float) -> bool:
        """Wait for the server, s of this computer; whether it is there."""
        deadline = time.monotonic() + limit
        while not self.there():
            if time.monotonic() > deadline:
                return False
            time.sleep(CONNECT_LOOK_PERIOD)  # nothing tells of connections that come
        return True

    def send(self, goal: Any, read: Callable[[int, str], Any]) -> GoalCall:
        """Send a goal; see `GoalCall`."""
        call = GoalCall(self, read)
        with self._lock:
            self._running = [*(other for other in self._running if not other.done()), call]
        call.send(goal)
        return call

    def peer_unsubscribe(self, _topic_name: str, _num_peers: int) -> None:
        """Somebody takes goals no more; called by rospy."""
        left = self.client.pub_goal.impl.connections
        for call in self.running:
            if call.server not in left:  # it was the server: nothing would ever come
                call.lose()
