"""Every text of libqi becomes the error that says what happened."""

from __future__ import annotations

import pytest

from naoqi import errors
from naoqi.translate import CallSite, call_error, closest_names, connect_reason

METHODS = ["setIntensity", "getIntensity", "fade"]


def site(*arguments):
    return CallSite("nao", 9559, "ALLeds", "fade", arguments, lambda: ["fade(string, float)"], lambda: METHODS)


def error_of(text, *arguments):
    return call_error(RuntimeError(text), site(*arguments))


@pytest.mark.parametrize(
    "text, kind",
    [
        ("Session closed", errors.ConnectionLost),
        ("Service removed", errors.ConnectionLost),
        ("Socket is not connected", errors.RobotUnreachable),
        ("Future canceled.", errors.CallCanceled),
        ("Call has been canceled.", errors.CallCanceled),
        ("Can't find method: fade (resolved to '()')\n", errors.UnknownMethod),
        (
            "Arguments types did not match for fade (resolved to '(s)'):\n  Candidate:\n  fade::(sff) (1)\n",
            errors.BadArguments,
        ),
        (
            "Call argument number 1 conversion failure from String to Float. Function signature: (sf).",
            errors.BadArguments,
        ),
        ("motor too hot", errors.RobotError),
    ],
)
def test_each_text_has_its_error(text, kind):
    assert type(error_of(text)) is kind


def test_a_text_about_another_method_is_the_robots_own_trouble():
    text = "Arguments types did not match for say (resolved to '(i)'):\n  Candidate:\n  say::(s) (1)\n"
    assert type(error_of(text)) is errors.RobotError


def test_only_libqis_own_kind_of_error_speaks_about_signatures():
    text = "Arguments types did not match for fade (resolved to '(s)'):\n  fade::(sff) (1)"
    assert type(error_of(f"RuntimeError: {text}\n\nAt:\n  /x.py(3): fade\n")) is errors.BadArguments
    assert type(error_of(f"ValueError: {text}\n\nAt:\n  /x.py(3): fade\n")) is errors.RobotError


def test_libqis_words_out_of_the_mouth_of_a_service_do_not_mean_our_connection():
    error = error_of("RuntimeError: Session closed\n\nAt:\n  /x.py(3): fade\n")
    assert type(error) is errors.RobotError


def test_the_candidates_of_libqi_are_listed_in_words():
    error = error_of(
        "Arguments types did not match for fade (resolved to '(s)'):\n  Candidates:\n"
        "  fade::(sff) (1)\n  fade::(s[f]) (1)\n",
        "FaceLeds",
    )
    assert error.signatures == ["fade(string, float, float)", "fade(string, list of float)"]
    assert error.given == ("FaceLeds",)
    assert "fade(string, list of float)" in str(error)
    assert "'FaceLeds'" in str(error)


def test_the_class_name_and_trace_of_a_python_service_are_set_apart():
    error = error_of("ValueError: joint Tail\nis unknown\n\nAt:\n  /x.py(3): fade\n  /y.py(1): g\n")
    assert (error.kind, error.text) == ("ValueError", "joint Tail\nis unknown")
    assert "/x.py(3): fade" in error.trace
    assert str(error) == "ALLeds.fade failed: joint Tail\nis unknown"


def test_an_exception_without_text_is_named_by_its_class():
    assert "StopIteration" in str(error_of("StopIteration: \n\nAt:\n  /x.py(3): fade\n"))


def test_an_argument_that_libqi_refuses_is_named():
    error = error_of("Unable to cast Python instance of type <class 'int'>", 2**70)
    assert type(error) is errors.BadArguments
    assert "64 bits" in error.reason


@pytest.mark.parametrize(
    "text, word",
    [
        ("Connect error: 111: Connection refused", "refused"),
        ("Connect error: 1: Host not found (authoritative)", "name of the host"),
        ("Connect error: 113: No route to host", "no route"),
        ("Connect error: 110: Connection timed out", "no answer"),
        ("something new", "something new"),
    ],
)
def test_reasons_of_failed_connections_come_with_advice(text, word):
    reason, check = connect_reason(text)
    assert word in reason
    assert check


def test_closest_names_ignore_case_and_come_best_first():
    assert closest_names("setintensity", METHODS)[0] == "setIntensity"
    assert closest_names("walk", METHODS) == []


@pytest.mark.parametrize("kind", [value for value in vars(errors).values() if isinstance(value, type)])
def test_the_family_is_one_and_is_runtime_error(kind):
    if kind.__module__ == errors.__name__:
        assert issubclass(kind, errors.NaoError)
        assert issubclass(kind, RuntimeError)
