"""What hot motors do to the robot: their boards cut the torque, and ALMotion lets go of the chain they are in."""

from __future__ import annotations

from typing import Sequence

# Motor temperatures in degC from which the status is 1 (at limit), 2 (very hot) and 3 (critical).
HOT = (68.0, 74.0, 80.0)
NORMAL, AT_LIMIT, VERY_HOT, CRITICAL = range(4)
# Share of the torque that is left at each status: a very hot motor loses more than 30 %, a critical one all of it.
SHARES = (1.0, 1.0, 0.65, 0.0)


def heat_status(celsius: float) -> int:
    """Status of a motor at this temperature, 0 (regular) to 3 (critical)."""
    return sum(celsius >= limit for limit in HOT)


def heat_shares(temperatures: Sequence[float]) -> tuple[float, ...]:
    """Share of the torque that each motor has left; empty while all of them have it all."""
    if max(temperatures) < HOT[VERY_HOT - 1]:
        return ()
    return tuple(SHARES[heat_status(celsius)] for celsius in temperatures)
