#!/usr/bin/env python3
"""Times a robot that speaks and listens to itself against its twin in silence.

Ears work in a thread of their own beside the ticks, so whole stretches of ticks are timed and not single ones. Prints
JSON: `ours` and `reference`, s of a mean tick of each stretch.
"""

from __future__ import annotations

import argparse
import json
import sys

import numpy as np
from nao_benchmarks.stats import interleave

from nao_sim_bridge.sim.simulation import Scene, Simulation
from nao_sim_bridge.sim.sound.ears import BLOCK
from nao_sim_bridge.sim.sound.samples import RATE, Sound

SETTLE_S = 1.0
TICKS = 102
"""Five blocks of the microphones."""
SWITCH_INTERVAL = 0.0005
"""s; as the server has it."""


def awake() -> Simulation:
    """A robot that stands stiff."""
    simulation = Simulation(Scene(posture="Stand"))
    simulation.robot.joints.set_stiffness(dict.fromkeys(range(len(simulation.model.joints)), 1.0))
    simulation.run(SETTLE_S)
    return simulation


def main() -> int:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=60, help="stretches to measure")
    rounds = parser.parse_args().rounds
    sys.setswitchinterval(SWITCH_INTERVAL)
    speaking, silent = awake(), awake()
    noise = np.random.default_rng(0).normal(0.0, 0.1, 5 * RATE).astype(np.float32)
    speaking.sound.loudspeakers.play(Sound(noise), "say", loop=True)
    blocks: list[int] = []
    speaking.sound.ears.listen("benchmark", lambda block: blocks.append(len(block.samples)))

    def stretch(simulation: Simulation) -> None:
        for _ in range(TICKS):
            simulation.tick()

    def speak() -> None:
        stretch(speaking)
        # What is still to be heard would disturb the other robot's turn.
        speaking.sound.ears.catch_up()

    ours, reference = interleave([speak, lambda: stretch(silent)], rounds, warm_up=3)
    for simulation in (speaking, silent):
        simulation.close()
    if len(blocks) < round(rounds * TICKS * speaking.settings.tick_s * RATE) // BLOCK:
        print(f"ears heard {len(blocks)} blocks only")
        return 1
    print(json.dumps({"ours": [s / TICKS for s in ours.seconds], "reference": [s / TICKS for s in reference.seconds]}))
    return 0


if __name__ == "__main__":
    sys.exit(main())
