"""Checks of the detections, made before a chain begins. Parameters are fields of VisionFunction."""

from __future__ import annotations

from typing import Any

from ...base.errors import BadGoal
from ...base.field_checks import require_text, require_within
from ...base.limits import limit
from ...base.suggestion import did_you_mean
from ..capture.cameras import CAMERAS, camera_name
from ..capture.checks import LONGEST_WAIT
from .events import BALL, CODE, FACE, LANDMARK

TIMEOUT, SHARE, SIZE, LOOKS = limit("timeout"), limit("share"), limit("size"), limit("looks")
LONGEST_NAME = 100
LOOKED_FOR = (BALL, FACE, LANDMARK, CODE)
"""What lookFor looks for."""


def camera_index(camera: str) -> int | None:
    """Index of a camera that a message names; None for the active one.

    Raises:
        BadGoal: If there is no such camera.
    """
    return CAMERAS[camera_name(camera, "top")] if camera.strip() else None


def require_look(camera: str, timeout: float, confidence: float) -> None:
    """A camera, a wait, a least confidence."""
    camera_index(camera)
    require_within("timeout", timeout, TIMEOUT, f"up to {LONGEST_WAIT:g} s, or 0 for the default")
    require_within("confidence", confidence, SHARE)


def require_size(size: float) -> None:
    """A real size, m."""
    require_within("size", size, SIZE, f"up to {SIZE[1]:g} m, or 0 for the default")


def require_looks(count: int) -> None:
    """How many pictures are to count."""
    require_within("count", count, LOOKS, f"up to {LOOKS[1]} looks, or 0 for one")


def require_mark(number: str) -> str:
    """The number of a landmark, without blanks and leading zeros; empty for any."""
    bare = number.strip()
    if bare and not (bare.isascii() and bare.isdigit() and len(bare) < 10):
        raise BadGoal("str_param", number, "the number of a landmark, or nothing for all")
    return str(int(bare)) if bare else ""


def require_name(name: str) -> str:
    """The name of a person, without blanks around it."""
    bare = require_text("str_param", name, "the name of a person")
    if len(bare) > LONGEST_NAME:
        problem = f"{bare[:20]!r}... is too long"
        raise BadGoal("str_param", name, f"up to {LONGEST_NAME} characters", problem=problem)
    if not bare.isprintable():
        raise BadGoal("str_param", name, "a name of characters that can be printed")
    return bare


def wanted_thing(text: str) -> tuple[str, str]:
    """What lookFor looks for: its kind, and its name or nothing.

    Raises:
        BadGoal: If it cannot be looked for.
    """
    kind, _, name = text.strip().partition(" ")
    name = name.strip()
    if kind not in LOOKED_FOR:
        allowed = f"{', '.join(LOOKED_FOR)}; a name, a number or a text may follow: {FACE} NAME"
        problem = f"{kind!r} is nothing to look for{did_you_mean(kind, LOOKED_FOR)}"
        raise BadGoal("str_param", text, allowed, problem=problem)
    if kind == BALL and name:
        raise BadGoal("str_param", text, BALL, problem="balls have no names")
    return kind, require_mark(name) if kind == LANDMARK else name


# Checks of functions


def check_detection(self: Any, camera: str, timeout: float, confidence: float, count: int, size: float) -> None:
    """Looks at things whose size may be given."""
    require_look(camera, timeout, confidence)
    require_looks(count)
    require_size(size)


def check_landmarks(
    self: Any, str_param: str, camera: str, timeout: float, confidence: float, count: int, size: float
) -> None:
    """Looks at landmarks, perhaps only one of them."""
    require_mark(str_param)
    check_detection(self, camera, timeout, confidence, count, size)


def check_movement(self: Any, camera: str, timeout: float, confidence: float, count: int, sensitivity: float) -> None:
    """Looks at what moves."""
    require_look(camera, timeout, confidence)
    require_looks(count)
    require_within("sensitivity", sensitivity, SHARE)


def check_learning(self: Any, str_param: str, camera: str, timeout: float) -> None:
    """A name, and a look at the face."""
    require_name(str_param)
    require_look(camera, timeout, 0.0)


def check_name(self: Any, str_param: str) -> None:
    """A name."""
    require_name(str_param)


def check_tracking(
    self: Any, camera: str, timeout: float, confidence: float, size: float, duration: float, speed: float
) -> None:
    """What is followed, how long, how fast."""
    require_look(camera, timeout, confidence)
    require_size(size)
    until = f"up to {LONGEST_WAIT:g} s, or 0: until the goal is preempted"
    require_within("duration", duration, TIMEOUT, until)
    require_within("speed", speed, SHARE, "0..1 of the top speed, or 0 for a moderate one")


def check_search(
    self: Any,
    str_param: str,
    camera: str,
    timeout: float,
    confidence: float,
    count: int,
    size: float,
    speed: float,
) -> None:
    """What is looked for, how long, how fast."""
    wanted_thing(str_param)
    check_tracking(self, camera, timeout, confidence, size, 0.0, speed)
    require_looks(count)
