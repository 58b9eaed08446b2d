"""Distances of capsules: known values."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.sim.motion.capsules import segment_distances

ZERO, X, Y, Z = np.zeros(3), *np.eye(3)


@pytest.mark.parametrize(
    "p1, q1, p2, q2, distance",
    [
        (ZERO, ZERO, X, X, 1.0),
        (ZERO, ZERO, X - Y, X + Y, 1.0),
        (X - Y, X + Y, ZERO, ZERO, 1.0),
        (ZERO, X, Z + X / 2 - Y, Z + X / 2 + Y, 1.0),
        (ZERO, X, 2 * X, 3 * X, 1.0),
        (ZERO, X, Y, Y + X, 1.0),
        (ZERO, X, 2 * X + Y, 2 * X + 2 * Y, np.sqrt(2.0)),
        (-X, X, -Y, Y, 0.0),
        (ZERO, ZERO, ZERO, ZERO, 0.0),
    ],
)
def test_known_distances(p1, q1, p2, q2, distance):
    found = segment_distances(*(np.array([end]) for end in (p1, q1, p2, q2)))
    assert found == pytest.approx([distance], abs=1e-6)


def test_many_at_once_agree_with_a_search_over_points():
    chance = np.random.default_rng(3)
    p1, q1, p2, q2 = chance.uniform(-1.0, 1.0, (4, 40, 3))
    shares = np.linspace(0.0, 1.0, 101)[None, :, None]
    first = p1[:, None] + shares * (q1 - p1)[:, None]
    second = p2[:, None] + shares * (q2 - p2)[:, None]
    searched = np.linalg.norm(first[:, :, None] - second[:, None, :], axis=-1).min(axis=(1, 2))
    found = segment_distances(p1, q1, p2, q2)
    assert (found <= searched + 1e-9).all()
    assert found == pytest.approx(searched, abs=0.02)
