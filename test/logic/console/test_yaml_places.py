"""Edits of a text at places in it: the values are as wanted, and all else stays as it was."""

from __future__ import annotations

import copy
import textwrap
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_library_modules.behaviors.strict_yaml import load
from nao_library_modules.console.timeline import yaml_places as places
from nao_library_modules.core.files import config_file

TEXT = textwrap.dedent("""\
    # What it is about.
    help: A test.   # one line
    do:
      - NaoMotion.wakeUp:
      # about the wait
      - {wait: 0.50, label: "here"}
      - - nao_audio_out.say:
            str_param: 'on'  # a word
            speed: 80
        - wait: 1
      - parallel: [{wait: 1}, {wait: 2}]
    """)
SHIPPED = sorted(Path(config_file("behaviors")).glob("*.yaml"))


def lines(text):
    return text.splitlines()


def test_a_value_changes_and_nothing_else():
    changed = places.set_value(TEXT, ("do", 1, "wait"), 0.75)
    assert changed == TEXT.replace("0.50", "0.75")


def test_quotes_stay_double_where_they_were():
    assert 'label: "there"' in places.set_value(TEXT, ("do", 1, "label"), "there")


def test_words_that_other_readers_take_for_truth_values_are_quoted():
    assert load(places.set_value(TEXT, ("do", 1, "label"), "off"), "t")["do"][1]["label"] == "off"


def test_a_new_key_stands_behind_the_others():
    assert '{wait: 0.50, label: "here", for: 2.0}' in places.set_value(TEXT, ("do", 1, "for"), 2.0)
    changed = places.set_value(TEXT, ("do", 2, 0, "nao_audio_out.say", "volume"), 0.5)
    assert "        speed: 80\n        volume: 0.5\n    - wait: 1" in changed


def test_a_function_without_fields_gets_its_first_one():
    assert "- NaoMotion.wakeUp: {time: 1.0}\n" in places.set_value(TEXT, ("do", 0, "NaoMotion.wakeUp", "time"), 1.0)


def test_a_key_goes_with_its_line_and_no_other():
    changed = places.delete_key(TEXT, ("do", 2, 0, "nao_audio_out.say", "speed"))
    assert lines(changed) == [line for line in lines(TEXT) if "speed" not in line]


def test_a_step_goes_and_comments_stay():
    changed = places.delete_item(TEXT, ("do", 0))
    assert lines(changed) == [line for line in lines(TEXT) if "wakeUp" not in line]
    assert "# about the wait" in changed


def test_the_first_of_a_list_that_begins_on_the_line_of_another_goes():
    changed = load(places.delete_item(TEXT, ("do", 2, 0)), "t")
    assert changed["do"][2] == [{"wait": 1}]


def test_the_only_step_of_a_group_stays():
    text = "do:\n  - parallel: [{wait: 1}]\n"
    with pytest.raises(places.EditRefused, match="only step"):
        places.delete_item(text, ("do", 0, "parallel", 0))


def test_a_step_is_put_above_the_comment_of_the_next():
    changed = places.insert_item(TEXT, ("do",), 1, {"wait": 9})
    assert "wakeUp:\n  - wait: 9\n  # about the wait\n" in changed


def test_a_group_with_steps_is_written_in_lines():
    changed = places.insert_item(TEXT, ("do",), 4, {"label": "both", "parallel": [{"wait": 1}, {"wait": 2}]})
    assert changed.endswith("  - label: both\n    parallel:\n      - {wait: 1}\n      - {wait: 2}\n")


def test_a_moved_step_keeps_its_text():
    changed = places.move_item(TEXT, ("do", 2, 0), ("do",), 0)
    assert "  - nao_audio_out.say:\n      str_param: 'on'  # a word\n      speed: 80\n  - NaoMotion.wakeUp:" in changed


def test_a_step_cannot_be_moved_into_itself():
    with pytest.raises(places.EditRefused, match="into itself"):
        places.move_item(TEXT, ("do", 3), ("do", 3, "parallel"), 0)


def test_a_value_that_an_alias_shares_is_refused_not_changed_twice():
    text = "help: h\ndo:\n  - &one {wait: 1}\n  - *one\n"
    with pytest.raises(places.EditRefused, match="as text"):
        places.set_value(text, ("do", 0, "wait"), 2)


def test_a_place_that_is_gone_is_refused():
    with pytest.raises(places.EditRefused, match="the text has changed"):
        places.set_value(TEXT, ("do", 9, "wait"), 1)


def spots(value, place=()):
    """Places of all mappings' values and of all items."""
    pairs = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, each in pairs:
        yield (*place, key)
        yield from spots(each, (*place, key))


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_every_value_of_the_behaviours_that_come_along_can_be_set(path):
    text = path.read_text(encoding="utf-8")
    content = load(text, "t")
    for place in spots(content):
        changed = places.set_value(text, place, 7.5)
        assert places.value_at(load(changed, "t"), place) == 7.5


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_every_step_of_the_behaviours_that_come_along_can_be_moved_and_deleted(path):
    text = path.read_text(encoding="utf-8")
    content = load(text, "t")
    lists = [place for place in spots(content) if isinstance(places.value_at(content, place), list)]
    for place in lists:
        count = len(places.value_at(content, place))
        for index in range(count) if count > 1 else ():
            assert len(places.value_at(load(places.delete_item(text, (*place, index)), "t"), place)) == count - 1
            moved = places.move_item(text, (*place, index), place, 0)
            assert places.value_at(load(moved, "t"), place)[0] == places.value_at(content, (*place, index))


SCALARS = st.one_of(
    st.floats(0, 9), st.integers(-5, 5), st.booleans(), st.text("ab: #-{}[]',\"\n${}&*!|>%@`öé", max_size=8)
)


@settings(max_examples=150, deadline=None)
@given(st.lists(st.dictionaries(st.sampled_from("abcd"), SCALARS, min_size=1), min_size=2, max_size=4), st.data())
def test_what_is_put_in_is_what_is_read(steps, data):
    text = "help: x\ndo:\n  - wait: 1\n  - wait: 2\n"
    expected = copy.deepcopy(load(text, "t")["do"])
    for step in steps:
        index = data.draw(st.integers(0, len(expected)))
        text = places.insert_item(text, ("do",), index, step)
        expected.insert(index, step)
    key = data.draw(st.sampled_from(sorted(steps[0])))
    value = data.draw(SCALARS)
    where = expected.index(steps[0])
    text = places.set_value(text, ("do", where, key), value)
    expected[where] = {**expected[where], key: value}
    assert load(text, "t")["do"] == expected
