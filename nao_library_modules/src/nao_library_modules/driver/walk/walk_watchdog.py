"""Notices that velocity commands have ceased. Arithmetic only: times are passed in."""

from __future__ import annotations


class WalkWatchdog:
    """Counts the time since the last command of a walk that somebody steers. Not for several threads at once."""

    def __init__(self, limit: float) -> None:
        """Begin with nothing to watch.

        Args:
            limit: s without a command after which the walk has to stop; 0: never.
        """
        self.limit = limit
        self._last: float | None = None

    def feed(self, now: float) -> None:
        """A command came: watch the walk from now on.

        Args:
            now: Time in s.
        """
        self._last = now if self.limit > 0.0 else None

    def rest(self) -> None:
        """Nothing is steered any more: watch nothing."""
        self._last = None

    def left(self, now: float) -> float | None:
        """Time in s until the walk has to stop, 0 or less when it is over; None while there is nothing to watch.

        Args:
            now: Time in s. When it lies before the last command, the clock was set back (a simulation that began
                anew), and the command counts as just come.
        """
        if self._last is None:
            return None
        self._last = min(self._last, now)
        return self._last + self.limit - now
