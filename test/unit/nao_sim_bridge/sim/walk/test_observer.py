"""The pendulum observer: a body that moves as a pendulum, measured with noise."""

from __future__ import annotations

import math
import random

import pytest

from nao_sim_bridge.sim.walk.observer import PendulumObserver
from nao_sim_bridge.sim.walk.settings import load_walk_settings

OMEGA, DT = 6.1, 1.0 / 120.0
SETTINGS = load_walk_settings()


@pytest.fixture
def observer():
    return PendulumObserver(OMEGA, SETTINGS.observer_place, SETTINGS.observer_speed)


def body(place, speed, ticks, pressure=0.0):
    """Place and speed of a pendulum after each tick, exactly."""
    for i in range(1, ticks + 1):
        c, s = math.cosh(OMEGA * i * DT), math.sinh(OMEGA * i * DT)
        off = place - pressure
        yield pressure + off * c + speed * s / OMEGA, off * OMEGA * s + speed * c


def test_it_is_where_it_was_put(observer):
    observer.reset(0.02, -0.1)
    assert (observer.place, observer.speed) == (0.02, -0.1)
    assert observer.divergent == pytest.approx(0.02 - 0.1 / OMEGA)


def test_right_from_the_start_it_stays_right(observer):
    observer.reset(0.01, 0.05)
    for place, speed in body(0.01, 0.05, 40, pressure=0.02):
        observer.update(place, 0.02, DT)
        assert observer.place == pytest.approx(place, abs=1e-4)
        assert observer.speed == pytest.approx(speed, abs=2e-3)


@pytest.mark.parametrize("place, speed", [(0.02, 0.0), (0.0, 0.3), (-0.01, -0.2)])
def test_wrong_at_the_start_it_finds_the_body(observer, place, speed):
    truth = list(body(0.0, 0.05, 60))
    observer.reset(place, speed)
    for measured, _ in truth:
        observer.update(measured, 0.0, DT)
    true_place, true_speed = truth[-1]
    assert observer.place == pytest.approx(true_place, abs=2e-3)
    assert observer.divergent == pytest.approx(true_place + true_speed / OMEGA, abs=6e-3)


def test_it_is_quieter_than_what_is_measured(observer):
    r = random.Random(1)
    errors, plain = [], []
    before = 0.0
    for _ in range(2000):
        measured = r.gauss(0.0, 0.001)
        observer.update(measured, observer.place, DT)
        errors.append(observer.divergent)
        plain.append(measured + (measured - before) / DT / OMEGA)
        before = measured
    deviation, of_plain = (math.sqrt(sum(e * e for e in es) / len(es)) for es in (errors[50:], plain[50:]))
    assert deviation < 0.25 * of_plain


def test_a_push_shows_within_a_few_ticks(observer):
    observer.reset(0.0, 0.0)
    for place, _ in body(0.0, 0.3, 10):
        observer.update(place, 0.0, DT)
    assert observer.divergent > 0.5 * 0.3 / OMEGA
