"""Distances between capsules, many at once. A sphere is a capsule of no length. Pure functions of arrays."""

from __future__ import annotations

import numpy as np

# Squares of lengths below this, m2, are those of points.
POINT = 1e-12


def segment_distances(p1: np.ndarray, q1: np.ndarray, p2: np.ndarray, q2: np.ndarray) -> np.ndarray:
    """(n,) distances in m between segments p1-q1 and p2-q2, each (n, 3) in one frame; ends may coincide.

    Source: the closest points follow from the two normal equations, clamped to the ends of the segments one after the
    other (C. Ericson, Real-Time Collision Detection, 5.1.9).
    """
    d1, d2, between = q1 - p1, q2 - p2, p1 - p2
    a, e = _dot(d1, d1), _dot(d2, d2)
    b, c, f = _dot(d1, d2), _dot(d1, between), _dot(d2, between)
    safe_a, safe_e = np.maximum(a, POINT), np.maximum(e, POINT)
    denominator = a * e - b * b
    parallel = denominator < POINT
    s = np.where(parallel, 0.0, np.clip((b * f - c * e) / np.where(parallel, 1.0, denominator), 0.0, 1.0))
    t = np.clip((b * s + f) / safe_e, 0.0, 1.0) * (e > POINT)
    s = np.clip((b * t - c) / safe_a, 0.0, 1.0) * (a > POINT)
    apart = between + s[:, None] * d1 - t[:, None] * d2
    return np.sqrt(_dot(apart, apart))


def _dot(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    return np.einsum("ij,ij->i", first, second)
