"""What came over the wire against the types of NAOqi's table."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.services.api import Method, Overload
from nao_sim_bridge.services.errors import NaoqiError
from nao_sim_bridge.services.wire_types import fitted, fitted_to
from nao_sim_bridge.sim.errors import BadValue

NO_TEXT = [None, 1, 1.5, True, [], ["a"], {"a": "b"}]
NO_NUMBER = [None, "", "1", [], [1], {}]


def method(*overloads):
    return Method("go", tuple(Overload(types, tuple("abc"[: len(types)])) for types in overloads), "void", "goes")


@pytest.mark.parametrize(
    "kind, right, wrong, told",
    [
        ("string", ["", "a"], NO_TEXT, "a text"),
        ("bool", [True, False, 0, 1, 1.0], [*NO_NUMBER, math.nan, math.inf, -math.inf], "true or false"),
        (
            "int",
            [0, -1, 2**31 - 1, -(2**31)],
            [*NO_NUMBER, 1.5, -0.1, 2**31, 2.0**31, 1e300, math.nan, math.inf, -math.inf],
            "a whole number",
        ),
        ("float", [0, -1.5, 1e300, True, math.nan], NO_NUMBER, "a number"),
        ("list<string>", [[], ["a", "b"], ("a",)], [None, 1, True, {"a": "b"}, [1], ["a", None]], "list of texts"),
        ("list<float>", [[], [1, 2.5]], [None, 1.0, "a", {1: 2}, ["a"], [[1.0]]], "list of numbers"),
        (
            "map<string,string>",
            [{}, {"a": "b"}],
            [None, "a", ["a"], {"a": 1}, {1: "a"}, {"a": ["b"]}],
            "texts by texts",
        ),
        ("TagForAnimations", [{}, {"a": ["b"]}], [None, "a", {"a": "b"}, {"a": [1]}, {1: ["b"]}], "lists of texts"),
        ("ALValue", [None, "", math.nan, [[]], {}], [], ""),
        ("buffer", [b"", bytearray(b"a")], [], ""),
    ],
)
def test_each_type_takes_what_is_of_it_and_tells_what_is_not(kind, right, wrong, told):
    for value in right:
        assert fitted(method((kind,)), [value])[0] is value
    for value in wrong:
        with pytest.raises(BadValue, match=f"a is .*, allowed is .*{told}"):
            fitted(method((kind,)), [value])


def test_of_overloads_with_as_many_parameters_any_may_be_meant():
    either = method(("string", "int"), ("list<string>", "int"), ("string",))
    fitted(either, ["a", 1])
    fitted(either, [["a"], 1])
    with pytest.raises(BadValue, match="a is 3, allowed is a text or a list of texts"):
        fitted(either, [3, 1])
    with pytest.raises(BadValue, match="a is .*, allowed is a text$"):
        fitted(either, [["a"]])


def test_one_text_for_a_list_of_texts_is_a_list_of_one():
    assert fitted(method(("list<string>", "int")), ["a", 1]) == [["a"], 1]
    assert fitted(method(("list<string>",), ("string",)), ["a"]) == ["a"], "a text may be meant"
    assert fitted_to(["names"], ["[s]"], ["a"]) == [["a"]]


@pytest.mark.parametrize(
    "value, whole", [(2.0, 2), (-3.0, -3), (-0.0, 0), (2.0**31 - 1.0, 2**31 - 1), (True, 1), (False, 0)]
)
def test_a_whole_number_is_handed_on_as_one(value, whole):
    for found in (fitted(method(("int",)), [value]), fitted_to(["a"], ["i"], [value])):
        assert found == [whole]
        assert type(found[0]) is int


def test_arguments_are_those_of_one_overload():
    either = method(("string", "float"), ("int", "string"))
    assert fitted(either, ["a", 1.5]) == ["a", 1.5]
    assert fitted(either, [1.0, "a"]) == [1, "a"]
    with pytest.raises(BadValue, match="b is 'a', allowed is a number$"):
        fitted(either, ["a", "a"])
    with pytest.raises(BadValue, match="b is 1.5, allowed is a text$"):
        fitted(either, [1, 1.5])


def test_of_overloads_that_fit_the_one_counts_that_changes_least():
    assert type(fitted(method(("string", "int"), ("string", "float")), ["a", 2.0])[1]) is float
    assert fitted(method(("int",), ("bool",)), [True])[0] is True
    assert fitted(method(("list<string>", "float"), ("string", "int")), ["a", 2]) == ["a", 2]


def test_another_number_of_arguments_is_told_with_what_is_right():
    with pytest.raises(NaoqiError, match=r"with 3 arguments, allowed is go\(int a\) or go\(int a, int b\)"):
        fitted(method(("int",), ("int", "int")), [1, 2, 3])


def test_types_in_letters_of_libqi():
    fitted_to(["name", "sizes", "any"], ["s", "[f]", "m"], ["a", [1.0], None])
    with pytest.raises(BadValue, match="sizes is 'b', allowed is a list of numbers"):
        fitted_to(["name", "sizes"], ["s", "[f]"], ["a", "b"])
