"""The moment before which no goal is over, so that actionlib's SimpleActionClient can note which goal it sent.

That client drops an end that comes before its `send_goal` has returned, and waits for ever (ros/actionlib #206).
"""

from __future__ import annotations

import time

SOONEST_END = 0.005
"""s from when a goal is taken up to its end, at least; docs/functions.md has what it costs and what it saves."""


def let_the_client_note_the_goal(taken_up: float, soonest_end: float = SOONEST_END) -> None:
    """Wait until a goal may be over.

    `taken_up`: when it was taken up, by `time.monotonic`. `soonest_end`: s after which it may be over.
    """
    left = taken_up + soonest_end - time.monotonic()
    if left > 0.0:
        time.sleep(left)
