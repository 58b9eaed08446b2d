"""What goes over the wire, libqi's signatures in words, and its texts as the errors that say what happened."""

from __future__ import annotations

import enum

import numpy as np
import pytest

from naoqi import errors, translate
from naoqi.translate import CallSite, call_error, connect_reason, mentions_raw, readable_call, readable_type

METHODS = ["setIntensity", "getIntensity", "fade"]
FADE = "Arguments types did not match for fade (resolved to '(s)'):\n  Candidates:\n  fade::(sff) (1)\n"
TRACE = "\n\nAt:\n  /x.py(3): fade\n"


class Speed(enum.IntEnum):
    FAST = 3


class Degrees(float):
    pass


def sent(value, raw=False):
    (found,) = translate.to_wire((value,), lambda: raw)
    return found


@pytest.mark.parametrize(
    "given, plain",
    [
        (np.float32(0.5), 0.5),
        (np.bool_(True), True),
        (np.array([[1.0, 2.0], [3.0, 4.0]]), [[1.0, 2.0], [3.0, 4.0]]),
        (Speed.FAST, 3),
        (Degrees(1.5), 1.5),
        ({"a": np.int8(1)}, {"a": 1}),
        ({"a": 1}.keys(), ["a"]),
        (map(float, (1, 2)), [1.0, 2.0]),
        (b"text", "text"),
    ],
)
def test_values_become_plain(given, plain):
    found = sent(given)
    assert found == plain
    assert type(found) is type(plain)
    if isinstance(found, list):
        assert [type(member) for member in found] == [type(member) for member in plain]


def test_raw_bytes_go_where_raw_is_declared_and_what_cannot_go_is_named():
    assert sent(b"\xff\x00", raw=True) == b"\xff\x00"
    for fault, send in (
        ("2 raw bytes", lambda: sent(b"\xff\x00")),
        ("type object", lambda: sent([object()], raw=True)),
        ("64 bits", lambda: translate.check_sendable([1, 2**63])),
        ("Unicode", lambda: translate.check_sendable({"a": "\udcff"})),
    ):
        with pytest.raises(translate.UnsendableError, match=fault):
            send()
    translate.check_sendable([2**63 - 1, -(2**63)])


@pytest.mark.parametrize(
    "came, expected",
    [
        (bytearray(b"\x00\xff"), b"\x00\xff"),
        ((1, (2, bytearray(b"\x02"))), (1, (2, b"\x02"))),
        ({"left": [bytearray(b"\x03")]}, {"left": [b"\x03"]}),
    ],
)
def test_raw_data_become_bytes_at_every_depth(came, expected):
    found = translate.from_wire(came)
    assert found == expected
    assert "bytearray" not in repr(found)


@pytest.mark.parametrize(
    "signature, words",
    [
        ("s", "string"),
        ("[f]", "list of float"),
        ("{s[i]}", "map of string to list of int"),
        ("(sf)", "(string, float)"),
        ("[(sf)<Led,name,value>]", "list of (string, float)"),
        ("({s(ii)<Pair<int,int>,a,b>}b)", "(map of string to (int, int), bool)"),
        ("?", "?"),
    ],
)
def test_types_are_readable(signature, words):
    assert readable_type(signature) == words


def test_calls_are_readable_and_raw_data_are_seen_but_not_in_names():
    words = {"()": "say()", "(sf)": "say(string, float)", "m": "say(...)", "(m)": "say(any value)", "(?)": "say(?)"}
    assert {parameters: readable_call("say", parameters) for parameters in words} == words
    assert [mentions_raw(text) for text in ("(r)", "([(ir)])", "(s)<Frame,raw>", "(s)")] == [True, True, False, False]


# Errors


def error_of(text, *arguments):
    site = CallSite("nao", 9559, "ALLeds", "fade", arguments, lambda: ["fade(string, float)"], lambda: METHODS, "")
    return call_error(RuntimeError(text), site)


@pytest.mark.parametrize(
    "text, kind",
    [
        ("Session closed", errors.ConnectionLost),
        ("Future canceled.", errors.CallCanceled),
        ("Can't find method: fade (resolved to '()')\n", errors.UnknownMethod),
        (FADE, errors.BadArguments),
        (
            "Call argument number 1 conversion failure from String to Float. Function signature: (sf).",
            errors.BadArguments,
        ),
        ("motor too hot", errors.RobotError),
        # About another method, or out of the mouth of a service: the robot's own trouble.
        (FADE.replace("fade", "say"), errors.RobotError),
        (f"RuntimeError: {FADE}{TRACE}", errors.BadArguments),
        (f"RuntimeError: Session closed{TRACE}", errors.RobotError),
    ],
)
def test_each_text_has_its_error(text, kind):
    assert type(error_of(text)) is kind


def test_the_candidates_of_libqi_are_listed_in_words():
    error = error_of(FADE + "  fade::(s[f]) (1)\n", "FaceLeds")
    assert error.signatures == ["fade(string, float, float)", "fade(string, list of float)"]
    assert error.given == ("FaceLeds",)
    assert "fade(string, list of float)" in str(error) and "'FaceLeds'" in str(error)


def test_the_class_name_and_trace_of_a_python_service_are_set_apart():
    error = error_of(f"ValueError: joint Tail\nis unknown{TRACE}  /y.py(1): g\n")
    assert (error.kind, error.text) == ("ValueError", "joint Tail\nis unknown")
    assert "/x.py(3): fade" in error.trace
    assert str(error) == "ALLeds.fade failed: joint Tail\nis unknown"
    error = error_of("ALLeds::fade\n\tno light Tail")
    assert (error.text, str(error)) == ("ALLeds::fade\n\tno light Tail", "ALLeds.fade failed: no light Tail")
    assert str(error_of("ALLeds::fadeRGB no light")) == "ALLeds.fade failed: ALLeds::fadeRGB no light"


def test_an_argument_that_libqi_refuses_is_named():
    error = error_of("Unable to cast Python instance of type <class 'int'>", 2**70)
    assert type(error) is errors.BadArguments and "64 bits" in error.reason


def test_reasons_of_failed_connections_come_with_advice():
    for text, word in (
        ("Connect error: 111: Connection refused", "refused"),
        ("Connect error: 1: Host not found (authoritative)", "name of the host"),
        ("something new", "something new"),
    ):
        reason, check = connect_reason(text)
        assert word in reason and check
