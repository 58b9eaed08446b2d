"""What a chain saves: many functions in one goal, against a goal for each."""

from __future__ import annotations

import time

from ..row import Figures, Row, at_most
from ..stack import Stack
from ..stats import Sample, interleave

FUNCTIONS = 100
ROUNDS = 3
LIGHT = "Brain0"


class ChainedFunctions(Row):
    """The same functions, each with its call to the robot, sent together and one by one."""

    name = "chained_functions"
    subject = f"{FUNCTIONS} functions (setIntensity) in one goal"
    against = f"{FUNCTIONS} goals one after the other"
    unit = "ms"
    bound = at_most(0.2)

    def measure(self, stack: Stack) -> Figures:
        """Measure both ways with our server in turns; for the note also each goal by itself."""
        client = stack.lights_client
        # Alternating, so that every call of the chain changes something.
        steps = [{"lights": [LIGHT], "i_values": [float(i % 2)]} for i in range(FUNCTIONS)]
        together, alone = client.goal("setIntensity", *steps), client.goal("setIntensity", steps[0])
        single: list[float] = []

        def one_by_one() -> None:
            for _ in range(FUNCTIONS):
                began = time.perf_counter()
                client.run(alone)
                single.append(time.perf_counter() - began)

        client.run(together)
        ours, reference = interleave([lambda: client.run(together), one_by_one], ROUNDS)
        typical = Sample(tuple(single)).median
        note = (
            f"of these goals the median is {1e3 * typical:.2f} ms; the chain : {FUNCTIONS} times that"
            f" = {ours.median / (FUNCTIONS * typical):.2f}"
        )
        return Figures.compared(ours, reference, scale=1e3, note=note)
