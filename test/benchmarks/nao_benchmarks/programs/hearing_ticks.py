#!/usr/bin/env python3
"""Times a robot that speaks and listens to itself against its twin in silence.

Ears work in a thread of their own beside the ticks, so whole stretches of ticks are timed and not single ones. Prints
JSON: `ours` and `reference`, s of a mean tick of each stretch.
"""

from __future__ import annotations

import sys

import numpy as np
from nao_benchmarks.errors import BenchmarkError
from nao_benchmarks.printing import print_times
from nao_benchmarks.robots import awake
from nao_benchmarks.stats import interleave

from nao_sim_bridge.base.samples import RATE, Sound
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.sound.ears import BLOCK

TICKS = 102
"""Five blocks of the microphones."""
WARM_UP = 3
LOUD = 100.0
"""Mean of the samples of a block in which the robot hears itself; the noise of the room has some 5."""
SWITCH_INTERVAL = 0.0005
"""s; as the server has it."""


def time_stretches(rounds: int) -> dict[str, list[float]]:
    """Alternate stretches of two robots, one of which speaks and is heard.

    Raises:
        BenchmarkError: If its microphones are not heard all the time.
    """
    speaking, silent = awake(), awake()
    noise = np.random.default_rng(0).normal(0.0, 0.1, 5 * RATE).astype(np.float32)
    speaking.sound.loudspeakers.play(Sound(noise), "say", loop=True)
    levels: list[float] = []
    speaking.sound.ears.listen("benchmark", lambda block: levels.append(float(np.abs(block.samples).mean())))

    def stretch(simulation: Simulation) -> None:
        for _ in range(TICKS):
            simulation.tick()

    def speak() -> None:
        stretch(speaking)
        # What is still to be heard would disturb the other robot's turn.
        speaking.sound.ears.catch_up()

    try:
        ours, reference = interleave([speak, lambda: stretch(silent)], rounds, warm_up=WARM_UP)
    finally:
        speaking.close()
        silent.close()
    wanted = round(rounds * TICKS * speaking.settings.tick_s * RATE) // BLOCK
    heard = sum(level > LOUD for level in levels)
    if heard < wanted:
        raise BenchmarkError(f"ears heard {heard} blocks with sound, of {wanted}")
    return {"ours": [s / TICKS for s in ours.seconds], "reference": [s / TICKS for s in reference.seconds]}


if __name__ == "__main__":
    sys.setswitchinterval(SWITCH_INTERVAL)
    sys.exit(print_times(time_stretches, __doc__, 60))
