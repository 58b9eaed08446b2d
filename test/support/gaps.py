"""How long time stands still in a simulator, seen from outside."""

import itertools
import threading
import time

from simulator import connected

LONGEST = 1.0
"""s of wall time between two ticks, at most."""
PERIOD = 0.02
PATIENCE = 60.0


class Gaps:
    """Looks again and again, in a thread of its own.

    Attributes:
        longest: The longest time without news so far, s of wall time.

    Args:
        look: Gives another value whenever time goes on.
        close: Called at the end.
    """

    def __init__(self, look, close=lambda: None):
        self.longest = 0.0
        self._look, self._close = look, close
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name="gaps", daemon=True)
        self._thread.start()

    def _run(self):
        last, since = self._look(), time.monotonic()
        while not self._ended.wait(PERIOD):
            asked = time.monotonic()
            now = self._look()
            self.longest = max(self.longest, time.monotonic() - since)  # at most: a look itself takes time
            if now != last:
                last, since = now, asked

    def close(self):
        self._ended.set()
        self._thread.join(PATIENCE)
        self._close()


def gaps_at(port):
    """Gaps between the ticks of a simulator whose time passes."""
    session = connected(port)
    return Gaps(session.service("NaoSimulation").time, session.close)


def gaps_of(runner):
    """Gaps in which the thread of a simulation in this process takes no command; its time may stand still."""
    numbers = itertools.count()
    return Gaps(lambda: runner.execute(lambda: next(numbers)).result(PATIENCE))
