"""NAOqi's interface as a table, and what came over the wire against its types."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.base.errors import BadValue, ConfigError
from nao_sim_bridge.naoqi.binding.api import FILE, Method, Overload, qi_type
from nao_sim_bridge.naoqi.binding.arguments import number, numbers, per_item
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.binding.wire_types import fitted, fitted_to

CODES = {
    "void": "v", "bool": "b", "int": "i", "float": "f", "string": "s", "ALValue": "m", "object": "o",
    "list<string>": "[s]", "list<list<float>>": "[[f]]", "map<string,string>": "{ss}",
    "map<string,list<int>>": "{s[i]}", "pair<string,int>": "(si)", "tuple<string,string,list<string>>": "(ss[s])",
    "list<tuple<string,map<string,int>>>": "[(s{si})]",
}  # fmt: skip
NO_TEXT = [None, 1, 1.5, True, [], ["a"], {"a": "b"}]
NO_NUMBER = [None, "", "1", [], [1], {}]
NO_WHOLE = [*NO_NUMBER, 1.5, -0.1, 2**31, 2.0**31, 1e300, math.nan, math.inf, -math.inf]
INFINITE = [math.nan, math.inf, -math.inf]


def test_types_become_codes_of_libqi_and_unknown_ones_are_refused():
    assert {name: qi_type(name) for name in CODES} == CODES
    for name in ("text", "list<text>", "list<>", "map<string>", "tuple<>", "pair<int>", ""):
        with pytest.raises(ConfigError, match=f"{FILE}: unknown type"):
            qi_type(name)


def method(*overloads):
    return Method("go", tuple(Overload(types, tuple("abc"[: len(types)])) for types in overloads), "void", "goes")


@pytest.mark.parametrize("kind, right, wrong, told", [
    ("string", ["", "a"], NO_TEXT, "a text"),
    ("bool", [True, False, 0, 1, 1.0], [*NO_NUMBER, *INFINITE], "true or false"),
    ("int", [0, -1, 2**31 - 1, -(2**31)], NO_WHOLE, "a whole number"),
    ("float", [0, -1.5, 1e9, True], NO_NUMBER, "a number"),
    ("list<string>", [[], ["a", "b"], ("a",)], [None, 1, True, {"a": "b"}, [1], ["a", None]], "list of texts"),
    ("list<float>", [[], [1, 2.5]], [None, 1.0, "a", {1: 2}, ["a"], [[1.0]]], "list of numbers"),
    ("map<string,string>", [{}, {"a": "b"}], [None, "a", ["a"], {"a": 1}, {1: "a"}, {"a": ["b"]}], "texts by texts"),
    ("TagForAnimations", [{}, {"a": ["b"]}], [None, "a", {"a": "b"}, {"a": [1]}, {1: ["b"]}], "lists of texts"),
    ("ALValue", [None, "", [[]], {}], [], ""),
    ("buffer", [b"", bytearray(b"a")], [], ""),
])  # fmt: skip
def test_each_type_takes_what_is_of_it_and_tells_what_is_not(kind, right, wrong, told):
    for value in right:
        assert fitted(method((kind,)), [value])[0] is value
    for value in wrong:
        with pytest.raises(BadValue, match=f"a is .*, allowed is .*{told}"):
            fitted(method((kind,)), [value])


def test_whole_numbers_and_single_texts_are_made_what_they_stand_for():
    for value, whole in ((2.0, 2), (-3.0, -3), (-0.0, 0), (2.0**31 - 1.0, 2**31 - 1), (True, 1), (False, 0)):
        for found in (fitted(method(("int",)), [value]), fitted_to(["a"], ["i"], [value])):
            assert found == [whole] and type(found[0]) is int
    assert fitted(method(("list<string>", "int")), ["a", 1]) == [["a"], 1]
    assert fitted(method(("list<string>",), ("string",)), ["a"]) == ["a"]  # a text may be meant
    assert fitted_to(["names"], ["[s]"], ["a"]) == [["a"]]
    fitted_to(["name", "sizes", "any"], ["s", "[f]", "m"], ["a", [1.0], None])
    with pytest.raises(BadValue, match="sizes is 'b', allowed is a list of numbers"):
        fitted_to(["name", "sizes"], ["s", "[f]"], ["a", "b"])


def test_arguments_are_those_of_one_overload_the_one_that_changes_least():
    either = method(("string", "float"), ("int", "string"))
    assert fitted(either, ["a", 1.5]) == ["a", 1.5] and fitted(either, [1.0, "a"]) == [1, "a"]
    texts = method(("string", "int"), ("list<string>", "int"), ("string",))
    assert fitted(texts, ["a", 1]) == ["a", 1] and fitted(texts, [["a"], 1]) == [["a"], 1]
    for function, arguments, told in (
        (either, ["a", "a"], "b is 'a', allowed is a number$"),
        (either, [1, 1.5], "b is 1.5, allowed is a text$"),
        (texts, [3, 1], "a is 3, allowed is a text or a list of texts"),
        (texts, [["a"]], "a is .*, allowed is a text$"),
    ):
        with pytest.raises(BadValue, match=told):
            fitted(function, arguments)
    assert type(fitted(method(("string", "int"), ("string", "float")), ["a", 2.0])[1]) is float
    assert fitted(method(("int",), ("bool",)), [True])[0] is True
    assert fitted(method(("list<string>", "float"), ("string", "int")), ["a", 2]) == ["a", 2]
    with pytest.raises(NaoqiError, match=r"with 3 arguments, allowed is go\(int a\) or go\(int a, int b\)"):
        fitted(method(("int",), ("int", "int")), [1, 2, 3])


def test_numbers_are_checked_by_name_place_and_range():
    for value in (0, 0.5, 1):
        assert number(value, "speed", 0.0, 1.0) == value and isinstance(number(value, "speed", 0.0, 1.0), float)
    assert numbers([1, 2.5], "force") == [1.0, 2.5]
    assert [per_item(value, 3, "angles") for value in (0.5, [0.5], [1, 2, 3])] == [[0.5] * 3, [0.5] * 3, [1, 2, 3]]
    for wrong in (True, "0.5", None, [0.5], math.nan, math.inf):
        with pytest.raises(BadValue, match="speed is .*, allowed is a finite number"):
            number(wrong, "speed")
    for call, told in (
        (lambda: number(1.5, "speed", 0.0, 1.0), "speed is 1.5, allowed is 0 to 1"),
        (lambda: number(-1, "speed", 0.0, math.inf), "speed is -1, allowed is 0 or more"),
        (lambda: numbers([1.0, "x"], "force"), r"force\[1\] is 'x'"),
        (lambda: numbers(3, "force"), "force is 3, allowed is a list of numbers"),
        *((lambda v=v: per_item(v, 3, "angles"), "angles is .* one number or 3, one for each") for v in ([], [1, 2])),
    ):
        with pytest.raises(BadValue, match=told):
            call()
