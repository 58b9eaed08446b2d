"""Ports for programs that end and are to be found again where they were, or at which nobody listens for a while.

What a program listens on from its start to the end of a test has a port of the system's (port 0), which it tells.
"""

import os

LOWEST, HIGHEST = 20000, 32000
"""The system gives connections no port below 32768."""
WIDTH = 8


def named_port(number: int = 0) -> int:
    """One of the eight ports of this process, counted from 0, that follow each other."""
    return LOWEST + os.getpid() * WIDTH % (HIGHEST - LOWEST) + number
