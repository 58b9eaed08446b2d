"""Which behaviours there are, and which one a name means."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.behaviors.installed import InstalledBehaviors
from nao_sim_bridge.sim.behaviors.steps import Behavior, Wait
from nao_sim_bridge.sim.errors import BadValue, UnknownName
from nao_sim_bridge.sim.speech.animations import load_animations

HEY = "animations/Stand/Gestures/Hey_1"


@pytest.fixture
def installed():
    return InstalledBehaviors(load_animations())


def made(*names):
    return [Behavior(name, Wait(1.0)) for name in names]


@pytest.mark.parametrize("name", [HEY, "Hey_1", "Gestures/Hey_1", "User/" + HEY, HEY + "/.", "/" + HEY])
def test_a_behaviour_has_more_than_one_name(installed, name):
    assert installed.resolve(name).name == HEY


def test_a_package_with_one_behaviour_may_stand_for_it(installed):
    installed.install(made("mine/behavior_1"))
    assert installed.resolve("mine").name == "mine/behavior_1"
    installed.install(made("mine/behavior_2"))
    with pytest.raises(BadValue, match="one of 2"):
        installed.resolve("mine")


def test_only_full_names_are_known(installed):
    assert installed.knows(HEY)
    assert not installed.knows("Hey_1")


def test_a_wrong_name_gets_the_nearest_ones(installed):
    with pytest.raises(UnknownName, match="Hey_1"):
        installed.resolve("animations/Stand/Gestures/Hei_1")


def test_what_comes_with_the_robot_stays(installed):
    with pytest.raises(BadValue, match="free"):
        installed.install(made(HEY))
    with pytest.raises(BadValue, match="installed"):
        installed.remove(HEY)


def test_installing_tells_what_is_new_and_removing_takes_the_package(installed):
    assert installed.install(made("a/x", "a/y")) == (["a/x", "a/y"], [])
    assert installed.install(made("a/y", "a/z")) == (["a/z"], ["a/y"])
    with pytest.raises(BadValue, match="free"):
        installed.install(made("a/x"), overwrite=False)
    assert sorted(installed.remove("a")) == ["a/x", "a/y", "a/z"]
    assert installed.user == {}
