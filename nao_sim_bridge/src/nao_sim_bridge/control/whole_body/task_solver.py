"""Joint steps for several wishes of different rank: damped least squares, each in the null space of those before. Pure.

A wish is rows of `jacobian @ step = change`. Wishes of a lower rank use only the freedom that those of a higher rank
leave; what is free after all of them goes to a preferred step of the joints. No joint leaves its bounds: one that would
is kept at its bound, and the others make up for it.
"""

from __future__ import annotations

from typing import NamedTuple, Sequence

import numpy as np

# Damping where freedom is taken away: so little that a wish of low rank has no hold on what a higher one asks for.
SHARP = 1e-12
# A bound that is overstepped by rounding only.
ROUNDING = 1e-9


class Wish(NamedTuple):
    """What one rank asks for.

    Attributes:
        jacobian: (rows, n), per rad of each joint.
        change: (rows,) that the step should bring.
        damping: Added to the square of the jacobian: keeps steps small near singular poses.
    """

    jacobian: np.ndarray
    change: np.ndarray
    damping: float


def ranked_step(
    wishes: Sequence[Wish],
    preferred: np.ndarray,
    lower: np.ndarray,
    upper: np.ndarray,
    mobility: np.ndarray,
) -> np.ndarray:
    """The joint step, (n,) in rad within the bounds, that serves `wishes`, the first one first.

    Args:
        wishes: By rank, the highest first.
        preferred: (n,) step that joints make with the freedom that is left, rad.
        lower: (n,) least step of each joint, rad; equal to `upper` for one that stands still.
        upper: (n,) largest step of each joint, rad.
        mobility: (n,) above 0: how readily a joint helps where there is a choice.
    """
    scale = np.sqrt(mobility)
    kept = upper - lower <= 0.0
    step = np.where(kept, lower, 0.0)
    for _ in range(len(preferred)):
        step = _free_step(wishes, preferred, np.where(kept, 0.0, scale), step)
        bounded = np.minimum(np.maximum(step, lower), upper)
        beyond = np.abs(step - bounded)
        worst = int(np.argmax(beyond))
        if beyond[worst] <= ROUNDING:
            return bounded
        # One at a time: with it at its bound, others may not be beyond theirs any more.
        kept = kept.copy()
        kept[worst] = True
        step = np.where(kept, bounded, 0.0)
    return step


def _free_step(wishes: Sequence[Wish], preferred: np.ndarray, scale: np.ndarray, kept: np.ndarray) -> np.ndarray:
    """The step without bounds; joints of scale 0 step as `kept` says."""
    step = kept
    freedom = np.diag((scale > 0.0).astype(float))
    for jacobian, change, damping in wishes:
        rows = (jacobian * scale) @ freedom
        square = rows @ rows.T
        unit = np.eye(len(square))
        step = step + scale * (rows.T @ np.linalg.solve(square + damping * unit, change - jacobian @ step))
        freedom = freedom - rows.T @ np.linalg.solve(square + SHARP * unit, rows)
    free = scale > 0.0
    wanted = np.zeros(len(scale))
    wanted[free] = (preferred - step)[free] / scale[free]
    return step + scale * (freedom @ wanted)
