"""A separable evolution strategy with covariance matrix adaptation: minimises without gradients.

One variance a coordinate instead of a full covariance matrix, so that many coordinates are learned in few generations.

Source: Ros and Hansen (2008), "A Simple Modification in CMA-ES Achieving Linear Time and Space Complexity".
"""

from __future__ import annotations

import math
from typing import Any, Mapping, Sequence

import numpy as np


class SepCmaEs:
    """The search: `ask` for candidates, `tell` what they cost.

    Attributes:
        mean: (n,) centre of the search; after it the answer that is robust under noise.
        sigma: Overall step size.
        generation: Generations told so far.

    Args:
        mean: (n,) where to start.
        sigma: Step size to start with, in the unit of the coordinates.
        population: Candidates a generation, at least 4.
        seed: Of the random numbers.
    """

    def __init__(self, mean: Sequence[float], sigma: float, population: int, seed: int = 0) -> None:
        self.mean = np.array(mean, dtype=float)
        self.sigma = float(sigma)
        self.generation = 0
        self._population = population
        self._seed = seed
        n, parents = len(self.mean), population // 2
        weights = math.log(parents + 0.5) - np.log(np.arange(1, parents + 1))
        self._weights = weights / weights.sum()
        effective = 1.0 / float((self._weights**2).sum())
        self._effective = effective
        self._sigma_rate = (effective + 2.0) / (n + effective + 5.0)
        self._damping = 1.0 + self._sigma_rate + 2.0 * max(0.0, math.sqrt((effective - 1.0) / (n + 1.0)) - 1.0)
        self._path_rate = 4.0 / (n + 4.0)
        # A diagonal has so few entries that it may learn faster than a full matrix.
        faster = (n + 2.0) / 3.0
        self._rank_one = min(1.0, faster * 2.0 / ((n + 1.3) ** 2 + effective))
        rank_mu = faster * 2.0 * (effective - 2.0 + 1.0 / effective) / ((n + 2.0) ** 2 + effective)
        self._rank_mu = min(1.0 - self._rank_one, rank_mu)
        self._usual_length = math.sqrt(n) * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n))
        self._variances = np.ones(n)
        self._sigma_path = np.zeros(n)
        self._path = np.zeros(n)

    def ask(self) -> np.ndarray:
        """(population, n) candidates of this generation; the same ones until it is told."""
        return self.mean + self.sigma * np.sqrt(self._variances) * self._draws()

    def tell(self, costs: Sequence[float]) -> None:
        """Learn from the costs of the candidates of `ask`, in their order."""
        order = np.argsort(costs)[: len(self._weights)]
        chosen = self._draws()[order]
        spread = np.sqrt(self._variances)
        step = self._weights @ chosen
        self.mean = self.mean + self.sigma * spread * step
        self.generation += 1
        rate = self._sigma_rate
        self._sigma_path = (1 - rate) * self._sigma_path + math.sqrt(rate * (2 - rate) * self._effective) * step
        length = float(np.linalg.norm(self._sigma_path))
        expected = math.sqrt(1.0 - (1.0 - rate) ** (2 * self.generation))
        # A path that grows too fast comes from a step size that is too small, not from the shape of the valley.
        trusted = length / expected < (1.4 + 2.0 / (len(step) + 1.0)) * self._usual_length
        rate = self._path_rate
        pull = math.sqrt(rate * (2 - rate) * self._effective) if trusted else 0.0
        self._path = (1 - rate) * self._path + pull * spread * step
        self._variances = (
            (1.0 - self._rank_one - self._rank_mu) * self._variances
            + self._rank_one * self._path**2
            + self._rank_mu * (self._weights @ (spread * chosen) ** 2)
        )
        self.sigma *= math.exp(min(1.0, self._sigma_rate / self._damping * (length / self._usual_length - 1.0)))

    def state(self) -> dict[str, Any]:
        """Everything needed to go on later, as plain numbers and lists."""
        return {
            "mean": self.mean.tolist(),
            "sigma": self.sigma,
            "population": self._population,
            "seed": self._seed,
            "generation": self.generation,
            "variances": self._variances.tolist(),
            "sigma_path": self._sigma_path.tolist(),
            "path": self._path.tolist(),
        }

    @classmethod
    def from_state(cls, state: Mapping[str, Any]) -> SepCmaEs:
        """The search that `state` was taken from."""
        search = cls(state["mean"], state["sigma"], state["population"], state["seed"])
        search.generation = state["generation"]
        search._variances = np.array(state["variances"])
        search._sigma_path = np.array(state["sigma_path"])
        search._path = np.array(state["path"])
        return search

    def _draws(self) -> np.ndarray:
        """(population, n) normal numbers of this generation; they depend on seed and generation alone."""
        chance = np.random.default_rng([self._seed, self.generation])
        return chance.standard_normal((self._population, len(self.mean)))
