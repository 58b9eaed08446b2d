"""The behaviours that come with the library, and the motions and sounds that they play."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from nao_library_modules.behaviors import BehaviorStore, problems_of
from nao_library_modules.errors import BadGoal
from nao_library_modules.motion_store import MotionStore
from nao_library_modules.paths import config_file
from nao_sim_bridge.paths import sounds_directory
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.motion.curves import SmoothCurve

TEN = [
    "bow",
    "count_to_ten",
    "dance",
    "hello",
    "introduce_yourself",
    "look_around",
    "nod",
    "shake_head",
    "sit_and_rest",
    "tai_chi",
]
MOTIONS = sorted(path.stem for path in config_file("motions").glob("*.yaml"))
SHARE = 0.75
"""Of its top speed that a joint of a shipped motion may need."""


@pytest.fixture
def store(tmp_path):
    return BehaviorStore(tmp_path, config_file("behaviors"))


@pytest.fixture
def motions(tmp_path):
    return MotionStore(tmp_path, config_file("motions"))


def fields_named(node, name):
    """Values of a field, wherever it is in a file."""
    if isinstance(node, dict):
        return [value for key, value in node.items() if key == name] + [
            found for value in node.values() for found in fields_named(value, name)
        ]
    return [found for value in node for found in fields_named(value, name)] if isinstance(node, list) else []


def test_there_are_ten(store):
    assert store.names() == TEN


@pytest.mark.parametrize("name", TEN)
def test_each_can_be_run_as_it_is_and_explains_itself(store, name):
    assert problems_of(lambda: store.load(name), store.load) == []
    behavior = store.load(name)
    assert behavior.help and behavior.tags
    assert behavior.parameters


def test_every_motion_is_played_by_one_of_them(store):
    played = []
    for name in TEN:
        for step in fields_named(yaml.safe_load(store.text(name)), "NaoMotion.playMotion"):
            depths = ["small", "deep"] if "${depth}" in step["str_param"] else [""]
            played += [step["str_param"].replace("${depth}", depth) for depth in depths]
    assert sorted(played) == MOTIONS


def test_the_music_of_the_dance_is_there(store):
    (play,) = fields_named(yaml.safe_load(store.text("dance")), "nao_audio_out.playFile")
    for tempo in store.load("dance").parameters["tempo"].choices:
        assert (sounds_directory() / play["str_param"].replace("${tempo}", str(tempo))).is_file()


@pytest.mark.parametrize("name", MOTIONS)
def test_joints_can_follow_a_motion(motions, name):
    motion, model = motions.load(name).key_frames(), load_model()
    for place, joint in enumerate(motion.joints):
        limits = model.joint(joint)
        curve = SmoothCurve(motion.times, [row[place] for row in motion.angles])
        low, high = curve.extremes
        assert limits.lower - 1e-4 <= low and high <= limits.upper + 1e-4, joint
        assert curve.peak_speed() <= SHARE * limits.max_velocity, joint


def test_shipped_motions_can_be_replayed_but_not_changed(motions):
    assert motions.names() == []
    for change in (motions.delete, motions.require, lambda name: motions.rename(name, "mine")):
        with pytest.raises(BadGoal, match="'wave' comes with the library"):
            change("wave")


def test_a_motion_of_the_user_stands_before_a_shipped_one(motions):
    mine = motions.load("wave").faster(2.0)
    motions.save("wave", mine)
    assert motions.load("wave").duration == pytest.approx(mine.duration) and motions.names() == ["wave"]
    motions.delete("wave")
    assert motions.load("wave").duration == pytest.approx(2.0 * mine.duration)


def test_a_motion_that_is_not_there_is_told_with_the_shipped_ones(motions):
    with pytest.raises(BadGoal, match="did you mean 'wave'"):
        motions.load("wavy")


def test_paths_are_found_for_folders():
    assert isinstance(config_file("motions"), Path) and config_file("motions").is_dir()
