"""Answers of functions as strings."""

from __future__ import annotations

import json

import numpy as np
import pytest

from nao_library_modules.answers import json_of, text_of, values_of


@pytest.mark.parametrize(
    "value, text",
    [
        ("as it is", "as it is"),
        (0.5, "0.5"),
        (7, "7"),
        (True, "True"),
        (None, "None"),
        ([1, [2.5, "x"]], '[1, [2.5, "x"]]'),
        ({"a": None}, '{"a": null}'),
    ],
)
def test_text_of_one_value(value, text):
    assert text_of(value) == text


@pytest.mark.parametrize(
    "answer, values",
    [
        (None, []),
        ("one", ["one"]),
        (0.5, ["0.5"]),
        (["a", 1], ["a", "1"]),
        ([[0.0, 1.0]], ["[0.0, 1.0]"]),
        ([], []),
    ],
)
def test_a_list_gives_one_string_a_member(answer, values):
    assert values_of(answer) == values


def test_json_takes_what_robots_send():
    assert json_of(b"\x00\xff") == '"00ff"'
    assert json.loads(json_of({"angles": np.array([0.5, 1.0])})) == {"angles": [0.5, 1.0]}
    assert "object" in json_of(object())


@pytest.mark.parametrize("number", [float("nan"), float("inf"), -float("inf"), np.float64("nan")])
def test_numbers_that_json_does_not_have_are_null(number):
    assert json_of(number) == "null"
    assert json_of([1, number, {"a": (number, b"\x01"), "b": "NaN"}]) == '[1, null, {"a": [null, "01"], "b": "NaN"}]'
