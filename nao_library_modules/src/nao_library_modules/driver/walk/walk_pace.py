"""How often walking commands go to the robot. Arithmetic only: times are passed in."""

from __future__ import annotations

from .walk_commands import Velocity

PACE = 0.05
"""s from one velocity or target to the next, at least."""
REFRESH = 1.0
"""s after which a velocity that is commanded on and on is sent again. The robot may have ended the walk by itself:
legs that were limp, feet in the air."""


class WalkPace:
    """What was sent last, and when. Not for several threads at once."""

    def __init__(self) -> None:
        """Begin with nothing sent."""
        self._velocity: Velocity | None = None
        self._sent: float | None = None
        self._heard: float | None = None

    def pause(self, now: float) -> float:
        """Time in s until the next velocity or target may be sent; 0 or less: at once."""
        return 0.0 if self._sent is None else self._sent + PACE - now

    def sent(self, velocity: Velocity | None, now: float) -> None:
        """A command was sent.

        Args:
            velocity: The velocity that the robot has now; None after a command of another kind.
            now: Time in s.
        """
        self._velocity, self._sent = velocity, now

    def is_news(self, velocity: Velocity, now: float) -> bool:
        """Note that a velocity is commanded, and tell whether the robot has to be told.

        What it has got already it has to be told again now and then. A standstill only after a break in the commands:
        then it is no idle stick of somebody any longer, and may be meant for a walk that others began.
        """
        before, self._heard = self._heard, now
        if velocity != self._velocity or before is None or self._sent is None or now - before > REFRESH:
            return True
        return not velocity.is_zero and now - self._sent >= REFRESH
