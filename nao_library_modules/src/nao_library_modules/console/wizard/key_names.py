"""Keys of a keyboard as they are written in the wizard's file, and those that are taken already. Pure."""

from __future__ import annotations

import re

from naoqi.errors import NaoError

from ...driver.teleop.teleop_nao_keyboard import ARROWS, DIRECTIONS

SHIFT = "Shift+"
FUNCTION_KEYS = ("F2", "F4", "F8", "F9")
"""Those that no usual browser takes for itself."""
ALLOWED = f"a letter, a digit, one of , . - + # or {', '.join(FUNCTION_KEYS)}; letters and digits also with {SHIFT}"
_SIGNS = ",.-+#"
_SHIFTED = re.compile(r"[A-Z0-9]")
WALKING = {
    **{f"Arrow{name.capitalize()}": DIRECTIONS[key] for name, key in ARROWS.items()},
    **{key.upper(): velocity for key, velocity in DIRECTIONS.items()},
}
"""Keys that walk while they are held, in the form of `key_of` -> the velocity."""
_BROWSER = {"TAB": "moves the focus", "ENTER": "presses what has the focus", "SPACE": "presses what has the focus"}


class BadKey(NaoError):
    """A text names no key that a button may have."""


def key_of(text: str) -> str:
    """A shortcut in its one form: "h" and "H" are "H", "shift + h" is "Shift+H", "f2" is "F2".

    Raises BadKey if a button cannot have it.
    """
    word = "".join(text.split()) if len(text) > 1 else text
    shifted = word.lower().startswith(SHIFT.lower()) and len(word) > len(SHIFT)
    key = word[len(SHIFT) :] if shifted else word
    key = key.upper()
    if key in ("ESC", "ESCAPE"):
        raise BadKey(f"{text!r} always stops the robot: {ALLOWED}")
    if key in WALKING or key.startswith("ARROW"):
        raise BadKey(f"{text!r} walks (W A S D Q E and the arrows): {ALLOWED}")
    if key in _BROWSER or key == " ":
        raise BadKey(f"{text!r} {_BROWSER.get(key, _BROWSER['SPACE'])}: {ALLOWED}")
    if key in FUNCTION_KEYS and not shifted:
        return key
    if _SHIFTED.fullmatch(key):
        return f"{SHIFT}{key}" if shifted else key
    if len(key) == 1 and key in _SIGNS and not shifted:
        return key
    raise BadKey(f"{text!r} is no key for a button: {ALLOWED}")
