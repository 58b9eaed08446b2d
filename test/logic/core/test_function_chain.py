"""Look-up, binding by name, and checks of whole chains."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from nao_library_modules.core.chain import FunctionChain, checked_by, seconds
from nao_library_modules.core.errors import BadGoal, FunctionFailed, UnknownFunction


class Message:
    """A function message: its fields are its slots, as with generated messages."""

    __slots__ = ["function", "time", "str_param", "names", "speed"]

    def __init__(self, function="move", time=0.0, str_param="", names=(), speed=0.5):
        self.function, self.time, self.str_param, self.names, self.speed = function, time, str_param, names, speed


def arguments(function, **fields):
    """What a function is called with."""
    return FunctionChain({"move": function}).read([Message(**fields)])[0].args


def test_fields_become_arguments_by_name_in_the_order_of_the_parameters():
    class Module:
        def move(self, names):
            return names

    chain = FunctionChain({"move": lambda speed, names: None})
    (step,) = chain.read([Message(names=["LHand"], speed=0.75, time=2.0)])
    assert (step.args, step.position, step.function, step.sleep_time) == ((0.75, ["LHand"]), 1, "move", 2.0)
    assert arguments(Module().move, names=["LArm"]) == (["LArm"],)
    assert arguments(lambda names, times=3, speed=9: None, names=["a"], speed=0.25) == (["a"], 3, 0.25)
    assert arguments(lambda speed, *rest, **options: None, names=["a"]) == (0.5, "", ["a"])
    assert arguments(lambda args: None, names=["a"]) == (["", ["a"], 0.5],)
    with pytest.raises(FunctionFailed, match=r"function 1 \(move\): field velocity.*str_param, names, speed"):
        arguments(lambda velocity: None)


def test_an_unknown_function_names_its_place_and_the_closest_names_or_all():
    table = {"move": print, "setColor": print, "on": print}
    with pytest.raises(FunctionFailed) as caught:
        FunctionChain(table).read([Message(), Message(function="setColour")])
    problem = "unknown function 'setColour': did you mean 'setColor'?"
    assert str(caught.value) == f"function 2 (setColour): {problem}; known are move, on, setColor"
    assert isinstance(caught.value.cause, UnknownFunction) and caught.value.cause.known == ["move", "on", "setColor"]
    chain = FunctionChain(table, "NaoLights")
    with pytest.raises(UnknownFunction) as caught:
        chain.look_up("setColour")
    assert str(caught.value) == f"{problem}; `nao list NaoLights --all` tells all"
    with pytest.raises(UnknownFunction, match="unknown function 'zzz'; `nao list NaoLights --all` tells all"):
        chain.look_up("zzz")
    with pytest.raises(UnknownFunction, match="unknown function 'zzz'; known are move, on, setColor"):
        FunctionChain(table).look_up("zzz")


def test_lists_and_chains_have_a_bound():
    chain = FunctionChain({"move": lambda names: None})
    with pytest.raises(FunctionFailed, match=r"function 2 \(move\): field names: 1001 are too many: at most 1000"):
        chain.read([Message(), Message(names=["ab"] * 1001)])
    with pytest.raises(FunctionFailed, match="field names: 300001 are too many: at most 300000"):
        chain.read([Message(names=[0.5] * 300_001)])
    with pytest.raises(FunctionFailed, match="field str_param: 1000001 characters are too many: at most 1000000"):
        chain.read([Message(str_param="a" * 1_000_001)])
    with pytest.raises(BadGoal, match="field functions: 1001 are too many: at most 1000"):
        chain.read([Message()] * 1001)
    assert len(chain.read([Message()] * 1000)) == 1000


def test_a_text_where_a_list_belongs_is_told_of_as_it_was_meant():
    def check(names):
        for name in names:
            if name != "LArm":
                raise BadGoal("names", name, "LArm", problem=f"unknown {name!r}")

    chain = FunctionChain({"move": checked_by(check)(lambda names: None)})
    for names, text in ((list("LArm"), r"it is a text, and a list is needed: \['LArm'\]"), (["Arm"], "unknown 'Arm'")):
        with pytest.raises(FunctionFailed, match=rf"function 1 \(move\): field names: {text}"):
            chain.read([Message(names=names)])


def test_a_wait_must_be_a_finite_time_and_a_chain_is_not_empty():
    for time in (-0.5, float("nan"), float("inf")):
        with pytest.raises(FunctionFailed, match=r"function 1 \(move\): field time: .* 0\.\.86400 s"):
            arguments(lambda: None, time=time)
    with pytest.raises(BadGoal, match="the chain is empty"):
        FunctionChain({}).read([])
    assert (seconds(SimpleNamespace(to_sec=lambda: 1.5)), seconds(2)) == (1.5, 2.0)


def test_a_check_sees_the_fields_it_names_of_its_module_or_of_what_stands_in_for_it():
    class Module:
        limit = 0.5

        def check_speed(self, speed, context):
            context["checked"] = speed
            if speed > self.limit:
                raise BadGoal("speed", speed, f"0..{self.limit}")

        @checked_by(check_speed)
        def move(self, names, speed):
            raise AssertionError("checking must not run anything")

    chain = FunctionChain({"move": Module().move})
    with pytest.raises(FunctionFailed) as caught:
        chain.read([Message(speed=0.5), Message(speed=0.5), Message(speed=0.75)])
    assert str(caught.value) == "function 3 (move): field speed: 0.75 is not allowed: 0..0.5"
    assert (caught.value.position, caught.value.cause.field) == (3, "speed")
    (binding,) = chain.bind([Message(speed=0.75)])
    context = {}
    binding.run_check(Message(speed=0.75), context, lambda _: SimpleNamespace(limit=1.0))
    assert context == {"checked": 0.75}
    with pytest.raises(BadGoal):
        binding.run_check(Message(speed=0.75), context)
