"""How much a simulator computes while its time stands still, seen from outside."""

import itertools
import os
import threading
import time
from pathlib import Path

from simulator import connected

LONGEST = 3.0
"""s of processor time between two ticks, at most; what else the computer does is in wall time alone."""
PERIOD = 0.02
PATIENCE = 60.0
TICKS = os.sysconf("SC_CLK_TCK")


class Gaps:
    """Looks again and again, in a thread of its own.

    Attributes:
        longest: The most processor time without news so far, s.

    Args:
        look: Gives another value whenever time goes on.
        spent: Processor time that the simulator has had, s.
        close: Called at the end.
    """

    def __init__(self, look, spent, close=lambda: None):
        self.longest = 0.0
        self._look, self._spent, self._close = look, spent, close
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name="gaps", daemon=True)
        self._thread.start()

    def _run(self):
        last, since = self._look(), self._spent()
        while not self._ended.wait(PERIOD):
            asked = self._spent()
            now = self._look()
            self.longest = max(self.longest, self._spent() - since)  # at most: a look itself takes time
            if now != last:
                last, since = now, asked

    def close(self):
        self._ended.set()
        self._thread.join(PATIENCE)
        self._close()


def gaps_at(port):
    """Gaps between the ticks of a simulator whose time passes."""
    session = connected(port)
    pid = next(each["processId"] for each in session.services() if each["name"] == "NaoSimulation")
    return Gaps(session.service("NaoSimulation").time, lambda: spent_by(pid), session.close)


def gaps_of(runner):
    """Gaps in which the thread of a simulation in this process takes no command; its time may stand still."""
    numbers = itertools.count()
    return Gaps(lambda: runner.execute(lambda: next(numbers)).result(PATIENCE), time.process_time)


def spent_by(pid):
    """Processor time of a process, s."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / TICKS
