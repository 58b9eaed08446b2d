from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from nao_sim_bridge.sim.errors import BadValue
from nao_sim_bridge.sim.kinematics import link_transforms, quaternion_matrix, transform
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.readings import Pose
from nao_sim_bridge.sim.rotations import from_roll_pitch_yaw
from nao_sim_bridge.sim.sound.poses import PoseTrack


def snapshot(tick):
    turn = from_roll_pitch_yaw(0.1 * tick, -0.05 * tick, 0.3 * tick)
    return SimpleNamespace(torso=Pose((0.1 * tick, 0.2, 0.3), turn), positions=(0.2 * tick, -0.1 * tick, *[0.0] * 24))


def test_points_of_the_head_are_where_the_kinematics_put_them():
    model = load_model()
    track = PoseTrack(model, "HeadPitch", 100)
    for tick in range(6):
        track.record(tick, snapshot(tick))
    point = np.array([[0.02, 0.03, 0.1], [-0.02, 0.05, 0.08]])
    found = track.at(2, 5).place(point)
    for row, tick in enumerate(range(2, 6)):
        now = snapshot(tick)
        torso = transform(quaternion_matrix(now.torso.orientation), now.torso.position)
        head = torso @ link_transforms(model, now.positions)["HeadPitch"]
        assert found[row] == pytest.approx((head @ np.c_[point, [1.0, 1.0]].T)[:3].T, abs=1e-9)


def test_it_keeps_as_many_ticks_as_it_should():
    track = PoseTrack(load_model(), "HeadPitch", 10)
    for tick in range(1000):
        track.record(tick, snapshot(0))
    assert len(track._poses) == 10
    assert len(track.at(990, 999).positions) == 10
    for first, last in ((989, 995), (995, 1000)):
        with pytest.raises(BadValue):
            track.at(first, last)
