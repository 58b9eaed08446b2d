"""Names of LEDs, of the robot's groups, and of groups that clients make."""

from __future__ import annotations

import pytest

from nao_sim_bridge.services.errors import NaoqiError
from nao_sim_bridge.services.led_names import LedNames
from nao_sim_bridge.sim.errors import UnknownName
from nao_sim_bridge.sim.leds_layout import load_leds

LEDS = load_leds()


@pytest.fixture
def names():
    return LedNames(LEDS)


@pytest.mark.parametrize("name", ["FaceLeds", "LeftFaceLed1", "Brain0", "ChestBoard/Led/Blue/Actuator/Value"])
def test_the_robots_own_names_mean_what_the_layout_says(names, name):
    assert names.devices(name) == LEDS.devices_of(name)


def test_a_made_group_means_its_members_each_once(names):
    names.make_group("mine", ["LeftFaceLed1", "LeftFaceLed1", "FaceLedLeft0", "Brain3"])
    assert names.members("mine") == ["LeftFaceLed1", "LeftFaceLed1", "FaceLedLeft0", "Brain3"]
    assert set(names.devices("mine")) == {*LEDS.devices_of("FaceLedLeft0"), *LEDS.devices_of("Brain3")}
    assert len(names.devices("mine")) == 4
    assert "mine" in names.groups()


def test_groups_may_hold_groups(names):
    names.make_group("eyes", ["FaceLeds"])
    names.make_group("all", ["eyes", "Brain0"])
    assert set(names.devices("all")) == {*LEDS.devices_of("FaceLeds"), *LEDS.devices_of("Brain0")}


def test_a_group_can_be_made_anew(names):
    names.make_group("mine", ["FaceLeds"])
    names.make_group("mine", ["Brain0"])
    assert names.devices("mine") == LEDS.devices_of("Brain0")


@pytest.mark.parametrize(
    "name, members, message",
    [
        ("FaceLeds", ["Brain0"], "'FaceLeds' is taken by the robot's own LEDs"),
        ("Brain0", ["Brain1"], "'Brain0' is taken"),
        ("", ["Brain0"], "'' is taken"),
        ("mine", [], "'mine' has no members"),
    ],
)
def test_impossible_groups_are_refused(names, name, members, message):
    with pytest.raises(NaoqiError, match=message):
        names.make_group(name, members)


def test_a_group_with_an_unknown_member_is_not_made(names):
    with pytest.raises(UnknownName, match="unknown LED or group 'Brian0'.*'Brain0'"):
        names.make_group("mine", ["Brian0"])
    assert "mine" not in names.groups()


@pytest.mark.parametrize("length", [1, 2, 3, 4])
def test_no_group_can_hold_itself_however_long_the_way(names, length):
    chain = [f"group{n}" for n in range(length)]
    names.make_group(chain[0], ["Brain0"])
    for inner, outer in zip(chain, chain[1:]):
        names.make_group(outer, [inner])
    with pytest.raises(NaoqiError, match="'group0' would hold itself"):
        names.make_group("group0", [chain[-1]])
    assert names.devices(chain[-1]) == LEDS.devices_of("Brain0")


def test_listings(names):
    assert len(names.groups()) == 70
    assert len(names.short_names()) == 57
    assert names.device_names("LeftFaceLed1")[0].startswith("Face/Led/Red/Left/")
    assert names.members("FaceLedLeft0") == ["LeftFaceLed1"]


@pytest.mark.parametrize(
    "listing, message",
    [
        (lambda names: names.members("FaceLed"), "unknown group 'FaceLed'.*'FaceLeds'"),
        (lambda names: names.device_names("FaceLeds"), "unknown LED 'FaceLeds'"),
        (lambda names: names.devices("Brian0"), "unknown LED or group 'Brian0'.*'Brain0'"),
    ],
)
def test_unknown_names_offer_the_closest(names, listing, message):
    with pytest.raises(UnknownName, match=message):
        listing(names)
