"""What goals say of detections: cameras, landmarks, persons, and what is looked for. Pure."""

from __future__ import annotations

from ...base.errors import BadGoal
from ...base.field_checks import require_text
from ...base.suggestion import did_you_mean
from ..capture.cameras import CAMERAS, camera_name
from .events import BALL, CODE, FACE, LANDMARK

LONGEST_NAME = 100
LOOKED_FOR = (BALL, FACE, LANDMARK, CODE)
"""What lookFor looks for."""
MARK = "the number of a landmark, or nothing for all"
THING = f"{', '.join(LOOKED_FOR)}; a name, a number or a text may follow: {FACE} NAME"


def camera_index(camera: str) -> int | None:
    """Index of a camera that a message names; None for the active one.

    Raises:
        BadGoal: If there is no such camera.
    """
    return CAMERAS[camera_name(camera, "top")] if camera.strip() else None


def require_mark(number: str) -> str:
    """The number of a landmark, without blanks and leading zeros; empty for any."""
    bare = number.strip()
    if bare and not (bare.isascii() and bare.isdigit() and len(bare) < 10):
        raise BadGoal("str_param", number, MARK)
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
        problem = f"{kind!r} is nothing to look for{did_you_mean(kind, LOOKED_FOR)}"
        raise BadGoal("str_param", text, THING, problem=problem)
    if kind == BALL and name:
        raise BadGoal("str_param", text, BALL, problem="balls have no names")
    return kind, require_mark(name) if kind == LANDMARK else name
