"""What runs on the robot exactly while it is wanted, after a lost connection too: subscriptions, extractors. No ROS."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from naoqi.errors import NaoError

from ...core.health import Level, Report
from ...core.robot_events import EventRelay

log = logging.getLogger(__name__)

FIRST_RETRY, RETRY = 0.1, 1.0
"""s after which a start that failed is tried again: the first time, and in the long run. Then it is logged as well."""
LOOK_PERIOD = 1.0
"""s between two looks whether what runs is alive."""
CLOSE_LIMIT = 2.0
"""s that the end may take, if nothing else is said."""


class LazySubscription:
    """Starts and stops something, in a thread of its own.

    Any thread may say whether it is wanted. One lock keeps starts and stops apart; the condition guards the rest, and
    is not held during calls to the robot.

    Attributes:
        problem: Why it does not run although it is wanted; empty if it does.
    """

    def __init__(
        self,
        robot: Any,
        name: str,
        start: Callable[[], None],
        stop: Callable[[], None],
        alive: Callable[[], bool] | None = None,
    ) -> None:
        """Nothing is wanted yet.

        Args:
            robot: Its connection, see `nao_library_modules.core.robot`.
            name: Of what is started, for the log.
            start: Starts it. It may have been started before, on a robot that was lost since.
            alive: Whether it still works; if not, it is stopped and started. Asked once a second.
        """
        self._robot = robot
        self._name = name
        self._start, self._stop, self._alive = start, stop, alive
        self._condition = threading.Condition()
        self._work = threading.Lock()
        self._wanted = False
        self._stale = False
        self._closed = False
        self._generation: int | None = None
        self.problem = ""
        self._delay = FIRST_RETRY
        self._logged = False
        robot.connection.add_listener(self._on_state)
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    @property
    def wanted(self) -> bool:
        return self._wanted

    @property
    def running(self) -> bool:
        """Whether it runs on the robot as it is connected now."""
        connection = self._robot.connection
        return connection.state == "connected" and self._generation == connection.generation

    def report(self, idle: str, runs: str, fails: str, values: dict[str, str]) -> Report:
        """State for diagnostics, by the text that fits: it is not wanted, it runs, or it fails (the reason follows)."""
        values.setdefault("last error", self.problem)
        if not self._wanted:
            return Report(Level.OK, idle, values)
        if self.running:
            return Report(Level.OK, runs, values)
        return Report(Level.ERROR, f"{fails}: {self.problem or 'the robot is not connected'}", values)

    def want(self, wanted: bool) -> None:
        with self._condition:
            self._wanted = wanted
            self._condition.notify_all()

    def start_now(self) -> None:
        """Start it in the calling thread, unless it runs; from then on it is wanted.

        Raises NaoError if it cannot be started; then it is not wanted.
        """
        with self._work:
            if not self.running:
                self.want(False)
                self._start()
                self._generation = self._robot.connection.generation
            self.problem = ""
            self.want(True)

    def stop_now(self) -> None:
        """Stop it in the calling thread; from then on it is not wanted.

        Raises NaoError if the robot cannot be asked.
        """
        self.want(False)
        with self._work:
            if self._generation is not None:
                runs, self._generation = self.running, None
                if runs:
                    self._stop()

    def restart(self) -> None:
        """Stop and start it, if it runs, because its settings have changed."""
        with self._condition:
            self._stale = True
            self._condition.notify_all()

    def close(self, limit: float = CLOSE_LIMIT) -> None:
        """Stop it for good, and wait up to `limit` s for that."""
        self._robot.connection.remove_listener(self._on_state)
        with self._condition:
            self._closed, self._wanted = True, False
            self._condition.notify_all()
        self._thread.join(limit)

    def _on_state(self, *_: Any) -> None:
        with self._condition:
            self._condition.notify_all()

    # --- the thread -----------------------------------------------------------------------------------------------

    def _run(self) -> None:
        while True:
            with self._condition:
                if not self._due() and not self._closed:
                    looks = self._alive is not None and self._generation is not None
                    self._condition.wait(LOOK_PERIOD if looks else None)
                closed, due = self._closed, self._due()
            if due or (self._alive is not None and self.running and not self._alive()):
                self._do()
            if closed:
                return

    def _due(self) -> bool:
        if self._robot.connection.state != "connected":
            return False
        return self._wanted != self.running or (self._stale and self.running)

    def _do(self) -> None:
        with self._work:
            try:
                self._stale = False
                if self.running:
                    self._generation = None
                    self._stop()
                if self._wanted:
                    generation = self._robot.connection.generation
                    self._start()
                    self._generation = generation
                self._succeeded()
                return
            except NaoError as error:
                self.problem = str(error)
            except Exception as error:  # a mistake in here must not leave a node that lives and does nothing
                log.exception("%s failed", self._name)
                self.problem = f"unexpected error: {error!r}"
        self._wait_after_failure()

    def _succeeded(self) -> None:
        if self._logged:
            log.info("%s: it works again", self._name)
        self.problem, self._delay, self._logged = "", FIRST_RETRY, False

    def _wait_after_failure(self) -> None:
        """A robot that starts, or has just come back, needs a moment: so the first failures are not logged."""
        if self._delay >= RETRY and not self._logged:
            log.warning("%s: %s", self._name, self.problem)
            self._logged = True
        with self._condition:
            if self._wanted and not self._closed:
                self._condition.wait(self._delay)
        self._delay = min(2.0 * self._delay, RETRY)


MEMORY = "ALMemory"


@dataclass(frozen=True)
class ExtractorKind:
    """A module of the robot that detects something, and where its values are."""

    name: str  # for people
    module: str
    event: str
    key: str = ""  # in the robot's memory, of the value of an event without one; else empty
    states: tuple[str, str, str] = ("off", "on", "cannot run")  # in words: not wanted, works, fails


class Extractor:
    """Has the robot detect something while that is wanted, also after a lost connection.

    Any thread may call. Methods raise NaoError if the robot cannot be asked.
    """

    answer_limit = 5.0
    """s that a call to the robot may take."""

    def __init__(
        self,
        robot: Any,
        kind: ExtractorKind,
        subscriber: str,
        sink: Callable[[Any], None],
        prepare: Callable[[], None] = lambda: None,
    ) -> None:
        """Start switched off; the robot need not be connected yet.

        Args:
            kind: Module and event.
            subscriber: Name of the subscriber at the robot.
            sink: Gets the value of each event, in a thread of libqi: it must not wait.
            prepare: Called before the robot begins, for settings that it may have forgotten. May make calls, and choose
                another `kind`.
        """
        self.kind = kind
        self._robot = robot
        self._subscriber = subscriber
        self._sink = sink
        self._prepare = prepare
        self._relay = EventRelay(lambda: robot.proxy(MEMORY), self._on_event)
        self._looking = LazySubscription(robot, kind.name, self._begin, self._end)

    def want(self, wanted: bool) -> None:
        self._looking.want(wanted)

    def enable(self) -> None:
        """Switch on; after an error it is off. No effect if it is on."""
        self._looking.start_now()

    def disable(self) -> None:
        """Switch off, even after an error. No effect if it is off."""
        self._looking.stop_now()

    def call(self, method: str, *arguments: Any, limit: float | None = None) -> Any:
        """Call a method of the module. `limit`: s, if not `answer_limit`."""
        call = self._robot.proxy(self.kind.module).call_async(method, *arguments)
        return call.result(timeout=self.answer_limit if limit is None else limit)

    def report(self) -> Report:
        return self._looking.report(*self.kind.states, {"module": self.kind.module})

    def close(self) -> None:
        self._looking.close()

    def _begin(self) -> None:
        self._prepare()
        self._relay.close()  # events of a connection that was lost
        self._relay.subscribe(self.kind.event)
        try:
            self.call("subscribe", self._subscriber)
        except NaoError:
            self._relay.close()
            raise

    def _end(self) -> None:
        self._relay.close()
        self.call("unsubscribe", self._subscriber)

    # --- in threads of libqi --------------------------------------------------------------------------------------

    def _on_event(self, _name: str, value: Any) -> None:
        if self.kind.key and not (isinstance(value, (list, tuple)) and value):
            self._robot.proxy(MEMORY).call_async("getData", self.kind.key).add_done_callback(self._on_value)
        elif self._looking.wanted:
            self._sink(value)

    def _on_value(self, call: Any) -> None:
        try:
            value = call.result(timeout=0)
        except NaoError as error:
            log.debug("%s: %s", self.kind.key, error)
            return
        if self._looking.wanted:
            self._sink(value)
