"""The console's pulse: pages hear it, and stamp what they send with its clock.

A press that waited in a network that was cut, or for a console that hung, comes late: it is refused. Stop never is.
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from typing import Any

PERIOD = 0.5
"""s between two beats."""
LATE = 3.0
"""s from a press to its arrival at most."""
STAMP = "at"
"""Field of a message: when it was made, as `console_time`."""


def console_time() -> float:
    """Time of the clock that beats tell and messages are stamped with, s."""
    return time.monotonic()


def refusal_of_late(message: Mapping[str, Any]) -> str:
    """Why a message is not carried out, for people; empty: it is in time, or has no stamp."""
    stamp = message.get(STAMP)
    if not isinstance(stamp, (int, float)) or isinstance(stamp, bool) or not math.isfinite(stamp):
        return ""
    if console_time() - stamp <= LATE:
        return ""
    return (
        f"it came more than {LATE:g} s late, as the connection was interrupted: look, and press again if still wanted"
    )
