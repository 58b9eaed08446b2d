"""LEDs over time: at once, fading, in steps; who comes last has the say."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.leds import LedBank, LedKeyframe, uniform
from nao_sim_bridge.sim.tasks import TaskIds


@pytest.fixture
def bank():
    return LedBank(4, TaskIds())


def test_all_are_dark_at_first(bank):
    assert bank.values == (0.0,) * 4


def test_set_works_at_once_on_what_it_names(bank):
    bank.set({1: 0.5, 3: 1.0})
    assert bank.values == (0.0, 0.5, 0.0, 1.0)


@pytest.mark.parametrize("asked, shown", [(1.7, 1.0), (-0.2, 0.0)])
def test_intensities_are_kept_from_0_to_1(bank, asked, shown):
    bank.set({0: asked})
    bank.animate("fade", [LedKeyframe(1.0, {1: asked})], now=0.0)
    bank.tick(1.0)
    assert bank.values[:2] == (shown, shown)


def test_published_values_are_replaced_and_never_changed(bank):
    before = bank.values
    bank.set({0: 1.0})
    assert before == (0.0,) * 4


def test_a_fade_runs_evenly_from_the_present_intensity_and_ends_its_task(bank):
    bank.set({0: 0.2})
    task = bank.animate("fade", [LedKeyframe(2.0, {0: 1.0})], now=10.0)
    for now, value in ((10.5, 0.4), (11.0, 0.6), (11.75, 0.9)):
        bank.tick(now)
        assert bank.values[0] == pytest.approx(value)
        assert not task.finished
    bank.tick(12.0)
    assert bank.values[0] == 1.0
    assert task.finished and not task.killed


def test_a_fade_runs_through_several_colours(bank):
    bank.animate("list", [LedKeyframe(1.0, {0: 1.0, 1: 0.5}), LedKeyframe(3.0, {0: 0.0})], now=0.0)
    bank.tick(0.5)
    assert bank.values[:2] == pytest.approx((0.5, 0.25))
    bank.tick(2.0)
    assert bank.values[:2] == pytest.approx((0.5, 0.5))
    bank.tick(3.0)
    assert bank.values[:2] == (0.0, 0.5)


def test_steps_jump_at_their_times(bank):
    task = bank.animate("blink", [LedKeyframe(0.0, {0: 1.0}), LedKeyframe(1.0, {0: 0.3})], now=0.0, step=True)
    bank.tick(0.01)
    assert bank.values[0] == 1.0
    bank.tick(0.99)
    assert bank.values[0] == 1.0
    bank.tick(1.0)
    assert bank.values[0] == 0.3
    assert task.finished


def test_a_newer_fade_takes_over_only_what_it_names(bank):
    old = bank.animate("fade", [LedKeyframe(2.0, uniform((0, 1), 1.0))], now=0.0)
    bank.tick(1.0)
    new = bank.animate("fade", [LedKeyframe(1.0, {0: 0.0})], now=1.0)
    bank.tick(1.5)
    assert bank.values[:2] == pytest.approx((0.25, 0.75))
    bank.tick(2.0)
    assert old.finished and new.finished
    assert bank.values[:2] == (0.0, 1.0)


def test_set_ends_a_fade_of_what_it_names_only(bank):
    bank.animate("fade", [LedKeyframe(2.0, uniform((0, 1), 1.0))], now=0.0)
    bank.tick(1.0)
    bank.set({0: 0.1})
    bank.tick(2.0)
    assert bank.values[:2] == (0.1, 1.0)


def test_a_killed_fade_leaves_the_light_as_it_is(bank):
    task = bank.animate("fade", [LedKeyframe(2.0, {0: 1.0})], now=0.0)
    bank.tick(1.0)
    assert task.kill()
    bank.tick(2.0)
    assert task.killed
    assert bank.values[0] == pytest.approx(0.5)


def test_the_end_of_an_overtaken_task_does_not_stop_its_successor(bank):
    old = bank.animate("fade", [LedKeyframe(1.0, {0: 1.0})], now=0.0)
    bank.tick(0.5)
    bank.animate("fade", [LedKeyframe(2.0, {0: 0.0})], now=0.5)
    bank.tick(1.0)
    assert old.finished
    bank.tick(1.5)
    assert bank.values[0] == pytest.approx(0.25)


def test_kill_all_ends_every_task(bank):
    tasks = [bank.animate("fade", [LedKeyframe(2.0, {i: 1.0})], now=0.0) for i in range(3)]
    bank.kill_all()
    assert all(task.killed for task in tasks)
    bank.tick(2.0)
    assert bank.values == (0.0,) * 4


def test_an_animation_without_frames_ends_with_the_next_tick(bank):
    task = bank.animate("nothing", [], now=0.0)
    bank.tick(0.01)
    assert task.finished


def test_a_fade_ends_exactly_though_its_end_is_a_rounding_away(bank):
    bank.set({0: 1.0})
    task = bank.animate("fade", [LedKeyframe(1.0, {0: 0.0})], now=0.0)
    bank.tick(1.0 - 1e-12)
    assert task.finished
    assert bank.values[0] == 0.0
