#!/usr/bin/env python3
"""Learns to stand against pushes by augmented random search, plays what it has learned, and compares.

Needs `pip install ./nao_sim_bridge[rl,sweep]`. The policy is linear in the observation of NaoStand-v0; each iteration
tries a handful of directions in the space of policies, both ways, over the same pushes, and goes along those that
paid (Mania, Guy and Recht 2018, without their scaling of states). The rollouts are spread over all processors.
"""

from __future__ import annotations

import argparse
from contextlib import closing, nullcontext
from pathlib import Path

import gymnasium
import numpy as np

from nao_sim_bridge import NaoSim
from nao_sim_bridge.sweep import ray_running, sweep

ENVIRONMENT = "nao_sim_bridge.envs:NaoStand-v0"
WIDTH, RATE = 0.03, 0.02
"""How far a direction is tried, and how far the policy goes along those that paid."""
FIRST_SEED = 1000
"""Of the pushes of the first iteration; each has its own."""


def environment(push: float) -> gymnasium.Env:
    """Where the robot stands as noisy and late as a real one, with pushes of up to so much momentum, N s."""
    return gymnasium.make(ENVIRONMENT, randomization={"push": push, "noise": 1.0, "delay": 0.01})


def rollout(policy: np.ndarray, seed: int, push: float) -> tuple[float, bool]:
    """Sum of rewards of an episode, and whether the robot stood to its end."""
    total, over, late = 0.0, False, False
    with closing(environment(push)) as env:
        seen, _ = env.reset(seed=seed)
        while not (over or late):
            seen, reward, over, late, _ = env.step(np.tanh(policy @ seen))
            total += reward
    return total, not over


def improved(policy: np.ndarray, ways: np.ndarray, seed: int, push: float, workers: int | None) -> np.ndarray:
    """A policy that has gone along the directions (ways, actions, observations) that paid."""

    def tried(seed: int, way: int, sign: int) -> float:
        return rollout(policy + sign * WIDTH * ways[way], seed, push)[0]

    table = sweep(tried, seeds=[seed], workers=workers, progress=False, way=list(range(len(ways))), sign=[1, -1])
    if table.errors:
        raise RuntimeError(f"a rollout failed: {table.errors[0]['error']}")
    rewards = np.array([row["result"] for row in table.rows]).reshape(-1, 2)
    print(f"iteration {seed - FIRST_SEED + 1}: {rewards.mean():.1f} of 400")
    steps = (rewards[:, 0] - rewards[:, 1])[:, None, None] * ways
    return policy + RATE / (rewards.std() + 1e-6) * steps.mean(axis=0)


def train(iterations: int, directions: int, push: float, workers: int | None) -> np.ndarray:
    """A policy, (actions, observations)."""
    with closing(environment(push)) as env:
        policy = np.zeros((*env.action_space.shape, *env.observation_space.shape))
    chance = np.random.default_rng(0)
    for seed in range(FIRST_SEED, FIRST_SEED + iterations):
        policy = improved(policy, chance.standard_normal((directions, *policy.shape)), seed, push, workers)
    return policy


def own_balance(seed: int, push: float) -> bool:
    """Whether the robot's own balance stands the same kind of pushes for ten seconds."""
    chance = np.random.default_rng(seed)
    with NaoSim(seed=seed, noise=1.0) as nao:
        while nao.time < 10.0 and not nao.fallen:
            nao.step(chance.exponential(2.0))
            angle, size = chance.uniform(0.0, 2.0 * np.pi), 10.0 * push * chance.uniform()
            nao.push("Torso", (size * np.cos(angle), size * np.sin(angle), 0.0), 0.1)
        return not nao.fallen


def main() -> None:
    """Train, compare, draw."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--iterations", type=int, default=60)
    options.add_argument("--directions", type=int, default=16)
    options.add_argument("--push", type=float, default=3.0, help="momentum, N s, at most")
    options.add_argument("--episodes", type=int, default=40, help="for the comparison")
    options.add_argument("--workers", type=int, default=None, help="processes; 0: none beside this one")
    options.add_argument("--output", type=Path, default=Path("train_stand"), help="folder for policy, table and figure")
    chosen = options.parse_args()
    chosen.output.mkdir(parents=True, exist_ok=True)
    with nullcontext() if chosen.workers == 0 else ray_running(chosen.workers):  # once, for all sweeps
        learn_and_compare(chosen)


def learn_and_compare(chosen: argparse.Namespace) -> None:
    """All but the arguments."""
    policy = train(chosen.iterations, chosen.directions, chosen.push, chosen.workers)
    np.save(chosen.output / "policy.npy", policy)
    nothing = np.zeros_like(policy)

    def compared(seed: int, push: float, who: str) -> dict[str, bool]:
        if who == "own balance":
            return {"stood": own_balance(seed, push)}
        return {"stood": rollout(policy if who == "trained" else nothing, seed, push)[1]}

    pushes = [chosen.push * share for share in (0.5, 0.75, 1.0, 1.25, 1.5)]
    table = sweep(
        compared,
        chosen.episodes,
        chosen.output / "compared.csv",
        chosen.workers,
        push=pushes,
        who=["no policy", "trained", "own balance"],
    )
    print(table)
    print(f"figure: {table.plot(chosen.output / 'compared.png')}")


if __name__ == "__main__":
    main()
