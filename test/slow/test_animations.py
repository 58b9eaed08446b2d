"""Animations of a NAO under physics, with sensors like a real robot's."""

from __future__ import annotations

import numpy as np
import pytest
from amount import amount, part_of

from nao_sim_bridge.speech.animations import is_for, load_animations
from nao_sim_bridge.speech.animator import Animator
from nao_sim_bridge.speech.gesture_families import names

REAL = {"sensor_noise": 1.0, "sensor_delay": 0.016}
PARTS = amount(1, 4)
# So far joints may seem to be beyond their limits: noise, rad. So far the arms may be behind their commands, rad.
NOISE, BEHIND = 0.02, 0.3
# So far the trunk may turn from where it was, rad, and come down, m: that of a robot that bows.
LEAN, SINK = 0.3, 0.03
# How often a robot is looked at, ticks.
EVERY = 10


def self_contacts(physics):
    """Pairs of the robot's links that press on each other."""
    names = {index: name for name, index in physics.links.items()}
    points = physics.engine.getContactPoints(physics.robot, physics.robot)
    return {(names.get(point[3], "torso"), names.get(point[4], "torso")) for point in points if point[9] > 0.0}


# Those of robots before NAOqi 2.8 are made of the same strokes: one in so many is played.
OLDER_STEP = 5
# One in so many of all of them is played in the short form.
ONE_IN = 8


def part(posture, number, parts):
    group = pytest.mark.xdist_group(f"{posture} {number} slow/test_animations.py")
    own = [name for name in names() if is_for(name, posture)]
    older = [name for name in own if not names()[name].tags]
    played = [*(name for name in own if name not in older), *older[::OLDER_STEP]]
    return pytest.param(posture, part_of(played[number::parts], ONE_IN), marks=group)


@pytest.mark.parametrize("posture, played", [*(part("Stand", k, PARTS) for k in range(PARTS)), part("Sit", 0, 1)])
def test_nobody_falls_and_no_limb_meets_its_limit_or_another(bench, posture, played):
    one, library = bench(posture, **REAL), load_animations()
    simulation, model = one.simulation, one.model
    animator = Animator(simulation)
    one.run(0.5)
    low, high = np.array([(joint.lower - NOISE, joint.upper + NOISE) for joint in model.joints]).T
    arms = [model.joint_index[name] for arm in ("LArm", "RArm") for name in model.chains[arm] if "Hand" not in name]
    for name in played:
        start, task = one.now, animator.start(library.get(name))
        while not task.finished:
            now = one.run(EVERY * simulation.settings.tick_s)
            angles = np.array(now.positions)
            beyond = (angles < low) | (angles > high)
            assert not beyond.any(), f"{name}: {[model.joints[i].name for i in np.flatnonzero(beyond)]}"
            assert not self_contacts(simulation.physics), f"{name}: {self_contacts(simulation.physics)}"
            behind = np.abs(angles - now.commands)[arms].max()
            assert behind < BEHIND, f"{name}: an arm is {behind:.2f} rad behind"
            turned = np.abs(np.subtract(now.imu.angles, start.imu.angles))[:2].max()
            fallen = one.robot.stability.falls.falling or turned > LEAN
            assert not fallen, f"{name}: the trunk has turned by {turned:.2f} rad"
            assert start.torso.position[2] - now.torso.position[2] < SINK, name
