"""The body as a pendulum: its planned divergent component, and an observer of the real one."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.walk.pattern import PendulumObserver, Segment, divergent_component
from nao_sim_bridge.walk.settings import load_walk_settings

OMEGA, DT = 6.1, 1.0 / 120.0
END = (0.06, 0.0)
PLAN = [
    Segment(0.3, (0.0, 0.0), (0.02, -0.05)),
    Segment(0.33, (0.02, -0.05), (0.02, -0.05)),
    Segment(0.09, (0.02, -0.05), (0.06, 0.05)),
    Segment(0.33, (0.06, 0.05), (0.06, 0.05)),
    Segment(0.3, (0.06, 0.05), END),
]


def test_followed_through_the_plan_it_comes_to_rest_at_the_end():
    x, y = divergent_component(PLAN, END, OMEGA)
    step = 1e-3
    grown = math.exp(OMEGA * step)
    for duration, (ax, ay), (bx, by) in PLAN:
        count = round(duration / step)
        for i in range(count):
            share = (i + 0.5) / count
            at_x, at_y = ax + share * (bx - ax), ay + share * (by - ay)
            x, y = at_x + grown * (x - at_x), at_y + grown * (y - at_y)
    assert (x, y) == pytest.approx(END, abs=4e-4)


@pytest.fixture
def observer():
    settings = load_walk_settings()
    return PendulumObserver(OMEGA, settings.observer_place, settings.observer_speed)


def body(place, speed, ticks, pressure=0.0):
    """Place and speed of a pendulum after each tick, exactly."""
    for i in range(1, ticks + 1):
        c, s = math.cosh(OMEGA * i * DT), math.sinh(OMEGA * i * DT)
        off = place - pressure
        yield pressure + off * c + speed * s / OMEGA, off * OMEGA * s + speed * c


def test_right_from_the_start_the_observer_stays_right(observer):
    observer.reset(0.01, 0.05)
    assert (observer.place, observer.speed) == (0.01, 0.05)
    assert observer.divergent == pytest.approx(0.01 + 0.05 / OMEGA)
    for place, speed in body(0.01, 0.05, 40, pressure=0.02):
        observer.update(place, 0.02, DT)
        assert observer.place == pytest.approx(place, abs=1e-4)
        assert observer.speed == pytest.approx(speed, abs=2e-3)


@pytest.mark.parametrize("place, speed", [(0.02, 0.0), (0.0, 0.3), (-0.01, -0.2)])
def test_wrong_at_the_start_the_observer_finds_the_body(observer, place, speed):
    truth = list(body(0.0, 0.05, 60))
    observer.reset(place, speed)
    for measured, _ in truth:
        observer.update(measured, 0.0, DT)
    true_place, true_speed = truth[-1]
    assert observer.place == pytest.approx(true_place, abs=2e-3)
    assert observer.divergent == pytest.approx(true_place + true_speed / OMEGA, abs=6e-3)
