"""The motions that come with the library are what their tables say, and feet stay where they are to be."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path

import numpy as np
import pytest

from nao_library_modules.motion_store import MotionStore
from nao_sim_bridge.sim.body_mass import center_of_links
from nao_sim_bridge.sim.kinematics import link_transforms
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.postures import posture

ROOT = Path(__file__).resolve().parents[4]
TOOLS = ROOT / "nao_sim_bridge" / "tools"
SHIPPED = ROOT / "nao_library_modules" / "config" / "motions"
BASE = "StandInit"
SHORT = ("wave", "offer", "bow_small")
"""Those that are made quickly: one of the whole body among them."""
CLOSE = 4e-3
"""m; with the torso shifted and pitched a foot turns a little, and what is seen from it turns with it."""


@pytest.fixture
def tool(monkeypatch):
    monkeypatch.syspath_prepend(str(TOOLS))
    yield importlib.import_module
    for name in ("make_motions", "motion_tables", "motion_dance", "choreography"):
        sys.modules.pop(name, None)


@pytest.fixture(scope="module")
def model():
    return load_model()


@pytest.fixture
def choreographer(tool, model):
    return tool("choreography").Choreographer(model)


def pose(model, joints, angles):
    """(26,) angles of a sample, the rest as in the posture that motions begin with."""
    whole = list(posture(model, BASE))
    for joint, angle in zip(joints, angles):
        whole[model.joint_index[joint]] = angle
    return whole


def left_foot_to_com_and_right_foot(model, angles):
    """Centre of mass and right ankle, seen from the left foot, m."""
    poses = link_transforms(model, angles)
    foot = np.linalg.inv(poses["LAnkleRoll"])
    center = foot @ np.append(center_of_links(model, model.links, angles), 1.0)
    return center[:3], (foot @ poses["RAnkleRoll"])[:3, 3]


def test_the_files_are_what_the_tables_say(tool, monkeypatch, tmp_path):
    monkeypatch.setattr(sys, "argv", ["make_motions.py", "--folder", str(tmp_path), *SHORT])
    program = tool("make_motions")
    assert program.main() == 0
    made, shipped = MotionStore(tmp_path), MotionStore(SHIPPED)
    assert sorted(make.__name__ for make in program.MOTIONS) == shipped.names()
    assert made.names() == sorted(SHORT)
    for name in made.names():
        assert made.load(name).joints == shipped.load(name).joints
        assert made.load(name).times == pytest.approx(shipped.load(name).times)
        np.testing.assert_allclose(made.load(name).angles, shipped.load(name).angles, atol=1e-4)


def test_nothing_but_the_named_joints_moves_without_a_channel_of_the_body(choreographer):
    joints, samples = choreographer.samples({"HeadYaw": [(0.0, 0.0), (0.35, 0.5)]})
    assert joints == ["HeadYaw"]
    assert [time for time, _ in samples] == pytest.approx([0.0, 0.1, 0.2, 0.3, 0.35])
    assert samples[-1][1] == pytest.approx([0.5])


def test_the_weight_goes_where_it_is_to_go_and_the_feet_stay(choreographer, model):
    joints, samples = choreographer.samples({"com_y": [(0.0, 0.0), (1.0, 0.04)]})
    before, other_before = left_foot_to_com_and_right_foot(model, pose(model, joints, samples[0][1]))
    after, other_after = left_foot_to_com_and_right_foot(model, pose(model, joints, samples[-1][1]))
    assert (after - before)[:2] == pytest.approx([0.0, 0.04], abs=CLOSE)
    assert other_after == pytest.approx(other_before, abs=CLOSE)


def test_the_weight_stays_over_the_feet_in_a_bow(choreographer, model):
    joints, samples = choreographer.samples({"pitch": [(0.0, 0.1), (1.0, 0.7)], "height": [(0.0, 0.31), (1.0, 0.3)]})
    before, other_before = left_foot_to_com_and_right_foot(model, pose(model, joints, samples[0][1]))
    after, other_after = left_foot_to_com_and_right_foot(model, pose(model, joints, samples[-1][1]))
    assert (after - before)[:2] == pytest.approx([0.0, 0.0], abs=1e-3)
    assert other_after == pytest.approx(other_before, abs=1e-3)


def test_a_foot_is_lifted(choreographer, model):
    table = {"com_y": [(0.0, 0.03), (1.0, 0.04)], "right_z": [(0.0, 0.0), (1.0, 0.04)]}
    joints, samples = choreographer.samples(table)
    _, before = left_foot_to_com_and_right_foot(model, pose(model, joints, samples[0][1]))
    _, after = left_foot_to_com_and_right_foot(model, pose(model, joints, samples[-1][1]))
    assert after - before == pytest.approx([0.0, 0.0, 0.04], abs=CLOSE)


@pytest.mark.parametrize(
    "table, text",
    [
        ({"Nose": [(0.0, 0.0), (1.0, 1.0)]}, "Nose is no joint"),
        ({"HeadYaw": [(0.5, 0.0), (1.0, 1.0)]}, "not at 0"),
        ({"HeadYaw": [(0.0, 0.0), (1.0, 3.0)]}, "HeadYaw would be at"),
        ({"com_y": [(0.0, 0.0), (1.0, 0.2)]}, "Roll would be at"),
    ],
)
def test_what_cannot_be_is_refused(choreographer, table, text):
    with pytest.raises(ValueError, match=text):
        choreographer.samples(table)
