"""How fast a NAO walks at a step frequency. Figures of NAOqi's documentation of the walk."""

from __future__ import annotations

SHORTEST_STEP, LONGEST_STEP = 0.42, 0.6
"""s that a step takes at the highest and the lowest frequency."""
STEP_LENGTH, STEP_TURN = 0.04, 0.349
"""m, rad: the longest step ahead and the largest turn of a step, where nobody asks for others."""


def step_period(frequency: float) -> float:
    """Time that a step takes, s. `frequency`: share 0..1 of the range of step frequencies."""
    return LONGEST_STEP + frequency * (SHORTEST_STEP - LONGEST_STEP)


def top_speeds(frequency: float) -> tuple[float, float]:
    """Speed ahead, m/s, and of turning, rad/s, that velocities of 1 mean. `frequency`: as `step_period` takes it."""
    period = step_period(frequency)
    return STEP_LENGTH / period, STEP_TURN / period
