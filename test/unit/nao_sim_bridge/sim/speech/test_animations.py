"""The gestures of the robot: their file, their names and tags, and that no arm hits anything."""

from __future__ import annotations

import json

import numpy as np
import pytest

from nao_sim_bridge.sim.errors import ConfigError
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.motion.self_collision import SelfCollision
from nao_sim_bridge.sim.postures import posture
from nao_sim_bridge.sim.speech.animations import load_animations, read_animations
from nao_sim_bridge.sim.speech.body_language import QUICKEST

GESTURES = "animations/Stand/Gestures/"
NAMES = ("Explain_1", "Hey_1", "Me_1", "You_1", "Yes_1", "No_1", "IDontKnow_1", "Enthusiastic_1")
ALL = sorted(load_animations().animations)
# How near limbs may come, m: the shapes that are looked at are wider than the limbs, and an arm is kept at -0.006.
NEAREST = -0.004


@pytest.fixture
def library():
    return load_animations()


@pytest.mark.parametrize("name", NAMES)
def test_the_gestures_that_scripts_use_are_there(library, name):
    assert library.find(GESTURES + name).name == GESTURES + name
    assert library.find(name) is library.find(f"Stand/Gestures/{name}") is library.find(GESTURES + name)
    assert library.find(f"animations/[posture]/Gestures/{name}") is library.find(name)


def test_another_number_of_a_family_stands_for_one_that_is_there(library):
    assert library.find(GESTURES + "Hey_6") is library.find("Hey_1")
    assert library.find(GESTURES + "Somersault_1") is None


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
@pytest.mark.parametrize("name", ALL)
def test_no_arm_comes_too_near_on_the_way(library, name, start):
    model = load_model()
    collision, home = SelfCollision(model), np.array(posture(model, start))
    animation = library.animations[name]
    at_home = collision.distances(home)
    indices = {joint: model.joint_index[joint] for joint in animation.joints}
    curves = {index: animation.curve(joint, home[index], home[index], 1.0) for joint, index in indices.items()}
    for time in np.arange(0.0, animation.length, 0.04):
        angles = home.copy()
        for index, curve in curves.items():
            angles[index] = curve.value(time)
        distances = collision.distances(angles)
        near = distances < np.minimum(at_home, NEAREST) - 1e-6
        assert not near.any(), f"{distances.min():.3f} m at {time:.2f} s"


@pytest.mark.parametrize("name", ALL)
def test_joints_end_where_they_began_and_are_no_faster_than_their_motors(library, name):
    model = load_model()
    home = posture(model, "Stand")
    animation = library.animations[name]
    for joint in animation.joints:
        index = model.joint_index[joint]
        curve = animation.curve(joint, home[index], home[index], QUICKEST)
        assert curve.value(0.0) == curve.value(curve.duration) == home[index]
        assert curve.duration == pytest.approx(QUICKEST * animation.length)
        assert curve.peak_speed() < model.joints[index].max_velocity


@pytest.mark.parametrize(
    "change, problem",
    [
        ({"joints": {}}, "moves no joint"),
        ({"joints": {"LKneePitch": {"times": [1.0], "angles": [0.0]}}}, "no joint of arms, hands or head"),
        ({"joints": {"LElbow": {"times": [1.0], "angles": [0.0]}}}, "no joint of arms, hands or head"),
        ({"joints": {"LHand": {"times": [2.5], "angles": [0.0]}}}, "do not rise between 0 and 2 s"),
        ({"joints": {"LHand": {"times": [1.0, 0.5], "angles": [0.0, 1.0]}}}, "do not rise"),
        ({"joints": {"LHand": {"times": [1.0, 1.5], "angles": [0.0]}}}, "not 2 finite numbers"),
        ({"joints": {"LElbowRoll": {"times": [1.0], "angles": [0.5]}}}, "not all within"),
        ({"speed": 2}, "unknown key 'speed'"),
    ],
)
def test_files_with_errors_are_refused_with_the_place(tmp_path, change, problem):
    entry = {"length": 2.0, "joints": {"LHand": {"times": [1.0], "angles": [1.0]}}}
    path = tmp_path / "mine.json"
    path.write_text(json.dumps({"animations": {"mine/Wave": entry}}))
    assert read_animations(path)["mine/Wave"].length == 2.0
    path.write_text(json.dumps({"animations": {"mine/Wave": {**entry, **change}}}))
    with pytest.raises(ConfigError, match=problem) as error:
        read_animations(path)
    assert "mine.json: mine/Wave" in str(error.value)
