"""How functions have NAOqi's extractors work: subscriptions that end, waiting for events."""

from __future__ import annotations

import logging
import re
import socket
from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, Callable

from naoqi.errors import NaoError
from naoqi.limits import CLEAN_UP_LIMIT

from ..base.cancellation import CancellationToken
from ..functions.memory_functions import MEMORY
from ..functions.parts import Part
from ..robot.event_relay import EventRelay
from ..robot.event_times import Event, EventTimes
from ..robot.robot_task import wait_for_call

log = logging.getLogger(__name__)


class Events:
    """Events of the robot's memory for one function that waits for them.

    Told from threads of libqi, asked from the one that executes goals.
    """

    def __init__(self, clock: Any, interrupt: CancellationToken, times: EventTimes) -> None:
        """Nothing has happened yet. `clock`: time of waits. `interrupt`: ends them. `times`: of these events."""
        self._times = times
        self._clock = clock
        self._interrupt = interrupt
        self._news = CancellationToken()
        self._events: deque[Event] = deque()

    def tell(self, name: str, value: Any) -> None:
        self._events.append(self._times.arrived(name, value, self._clock.now()))
        self._news.trigger()

    def until(self, end: float) -> Iterator[Event]:
        """Events as they come.

        `end`: ROS time of the end, s. Raises Preempted, or whatever reason the interrupt has.
        """
        while True:
            self._interrupt.check()
            while self._events:
                yield self._events.popleft()
                self._interrupt.check()
            remaining = end - self._clock.now()
            if remaining <= 0.0:
                return
            self._news.clear()
            if self._events:
                continue  # it came before `clear`
            with self._interrupt.waking(self._news.trigger):
                self._clock.wait(remaining, self._news)


class ExtractorUse(Part):
    """How the functions of one server use extractors.

    `subscriber`: what NAOqi knows this server by: of each robot's clients no two have the same name.
    """

    def __init__(self, module: Any, subscriber: str) -> None:
        self.robot, self.robot_clock = module.robot, module.robot_clock
        self.clock, self.interrupt = module.clock, module.interrupt
        self.call, self.call_now, self.wait = module.call, module.call_now, module.wait
        self.subscriber = subscriber

    def begin(self, module: str, method: str, args: Sequence[Any], undo: str, *undo_args: Any) -> Any:
        """Call a method that begins something which has to be ended.

        Preemption does not end the call in the middle: only when it is over it is known whether there is something to
        end. A call that takes too long for that is undone when it is over. Returns what the call returns.

        Args:
            module: NAOqi module.
            undo: The method that ends what it begins.

        Raises:
            NaoError: If the call fails; then nothing has begun.
            Preempted: If that came first, and the call took too long to wait for its end.
        """
        self.interrupt.check()
        proxy = self.robot.proxy(module)
        call = proxy.call_async(method, *args)
        if not wait_for_call(call, self.interrupt) and not call.wait(CLEAN_UP_LIMIT):
            call.add_done_callback(lambda _: proxy.call_async(undo, *undo_args))
            self.interrupt.check()
        return call.result(timeout=0)

    @contextmanager
    def ended_by(self, action: Callable[[], Any], what: str) -> Iterator[None]:
        """Do something at the end of a block, however it ends.

        `action`: what to do; an error in it counts where there is no other. `what`: what goes on if that fails, for the
        log.
        """
        try:
            yield
        except BaseException:
            try:
                action()
            except NaoError as error:
                log.warning("%s: %s", what, error)
            raise
        else:
            action()

    @contextmanager
    def subscribed(self, module: str, purpose: str) -> Iterator[None]:
        """Have an extractor work during a block."""
        self.start_extractor(module, purpose)
        with self.ended_by(lambda: self.stop_extractor(module, purpose), f"{module} may go on for nobody"):
            self.interrupt.check()
            yield

    def start_extractor(self, module: str, purpose: str) -> None:
        """Have an extractor work until `stop_extractor`."""
        name = self.subscriber_for(purpose)
        self.begin(module, "subscribe", [name], "unsubscribe", name)

    def stop_extractor(self, module: str, purpose: str) -> None:
        """End a subscription; preemption does not interrupt this."""
        self.call_now(self.robot.proxy(module), "unsubscribe", self.subscriber_for(purpose))

    def end_leftovers(self, modules: Iterable[str]) -> bool:
        """End subscriptions that a killed server of this name has left in modules; whether the robot was asked."""
        for module in modules:
            try:
                proxy = self.robot.proxy(module)
                for name, *_ in self.call_now(proxy, "getSubscribersInfo"):
                    if name.startswith(self.subscriber_for("")):
                        self.call_now(proxy, "unsubscribe", name)
            except NaoError as error:
                log.debug("%s may work for nobody: %s", module, error)
        return self.robot.connection.state == "connected"

    def subscriber_for(self, purpose: str) -> str:
        """Name of a subscription: two of one server must not end each other."""
        return f"{self.subscriber}_{purpose}"

    def event_time(self, event: Event) -> float:
        """ROS time at which an event was raised on the robot, s; preemption ends the look at its clock."""
        return event.source.time_of(event)

    @contextmanager
    def events_of(self, *names: str) -> Iterator[Events]:
        """Have events of the robot's memory told during a block."""
        times = EventTimes(self.robot, self.robot_clock, self.call)
        events = Events(self.clock, self.interrupt, times)
        relay = EventRelay(lambda: self.robot.proxy(MEMORY), events.tell)
        try:
            for name in names:
                relay.subscribe(name)
            times.begin(*names)
            yield events
        finally:
            relay.close()


def subscriber_name(server: str, namespace: str) -> str:
    """A name for a server's subscriptions that no other server has: of this computer, in this namespace."""
    return re.sub(r"\W+", "_", f"{server}_{socket.gethostname()}{namespace}").strip("_")
