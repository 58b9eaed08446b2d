"""Who has which resource: a tree, of which owners have parts."""

from __future__ import annotations

import pytest

from nao_sim_bridge.base.errors import BadValue, UnknownName
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.system.resources import Conflict, ResourceTree


@pytest.fixture
def tree():
    return ResourceTree({"Motors": {"Head": {"HeadYaw": {}, "HeadPitch": {}}, "LArm": {}}, "Leds": {}})


def test_who_has_a_resource_has_all_that_is_in_it(tree):
    tree.take(["Head"], "dance")
    assert tree.owns("HeadYaw", "dance") and not tree.owns("Motors", "dance")
    assert tree.owners() == [["Head", "dance"]]
    for name in ("HeadYaw", "Head", "Motors"):
        assert tree.conflicts([name], "look") == [Conflict("Head", "dance")]
        assert tree.conflicts([name], "dance") == []
    assert tree.conflicts(["LArm", "Leds"], "look") == []


def test_a_group_conflicts_with_each_owner_of_a_part(tree):
    tree.take(["HeadYaw"], "look")
    tree.take(["LArm"], "wave")
    assert [str(conflict) for conflict in tree.conflicts(["Motors"], "dance")] == [
        "HeadYaw belongs to look",
        "LArm belongs to wave",
    ]
    tree.release(["HeadYaw"], "look")
    assert tree.release_all("wave") is True and tree.release_all("wave") is False
    assert tree.conflicts(["Motors"], "dance") == []


def test_what_is_disabled_cannot_be_had_nor_what_is_in_it(tree):
    tree.enable("Head", False)
    assert [str(conflict) for conflict in tree.conflicts(["HeadYaw", "Leds"], "look")] == ["Head is disabled"]
    assert tree.conflicts(["Motors"], "look") == []
    tree.enable("Head", True)
    assert tree.conflicts(["HeadYaw"], "look") == []


def test_resources_are_created_and_deleted(tree):
    tree.create(["Ball", "Goal"], "")
    tree.create(["Skin"], "Ball")
    assert tree.is_in("Ball", "Skin") and not tree.is_in("Ball", "Ball") and not tree.is_in("Skin", "Ball")
    assert tree.tree()[2:] == [["Ball", [["Skin", []]]], ["Goal", []]]
    with pytest.raises(NaoqiError, match="Ball has Skin in it"):
        tree.delete("Ball")
    assert tree.delete("Ball", with_children=True) == ["Ball", "Skin"]
    assert tree.delete("Goal") == ["Goal"]
    assert tree.tree()[2:] == []


def test_what_cannot_be_is_refused_and_changes_nothing(tree):
    before = tree.tree()
    with pytest.raises(BadValue, match="a name that no resource has"):
        tree.create(["Ball", "Leds"], "")
    with pytest.raises(UnknownName, match="unknown resource 'Hed'"):
        tree.create(["Ball"], "Hed")
    with pytest.raises(NaoqiError, match="1000 resources are there at most"):
        tree.create([str(number) for number in range(load_sizes().kept.resources)], "")
    with pytest.raises(NaoqiError, match="Leds comes with the robot"):
        tree.delete("Leds")
    tree.take(["Leds"], "dance")
    with pytest.raises(NaoqiError, match="Leds belongs to dance, not to look"):
        tree.release(["Leds"], "look")
    assert tree.tree() == before and tree.owners() == [["Leds", "dance"]]
