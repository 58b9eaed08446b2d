"""Behaviours that run when the robot is touched, and the functions that link touches with behaviours."""

from __future__ import annotations

import contextlib
import logging
import threading
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any, Protocol

from genpy import Time

from nao_library_msgs.msg import TouchBinding
from naoqi.errors import NaoError

from ..core.chain import Part, checked_by
from ..core.fields import require_known
from ..core.files import Kept
from ..core.nao_facts import BY_EVENT, Sensor, names_of, sensors_of
from ..core.robot import Robot
from ..core.robot_events import Event, EventRelay, EventTimes
from ..core.waiting import CancellationToken
from .readings import Senses
from .tactile_fields import (
    BehaviorName,
    Contact,
    Cooldown,
    Link,
    NewLink,
    Parameters,
    Presses,
    Sensors,
    Touch,
    TouchTime,
    TouchWatch,
    WantedTouch,
    require_touch,
    wanted_of,
)

log = logging.getLogger(__name__)

IDLE_LOOK = 3600.0
"""s; the thread that follows touches is woken by them, and looks by itself no more often."""


@dataclass(frozen=True)
class Binding:
    """A touch and what it starts."""

    name: str  # what the link is called
    sensors: tuple[Sensor, ...]  # any of them starts it
    wanted: WantedTouch  # what kind of touch
    behavior: str  # name of the behaviour
    parameters: tuple[str, ...] = ()  # its parameters, each as name=value
    cooldown: float = 0.0  # s after its end in which touches do not count


@dataclass(frozen=True)
class BindingState:
    """What became of a binding so far."""

    running: bool = False  # whether its behaviour runs
    runs: int = 0  # how often it was started
    last: str = ""  # how it ended last; empty if it never has
    text: str = ""  # what was said about that
    touched: float = 0.0  # ROS time, s, of the first contact of the touch that started it last; 0 if none has


class BehaviorRunner(Protocol):
    """Runs behaviours; see `ros/behavior_client.py`."""

    def run(self, behavior: str, parameters: Sequence[str], done: Callable[[str, str], None]) -> None:
        """Start a behaviour and go on; `done` gets how it ended and a text, in any thread, exactly once."""

    def close(self) -> None:
        """End what runs."""


@dataclass
class _Entry:
    """A binding at work."""

    binding: Binding
    watch: TouchWatch
    state: BindingState = BindingState()
    ready_at: float = 0.0  # ROS time, s, from which touches count


class TouchBindings:
    """Follows touches and starts behaviours.

    Threads: libqi tells of touches, actionlib of ends; a thread of its own, which lives as long as there is a binding,
    decides what they mean. The lock guards the entries; it is not held during calls to the robot or to the runner.

    Args:
        memory: Gives the proxy of ALMemory.
        runner: Runs behaviours.
        clock: ROS time.
        times: Knows when events were raised.
    """

    def __init__(self, memory: Callable[[], Any], runner: BehaviorRunner, clock: Any, times: EventTimes) -> None:
        self._relay = EventRelay(memory, self._told)
        self._runner = runner
        self._clock = clock
        self._times = times
        self._lock = threading.Lock()
        self._entries: dict[str, _Entry] = {}
        self._touches: deque[Event] = deque()
        self._news = CancellationToken()
        self._thread: threading.Thread | None = None
        self._closed = False

    @property
    def names(self) -> list[str]:
        """Names of the bindings, in the order in which they were made."""
        with self._lock:
            return list(self._entries)

    def states(self) -> list[tuple[Binding, BindingState]]:
        with self._lock:
            return [(each.binding, each.state) for each in self._entries.values()]

    def bind(self, binding: Binding, pressed: Sequence[Contact]) -> None:
        """Start a behaviour at touches from now on; one of the same name is replaced.

        `binding`: the link. `pressed`: sensors that are pressed already. Raises NaoError if the robot cannot be asked
        for the events.
        """
        new = [sensor.event for sensor in binding.sensors if sensor.event not in self._relay.names]
        for event in new:
            self._relay.subscribe(event)
        if new:
            self._times.begin(*new)
        names = names_of(binding.sensors)
        held = {contact.name: contact.begin for contact in pressed if contact.name in names}
        watch = TouchWatch(binding.wanted, held, self._clock.now())
        with self._lock:
            self._entries.pop(binding.name, None)
            self._entries[binding.name] = _Entry(binding, watch)
            if self._thread is None and not self._closed:
                self._thread = threading.Thread(target=self._follow, name="touch bindings", daemon=True)
                self._thread.start()
        self._news.trigger()

    def remove(self, name: str) -> None:
        """Start nothing any more for a binding; empty: for any. What runs goes on."""
        with self._lock:
            removed = [self._entries.pop(each) for each in ([name] if name else list(self._entries))]
            kept = {sensor.event for entry in self._entries.values() for sensor in entry.binding.sensors}
        for event in {sensor.event for entry in removed for sensor in entry.binding.sensors} - kept:
            self._relay.unsubscribe(event)

    def renew(self) -> None:
        """Ask a robot that has come back for the events."""
        self._relay.renew()
        with contextlib.suppress(NaoError):  # it is lost again
            self._times.begin(*self._relay.names)

    def close(self) -> None:
        with self._lock:
            self._closed = True
            self._entries.clear()
            thread = self._thread
        self._news.stop()
        self._relay.close()
        self._runner.close()
        if thread is not None:
            thread.join(1.0)

    def _told(self, event: str, value: Any) -> None:
        """Called from a thread of libqi."""
        self._touches.append(self._times.arrived(event, value, self._clock.now()))
        self._news.trigger()

    def _follow(self) -> None:
        while not self._closed:
            self._news.clear()
            due = self._take_touches(self._clock.now())
            if not self._touches and not self._closed:
                self._clock.wait(max(0.001, due - self._clock.now()), self._news)

    def _take_touches(self, now: float) -> float:
        """Start what the touches until now start; returns when to look again."""
        while self._touches:
            event = self._touches.popleft()
            name, pressed, when = BY_EVENT[event.name].name, bool(event.value), self._time_of(event)
            self._look(lambda entry, n=name, p=pressed, w=when: self._tell(entry, n, p, w))
        return self._look(lambda entry: entry.watch.look(now))

    def _time_of(self, event: Event) -> float:
        try:
            return self._times.time_of(event)
        except NaoError as error:
            log.debug("when %s happened is not known: %s", event.name, error)
            return event.arrived

    @staticmethod
    def _tell(entry: _Entry, name: str, pressed: bool, when: float) -> list[Contact]:
        return entry.watch.tell(name, pressed, when) if name in names_of(entry.binding.sensors) else []

    def _look(self, look: Callable[[_Entry], list[Contact]]) -> float:
        """Start what is touched as wanted, by what `look` says; returns when to look again."""
        now, due, to_start = self._clock.now(), [], []
        with self._lock:
            for entry in self._entries.values():
                touched = look(entry)
                if touched and not entry.state.running and now >= entry.ready_at:
                    began = min(contact.begin for contact in touched)
                    entry.state = replace(entry.state, running=True, runs=entry.state.runs + 1, touched=began)
                    to_start.append(entry)
                if entry.watch.due is not None:
                    due.append(entry.watch.due)
        for entry in to_start:
            self._start(entry)
        return min(due, default=now + IDLE_LOOK)

    def _start(self, entry: _Entry) -> None:
        binding = entry.binding
        log.info("touched: the behaviour %s begins (%s)", binding.behavior, binding.name)

        def done(end: str, text: str) -> None:
            with self._lock:
                entry.state = replace(entry.state, running=False, last=end, text=text)
                entry.ready_at = self._clock.now() + binding.cooldown
            if end not in ("succeeded", "preempted"):
                log.warning("the behaviour %s of %s: %s %s", binding.behavior, binding.name, end, text)

        try:
            self._runner.run(binding.behavior, binding.parameters, done)
        except NaoError as error:
            done("rejected", str(error))


class BindingFunctions(Part):
    """Parameters are fields of TactileFunction. `bindings`: which touch starts which behaviour."""

    left_by_goals = frozenset({"bindings"})

    def __init__(self, robot: Robot, senses: Senses, bindings: TouchBindings, kept: Kept) -> None:
        self._robot = robot
        self._senses = senses
        self.bindings = bindings
        self._kept = kept
        self._restoring = threading.Lock()
        self.unrestored: Sequence[dict[str, Any]] = kept.load(list) or ()  # links that are not made again yet

    def _check_link(
        self, str_param: str, touch: str, count: int, duration: float, behavior: str, context: dict[str, Any]
    ) -> None:
        """As waitForTouch; later functions of the chain may remove the link."""
        require_touch(touch, count, duration)
        context.setdefault("bindings", set(self.bindings.names)).add(str_param.strip() or behavior.strip())

    def _check_removal(self, str_param: str, context: dict[str, Any]) -> None:
        """A link that is there when it is to be removed."""
        names = context.setdefault("bindings", set(self.bindings.names))
        if not str_param.strip():
            names.clear()
            return
        names.remove(require_known("str_param", str_param, sorted(names), "link between a touch and a behaviour"))

    @checked_by(_check_link)
    def on_touch(
        self,
        str_param: NewLink,
        sensors: Sensors,
        touch: Touch,
        count: Presses,
        duration: TouchTime,
        behavior: BehaviorName,
        parameters: Parameters,
        cooldown: Cooldown,
    ) -> str:
        """Run a stored behaviour at each such touch from now on; answers the name of the link."""
        wanted = sensors_of(sensors)
        name = str_param.strip() or behavior.strip()
        binding = Binding(
            name, wanted, wanted_of(touch, count, duration), behavior.strip(), tuple(parameters), cooldown
        )
        self.restore()
        self.bindings.bind(binding, self._senses.contacts(wanted))
        self._keep()
        self._senses.measurements.bindings += [
            _message(*each) for each in self.bindings.states() if each[0].name == name
        ]
        return name

    def list_on_touch(self) -> list[str]:
        """Names of the links between touches and behaviours; what they are is in the result."""
        self.restore()
        self._senses.measurements.bindings += [_message(*each) for each in self.bindings.states()]
        return self.bindings.names

    @checked_by(_check_removal)
    def remove_on_touch(self, str_param: Link) -> None:
        """Start the behaviour of a link, or of all of them, no more; what runs goes on."""
        self.restore()
        self.bindings.remove(str_param.strip())
        self._keep()

    functions = {"onTouch": on_touch, "listOnTouch": list_on_touch, "removeOnTouch": remove_on_touch}

    def _keep(self) -> None:
        self._kept.save([_told(binding) for binding, _ in self.bindings.states()])

    def restore(self) -> None:
        """Make the links again that the node had before it died, as soon as the robot is there."""
        with self._restoring:
            if self._robot.connection.state != "connected":
                return
            unrestored, self.unrestored = self.unrestored, ()
            for told in unrestored:
                try:
                    self.bindings.bind(_binding(told), [])
                    log.info("the touch %s starts its behaviour again", told["name"])
                except (NaoError, KeyError, TypeError) as error:
                    log.warning("a link between a touch and a behaviour is not there again: %s: %s", told, error)


def _told(binding: Binding) -> dict[str, Any]:
    """A link in words of JSON."""
    told = asdict(binding)
    return {**told, "sensors": names_of(binding.sensors)}


def _binding(told: dict[str, Any]) -> Binding:
    """A link from words of JSON."""
    read = {"sensors": sensors_of(told["sensors"]), "wanted": WantedTouch(**told["wanted"])}
    return Binding(**{**told, **read, "parameters": tuple(told["parameters"])})


def _message(binding: Binding, state: BindingState) -> TouchBinding:
    return TouchBinding(
        name=binding.name,
        sensors=names_of(binding.sensors),
        touch=binding.wanted.kind,
        count=binding.wanted.count if binding.wanted.kind == "count" else 0,
        duration=binding.wanted.duration,
        behavior=binding.behavior,
        parameters=list(binding.parameters),
        cooldown=binding.cooldown,
        running=state.running,
        runs=state.runs,
        last=state.last,
        text=state.text,
        touched=Time.from_sec(state.touched),
    )
