"""Colours by name and as numbers."""

from __future__ import annotations

import json

import pytest

from nao_library_modules.colours import from_integer, named_colours, parse_colour, read_colours, to_integer
from nao_library_modules.errors import BadGoal


@pytest.mark.parametrize(
    "text, colour",
    [
        ("green", (0, 1, 0)),
        (" Yellow ", (1, 1, 0)),
        ("off", (0, 0, 0)),
        ("#FF0000", (1, 0, 0)),
        ("0x0000ff", (0, 0, 1)),
        ("#336699", (0.2, 0.4, 0.6)),
    ],
)
def test_colours_as_text(text, colour):
    assert parse_colour(text) == pytest.approx(colour)


@pytest.mark.parametrize("text", ["#FFF", "0xGG0000", "", "FF0000", "#FF0000 #00FF00"])
def test_other_texts_are_refused_with_what_is_allowed(text):
    with pytest.raises(BadGoal, match="'#RRGGBB', '0xRRGGBB' or one of white, red"):
        parse_colour(text)


def test_a_mistyped_name_is_recognised():
    with pytest.raises(BadGoal, match="unknown colour 'grean': did you mean 'green'"):
        parse_colour("grean")


@pytest.mark.parametrize("rgb", [0x000000, 0xFFFFFF, 0x123456, 0x00FF80])
def test_integers_survive_the_round_trip(rgb):
    assert to_integer(from_integer(rgb)) == rgb


def test_the_names_of_the_robot_are_there():
    assert set("white red green blue yellow magenta cyan".split()) <= set(named_colours())


@pytest.mark.parametrize("entry", [[1, 0], [0, 0, 2]])
def test_a_table_with_a_wrong_entry_is_refused(tmp_path, entry):
    path = tmp_path / "colours.json"
    path.write_text(json.dumps({"odd": entry}))
    with pytest.raises(ValueError, match="odd"):
        read_colours(path)
