"""Clicks of a button, counted. Arithmetic only: times are passed in.

NAOqi publishes no figures for its clicks; these are those of usual desktops.
"""

from __future__ import annotations

LONGEST_CLICK = 1.0
"""A button that is held longer, s, was no click."""
LONGEST_PAUSE = 0.5
"""Clicks that follow each other within this time, s, belong together."""
MOST_CLICKS = 3


class ClickCounter:
    """Counts the clicks of one button: feed it with every reading."""

    def __init__(self) -> None:
        self._down = False
        self._since = 0.0
        self._clicks = 0

    def feed(self, down: bool, now: float) -> int:
        """How many clicks are over at simulated time `now`, s: 1 to 3, once for each series; else 0."""
        if down != self._down:
            held = now - self._since
            self._down, self._since = down, now
            if down:
                return 0
            # What was held breaks the series: somebody who wants three clicks does not hold the second.
            self._clicks = self._clicks + 1 if held <= LONGEST_CLICK else 0
        elif down or not self._clicks or now - self._since < LONGEST_PAUSE:
            return 0
        else:
            return self._end()
        return self._end() if self._clicks == MOST_CLICKS else 0

    def _end(self) -> int:
        clicks, self._clicks = self._clicks, 0
        return clicks
