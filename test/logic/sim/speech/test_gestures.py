"""Gestures of the robot: their file, names and tags, that no arm hits anything; and which go with a sentence."""

from __future__ import annotations

import random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim_bridge.control.joints.self_collision import SelfCollision
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.postures import posture
from nao_sim_bridge.speech.animations import load_animations
from nao_sim_bridge.speech.body_language import CONTEXTUAL, QUICKEST, RANDOM, SLOWEST, plan

GESTURES = "animations/Stand/Gestures/"
ALL = sorted(load_animations().animations)
# How near limbs may come, m: the shapes that are looked at are wider than the limbs, and an arm is kept at -0.006.
NEAREST = -0.004


@pytest.fixture
def library():
    return load_animations()


def test_tags_and_words_lead_to_gestures(library):
    assert library.find("Hey_1") in library.tagged("hello") and library.find("Hey_1") in library.tagged("Hello")
    assert library.find("Me_1") in library.of_word("I")
    assert library.tagged("nonsense") == library.of_word("nonsense") == []
    library.add_tag("ahoy", [GESTURES + "Hey_1"])
    library.add_words("ahoy", ["Ship"])
    assert library.of_word("ship") == [library.find("Hey_1")]
    assert load_animations().of_word("ship") == []
    assert len(library.tagged(library.body_language)) >= 2


@pytest.mark.parametrize("start", ["Stand", "StandInit", "Sit"])
def test_no_arm_comes_too_near_on_the_way(library, start):
    model = load_model()
    collision, home = SelfCollision(model), np.array(posture(model, start))
    nearest = np.minimum(collision.distances(home), NEAREST) - 1e-6
    for name in ALL:
        animation = library.animations[name]
        indices = {joint: model.joint_index[joint] for joint in animation.joints}
        curves = {index: animation.curve(joint, home[index], home[index], 1.0) for joint, index in indices.items()}
        for time in np.arange(0.0, animation.length, 0.04):
            angles = home.copy()
            for index, curve in curves.items():
                angles[index] = curve.value(time)
            distances = collision.distances(angles)
            assert not (distances < nearest).any(), f"{name}: {distances.min():.3f} m at {time:.2f} s"


WORDS = [(0.1, "Hello"), (0.6, "my"), (1.0, "name"), (4.5, "maybe"), (5.0, "not")]


def gestures(duration, words, mode, seed=0):
    return plan(duration, words, mode, load_animations(), random.Random(seed))


def names(planned):
    return [gesture.animation.name.rsplit("/", 1)[-1] for gesture in planned]


@settings(max_examples=25)
@given(st.floats(2.0, 20.0), st.integers(0, 1000), st.sampled_from([RANDOM, CONTEXTUAL]))
def test_gestures_are_over_with_the_sentence_and_do_not_overlap(duration, seed, mode):
    planned = gestures(duration, WORDS, mode, seed)
    assert planned and all(gesture.start >= 0.0 and gesture.end <= duration + 1e-9 for gesture in planned)
    assert all(a.end <= b.start for a, b in zip(planned, planned[1:]))
    for gesture in planned:
        assert QUICKEST - 1e-9 <= gesture.length / gesture.animation.length <= SLOWEST + 1e-9


@pytest.mark.parametrize("mode, name", [(RANDOM, "Explain"), (CONTEXTUAL, "Hey_1")])
def test_a_sentence_too_short_for_any_gesture_has_a_quick_one(mode, name):
    (gesture,) = gestures(0.5, WORDS[:1], mode)
    assert names([gesture])[0].startswith(name) and gesture.start == 0.0
    assert gesture.length == pytest.approx(QUICKEST * gesture.animation.length)


def test_words_bring_their_gestures_a_little_before_they_are_said():
    planned = gestures(8.0, WORDS, CONTEXTUAL)
    assert names(planned)[0] == "Hey_1" and planned[0].start == 0.0
    assert planned[names(planned).index("IDontKnow_1")].start == pytest.approx(4.2)
