"""Touch sensors and bumpers: what presses where."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.sensors.contacts import Press
from nao_sim_bridge.sim.sensors.touch import REACH, TouchSensors

MODEL = load_model()
LINKS = {link.name: number for number, link in enumerate(MODEL.links)}
LEFT_FOOT, RIGHT_FOOT = LINKS["LAnkleRoll"], LINKS["RAnkleRoll"]


@pytest.fixture
def touch():
    return TouchSensors(MODEL, LINKS.__getitem__)


def at(x, y, z, upward=0.0):
    return Press(x, y, z, upward, 1.0)


def test_every_sensor_has_a_name_of_its_own(touch):
    assert len(touch.names) == len(set(touch.names)) == 14
    assert sum("/Bumper/" in name for name in touch.names) == 4


@pytest.mark.parametrize("place", MODEL.touch, ids=lambda place: place.name)
def test_a_press_on_its_middle_is_felt_by_each_sensor(touch, place):
    assert place.name in touch.read({LINKS[place.parent_link]: [at(*place.position)]})


@pytest.mark.parametrize("place", MODEL.touch, ids=lambda place: place.name)
def test_a_press_elsewhere_on_the_link_is_felt_by_none(touch, place):
    x, y, z = place.position
    assert touch.read({LINKS[place.parent_link]: [at(x - 3 * REACH, y, z + 2 * REACH)]}) == frozenset()


def test_the_same_place_on_another_link_is_something_else(touch):
    position = next(place.position for place in MODEL.touch if place.name == "Head/Touch/Front")
    assert touch.read({LINKS["LKneePitch"]: [at(*position)]}) == frozenset()


def test_the_floor_under_the_toes_presses_no_bumper(touch):
    assert touch.read({LEFT_FOOT: [at(0.0876, 0.019, -0.0353, upward=1.0)]}) == frozenset()


@pytest.mark.parametrize(
    "y, felt", [(0.03, {"Left"}), (0.0025, {"Left", "Right"}), (-0.03, {"Right"}), (0.048, {"Left"})]
)
def test_a_bumper_is_the_shell_round_its_half_of_the_toes(touch, y, felt):
    """The tip, where a flat wall touches first, belongs to both."""
    assert touch.read({LEFT_FOOT: [at(0.1, y, -0.04)]}) == {f"LFoot/Bumper/{half}" for half in felt}
    mirrored = {f"RFoot/Bumper/{'Right' if half == 'Left' else 'Left'}" for half in felt}
    assert touch.read({RIGHT_FOOT: [at(0.1, -y, -0.04)]}) == mirrored


def test_the_heel_has_no_bumper(touch):
    assert touch.read({LEFT_FOOT: [at(-0.05, 0.02, -0.035)]}) == frozenset()


def test_several_presses_are_felt_together(touch):
    positions = {place.name: place.position for place in MODEL.touch}
    presses = {
        LINKS["HeadPitch"]: [at(*positions["Head/Touch/Rear"]), at(*positions["Head/Touch/Middle"])],
        LINKS["LWristYaw"]: [at(*positions["LHand/Touch/Back"])],
    }
    assert touch.read(presses) >= {"Head/Touch/Rear", "Head/Touch/Middle", "LHand/Touch/Back"}
    assert touch.read({}) == frozenset()
