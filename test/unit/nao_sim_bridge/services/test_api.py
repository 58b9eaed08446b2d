"""The published interface: types, overloads, and one table for all modules."""

from __future__ import annotations

import pytest

from nao_sim_bridge.paths import config_file
from nao_sim_bridge.services.api import COMMON, EXTRACTOR, FILE, Overload, module_methods, qi_type
from nao_sim_bridge.sim.config import read_json
from nao_sim_bridge.sim.errors import ConfigError

MODULES = [name for name in read_json(config_file(FILE)) if not name.startswith("_")]


@pytest.mark.parametrize(
    "name, code",
    [
        ("void", "v"),
        ("bool", "b"),
        ("int", "i"),
        ("float", "f"),
        ("string", "s"),
        ("ALValue", "m"),
        ("object", "o"),
        ("list<string>", "[s]"),
        ("list<list<float>>", "[[f]]"),
        ("map<string,string>", "{ss}"),
        ("map<string,list<int>>", "{s[i]}"),
        ("pair<string,int>", "(si)"),
        ("tuple<string,string,list<string>>", "(ss[s])"),
        ("list<tuple<string,map<string,int>>>", "[(s{si})]"),
    ],
)
def test_types_become_codes_of_libqi(name, code):
    assert qi_type(name) == code


@pytest.mark.parametrize("name", ["text", "list<text>", "list<>", "map<string>", "tuple<>", "pair<int>", ""])
def test_unknown_types_are_refused(name):
    with pytest.raises(ConfigError, match=f"{FILE}: unknown type"):
        qi_type(name)


def test_an_overload_is_a_signature_and_a_text():
    overload = Overload(("string", "list<float>"), ("name", "values"))
    assert overload.signature == "(s[f])"
    assert str(overload) == "string name, list<float> values"
    assert Overload((), ()).signature == "()"


@pytest.mark.parametrize("module", MODULES)
def test_every_method_of_every_module_can_be_published(module):
    methods = module_methods(module)
    assert set(module_methods(COMMON)) <= set(methods)
    for method in methods.values():
        assert qi_type(method.returns)
        assert method.overloads and method.summary
        signatures = [overload.signature for overload in method.overloads]
        assert len(set(signatures)) == len(signatures), f"{method.name} has an overload twice"
        for overload in method.overloads:
            assert len(overload.types) == len(overload.names)
            assert all(overload.names)


def test_usage_shows_every_way_to_call_a_method():
    assert module_methods("ALLeds")["fadeRGB"].usage().splitlines() == [
        "void fadeRGB(string name, float red, float green, float blue, float duration)",
        "void fadeRGB(string name, string colorName, float duration)",
        "void fadeRGB(string name, int rgb, float duration)",
    ]


def test_extractors_have_the_methods_of_all_extractors():
    shared = set(module_methods(EXTRACTOR))
    assert {"subscribe", "unsubscribe", "getSubscribersInfo"} <= shared
    assert shared <= set(module_methods("ALSoundLocalization"))
    assert not shared <= set(module_methods("ALMotion"))


def test_an_unknown_module_is_refused():
    with pytest.raises(ConfigError, match="no module 'ALLed'"):
        module_methods("ALLed")
