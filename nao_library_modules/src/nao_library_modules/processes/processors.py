"""The processors of this computer, and whether there are enough of them."""

from __future__ import annotations

import os
from pathlib import Path

LOAD = Path("/proc/loadavg")
"""Linux: three averages, then `threads that run or wait for a processor/all threads`."""


def processors_are_short() -> bool:
    """Whether more threads want to run at this moment than there are processors. No, where the system does not say."""
    try:
        wanted = int(LOAD.read_text("ascii").split()[3].split("/")[0])
    except (OSError, ValueError, IndexError):
        return False
    return wanted > (os.cpu_count() or 1)
