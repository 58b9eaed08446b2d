"""How often walking commands go to the robot, and when they have ceased. Arithmetic only: times in s are passed in.

Neither class is for several threads at once.
"""

from __future__ import annotations

from .walk_commands import Velocity

PACE = 0.05
"""s from one velocity or target to the next, at least."""
REFRESH = 1.0
"""s after which a velocity that is commanded on and on is sent again. The robot may have ended the walk by itself:
legs that were limp, feet in the air."""


class WalkPace:
    """What was sent last, and when."""

    def __init__(self) -> None:
        self._velocity: Velocity | None = None
        self._sent: float | None = None
        self._heard: float | None = None

    def pause(self, now: float) -> float:
        """Time until the next velocity or target may be sent; at once if not above 0."""
        return 0.0 if self._sent is None else self._sent + PACE - now

    def sent(self, velocity: Velocity | None, now: float) -> None:
        """Note that a command was sent; `velocity` is what the robot has now, None after another kind of command."""
        self._velocity, self._sent = velocity, now

    def is_news(self, velocity: Velocity, now: float) -> bool:
        """Note that a velocity is commanded; whether it has to be sent.

        A velocity that the robot has already is sent again now and then. A standstill is sent again only after a break
        in the commands: then it is no longer an idle stick, and may be meant for a walk that others began.
        """
        before, self._heard = self._heard, now
        if velocity != self._velocity or before is None or self._sent is None or now - before > REFRESH:
            return True
        return not velocity.is_zero and now - self._sent >= REFRESH


class WalkWatchdog:
    """Time since the last command of a steered walk, which stops after `limit` s without one; 0: never."""

    def __init__(self, limit: float) -> None:
        self.limit = limit
        self._last: float | None = None

    def feed(self, now: float) -> None:
        """A command came: watch the walk from now on."""
        self._last = now if self.limit > 0.0 else None

    def rest(self) -> None:
        """Nothing is steered any more: watch nothing."""
        self._last = None

    def left(self, now: float) -> float | None:
        """Time until the walk has to stop, 0 or less when it is over; None while there is nothing to watch.

        If `now` lies before the last command, the clock was set back (a simulation that began anew), and the command
        counts as just come.
        """
        if self._last is None:
            return None
        self._last = min(self._last, now)
        return self._last + self.limit - now
