"""Events of the robot's memory: their relay, their times, and NAOqi's extractors that raise them. No ROS."""

from __future__ import annotations

import logging
import re
import socket
import threading
from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, Callable, NamedTuple

from naoqi.errors import NaoError, RobotError, UnknownMethod
from naoqi.limits import CLEAN_UP_LIMIT

from .chain import Part
from .memory_functions import MEMORY
from .robot import wait_for_call
from .waiting import CancellationToken

log = logging.getLogger(__name__)

CLOCKS_AGREE = 5.0
"""s between the robot's clock and simulated ROS time; more, and it is another clock. Ours may be a little late."""
SAMPLES = 12
"""Looks at the robot's clock that are compared at once: together longer than a tick of a simulated one."""
FRESH = 60.0
"""s for which a comparison holds; clocks that nobody keeps together drift by a few milliseconds in that time."""
JUMP = 0.03
"""s by which a clock must be off what is known of it to be compared anew at once: one that was set, that of a simulated
robot that began anew, or whose computer is too slow for it."""
KEY = "nao_library/Clock"
"""A key of ALMemory that is written to learn the robot's time from its timestamp."""


def same_clock(robot_time: float, now: float) -> bool:
    """Whether a recent time of the robot is one of simulated ROS time, `now`; both in s."""
    return abs(now - robot_time) <= CLOCKS_AGREE


def _mapped(time: float, latest: float) -> float:
    """A computed time, s: none after `latest`, and none below 0, where simulated time begins."""
    return max(0.0, min(time, latest))


class RobotClock:
    """Maps timestamps of the robot's ALMemory to ROS time. Any thread.

    A simulated robot whose clock is the simulated ROS time has nothing to map. With any other robot the clocks are
    compared when a time is asked for: a key is written several times, and was written between call and answer each
    time, which gives the difference of the clocks to half of the quickest write. A simulated robot's clock goes in
    ticks, which shows as times that contradict each other: then the write soonest after a tick counts. A robot behind
    another connection is compared anew.

    All methods take times in s, and `call`, the method of a module that calls a proxy: proxy, method, arguments. They
    raise NaoError if the robot cannot be asked.
    """

    def __init__(self, robot: Any, clock: Any) -> None:
        self._robot = robot
        self._clock = clock
        self._lock = threading.Lock()
        self._offset: tuple[float, float, int] | None = None  # s; when it was found, and in which connection

    def event_time(self, call: Callable[..., Any], event: str, value: Any, arrived: float) -> float:
        """ROS time at which an event was raised last, if its last value is this one; otherwise that of its arrival.

        `EventTimes` knows the times of those before.
        """
        last, seconds, microseconds = call(self._robot.proxy("ALMemory"), "getTimestamp", event)
        return arrived if last != value else self.raised(call, seconds + 1e-6 * microseconds, arrived)

    def raised(self, call: Callable[..., Any], robot_time: float, arrived: float) -> float:
        """ROS time of a time on the robot at which something was raised that arrived here at `arrived`."""
        if self._is_ours(robot_time):  # exact, while the time of arrival may be late
            return robot_time
        return min(self.ros_time(call, robot_time), arrived)

    def ros_time(self, call: Callable[..., Any], robot_time: float) -> float:
        """ROS time of a time on the robot; later than now only where now is late: /clock is on its way, too."""
        if self._is_ours(robot_time):
            return robot_time
        now = self._clock.now()
        return _mapped(robot_time + self._offset_at(call, now), now)

    def _is_ours(self, robot_time: float) -> bool:
        return self._clock.simulated and same_clock(robot_time, self._clock.now())

    def compare(self, call: Callable[..., Any]) -> None:
        """Have `mapped` know the robot's clock, where ROS time is not simulated."""
        if not self._clock.simulated:
            self._offset_at(call, self._clock.now())

    def mapped(self, robot_time: float, arrived: float) -> float:
        """As `ros_time`, without asking the robot: for threads that must not wait.

        Where the clocks have not been compared it is the ROS time of arrival.
        """
        if self._is_ours(robot_time):
            return robot_time
        with self._lock:
            known = self._offset
        if known is None or known[2] != self._robot.connection.generation:
            return arrived
        return _mapped(robot_time + known[0], arrived)

    def _offset_at(self, call: Callable[..., Any], now: float) -> float:
        generation = self._robot.connection.generation
        with self._lock:
            known = self._offset
        if known is not None and 0.0 <= now - known[1] <= FRESH and known[2] == generation:
            least, most = self._look(call)
            if least - JUMP <= known[0] <= most + JUMP:
                return known[0]
        looks = [self._look(call) for _ in range(SAMPLES)]
        least, most = max(low for low, _ in looks), min(high for _, high in looks)
        offset = (least + most) / 2.0 if least <= most else most
        with self._lock:
            self._offset = (offset, now, generation)
        return offset

    def _look(self, call: Callable[..., Any]) -> tuple[float, float]:
        """ROS time less the robot's, s, at least and at most."""
        before = self._clock.now()
        call(self._robot.proxy("ALMemory"), "insertData", KEY, before)
        after = self._clock.now()
        stamp = self._written(call)
        return before - stamp, after - stamp

    def robot_time(self, call: Callable[..., Any]) -> float:
        """The robot's time at some moment of the call."""
        call(self._robot.proxy("ALMemory"), "insertData", KEY, self._clock.now())
        return self._written(call)

    def _written(self, call: Callable[..., Any]) -> float:
        """The robot's time at which the key was written last."""
        _, seconds, microseconds = call(self._robot.proxy("ALMemory"), "getTimestamp", KEY)
        return seconds + 1e-6 * microseconds


WINDOW = 1.0
"""s over which the quickest picture tells how the clocks go together. A simulated robot's clock may go slower than ROS
time, when the computer has too much to do: the shorter, the sooner that is noticed."""
LEAST, OLDEST = 3, 5.0
"""Pictures that are compared however few there are in that time, unless they are older than so many s: after a pause
the clocks may go together otherwise."""
STEP = 1e-6
"""Least time between two pictures, s."""


class ImageClock:
    """Maps the robot's times of one stream to ROS time, so that they grow from picture to picture. For one thread.

    A picture comes some time after it was taken, sometimes sooner and sometimes later. The quickest of the last ones
    gives the difference of the robot's clock and ROS time.
    """

    def __init__(self) -> None:
        self._latest: deque[tuple[float, float]] = deque()  # ROS time of arrival, and robot's time before that
        self._last = (0.0, 0.0)

    def restart(self) -> None:
        """Begin another stream, whose clock may be another one."""
        self._latest.clear()

    def take(self, robot: float, now: float) -> float:
        """ROS time at which a picture was taken, s, never after its arrival.

        `robot`: robot's time at which it was taken, s. `now`: ROS time of its arrival, s.
        """
        last_robot, last_ros = self._last
        if robot < last_robot or now < last_ros:
            self._latest.clear()  # a clock was set back
        first = not self._latest
        self._latest.append((now, now - robot))
        while now - self._latest[0][0] > (WINDOW if len(self._latest) > LEAST else OLDEST):
            self._latest.popleft()
        ros = robot + min(late for _, late in self._latest)
        if not first:
            # Once in a while a picture is quicker than all before: the time steps back, but not before the last one.
            ros = max(ros, min(last_ros + STEP, now))
        self._last = (robot, ros)
        return ros


COUNTED = (type(None), bool, int, float, str)
"""Types of values that come again and again; a list is hardly ever raised twice."""
REMEMBERED = 32
"""Events of one value whose times are remembered."""


class Event(NamedTuple):
    """An event of the robot's memory.

    Attributes:
        name: Its name.
        value: What it says.
        arrived: ROS time of its arrival, s; `EventTimes.time_of` knows when it was raised.
        number: How many of its name and value came before; None where that is not known.
        source: Knows its time.
    """

    name: str
    value: Any
    arrived: float
    number: int | None
    source: EventTimes


@dataclass
class _Turn:
    """Events of one name and value.

    Attributes:
        after: Time of the robot, s: those that are not looked up yet were raised later.
        came: How many have come.
        passed: How many have been looked up.
        times: Of the last of these: number -> time of the robot, s.
    """

    after: float
    came: int = 0
    passed: int = 0
    times: dict[int, float] = field(default_factory=dict)


class EventTimes:
    """ROS times of the events that one subscriber hears.

    libqi brings events without their times. ALMemory keeps the last values of each event with their times, so the third
    event of a value has the third time of this value since the subscription: whatever was raised until it is asked for.
    Where the robot does not tell its history, an event that was raised again since has the time of its arrival.

    Any thread may note what arrives. `call` calls a proxy: proxy, method, arguments. The lock is not held during calls.
    """

    def __init__(self, robot: Any, robot_clock: RobotClock, call: Callable[..., Any]) -> None:
        self._robot = robot
        self._robot_clock = robot_clock
        self._call = call
        self._lock = threading.Lock()
        self._begun: dict[str, float] = {}  # time of the robot, s, from which on all events of a name come
        self._turns: dict[tuple[str, Any], _Turn] = {}

    def begin(self, *names: str) -> None:
        """Count events of these names anew: they have just been subscribed."""
        try:
            now = self._robot_clock.robot_time(self._call)
        except RobotError as error:
            log.debug("the robot does not tell its time: %s", error)
            return
        with self._lock:
            self._begun.update(dict.fromkeys(names, now))
            self._turns = {key: turn for key, turn in self._turns.items() if key[0] not in names}

    def arrived(self, name: str, value: Any, now: float) -> Event:
        """An event that has just arrived; `now`: ROS time, s."""
        with self._lock:
            if name not in self._begun or not isinstance(value, COUNTED):
                return Event(name, value, now, None, self)
            turn = self._turns.setdefault((name, value), _Turn(self._begun[name]))
            turn.came += 1
            return Event(name, value, now, turn.came - 1, self)

    def time_of(self, event: Event) -> float:
        """ROS time at which an event was raised, s; NaoError if the robot cannot be asked."""
        try:
            answer = self._call(self._robot.proxy("ALMemory"), "getEventHistory", event.name)
            history = [(value, seconds + 1e-6 * microseconds) for value, seconds, microseconds in answer]
        except (RobotError, UnknownMethod, TypeError, ValueError) as error:
            log.debug("the robot does not tell the history of %s: %s", event.name, error)
            history = []
        times = sorted(time for value, time in history if value == event.value)
        if not times:
            return self._robot_clock.event_time(self._call, event.name, event.value, event.arrived)
        with self._lock:
            raised = self._looked_up(event, times)
        return self._robot_clock.raised(self._call, times[-1] if raised is None else raised, event.arrived)

    def _looked_up(self, event: Event, times: list[float]) -> float | None:
        """The time of the robot, s, of an event among those of its value, in order; None where it is not known."""
        turn = self._turns.get((event.name, event.value)) if event.number is not None else None
        if turn is None:
            return None
        for time in times:
            if time > turn.after and turn.passed <= event.number:
                turn.times[turn.passed] = turn.after = time
                turn.passed += 1
        turn.passed = max(turn.passed, event.number + 1)  # also where it was raised just before `begin`
        for number in [each for each in turn.times if each < turn.passed - REMEMBERED]:
            del turn.times[number]
        return turn.times.get(event.number)


EventSink = Callable[[str, Any], None]


class EventRelay:
    """Subscriptions to events of ALMemory.

    The sink gets name and value of each event from a thread of libqi, so it must not block. `memory` gives the proxy of
    ALMemory. The lock guards the table of subscriptions; it is not held during calls to the robot or to the sink.
    """

    def __init__(self, memory: Callable[[], Any], sink: EventSink) -> None:
        self._memory = memory
        self._sink = sink
        self._lock = threading.Lock()
        self._links: dict[str, tuple[Any, Any] | None] = {}

    @property
    def names(self) -> list[str]:
        with self._lock:
            return sorted(self._links)

    def subscribe(self, name: str) -> None:
        """Subscribe to an event, unless it is subscribed already.

        Raises NaoError if the robot cannot be asked; then it is not subscribed.
        """
        with self._lock:
            if name in self._links:
                return
            self._links[name] = None  # a second call meanwhile must not subscribe twice
        try:
            self._link(name)
        except NaoError:
            with self._lock:
                self._links.pop(name, None)
            raise

    def unsubscribe(self, name: str) -> None:
        with self._lock:
            link = self._links.pop(name, None)
        self._unlink(name, link)

    def renew(self) -> None:
        """Subscribe to all events again: the robot behind a new connection knows nothing of them."""
        for name in self.names:
            try:
                self._link(name)
            except (NaoError, RuntimeError) as error:  # libqi's own where the connection breaks again meanwhile
                log.warning("event %s could not be subscribed again: %s", name, error)
            else:
                log.info("event %s is subscribed again", name)

    def close(self) -> None:
        for name in self.names:
            self.unsubscribe(name)

    def _link(self, name: str) -> None:
        subscriber = self._memory().subscriber(name)
        link = subscriber.signal.connect(lambda value=None, *_: self._pass_on(name, value))
        with self._lock:
            if name in self._links:
                # The subscriber is kept: the subscription ends with it.
                self._links[name] = (subscriber, link)
                return
        self._unlink(name, (subscriber, link))  # unsubscribed meanwhile

    def _pass_on(self, name: str, value: Any) -> None:
        try:
            self._sink(name, value)
        except Exception:
            log.exception("event %s could not be passed on", name)

    @staticmethod
    def _unlink(name: str, link: tuple[Any, Any] | None) -> None:
        if link is None:
            return
        subscriber, connection = link
        try:
            subscriber.signal.disconnect(connection)
        except (NaoError, RuntimeError) as error:  # a lost robot has forgotten it anyway
            log.debug("event %s: %s", name, error)


SLACK = 0.05
"""s by which times of the robot may lie before the call that they belong to: clocks are compared to a few ms."""


class SimulatedKey:
    """A key that the robot may have or not; that is asked once a connection."""

    def __init__(self, robot: Any, name: str) -> None:
        self._robot = robot
        self._name = name
        self._known = False
        self._generation = 0

    def known(self, call: Callable[..., Any]) -> bool:
        """Whether the robot has it.

        `call`: `call` of a module: proxy, method, arguments. Raises NaoError if the robot cannot be asked.
        """
        generation = self._robot.connection.generation
        if self._generation != generation:
            self._known = self._name in call(self._robot.proxy(MEMORY), "getDataList", self._name)
            self._generation = generation
        return self._known

    def value(self, call: Callable[..., Any]) -> Any:
        """What it holds. `call`: as `known` takes it. Raises NaoError if the robot cannot be asked."""
        return call(self._robot.proxy(MEMORY), "getData", self._name)

    def span(self, call: Callable[..., Any], clock: RobotClock, began: float) -> tuple[float, float]:
        """ROS times, s, from a key that holds [onset, end] of what came last, s of the robot.

        Returns both; 0 where it is something else, or there has been nothing. Raises NaoError if the robot cannot be
        asked.

        Args:
            call: As `known` takes it.
            clock: Turns times of the robot into ROS time.
            began: ROS time, s; what began before is something else.
        """
        return checked_span([clock.ros_time(call, time) for time in self.value(call)], began)


def checked_span(times: Sequence[float], began: float) -> tuple[float, float]:
    """Onset and end if they are that, and not of something that began before `began`, else 0; ROS times, s."""
    if len(times) == 2 and began - SLACK <= times[0] <= times[1]:
        return times[0], times[1]
    return 0.0, 0.0


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
