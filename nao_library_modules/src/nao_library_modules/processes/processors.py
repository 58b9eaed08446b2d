"""Load of the local processors."""

from __future__ import annotations

import os
from pathlib import Path

LOAD = Path("/proc/loadavg")
"""Linux: three averages, then `runnable threads/all threads`."""


def processors_are_short() -> bool:
    """Whether more threads are runnable now than there are processors; False where the system does not report it."""
    try:
        runnable = int(LOAD.read_text("ascii").split()[3].split("/")[0])
    except (OSError, ValueError, IndexError):
        return False
    return runnable > (os.cpu_count() or 1)
