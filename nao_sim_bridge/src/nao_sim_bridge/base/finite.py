"""The gate to the physics engine: nothing gets in, and nothing is taken from it, that is not a finite number."""

from __future__ import annotations

import math
from typing import Iterable, Sequence

from nao_sim_bridge.base.errors import SimulationError


class NotFinite(SimulationError):
    """Numbers of which one is not finite, or that are too large to be summed up.

    Attributes:
        what: What they are.
        numbers: They.
    """

    def __init__(self, what: str, numbers: Sequence[float]) -> None:
        self.what = what
        self.numbers = tuple(numbers)
        places = [i for i, number in enumerate(self.numbers) if not math.isfinite(number)]
        shown = ", ".join(f"{self.numbers[i]} at {i}" for i in places[:5]) or "too large"
        super().__init__(f"{what}: numbers must be finite, found {shown}")


def check_finite(what: str, numbers: Iterable[float]) -> None:
    """Refuse numbers of which one is not finite.

    Args:
        numbers: As they are about to go to the engine, or have just come from it.

    Raises:
        NotFinite: One of them is infinite or not a number.
    """
    if not math.isfinite(sum(numbers)):  # a tenth of the time of a look at each
        raise NotFinite(what, list(numbers))
