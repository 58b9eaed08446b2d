"""What the wizard does: presses buttons, says free texts, fills in names. One desk serves all pages and all robots."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol, Tuple

from ..robots.commands import CommandGoal, RobotCommand, say
from ..robots.presses import PATIENCE, Press, Presses
from ..robots.runs import NOT_SENT, end_of
from .errors import PressRefused
from .model import REPEATS, RUNS, USED, ButtonAction, ButtonGroup, PlanDesignator, WizardButton, WizardLayout
from .texts import filled_text, names_in

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
    """What the desk needs of a `robots.robot.RobotClient`."""

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
    it may not move the robot any more. How goals fail is reported to `presses`.
    """

    def __init__(self, presses: Presses) -> None:
        self.presses = presses
        self._lock = threading.RLock()
        self._pressed: dict[Place, _Pressed] = {}
        self._robots: dict[str, _RobotDesk] = {}
        self._listeners: dict[object, Callable[[], None]] = {}

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
        """Ids of buttons -> one of `model.BUTTON_WORDS`; the others are left out.

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
        key = object()
        with self._lock:
            self._listeners[key] = callback
        return lambda: self._forget(key)

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
        with self._lock:
            listeners = list(self._listeners.values())
        for listener in listeners:
            listener()

    def _forget(self, key: object) -> None:
        with self._lock:
            self._listeners.pop(key, None)


def _send(sending: _Sending) -> Any:
    robot, by, label, action = sending.robot, sending.press.by, sending.button.label, sending.action
    if isinstance(action, RobotCommand):
        return robot.send(action, by, label, stops=sending.stops, patience=PATIENCE)
    from nao_library_actions.msg import PerformDesignatorAction, PerformDesignatorGoal

    goal = CommandGoal(PLANS, PerformDesignatorAction, PerformDesignatorGoal(designator=action.text))
    return robot.send_goal(goal, by, label, stops=sending.stops, patience=PATIENCE)
