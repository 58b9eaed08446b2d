"""What functions declare of their fields, and who reads it."""

from __future__ import annotations

from functools import partial
from typing import List

import pytest
import readme_tables
from genpy import Duration

from nao_library_actions.msg import NaoLedAction
from nao_library_modules.behaviors.server_functions import FunctionTables
from nao_library_modules.cli import stack
from nao_library_modules.cli.stack import described_by_code
from nao_library_modules.core import fields
from nao_library_modules.core.chain import BoundFunction, FunctionChain, checked_by, declared_fields
from nao_library_modules.core.describe import Description
from nao_library_modules.core.errors import BadGoal, FunctionFailed
from nao_library_modules.core.fields import Annotated, Field, fields_of
from nao_library_modules.core.server_types import server_type
from nao_library_modules.lights.lights_server import NaoLights
from nao_library_msgs.msg import LedFunction

NAN, INF = float("nan"), float("inf")
Times = Annotated[List[float], fields.numbers((0.1, 5.0), "how long each is lit", "s")]
Lights = Annotated[List[str], fields.free("what blinks", choices=("Eyes", "Ears"))]
Angle = Annotated[int, fields.whole(0, 3, "quarters of a turn")]


def no_more_lights_than_times(self, lights, times, angle: Angle):
    if len(lights) > len(times):
        raise BadGoal("times", times, "one a light")


@checked_by(no_more_lights_than_times)
def blink(self, lights: Lights, times: Times, revert: bool) -> list[float]:
    """Blink once for each time."""


@pytest.mark.parametrize(
    ("field", "good", "bad", "allowed"),
    [
        (fields.number((0.5, 2), "", "m"), [0.5, 2], [0.0, 0.49, 2.01, NAN, INF], "0.5..2 m"),
        (fields.number((0.5, 2), "", zero=": the default"), [0.0, 1.0], [-0.1, 0.4], "0.5..2, or 0: the default"),
        (fields.number("duration", ""), [0.001, 86400], [0.0, 86401], "0.001..86400 s"),
        (fields.number((0, 1), "", allowed="a share"), [1], [2], "a share"),
        (fields.numbers((0, 1), "", allowed="each within 0..1"), [[], [0.0, 1.0]], [[0.0, 1.5]], "each within 0..1"),
        (fields.whole(1, 3, "", "times"), [1, 3.0], [0, 1.5, NAN], "a whole number 1..3 times"),
        (fields.moments((0.1, 9), ""), [[0.1, 9]], [[], [1, 1], [2, 1], [0.0]], "above 0 and rising, from 0.1 to 9"),
        (fields.word(("a", "b"), ""), ["a", " b "], ["", "c"], "one of a, b"),
        (fields.word(("a", "b"), "", empty="a"), ["", "b"], ["c"], "one of a, b; empty: a"),
        (fields.text("a name", ""), ["x"], ["", "  "], "a name"),
        (fields.free("", "m"), [INF, None], [], ""),
        (fields.flag(""), [True], [], ""),
    ],
)  # fmt: skip
def test_a_field_takes_what_it_declares_and_says_so(field, good, bad, allowed):
    assert field.allowed == allowed
    for value in good:
        field.require("it", value)
    for value in bad:
        with pytest.raises(BadGoal, match="field it: "):
            field.require("it", value)


def test_what_is_declared_is_read_from_the_names_of_annotations_of_function_and_check():
    names = LedFunction.__slots__
    assert list(fields_of(blink, names)) == ["lights", "times"], "a plain annotation declares nothing"
    assert list(fields_of(blink, ["times"])) == ["times"]
    assert fields_of(lambda lights: lights, names) == {}
    binding = FunctionChain({"blink": blink.__get__(object())}).bind_one(LedFunction(function="blink", times=[1.0]))
    assert list(binding.fields) == ["lights", "times", "angle"]


class Blinker:
    def __call__(self, times: Times, *, angle: Angle = 0):
        pass


def dotted(lights: fields.Angle, times: "Times"):
    pass


def unnamed(times: Annotated[List[float], fields.flag("")]):
    pass


@pytest.mark.parametrize(
    ("function", "declared"),
    [(partial(blink, None, []), ["times"]), (Blinker(), ["times"]), (dotted, ["lights", "times"]), (unnamed, [])],
)
def test_declarations_of_any_callable_are_read(function, declared, monkeypatch, caplog):
    monkeypatch.setattr(fields, "Angle", Angle, raising=False)
    assert list(fields_of(function, LedFunction.__slots__)) == declared
    assert [record.args[0] for record in caplog.records] == ([] if declared else ["times"]), (
        "what cannot be read is told"
    )


def test_what_a_function_declares_counts_before_what_its_check_does():
    def check(self, times: Angle):
        pass

    assert declared_fields(checked_by(check)(dotted), LedFunction.__slots__)["times"].unit == "s"


def test_a_duration_is_checked_in_seconds():
    seen = []

    class Message:
        __slots__ = ("hold",)

    def glow(hold):
        pass

    glow.__annotations__["hold"] = Annotated[float, Field("", check=lambda _, value: seen.append(value))]
    message = Message()
    message.hold = Duration(1.5)
    BoundFunction(glow, Message).check_fields(message)
    assert seen == [1.5]


def test_a_derived_field_differs_in_what_was_changed():
    number = fields.number((0, 1), "a share")
    other = number.but(help="another share")
    assert (other.help, other.maximum, other.check) == ("another share", 1, number.check)


@pytest.fixture
def with_blink(monkeypatch):
    """NaoLights with one function more, declared in one place."""
    monkeypatch.setattr(NaoLights, "functions", {**NaoLights.functions, "blink": blink})
    # What is remembered does not have it.
    monkeypatch.setattr(stack, "_servers_of_code", stack._servers_of_code.__wrapped__)


def test_a_function_that_is_declared_once_is_known_to_all_who_read_declarations(with_blink):
    lights = server_type("NaoLights")
    wrong, right = ([LedFunction(function="blink", lights=["Eyes"], times=times)] for times in ([9.0], [1.0]))

    chain = FunctionChain({"blink": blink.__get__(object())})
    with pytest.raises(FunctionFailed, match=r"function 1 \(blink\): field times: 9.0 is not allowed: 0.1..5 s"):
        chain.read(wrong)
    assert [step.args for step in chain.read(right)] == [(["Eyes"], [1.0], False)]

    known = FunctionTables()
    assert known.fields(lights, "blink") == ["lights", "times", "revert", "time", "on_error"]
    ((failed,), _) = known.check(lights, wrong)
    assert failed.cause.field == "times" and known.check(lights, right) == ([], [])

    ((_, response),) = described_by_code("NaoLights", functions=["blink"])
    ((function),) = response.functions
    assert (function.help, function.answers) == ("Blink once for each time.", "list of number")
    times = next(argument for argument in function.arguments if argument.name == "times")
    assert (times.unit, times.minimum, times.maximum, times.help) == ("s", 0.1, 5.0, "how long each is lit")
    assert list(function.arguments[0].choices) == ["Eyes", "Ears"], "what a shell completes"

    (server,) = (found for found in readme_tables.find_servers() if found.name == "NaoLights")
    assert (
        "| `blink` | `lights`, `times`, `revert`, `angle` | Blink once for each time. |"
        in readme_tables.functions_table(server.functions)
    )


def test_a_plain_callable_is_described_as_well():
    def wink(lights, i_values, **_more):
        """Wink."""

    (described,) = Description({"wink": wink}, NaoLights, NaoLedAction).functions()
    assert [(a.name, a.type, a.allowed) for a in described.arguments] == [
        ("lights", "string[]", ""),
        ("i_values", "float64[]", ""),
    ]
