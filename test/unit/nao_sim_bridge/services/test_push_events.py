"""Events of a robot that is pushed, over the network."""

from __future__ import annotations

import pytest


def test_a_push_from_the_right_is_told_with_its_direction_and_energy(stiff_robot, listener, patience):
    memory = stiff_robot.ALMemory
    events = ("ALMotion/RobotPushed", "ALMotion/Safety/RobotPushed", "ALMotion/Safety/PushRecovery")
    for event in events:
        memory.subscribeToEvent(event, "Listener", "onEvent")
    stiff_robot.advance(1.5)
    stiff_robot.NaoSimulation.push([0.0, 14.0, 0.0], 0.1, "torso")
    stiff_robot.advance(1.0)
    told = {}
    while len(told) < 3:
        name, value, _ = listener.heard.get(timeout=patience)
        told[name] = value
    angle, energy = told["ALMotion/RobotPushed"]
    assert angle == pytest.approx(1.57, abs=0.4)
    assert 0.003 < energy < 1.0
    assert told["ALMotion/Safety/RobotPushed"] == told["ALMotion/Safety/PushRecovery"] == [angle]
    for event in events:
        memory.unsubscribeToEvent(event, "Listener")
