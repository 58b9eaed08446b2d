"""libqi's signatures in words."""

from __future__ import annotations

import pytest

from naoqi.signatures import mentions_raw, readable_call, readable_type


@pytest.mark.parametrize(
    "signature, words",
    [
        ("s", "string"),
        ("[f]", "list of float"),
        ("{s[i]}", "map of string to list of int"),
        ("(sf)", "(string, float)"),
        ("[(sf)<Led,name,value>]", "list of (string, float)"),
        ("({s(ii)<Pair<int,int>,a,b>}b)", "(map of string to (int, int), bool)"),
        ("#m", "any number of any value"),
        ("?", "?"),
        ("(s", "(s"),
        ("ss", "ss"),
    ],
)
def test_types_are_readable(signature, words):
    assert readable_type(signature) == words


@pytest.mark.parametrize(
    "parameters, words",
    [
        ("()", "say()"),
        ("(sf)", "say(string, float)"),
        ("m", "say(...)"),
        ("(m)", "say(any value)"),
        ("(?)", "say(?)"),
    ],
)
def test_calls_are_readable(parameters, words):
    assert readable_call("say", parameters) == words


@pytest.mark.parametrize(
    "signature, raw", [("(r)", True), ("([(ir)])", True), ("(s)<Frame,raw>", False), ("(s)", False)]
)
def test_raw_data_are_seen_but_not_in_names(signature, raw):
    assert mentions_raw(signature) is raw
