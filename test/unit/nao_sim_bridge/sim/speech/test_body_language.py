"""Gestures of a sentence, planned."""

from __future__ import annotations

import random

import pytest

from nao_sim_bridge.sim.speech.animations import load_animations
from nao_sim_bridge.sim.speech.body_language import CONTEXTUAL, DISABLED, QUICKEST, RANDOM, SLOWEST, plan

WORDS = [(0.1, "Hello"), (0.6, "my"), (1.0, "name"), (4.5, "maybe"), (5.0, "not")]


def gestures(duration, words, mode, seed=0):
    return plan(duration, words, mode, load_animations(), random.Random(seed))


def names(planned):
    return [gesture.animation.name.rsplit("/", 1)[-1] for gesture in planned]


@pytest.mark.parametrize("mode", [RANDOM, CONTEXTUAL])
@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("duration", [2.0, 3.7, 7.5, 20.0])
def test_gestures_are_over_with_the_sentence_and_do_not_overlap(duration, seed, mode):
    planned = gestures(duration, WORDS, mode, seed)
    assert all(gesture.start >= 0.0 and gesture.end <= duration + 1e-9 for gesture in planned)
    assert all(a.end <= b.start for a, b in zip(planned, planned[1:]))
    for gesture in planned:
        assert QUICKEST - 1e-9 <= gesture.length / gesture.animation.length <= SLOWEST + 1e-9
    assert planned


@pytest.mark.parametrize("mode, name", [(RANDOM, "Explain"), (CONTEXTUAL, "Hey_1")])
def test_a_sentence_too_short_for_any_gesture_has_a_quick_one(mode, name):
    (gesture,) = gestures(0.5, WORDS[:1], mode)
    assert gesture.animation.name.rsplit("/", 1)[-1].startswith(name)
    assert gesture.start == 0.0
    assert gesture.length == pytest.approx(QUICKEST * gesture.animation.length)


def test_words_bring_their_gestures_a_little_before_they_are_said():
    planned = gestures(8.0, WORDS, CONTEXTUAL)
    assert names(planned)[0] == "Hey_1" and planned[0].start == 0.0
    maybe = next(gesture for gesture in planned if gesture.animation.name.endswith("IDontKnow_1"))
    assert maybe.start == pytest.approx(4.2)


def test_at_random_words_do_not_matter():
    assert names(gestures(8.0, WORDS, RANDOM)) == names(gestures(8.0, [], RANDOM))
    assert all(name.startswith("Explain") for name in names(gestures(8.0, WORDS, RANDOM)))


def test_disabled_means_no_gestures():
    assert gestures(8.0, WORDS, DISABLED) == []


def test_equal_chances_give_equal_gestures():
    assert names(gestures(20.0, WORDS, RANDOM, 3)) == names(gestures(20.0, WORDS, RANDOM, 3))
    assert len({tuple(names(gestures(20.0, WORDS, RANDOM, seed))) for seed in range(10)}) > 1
