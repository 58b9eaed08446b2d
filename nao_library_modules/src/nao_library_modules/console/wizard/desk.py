"""What the wizard does: presses buttons, says free texts, walks, turns the head.

One desk serves all pages and all robots; a session carries out what the WebSocket of one page asks for.
"""

from __future__ import annotations

import json
import math
import threading
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Protocol, Tuple

from naoqi.errors import NaoError

from ...core.waiting import Listeners
from ...studies.commands import CommandGoal, RobotCommand, say
from ...studies.robot_events import namespace_of
from ..access.connections import refusal_of_late
from ..robots.robot_goals import NOT_SENT, PATIENCE, Press, Presses, end_of
from .layout import (
    REPEATS,
    RUNS,
    USED,
    ButtonAction,
    ButtonGroup,
    PlanDesignator,
    PressRefused,
    WizardButton,
    WizardLayout,
    filled_text,
    names_in,
)

PLANS = "perform_designator"
"""Action of the node `process_modules`."""
LONGEST_HISTORY = 100
LONGEST_TEXT = 2000
LONGEST_VALUE = 100
NO_MORE = "no more repetitions"
STOPPED = "stopped"
"""Kind of the event that everything of a robot was stopped."""
Place = Tuple[str, str, str]
"""Namespace of a robot, title of a group, label of a button."""


class DeskRobot(Protocol):
    """What the desk needs of a `RobotClient`."""

    namespace: str
    events: Any

    @property
    def stops(self) -> int: ...

    def send(
        self, command: RobotCommand, by: str = "", label: str = "", stops: int | None = None, patience: float = PATIENCE
    ) -> Any: ...

    def send_goal(
        self, goal: CommandGoal, by: str = "", label: str = "", stops: int | None = None, patience: float = PATIENCE
    ) -> Any: ...

    def stop(self, by: str = "") -> None: ...


@dataclass
class _Pressed:
    """What became of a button."""

    runs: int = 0  # goals that have not ended
    used: bool = False
    repetition: object = None  # the one that goes on; None: none
    page: str = ""  # that the repetition began on
    timer: threading.Timer | None = None

    @property
    def state(self) -> str:
        if self.repetition is not None:
            return REPEATS
        return RUNS if self.runs else USED if self.used else ""


@dataclass(frozen=True)
class _Sending:
    """What is sent by one press, and again by its repetitions."""

    robot: DeskRobot
    button: WizardButton
    action: ButtonAction
    press: Press
    pressed: _Pressed
    repetition: object  # None: it is sent once
    refusal: Callable[[], str]
    stops: int  # of the robot when it was pressed


@dataclass
class _RobotDesk:
    """What is kept of one robot."""

    values: dict[str, str] = field(default_factory=dict)
    history: deque[str] = field(default_factory=lambda: deque(maxlen=LONGEST_HISTORY))
    forget_events: Callable[[], None] | None = None


class WizardDesk:
    """Presses of buttons, free texts and the values of names, of all robots. Any thread.

    A button that is for once is so for all pages. A repetition ends when its button is pressed again, when one of its
    runs does not succeed, when the robot is stopped, when the page that it began on leaves, and when the user who began
    it may not move the robot any more. How goals fail is reported to `Presses`.
    """

    def __init__(self, presses: Presses) -> None:
        self.presses = presses
        self._lock = threading.RLock()
        self._pressed: dict[Place, _Pressed] = {}
        self._robots: dict[str, _RobotDesk] = {}
        self._listeners = Listeners()

    def press(
        self,
        robot: DeskRobot,
        group: ButtonGroup,
        button: WizardButton,
        press: Press,
        page: str = "",
        refusal: Callable[[], str] = lambda: "",
        stops: int | None = None,
    ) -> Any:
        """Do what a button is for; the goal is on its way when this returns.

        Args:
            robot: The robot that the button is for.
            group: Its group.
            button: The button.
            press: By whom it was pressed, and how.
            page: Id of the page that it was pressed on.
            refusal: Why the user may not move the robot any more, asked before each repetition; empty: the user may.
            stops: Stops of the robot when it was pressed; None: as many as now.

        Returns:
            The Run of its goal; None if it stops everything, or a repetition.

        Raises:
            PressRefused: It was for once, or a name of its texts is empty.
            Stopped: The robot was stopped since.
            NaoError: The robot cannot be sent a goal.
        """
        place = press.place
        if stops is None:
            stops = robot.stops
        with self._lock:
            pressed = self._pressed.setdefault(place, _Pressed())
            if pressed.repetition is not None:
                self._end_repetition(pressed)
                ended = True
            else:
                action = self._filled(robot, button)
                if pressed.used:
                    raise PressRefused(f"{button.label} is for once, and was pressed: arm it again first")
                ended = False
                pressed.used = button.once
        if ended:
            press.log("pressed", f"{button.label}: no more repetitions")
            self._tell()
            return None
        press.log("pressed", button.label, key=button.key)
        repetition = object() if button.repeat else None
        if repetition is not None:
            with self._lock:
                pressed.repetition, pressed.page = repetition, page
            self._watch_stops(robot)
        try:
            return self._run(_Sending(robot, button, action, press, pressed, repetition, refusal, stops))
        except Exception:
            with self._lock:
                pressed.used = False
            raise
        finally:
            self._tell()

    def say(self, robot: DeskRobot, text: str, animated: bool, by: str, stops: int | None = None) -> Any:
        """Say a free text, with names filled in. Returns its Run. Raises PressRefused if it will not do, and Stopped.

        `stops`: of the robot when it was typed; None: it does not matter.
        """
        text = text.strip()
        if not text:
            raise PressRefused("there is no text to say")
        if len(text) > LONGEST_TEXT:
            raise PressRefused(f"the text has {len(text)} characters: at most {LONGEST_TEXT}")
        values = self._values_for(robot.namespace, names_in(text), "the text")
        kept = self._robot(robot.namespace)
        with self._lock:
            if text in kept.history:
                kept.history.remove(text)
            kept.history.append(text)
        spoken = filled_text(text, values)
        robot.events.add("pressed", f"says: {spoken}", by, button="free text")
        self._tell()
        return robot.send(say(spoken, animated), by, stops=stops, patience=PATIENCE)

    def history(self, namespace: str) -> list[str]:
        """Free texts that were said by a robot, the newest first, each once."""
        with self._lock:
            return list(reversed(self._robot(namespace).history))

    def values(self, layout: WizardLayout, namespace: str) -> dict[str, str]:
        """Values of the names of a file, of a robot."""
        with self._lock:
            own = self._robot(namespace).values
            return {name: own.get(name, value) for name, value in layout.names.items()}

    def set_values(self, namespace: str, values: Mapping[str, str]) -> None:
        """Give names values, for one robot; at most 100 characters of each."""
        with self._lock:
            kept = self._robot(namespace).values
            kept.update({name: " ".join(value.split())[:LONGEST_VALUE] for name, value in values.items()})
        self._tell()

    def take_names(self, layout: WizardLayout, namespace: str) -> None:
        """Let a robot know the names of a file: those that have no value yet get the one of the file."""
        with self._lock:
            kept = self._robot(namespace).values
            for name, value in layout.names.items():
                kept.setdefault(name, value)

    def arm(self, namespace: str = "") -> None:
        """Let buttons that are for once be pressed again: those of a robot, or all."""
        with self._lock:
            for (space, _, _), pressed in self._pressed.items():
                if namespace in ("", space):
                    pressed.used = False
        self._tell()

    def states(
        self, layout: WizardLayout, namespace_of: Callable[[WizardButton], str], user: str = ""
    ) -> dict[str, str]:
        """Ids of buttons -> one of `layout.BUTTON_WORDS`; the others are left out.

        `namespace_of`: tells the namespace of the robot that a button is for. `user`: who has not looked at what has
        failed.
        """
        failed = self.presses.ends(user)
        found = {}
        with self._lock:
            for group, button in layout.buttons():
                place = (namespace_of(button), group.title, button.label)
                now = self._pressed.get(place, _Pressed()).state
                if place in failed and now in ("", USED):
                    now = failed[place].state
                if now:
                    found[button.id] = now
        return found

    def subscribe(self, callback: Callable[[], None]) -> Callable[[], None]:
        """Have changes told, in the thread that makes them; what comes back ends that."""
        return self._listeners.add(callback)

    def leave(self, page: str) -> None:
        """A page is gone: repetitions that began on it end."""
        self._end_repetitions(lambda _place, pressed: pressed.page == page)

    # --- inside -------------------------------------------------------------------------------------------------------

    def _filled(self, robot: DeskRobot, button: WizardButton) -> ButtonAction:
        values = self._values_for(robot.namespace, button.names, button.label)
        if isinstance(button.action, PlanDesignator):
            return PlanDesignator(filled_text(button.action.text, values), button.action.label)
        return button.action.filled(values)

    def _values_for(self, namespace: str, names: tuple[str, ...], what: str) -> dict[str, str]:
        with self._lock:
            kept = dict(self._robot(namespace).values)
        empty = [name for name in names if not kept.get(name)]
        if empty:
            raise PressRefused(f"{what} needs {' and '.join(empty)}: fill that in under Names")
        return kept

    def _run(self, sending: _Sending) -> Any:
        pressed, repetition = sending.pressed, sending.repetition
        if isinstance(sending.action, RobotCommand) and sending.action.stops:
            sending.robot.stop(sending.press.by)
            return None
        with self._lock:
            pressed.runs += 1
        try:
            run = _send(sending)
        except Exception:
            with self._lock:
                pressed.runs -= 1
                if pressed.repetition is repetition:
                    self._end_repetition(pressed)
            raise

        def ended(run: Any) -> None:
            end, no_more = end_of(run.state), ""
            with self._lock:
                pressed.runs -= 1
                if repetition is not None and pressed.repetition is repetition:
                    if end.failed:
                        no_more = NO_MORE
                        self._end_repetition(pressed)
                    else:
                        again = threading.Timer(sending.button.repeat, self._again, (sending,))
                        again.daemon = True
                        pressed.timer = again
                        again.start()
            self.presses.report(sending.press, end, "; ".join(filter(None, (run.text, no_more))), goal=run.id)
            self._tell()

        run.on_end(ended)
        return None if repetition is not None else run

    def _again(self, sending: _Sending) -> None:
        with self._lock:
            if sending.pressed.repetition is not sending.repetition:
                return
        try:
            refusal = sending.refusal()
            if refusal:
                raise PressRefused(refusal)
            self._run(sending)
        except Exception as error:  # also: the robot is gone, or its server
            with self._lock:
                if sending.pressed.repetition is sending.repetition:
                    self._end_repetition(sending.pressed)
            self.presses.report(sending.press, NOT_SENT, f"{error}; {NO_MORE}")
        self._tell()

    def _watch_stops(self, robot: DeskRobot) -> None:
        kept = self._robot(robot.namespace)
        with self._lock:
            if kept.forget_events is not None:
                return
            kept.forget_events = robot.events.subscribe(lambda event: self._on_event(robot.namespace, event))

    def _on_event(self, namespace: str, event: Any) -> None:
        if event.kind == STOPPED:
            self._end_repetitions(lambda place, _pressed: place[0] == namespace)

    def _end_repetitions(self, concerns: Callable[[Place, _Pressed], bool]) -> None:
        with self._lock:
            for place, pressed in self._pressed.items():
                if pressed.repetition is not None and concerns(place, pressed):
                    self._end_repetition(pressed)
        self._tell()

    @staticmethod
    def _end_repetition(pressed: _Pressed) -> None:
        pressed.repetition = None
        if pressed.timer is not None:
            pressed.timer.cancel()
            pressed.timer = None

    def _robot(self, namespace: str) -> _RobotDesk:
        with self._lock:
            return self._robots.setdefault(namespace, _RobotDesk())

    def _tell(self) -> None:
        for listener in self._listeners:
            listener()


def _send(sending: _Sending) -> Any:
    robot, by, label, action = sending.robot, sending.press.by, sending.button.label, sending.action
    if isinstance(action, RobotCommand):
        return robot.send(action, by, label, stops=sending.stops, patience=PATIENCE)
    from nao_library_actions.msg import PerformDesignatorAction, PerformDesignatorGoal

    goal = CommandGoal(PLANS, PerformDesignatorAction, PerformDesignatorGoal(designator=action.text))
    return robot.send_goal(goal, by, label, stops=sending.stops, patience=PATIENCE)


LONGEST_MESSAGE = 4096
"""Characters."""
LONGEST_LABEL = 100
POINTS = ("click", "start", "drag", "end")
WALK, PRESS, HEAD, STOP = "walk", "press", "head", "stop"
KINDS = (WALK, PRESS, HEAD, STOP)
PAGE = "/wizard"


@dataclass(frozen=True)
class PageRights:
    """What the visitor of a page may do.

    Attributes:
        name: Of the user, for the log.
        refusal: Why the visitor may not move a robot now, by its namespace; empty: the visitor may.
        known: Whether the visitor is logged in, who may stop it then: observers, too.
        operator: Whether the visitor is an operator, whose failed presses the robot's events show.
    """

    name: str
    refusal: Callable[[str], str]
    known: Callable[[], bool]
    operator: Callable[[], bool]


class WizardSession:
    """One page of the wizard. Messages of one kind are taken one at a time; walk and stop do not wait for anything.

    Walk and stop are one kind in this: they keep their order.

    Messages are JSON objects, each with one of these keys:

    - walk: [ahead, left, turn left], shares -1..1 of the top speed; holds 0.4 s;
    - press: id of a button, with `revision` of the layout that it is from, its `label` and `group` there, and `via`,
      click or key;
    - head: {kind, camera, x, y}, as `head_pointer.HeadPointer.point` takes it;
    - stop: true; the stop of all pages ends what the robot of the page does, this one what the others do that the
      page's buttons are for.

    `at` of a message is its stamp, see `connections.refusal_of_late`: what came late moves nothing.

    Args:
        page: Id of the page.
        robot: The robot of the page, a `RobotClient`.
        desk: Of all pages.
        layout: Gives the layout that the page shows.
        rights: Of the visitor.
        find: Gives a robot by its name; raises NaoError if there is none. May ask the ROS master.
        known: Gives a robot by its name that was found before, without asking anybody; None: there is none.
        pointer: Makes what turns the head, when it is needed first.
    """

    def __init__(
        self,
        page: str,
        robot: Any,
        desk: WizardDesk,
        layout: Callable[[], WizardLayout],
        rights: PageRights,
        find: Callable[[str], Any],
        known: Callable[[str], Any],
        pointer: Callable[[Any], Any],
    ) -> None:
        self.robot = robot
        self.page = page
        self._desk = desk
        self._layout = layout
        self._rights = rights
        self._find = find
        self._known = known
        self._make_pointer = pointer
        self._pointer: Any = None
        self._left = False
        # Stops of the robot when the walk began that is held; -1: it was stopped from this page; None: none is held.
        self._walk_stops: int | None = None
        self._takers = {WALK: self._walk, PRESS: self._press, HEAD: self._head, STOP: self._stop}

    def stops(self) -> dict[str, int]:
        """Namespaces of the robots that are known -> how often each was stopped. Does not wait for anything."""
        return {robot.namespace: robot.stops for robot in (self.robot, *self._others())}

    def take(self, kind: str, message: Mapping[str, Any], stops: Mapping[str, int] | None = None) -> str:
        """Carry out a message, as `read_message` gives it; after `leave` only a press that stops.

        Args:
            kind: Of the message.
            message: The message.
            stops: What `stops` gave when it arrived; None: it arrives now. A press from before a stop is refused.

        Returns:
            What to tell the visitor; empty: all is well, or a press has failed, which is kept in `WizardDesk.presses`.
        """
        if self._left and kind != PRESS:
            return ""
        try:
            self._takers[kind](message[kind], message, self.stops() if stops is None else stops)
        except (ValueError, NaoError) as error:
            return str(error)
        return ""

    def leave(self) -> None:
        """The page is gone, or cannot be heard any more: what it held ends."""
        self._left = True
        self._end_walk()
        self._desk.leave(self.page)

    def close_pointer(self) -> None:
        """After `leave`, in the thread of head messages: end what turned the head."""
        if self._pointer is not None:
            self._pointer.close()
            self._pointer = None

    def robot_of(self, button: WizardButton) -> Any:
        """The robot that a button is for. Raises NaoError if there is none of that name."""
        return self._find(button.robot) if button.robot else self.robot

    def states(self) -> Mapping[str, str]:
        """Ids of buttons that run, repeat, were used or have failed -> which of it."""
        return self._desk.states(self._layout(), self._namespace, self._rights.name)

    def _namespace(self, button: WizardButton) -> str:
        """Of the robot that a button is for, whether it is there or not."""
        return namespace_of(button.robot) if button.robot else self.robot.namespace

    @property
    def must_let_go(self) -> bool:
        """Whether the robot was stopped while this page holds a walk: velocities count again after a zero."""
        return self._walk_stops is not None and self._walk_stops != self.robot.stops

    def _others(self) -> list[Any]:
        """The robots of buttons that are known, without that of the page."""
        names = {button.robot for _, button in self._layout().buttons() if button.robot}
        found = {robot.namespace: robot for robot in map(self._known, names) if robot is not None}
        found.pop(self.robot.namespace, None)
        return list(found.values())

    def _stop(self, _value: Any, _message: Any, _stops: Any) -> None:
        if not self._rights.known():
            raise ValueError("you are logged out: log in again")
        if self._walk_stops is not None:
            self._end_walk()
            self._walk_stops = -1
        for other in self._others():
            other.stop(self._rights.name)

    def _walk(self, value: Any, message: Mapping[str, Any], stops: Mapping[str, int]) -> None:
        velocity = _velocity(value)
        if not any(velocity):
            self._end_walk()
            return
        self._in_time(message)
        if self.must_let_go:
            raise ValueError("the robot was stopped: let go, and then walk again")
        self._require(self.robot)
        if self._walk_stops is None:
            self._walk_stops = stops.get(self.robot.namespace, self.robot.stops)
            if self.must_let_go:
                raise ValueError("the robot was stopped: let go, and then walk again")
        self.robot.walk(*velocity, self._rights.name)
        if self.must_let_go:  # stopped between the look and the walk
            self.robot.walk(0.0, 0.0, 0.0, self._rights.name)

    def _end_walk(self) -> None:
        """Forget the walk that is held, and end it unless a stop has."""
        held, self._walk_stops = self._walk_stops, None
        if held is not None and held == self.robot.stops:
            self.robot.walk(0.0, 0.0, 0.0, self._rights.name)

    def _press(self, value: Any, message: Mapping[str, Any], stops: Mapping[str, int]) -> None:
        layout = self._layout()
        found = [
            pair for pair in layout.buttons() if pair[1].id == value and message.get("revision") == layout.revision
        ]
        ends = bool(found) and getattr(found[0][1].action, "stops", False)
        if self._left and not ends:
            return
        if not self._desk.presses.is_new(str(message.get("press_id") or "")) and not ends:
            return  # it was told as not sent
        logged = self._rights.operator()  # what observers try is theirs to see
        label, group = (str(message.get(name, ""))[:LONGEST_LABEL] for name in ("label", "group"))
        via, streams = ("key" if message.get("via") == "key" else "click"), ((self.robot.events,) if logged else ())
        press = Press(label, self._rights.name, PAGE, self.robot.namespace, group, via, streams)
        try:
            if not found:
                raise PressRefused("the buttons have changed meanwhile: look again, and press once more")
            ((in_group, button),) = found
            press = replace(press, label=button.label, group=in_group.title, robot=self._namespace(button))
            if not ends:
                self._in_time(message)
            robot = self.robot_of(button)
            press = replace(press, streams=(*streams, robot.events) if logged else ())
            if not (ends and self._rights.known()):
                self._require(robot)
            self._desk.take_names(layout, robot.namespace)
            refusal, count = lambda: self._refusal(robot), stops.get(robot.namespace)
            self._desk.press(robot, in_group, button, press, self.page, refusal, count)
        except (ValueError, NaoError) as error:
            self._desk.presses.report(press, NOT_SENT, str(error))
        except Exception as error:
            self._desk.presses.report(press, NOT_SENT, f"unexpected error: {error!r}")
            raise

    def _head(self, value: Any, message: Mapping[str, Any], stops: Mapping[str, int]) -> None:
        if not isinstance(value, dict) or value.get("kind") not in POINTS:
            raise ValueError("a point of the picture that is none")
        self._in_time(message)
        x, y = _share(value.get("x")), _share(value.get("y"))
        self._require(self.robot)
        if self._pointer is None:
            self._pointer = self._make_pointer(self.robot)
        count = stops.get(self.robot.namespace)
        self._pointer.point(value["kind"], str(value.get("camera")), x, y, self._rights.name, count)

    def _require(self, robot: Any) -> None:
        refusal = self._refusal(robot)
        if refusal:
            raise ValueError(refusal)

    @staticmethod
    def _in_time(message: Mapping[str, Any]) -> None:
        refusal = refusal_of_late(message)
        if refusal:
            raise ValueError(refusal)

    def _refusal(self, robot: Any) -> str:
        return "the page is gone" if self._left else self._rights.refusal(robot.namespace)


def read_message(text: str) -> tuple[str, Mapping[str, Any]]:
    """The kind of a message, and the message. Raises ValueError if it is none."""
    if len(text) > LONGEST_MESSAGE:
        raise ValueError(f"a message of {len(text)} characters: at most {LONGEST_MESSAGE}")
    try:
        message = json.loads(text)
    except (ValueError, RecursionError):
        message = None
    kinds = [kind for kind in KINDS if kind in message] if isinstance(message, dict) else []
    if len(kinds) != 1:
        raise ValueError("a message that is not known here: load the page again")
    return kinds[0], message


def _velocity(value: Any) -> tuple[float, float, float]:
    if not isinstance(value, list) or len(value) != 3:
        raise ValueError("a velocity is [ahead, left, turn left]")
    x, y, theta = (_number(part) for part in value)
    return x, y, theta


def _number(value: Any) -> float:
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if not number or (isinstance(value, float) and not math.isfinite(value)):
        raise ValueError(f"{value!r} is no number")
    return float(min(max(value, -1), 1))  # an integer may be too large for a float


def _share(value: Any) -> float:
    return max(_number(value), 0.0)
