"""Which devices are hot, from the temperatures of a snapshot."""

from __future__ import annotations

from dataclasses import dataclass, field
from types import SimpleNamespace

import pytest

from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.settings import load_settings
from nao_sim_bridge.sim.temperatures import NOTHING_HOT, hot_devices

MODEL, LIMITS = load_model(), load_settings().head


@dataclass
class Warmth:
    temperatures: tuple = (30.0,) * 26
    head_temperature: float = 50.0
    battery: SimpleNamespace = field(default_factory=lambda: SimpleNamespace(hot=False))


def hot(**joints):
    return hot_devices(MODEL, LIMITS, Warmth(tuple(joints.get(joint.name, 30.0) for joint in MODEL.joints)))


def test_nothing_is_hot_at_first():
    assert hot() is NOTHING_HOT
    assert NOTHING_HOT.status == (0, ())


def test_the_worst_motors_decide():
    found = hot(HeadYaw=69.0, LKneePitch=76.0, RKneePitch=75.0)
    assert found.devices == {"HeadYaw": 1, "LKneePitch": 2, "RKneePitch": 2}
    assert found.status == (2, ("LKneePitch", "RKneePitch"))
    assert (found.severity, found.chains) == (1, ("LLeg", "RLeg"))


@pytest.mark.parametrize("celsius, severity", [(68.0, 0), (74.0, 1), (80.0, 2)])
def test_severity_of_one_motor(celsius, severity):
    assert hot(RElbowRoll=celsius).severity == severity


@pytest.mark.parametrize("celsius, status", [(94.9, 0), (95.0, 1), (105.0, 3)])
def test_a_hot_head_is_no_failure_of_a_chain(celsius, status):
    found = hot_devices(MODEL, LIMITS, Warmth(head_temperature=celsius))
    assert found.status[0] == status
    assert found.chains == found.joints == ()


def test_a_hot_battery():
    assert hot_devices(MODEL, LIMITS, Warmth(battery=SimpleNamespace(hot=True))).devices == {"Battery": 1}
