"""Random values from one seed, so that a failing property fails again."""

import numpy
import pytest

import almath


@pytest.fixture
def rng():
    """Source of random numbers, the same in each run."""
    return numpy.random.default_rng(20)


@pytest.fixture
def random_transforms(rng):
    """A hundred transforms with any rotation, up to 2 m away."""
    return [almath.Transform.fromPosition(*rng.uniform(-2.0, 2.0, 3), *rng.uniform(-3.1, 3.1, 3)) for _ in range(100)]


@pytest.fixture
def random_quaternions(rng):
    """A hundred unit quaternions, of all rotations alike."""
    return [almath.Quaternion(rng.normal(size=4)).normalize() for _ in range(100)]
