"""Look-up, binding by name, and checks of whole chains."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from nao_library_modules.errors import BadGoal, FunctionFailed, UnknownFunction
from nao_library_modules.function_chain import FunctionChain, checked_by, seconds


class Message:
    """A function message: its fields are its slots, as with generated messages."""

    __slots__ = ["function", "time", "str_param", "names", "speed"]

    def __init__(self, function="move", time=0.0, str_param="", names=(), speed=0.5):
        self.function = function
        self.time = time
        self.str_param = str_param
        self.names = names
        self.speed = speed


def test_fields_become_arguments_by_name_in_the_order_of_the_parameters():
    chain = FunctionChain({"move": lambda speed, names: None})
    (step,) = chain.read([Message(names=["LHand"], speed=0.75, time=2.0)])
    assert step.args == (0.75, ["LHand"])
    assert (step.position, step.function, step.sleep_time) == (1, "move", 2.0)


def test_a_method_is_bound_without_self():
    class Module:
        def move(self, names):
            return names

    module = Module()
    (step,) = FunctionChain({"move": module.move}).read([Message(names=["LArm"])])
    assert module.move(*step.args) == ["LArm"]


def test_a_parameter_that_is_no_field_keeps_its_default():
    chain = FunctionChain({"move": lambda names, times=3, speed=9: None})
    (step,) = chain.read([Message(names=["a"], speed=0.25)])
    assert step.args == (["a"], 3, 0.25)


def test_a_parameter_that_is_no_field_and_has_no_default_is_an_error_that_lists_the_fields():
    chain = FunctionChain({"move": lambda velocity: None})
    with pytest.raises(FunctionFailed, match=r"function 1 \(move\): field velocity.*str_param, names, speed"):
        chain.read([Message()])


def test_functions_that_take_anything_are_called_with_nothing():
    (step,) = FunctionChain({"move": lambda *args, **options: None}).read([Message()])
    assert step.args == ()


def test_an_entry_can_be_replaced_at_any_time():
    table = {"move": lambda names: None}
    chain = FunctionChain(table)
    assert chain.read([Message(names=["a"])])[0].args == (["a"],)
    table["move"] = lambda speed: None
    assert chain.read([Message(speed=0.1)])[0].args == (0.1,)


def test_an_unknown_function_names_its_place_the_closest_names_and_all():
    chain = FunctionChain({"move": print, "setColor": print, "on": print})
    with pytest.raises(FunctionFailed) as caught:
        chain.read([Message(), Message(function="setColour")])
    assert str(caught.value) == (
        "function 2 (setColour): unknown function 'setColour': did you mean 'setColor'?; known are move, on, setColor"
    )
    assert isinstance(caught.value.cause, UnknownFunction)
    assert caught.value.cause.known == ["move", "on", "setColor"]


def test_an_unknown_function_of_a_server_names_the_closest_or_all():
    chain = FunctionChain({"move": print, "setColor": print}, "NaoLights")
    with pytest.raises(UnknownFunction) as caught:
        chain.look_up("setColour")
    text = "unknown function 'setColour': did you mean 'setColor'?; `nao list NaoLights --all` tells all"
    assert str(caught.value) == text
    with pytest.raises(UnknownFunction, match="unknown function 'zzz'; known are move, setColor"):
        chain.look_up("zzz")


@pytest.mark.parametrize("time", [-0.5, float("nan"), float("inf")])
def test_a_wait_must_be_a_finite_time(time):
    with pytest.raises(FunctionFailed, match=r"function 1 \(move\): field time: .* 0 s or more"):
        FunctionChain({"move": lambda: None}).read([Message(time=time)])


def test_an_empty_chain_is_refused():
    with pytest.raises(BadGoal, match="the chain is empty"):
        FunctionChain({}).read([])


def test_a_check_sees_the_fields_it_names_and_its_error_names_the_function():
    class Module:
        limit = 0.5

        def check_speed(self, speed):
            if speed > self.limit:
                raise BadGoal("speed", speed, f"0..{self.limit}")

        @checked_by(check_speed)
        def move(self, names, speed):
            raise AssertionError("checking must not run anything")

    chain = FunctionChain({"move": Module().move})
    chain.read([Message(speed=0.5)])
    with pytest.raises(FunctionFailed) as caught:
        chain.read([Message(speed=0.5), Message(speed=0.5), Message(speed=0.75)])
    assert str(caught.value) == "function 3 (move): field speed: 0.75 is not allowed: 0..0.5"
    assert (caught.value.position, caught.value.cause.field) == (3, "speed")


def test_a_check_can_be_run_with_something_in_place_of_its_module():
    class Module:
        limit = 0.5

        def check_speed(self, speed, context):
            context["checked"] = speed
            if speed > self.limit:
                raise BadGoal("speed", speed, f"0..{self.limit}")

        @checked_by(check_speed)
        def move(self, names, speed):
            raise AssertionError("checking must not run anything")

    context = {}
    (binding,) = FunctionChain({"move": Module().move}).bind([Message(speed=0.75)])
    binding.run_check(Message(speed=0.75), context, SimpleNamespace(limit=1.0))
    assert context == {"checked": 0.75}
    with pytest.raises(BadGoal):
        binding.run_check(Message(speed=0.75), context)


def test_a_check_knows_what_earlier_functions_of_the_same_chain_define_and_of_no_other():
    def check_define(str_param, context):
        context.setdefault("defined", set()).add(str_param)

    def check_use(str_param, context):
        if str_param not in context.get("defined", ()):
            raise BadGoal("str_param", str_param, "a name defined before")

    define = checked_by(check_define)(lambda str_param: None)
    use = checked_by(check_use)(lambda str_param: None)
    chain = FunctionChain({"define": define, "use": use})
    chain.read([Message(function="define", str_param="a"), Message(function="use", str_param="a")])
    with pytest.raises(FunctionFailed, match=r"function 1 \(use\)"):
        chain.read([Message(function="use", str_param="a"), Message(function="define", str_param="a")])


def test_a_typo_is_found_before_any_check_asks_the_robot():
    asked = []
    look = checked_by(lambda names: asked.append(names))(lambda names: None)
    with pytest.raises(FunctionFailed, match=r"function 2 \(loook\)"):
        FunctionChain({"look": look}).read([Message(function="look"), Message(function="loook")])
    assert asked == []


def test_seconds_takes_ros_durations_and_numbers():
    assert seconds(SimpleNamespace(to_sec=lambda: 1.5)) == 1.5
    assert seconds(2) == 2.0
