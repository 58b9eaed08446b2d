"""What a page's WebSocket asks for, checked and carried out. No NiceGUI; ROS only through the robot."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from naoqi.errors import NaoError

from ..access.pulse import refusal_of_late
from ..robots.events import namespace_of
from ..robots.presses import Press
from ..robots.runs import NOT_SENT
from .desk import WizardDesk
from .errors import PressRefused
from .model import WizardButton, WizardLayout

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

    `at` of a message is its stamp, see `pulse`: what came late moves nothing.

    Args:
        page: Id of the page.
        robot: The robot of the page, a `robots.robot.RobotClient`.
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
