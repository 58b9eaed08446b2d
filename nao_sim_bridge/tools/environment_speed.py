#!/usr/bin/env python3
"""How fast the environments are, and a script that steps and reads: against the bare engine, in turns in one process.

Needs `pip install ./nao_sim_bridge[rl]`. All times are those of the processor. What else the computer does slows it all
the same, by up to half; the ratio to as many steps of the bare engine hardly shows that.
"""

from __future__ import annotations

import argparse
import time
from statistics import median
from typing import Callable

import gymnasium
import numpy as np

import nao_sim_bridge.envs
from nao_sim_bridge import NaoSim

CALLS = 40
"""In a block, which is timed as a whole; blocks take turns."""


def block(call: Callable[[], object]) -> float:
    """Seconds of the processor for a call, over a block of them."""
    began = time.process_time()
    for _ in range(CALLS):
        call()
    return (time.process_time() - began) / CALLS


def bare(nao: NaoSim, ticks: int) -> Callable[[], None]:
    """Steps of the engine alone in the world of a robot, as many as in some ticks."""
    engine, count = nao.robot._physics.engine, ticks * nao._session.shared.settings.steps_per_tick

    def steps() -> None:
        for _ in range(count):
            engine.stepSimulation()

    return steps


def told(name: str, ticks: int, times: list[float], engine: list[float]) -> str:
    """A row of the table."""
    each = median(times)
    ratio = median(ours / theirs for ours, theirs in zip(times, engine))
    return f"| {name} | {1.0 / each:.0f} | {ticks / 120.0 / each:.1f} | {ratio:.2f} |"


def environment(name: str, rounds: int) -> str:
    """A row of an environment whose actions move the joints a little."""
    env = gymnasium.make(name).unwrapped
    env.reset(seed=1)
    chance, times, engine = np.random.default_rng(1), [], []

    def step() -> None:
        if env.step(0.1 * chance.uniform(-1.0, 1.0, env.action_space.shape))[2]:
            env.reset()

    for _ in range(rounds):
        times.append(block(step))
        engine.append(block(bare(env.sim, env.TICKS)))
        env.reset()
    env.close()
    return told(f"`{name}`, a step", env.TICKS, times, engine)


def script(name: str, prepare: Callable[[NaoSim], object], read: bool, rounds: int) -> str:
    """A row of a script that steps tick by tick."""
    with NaoSim(seed=1) as nao, NaoSim(seed=1) as other:  # whose control does not mind steps of the engine alone
        prepare(nao)
        times, engine = [], []

        def tick() -> None:
            nao.step()
            if read:
                assert nao.imu and nao.feet and len(np.asarray(nao.angles)) == 26

        for _ in range(rounds):
            times.append(block(tick))
            engine.append(block(bare(other, 1)))
    return told(name, 1, times, engine)


def resets(rounds: int) -> str:
    """What a reset costs, in steps of `NaoStand-v0`."""
    with NaoSim(seed=1) as nao:
        nao.reset(1)
        times = [block(lambda: nao.reset(2)) for _ in range(rounds)]
        stand = list(nao.commands.values())
        steps = [block(lambda: nao.drive(stand, ticks=3)) for _ in range(rounds)]
    return f"a reset: {1e3 * median(times):.2f} ms, as long as {median(times) / median(steps):.1f} drives of 3 ticks"


def main() -> None:
    """Measure and print."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--rounds", type=int, default=24)
    rounds = options.parse_args().rounds
    print("| | a second of the processor | simulated s | times the bare engine |\n| --- | --- | --- | --- |")
    for name in nao_sim_bridge.envs.STEPS:
        if name != "NaoFollowBall":  # which draws pictures in another process
            print(environment(f"{name}-v0", rounds), flush=True)
    print(script("`step()`, standing", lambda nao: None, False, rounds), flush=True)
    print(script("`step()`, standing, with angles, `imu` and `feet`", lambda nao: None, True, rounds), flush=True)
    print(script("`step()`, walking", lambda nao: nao.walk(0.05), False, rounds), flush=True)
    print(resets(rounds))


if __name__ == "__main__":
    main()
