"""Types of values, and what becomes of a value in a message of some type."""

from __future__ import annotations

import pytest

from nao_library_modules.driver.memory_values import converted, kind_of, parse_value, type_of


@pytest.mark.parametrize(
    "value, type_, kind",
    [
        (True, "bool", "bool"),
        (3, "int", "int"),
        (2**31, "int", "string"),
        (0.5, "float", "float"),
        ("a", "string", "string"),
        ([1, 2], "int[]", "int[]"),
        ([1, 2**40], "int[]", "string"),
        ([1, 2.5], "float[]", "float[]"),
        (["a", "b"], "string[]", "string[]"),
        ([True, 1.0], "list", "string"),
        ([], "list", "string"),
        ([["Head", True]], "list", "string"),
        ({"a": 1}, "object", "string"),
        (None, "null", "string"),
    ],
)
def test_types_of_values_and_kinds_of_messages(value, type_, kind):
    assert (type_of(value), kind_of(value)) == (type_, kind)


@pytest.mark.parametrize(
    "value, kind, message",
    [
        (1, "float", 1.0),
        (True, "float", 1.0),
        (True, "int", 1),
        (1.5, "int", None),
        (2**31, "int", None),
        (1, "bool", None),
        ("a", "float", None),
        ("a", "string", "a"),
        ([1, "b"], "string", '[1, "b"]'),
        (None, "string", "null"),
        ([1, 2], "float[]", [1.0, 2.0]),
        ([], "int[]", []),
        ([1, "b"], "int[]", None),
        (["a"], "string[]", ["a"]),
        (3, "int[]", None),
    ],
)
def test_values_widen_and_lose_nothing(value, kind, message):
    result = converted(value, kind)
    assert result == message and type(result) is type(message)


def test_what_is_no_json_is_text():
    assert parse_value("[1, 2]") == [1, 2]
    assert parse_value("hello there") == "hello there"
    assert parse_value('"3"') == "3"
