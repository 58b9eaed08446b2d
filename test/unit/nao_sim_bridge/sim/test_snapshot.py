"""Snapshots: plain, immutable, and the same whoever asks first."""

from __future__ import annotations

import dataclasses
import math

import pytest

from nao_sim_bridge.sim.readings import Pose
from nao_sim_bridge.sim.rotations import from_roll_pitch_yaw

BALL = "{name: ball, sphere: 0.04, position: [0.3, 0.02, 0.3], mass: 0.2}"
DERIVED = ("left_foot", "right_foot", "touched", "currents", "velocity_in_torso", "turn_in_torso")


def leaves(value):
    """All single values in nested tuples, mappings and dataclasses."""
    if dataclasses.is_dataclass(value):
        value = [getattr(value, field.name) for field in dataclasses.fields(value) if field.compare]
    elif isinstance(value, dict):
        value = [*value, *value.values()]
    if isinstance(value, (list, tuple, frozenset)):
        return [leaf for item in value for leaf in leaves(item)]
    return [value]


@pytest.fixture
def snapshot(bench, world_file):
    one = bench(world=world_file(BALL))
    one.robot.press(["Head/Touch/Front"])
    return one.run(0.5)


def test_it_holds_plain_numbers_and_names_only(snapshot):
    """Numpy's own numbers look alike, but cannot go over the network."""
    found = leaves(snapshot) + [leaf for name in DERIVED for leaf in leaves(getattr(snapshot, name))]
    assert {type(leaf) for leaf in found} == {int, float, str, bool}
    assert all(math.isfinite(leaf) for leaf in found if isinstance(leaf, float))


def test_it_cannot_be_changed(snapshot):
    with pytest.raises(dataclasses.FrozenInstanceError):
        snapshot.time = 0.0


def test_what_is_derived_stays_the_same(bench):
    one = bench()
    snapshot = one.run(0.5)
    feet = snapshot.left_foot
    one.push((60.0, 0.0, 0.0), 0.3)
    one.run(1.0)
    assert snapshot.left_foot is feet
    assert snapshot.right_foot.total == pytest.approx(26.0, abs=1.5)


def test_the_velocity_turns_with_the_torso(snapshot):
    turned = dataclasses.replace(
        snapshot,
        torso=Pose((0.0, 0.0, 0.3), from_roll_pitch_yaw(0.0, 0.0, math.pi / 2)),
        linear_velocity=(0.0, 0.5, 0.1),
    )
    assert turned.velocity_in_torso == pytest.approx((0.5, 0.0, 0.1))


def test_the_turn_is_in_the_torso_and_true(bench):
    one = bench()
    one.push((0.0, 20.0, 0.0), 0.1)
    pushed = one.run(0.1)
    assert pushed.turn_in_torso == pytest.approx(pushed.imu.gyroscope)
    spoilt = dataclasses.replace(pushed, imu=dataclasses.replace(pushed.imu, gyroscope=(9.0, 9.0, 9.0)))
    assert spoilt.turn_in_torso == pushed.turn_in_torso
