"""What docs/behaviors.md shows can be run, and so can what comes with the library."""

from __future__ import annotations

import re
import textwrap
from pathlib import Path

import pytest

from nao_library_modules.behaviors import BehaviorStore, check, problems_of, read
from nao_library_modules.behaviors.step_reader import COMMON, FURTHER, KINDS
from nao_library_modules.paths import config_file

TEXT = (Path(__file__).parents[4] / "docs" / "behaviors.md").read_text(encoding="utf-8")
FILE, TIMELINE = re.findall(r"```yaml\n(.*?)```", TEXT, re.DOTALL)


@pytest.fixture
def store(tmp_path):
    return BehaviorStore(tmp_path, config_file("behaviors"))


def test_the_file_that_is_shown_can_be_run(store, tables):
    check(read(FILE, "shown"), store.load, {"tempo": 2.0, "colour": "red"}, tables)


def test_the_timeline_that_is_shown_can_be_run(store, tables):
    text = "help: x\nparameters: {tempo: {default: 1.0, help: x}}\ndo:\n" + textwrap.indent(TIMELINE, "  ")
    check(read(text, "shown"), store.load, None, tables)


@pytest.mark.parametrize("key", sorted({*COMMON, *KINDS, *(key for keys in FURTHER.values() for key in keys), "at"}))
def test_every_key_is_explained(key):
    assert re.search(rf"`{re.escape(key)}\b", TEXT)


def test_those_of_the_library_can_be_run(store, tables):
    names = store.names()
    assert names
    assert {name: problems_of(lambda name=name: store.load(name), store.load, tables) for name in names} == {
        name: [] for name in names
    }
