"""Limits of one joint that depend on where another one is, fast enough for every tick."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from typing import Sequence

from nao_sim_bridge.model.robot_model import RobotModel


@dataclass(frozen=True)
class Coupling:
    """One joint limited by another.

    Attributes:
        joint: Index of the joint that is limited.
        by: Index of the joint that it depends on.
        rows: (value of `by`, lower, upper) in rad, first column ascending; linear between rows.
    """

    joint: int
    by: int
    rows: Sequence[tuple[float, float, float]]

    def limits_at(self, value: float) -> tuple[float, float]:
        """Lower and upper limit in rad when the other joint is at `value` rad; the ends hold outside the table."""
        rows = self.rows
        after = bisect_right(rows, (value,))
        if after == 0:
            return rows[0][1], rows[0][2]
        if after == len(rows):
            return rows[-1][1], rows[-1][2]
        (x0, low0, high0), (x1, low1, high1) = rows[after - 1], rows[after]
        share = (value - x0) / (x1 - x0)
        return low0 + share * (low1 - low0), high0 + share * (high1 - high0)


def couplings(model: RobotModel) -> tuple[Coupling, ...]:
    index = model.joint_index
    found = [
        Coupling(index[limit.joint], index[limit.by_joint], [tuple(row) for row in limit.table.tolist()])
        for limit in model.coupled_limits.values()
    ]
    return tuple(sorted(found, key=lambda coupling: coupling.joint))
