"""What a page's WebSocket asks for, checked and carried out. No NiceGUI; ROS only through the robot."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from naoqi.errors import NaoError

from .desk import WizardDesk
from .model import WizardButton, WizardLayout

LONGEST_MESSAGE = 4096
"""Characters."""
POINTS = ("click", "start", "drag", "end")
WALK, PRESS, HEAD, STOP = "walk", "press", "head", "stop"
KINDS = (WALK, PRESS, HEAD, STOP)


@dataclass(frozen=True)
class PageRights:
    """What the visitor of a page may do.

    Attributes:
        name: Of the user, for the log.
        refusal: Why the visitor may not move a robot now, by its namespace; empty: the visitor may.
        operator: Whether the visitor may stop it, whoever holds the controls.
    """

    name: str
    refusal: Callable[[str], str]
    operator: Callable[[], bool]


class WizardSession:
    """One page of the wizard. Messages of one kind are taken one at a time; walk and stop do not wait for anything.

    Messages are JSON objects, each with one of these keys:

    - walk: [ahead, left, turn left], shares -1..1 of the top speed; holds 0.4 s;
    - press: id of a button, with `revision` of the layout that it is from, and `via`, click or key;
    - head: {kind, camera, x, y}, as `head_pointer.HeadPointer.point` takes it;
    - stop: true; the stop of all pages ends what the robot of the page does, this one what the others do that the
      page's buttons are for.

    Args:
        page: Id of the page.
        robot: The robot of the page, a `robots.robot.RobotClient`.
        desk: Of all pages.
        layout: Gives the layout that the page shows.
        rights: Of the visitor.
        find: Gives a robot by its name; raises NaoError if there is none.
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
        pointer: Callable[[Any], Any],
    ) -> None:
        self.robot = robot
        self.page = page
        self._desk = desk
        self._layout = layout
        self._rights = rights
        self._find = find
        self._make_pointer = pointer
        self._pointer: Any = None
        self._walks = False
        self._takers = {WALK: self._walk, PRESS: self._press, HEAD: self._head, STOP: self._stop}

    def take(self, kind: str, message: Mapping[str, Any]) -> str:
        """Carry out a message, as `read_message` gives it. Returns what to tell the visitor; empty: all is well."""
        try:
            self._takers[kind](message[kind], message)
        except (ValueError, NaoError) as error:
            return str(error)
        return ""

    def leave(self) -> None:
        """The page is gone, or cannot be heard any more: what it held ends."""
        if self._walks:
            self._walks = False
            self.robot.walk(0.0, 0.0, 0.0, self._rights.name)
        self._desk.leave(self.page)
        if self._pointer is not None:
            self._pointer.close()
            self._pointer = None

    def robot_of(self, button: WizardButton) -> Any:
        """The robot that a button is for. Raises NaoError if there is none of that name."""
        return self._find(button.robot) if button.robot else self.robot

    def states(self) -> Mapping[str, str]:
        """Ids of buttons that run, repeat or were used -> which of it."""

        def namespace(button: WizardButton) -> str:
            name = button.robot.strip("/")
            return f"/{name}/" if name else "/" if button.robot else self.robot.namespace

        return self._desk.states(self._layout(), namespace)

    def _stop(self, _value: Any, _message: Any) -> None:
        if not self._rights.operator():
            raise ValueError("observers look on; only operators stop the robot")
        self._walks = False
        robots = {}
        for _, button in self._layout().buttons():
            with suppress(NaoError):
                other = self.robot_of(button)
                robots[other.namespace] = other
        for namespace, other in robots.items():
            if namespace != self.robot.namespace:
                other.stop(self._rights.name)

    def _walk(self, value: Any, _message: Any) -> None:
        velocity = _velocity(value)
        if not any(velocity):
            if self._walks:
                self._walks = False
                self.robot.walk(0.0, 0.0, 0.0, self._rights.name)
            return
        self._require(self.robot)
        self._walks = True
        self.robot.walk(*velocity, self._rights.name)

    def _press(self, value: Any, message: Mapping[str, Any]) -> None:
        layout = self._layout()
        if message.get("revision") != layout.revision:
            raise ValueError("the buttons have changed meanwhile: look again, and press once more")
        found = [pair for pair in layout.buttons() if pair[1].id == value]
        if not found:
            raise ValueError("there is no such button any more: load the page again")
        ((group, button),) = found
        robot = self.robot_of(button)
        stops = getattr(button.action, "stops", False)
        if not (stops and self._rights.operator()):
            self._require(robot)
        self._desk.take_names(layout, robot.namespace)
        via = "key" if message.get("via") == "key" else "click"
        self._desk.press(robot, group, button, self._rights.name, self.page, via)

    def _head(self, value: Any, _message: Any) -> None:
        if not isinstance(value, dict) or value.get("kind") not in POINTS:
            raise ValueError("a point of the picture that is none")
        x, y = _share(value.get("x")), _share(value.get("y"))
        self._require(self.robot)
        if self._pointer is None:
            self._pointer = self._make_pointer(self.robot)
        self._pointer.point(value["kind"], str(value.get("camera")), x, y, self._rights.name)

    def _require(self, robot: Any) -> None:
        refusal = self._rights.refusal(robot.namespace)
        if refusal:
            raise ValueError(refusal)


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
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise ValueError(f"{value!r} is no number")
    return min(max(float(value), -1.0), 1.0)


def _share(value: Any) -> float:
    return max(_number(value), 0.0)
