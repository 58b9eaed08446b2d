"""Every method, called with ever new names and texts: each store comes to its bound."""

import pytest
from amount import part_of
from naoqi_calls import SIMULATION, read_calls
from store_walk import Walk, shrink


@pytest.mark.timeout(900)
@pytest.mark.parametrize("module", part_of([SIMULATION, *read_calls()], 2))
def test_what_a_module_keeps_of_ever_new_texts_comes_to_an_end(robot, module, monkeypatch):
    shrink(monkeypatch)
    found = Walk(robot).module(module)
    print(module, *found, sep="\n  ")
    assert [(str(way), way.wrong) for way in found if way.wrong] == []
