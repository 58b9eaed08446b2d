"""Gestures of the robot: names and tags, that no arm hits anything; and which go with a sentence."""

from __future__ import annotations

import random
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim_bridge.base.config import config_file
from nao_sim_bridge.control.joints.self_collision import SelfCollision
from nao_sim_bridge.model.kinematics import link_transforms
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.postures import posture
from nao_sim_bridge.speech import gesture_families
from nao_sim_bridge.speech.animations import FILE, is_for, load_animations, read_animations
from nao_sim_bridge.speech.body_language import CONTEXTUAL, QUICKEST, RANDOM, SLOWEST, plan

# Of any two animations one hand is so far from where the other animation has it, at some moment, m.
APART, APART_IN_FAMILY = 0.025, 0.04
# The middle of a hand in the frame of its wrist, m.
HAND = (0.05775, 0.0, -0.01231, 1.0)
GESTURES = "animations/Stand/Gestures/"
BY_HAND, ALL = read_animations(config_file(FILE)), gesture_families.names()
FAMILIES = [name for name, naming in ALL.items() if naming.tags]
# Those of robots before NAOqi 2.8.
OLDER = [name for name in ALL if name not in FAMILIES]
# How near limbs may come, m: the shapes that are looked at are wider than the limbs, and an arm is kept at -0.006.
NEAREST = -0.004


@pytest.fixture
def library():
    return load_animations()


def test_tags_and_words_lead_to_gestures(library):
    assert library.find("Hey_1") in library.tagged("hello") and library.find("Hey_1") in library.tagged("Hello")
    assert library.find("Me_1") in library.of_word("I") and library.find("Far_1") in library.of_word("there")
    assert library.tagged("nonsense") == library.of_word("nonsense") == []
    library.add_tag("ahoy", [GESTURES + "Hey_1"])
    library.add_words("ahoy", ["Ship"])
    assert library.of_word("ship") == [library.find("Hey_1")]
    assert load_animations().of_word("ship") == []
    assert len(library.tagged(library.body_language)) >= 2


def test_an_animation_that_is_declared_again_has_its_tags_and_no_others(library):
    hey = library.find("Hey_1")
    for tags in (("ahoy", "Hello"), ("ahoy",), ("ahoy",)):
        library.add([replace(hey, tags=tags)])
    assert library.tags_of(hey.name) == ("ahoy",) and [a.name for a in library.tagged("Ahoy")] == [hey.name]
    assert hey.name not in [a.name for a in library.tagged("hello")]


def curves_of(animation, home):
    """The ways of an animation's joints by index, from and to the angles of a posture."""
    indices = {joint: load_model().joint_index[joint] for joint in animation.joints}
    return {index: animation.curve(joint, home[index], home[index], 1.0) for joint, index in indices.items()}


def ways(animation, home, step):
    """Angles of all joints, rad, every `step` s."""
    times, curves = np.arange(0.0, animation.length, step), curves_of(animation, home)
    angles = np.repeat(home[None], len(times), 0)
    for index, curve in curves.items():
        angles[:, index] = [curve.value(time) for time in times]
    return angles


@pytest.mark.parametrize("start, names, step", [
    ("Stand", BY_HAND, 0.04), ("StandInit", BY_HAND, 0.04), ("Sit", BY_HAND, 0.04),
    ("Stand", FAMILIES, 0.2), ("Sit", FAMILIES, 0.1), ("Stand", OLDER, 0.4), ("Sit", OLDER, 0.2),
])  # fmt: skip
def test_no_arm_comes_too_near_on_the_way(library, start, names, step):
    model = load_model()
    collision, home = SelfCollision(model), np.array(posture(model, start))
    nearest = np.minimum(collision.distances(home), NEAREST) - 1e-6
    for name in names:
        if names is not BY_HAND and not is_for(name, start):
            continue
        for angles in ways(library.get(name), home, step):
            distances = collision.distances(angles)
            assert not (distances < nearest).any(), f"{name}: {distances.min():.3f} m"


def test_all_animations_of_a_nao_are_there_within_limits_speeds_and_a_few_seconds(library):
    model = load_model()
    assert len(FAMILIES) == 434 and set(ALL) <= set(library.names)
    for name in ALL:
        animation = library.get(name)
        assert 1.5 <= animation.length <= 5.0 and library.get(name) is animation
        for joint, frames in animation.joints.items():
            limits, home = model.joint(joint), posture(model, "Sit" if "/Sit/" in name else "Stand")
            curve = animation.curve(joint, *[home[model.joint_index[joint]]] * 2, QUICKEST)
            low, high = curve.extremes
            assert limits.lower <= low and high <= limits.upper, f"{name}: {joint} {low:.2f} to {high:.2f} rad"
            assert curve.peak_speed() <= limits.max_velocity, f"{name}: {joint} {curve.peak_speed():.1f} rad/s"
            assert 0.0 < frames.times[0] and frames.times[-1] < animation.length


def hands(animation):
    """(40, 2, 3) places of both hands, m in the torso, every 0.12 s of an animation and the stand behind it."""
    model = load_model()
    home = np.array(posture(model, "Stand"))
    path = [link_transforms(model, angles) for angles in ways(animation, home, 0.12)]
    places = [[(links[f"{arm}WristYaw"] @ HAND)[:3] for arm in "LR"] for links in path]
    return np.array([*places, *[places[0]] * (40 - len(places))])[:40]


def test_no_two_animations_are_the_same(library):
    names = FAMILIES
    paths = np.array([hands(library.get(name)) for name in names])
    families = [name.rsplit("_", 1)[0].rsplit("_", 1)[-1].rsplit("/", 1)[-1] for name in names]
    for k, path in enumerate(paths[:-1]):
        apart = np.linalg.norm(paths[k + 1 :] - path, axis=3).max(axis=(1, 2))
        nearest = int(apart.argmin())
        assert apart[nearest] >= APART, f"{names[k]} and {names[k + 1 + nearest]}: {apart[nearest]:.3f} m"
        for other, distance in zip(families[k + 1 :], apart):
            assert other != families[k] or distance >= APART_IN_FAMILY, f"{names[k]}: {distance:.3f} m"


def test_an_animation_is_as_its_name_says(library):
    build, names = library.get, FAMILIES
    folder = "animations/Stand/Affirmation/NAO/"
    for name in names:
        if "/Left_" in name:
            left, right = (hands(build(each)) for each in (name, name.replace("/Left_", "/Right_")))
            assert np.allclose(left, right[:, ::-1] * (1.0, -1.0, 1.0), atol=0.005), name
    slow, neutral, strong = (
        np.mean([build(name).length for name in names if name.startswith(f"{folder}Center_{tempo}_")])
        for tempo in ("Slow", "Neutral", "Strong")
    )
    assert slow > neutral and slow > strong
    sky = [hands(build(name))[:, :, 2].max() for name in names if "ShowSky" in name]
    floor = [hands(build(name))[:, :, 2].max() for name in names if "ShowFloor" in name]
    assert min(sky) > 0.15 > max(floor)
    yes, no = build("animations/Stand/Gestures/Yes_1"), build("animations/Stand/Gestures/No_1")
    assert "HeadPitch" in yes.joints and "HeadYaw" in no.joints


@pytest.mark.parametrize("side, sign", [("Left", 1.0), ("Right", -1.0)])
def test_the_trunk_goes_to_the_side_of_the_arm_that_leads_and_stays_upright(library, side, sign):
    model, home = load_model(), np.array(posture(load_model(), "Stand"))
    swaying = [a for a in map(library.get, FAMILIES) if f"/{side}_" in a.name and "LHipRoll" in a.joints]
    assert len(swaying) > 5
    for animation in swaying:
        angles, time = home.copy(), animation.joints["LHipRoll"].times[0]
        for index, curve in curves_of(animation, home).items():
            angles[index] = curve.value(time)
        links = link_transforms(model, angles)
        for foot in ("LAnkleRoll", "RAnkleRoll"):
            moved = link_transforms(model, home)[foot][1, 3] - links[foot][1, 3]
            assert sign * moved > 0.005 and links[foot][1, 2] == pytest.approx(0.0, abs=0.01), animation.name


def test_animations_of_earlier_robots_are_there_by_name_and_chosen_by_nothing_else(library):
    assert library.get("animations/Stand/Waiting/TakePicture_1").joints and library.find("AirGuitar_1").length > 1.5
    assert "animations/Sit/Emotions/Positive/Laugh_1" in library.names
    assert {tag for name in OLDER for tag in library.tags_of(name)} == set()


def test_a_contextual_name_is_that_of_the_posture(library):
    assert library.find("animations/[posture]/BodyTalk/BodyTalk_3", "Sit").name == "animations/Sit/BodyTalk/BodyTalk_3"
    assert library.find("animations/Stand/Negation/[robot]/Left_Strong_NEG_01").tags == ("negative_context", "refusal")
    assert library.find("BodyTalk_3", "Sit").name == "animations/Sit/BodyTalk/BodyTalk_3"
    assert library.find("BodyTalk_3").name == "animations/Stand/BodyTalk/BodyTalk_3"
    assert {a.name.split("/")[1] for a in library.tagged("body language", "Sit")} == {"Sit"}
    assert [a.name for a in library.below("animations/[posture]/Emotions", "happy")] == [
        "animations/Stand/Emotions/Positive/Happy_4", "animations/Stand/Emotions/Positive/Hysterical_1"
    ]  # fmt: skip


def test_gestures_are_built_when_they_are_asked_for():
    code = "from nao_sim_bridge.speech import animations, gesture_families as families; animations.load_animations();"
    code += "print(families._tables.cache_info().currsize, families.build.cache_info().currsize)"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout.split() == ["0", "0"]


WORDS = [(0.1, "Hello"), (0.6, "my"), (1.0, "name"), (4.5, "maybe"), (5.0, "not")]


def gestures(duration, words, mode, seed=0, sentence=""):
    return plan(duration, words, mode, load_animations(), random.Random(seed), sentence=sentence)


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


@pytest.mark.parametrize("mode, tag", [(RANDOM, "body language"), (CONTEXTUAL, "hello")])
def test_a_sentence_too_short_for_any_gesture_has_a_quick_one(mode, tag):
    (gesture,) = gestures(0.5, WORDS[:1], mode)
    assert tag in gesture.animation.tags and gesture.start == 0.0
    assert gesture.length == pytest.approx(QUICKEST * gesture.animation.length)


@pytest.mark.parametrize("ending, mode, tag", [
    ("?", CONTEXTUAL, "interrogative"), ("!", CONTEXTUAL, "exclamation"), (".", CONTEXTUAL, "body language"),
    ("?", RANDOM, "body language"),
])  # fmt: skip
def test_a_question_is_asked_with_the_hands_too(ending, mode, tag):
    planned = gestures(10.0, [], mode, sentence=f"Well{ending}")
    assert planned and all(tag in gesture.animation.tags for gesture in planned)


def test_words_bring_their_gestures_a_little_before_they_are_said():
    planned = gestures(8.0, WORDS, CONTEXTUAL)
    assert names(planned)[0].startswith("Hey_") and planned[0].start == 0.0
    (unsure,) = [gesture for gesture in planned if gesture.animation.name.rsplit("/", 1)[-1].startswith("IDontKnow_")]
    assert unsure.start == pytest.approx(4.2)
