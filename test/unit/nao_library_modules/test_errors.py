"""Texts of errors of a goal."""

from __future__ import annotations

from nao_library_modules.errors import LONGEST, BadGoal, FunctionFailed


def test_a_goal_of_megabytes_has_an_error_that_can_be_read():
    huge = BadGoal("id", "x" * 1000000, "one of a, b", problem=f"there is no stream {'x' * 1000000!r}")
    text = str(FunctionFailed(2, "stopThread", huge))
    assert text.startswith("function 2 (stopThread): field id: there is no stream 'xxx")
    assert text.endswith("xxx': one of a, b") and "characters) ..." in text
    assert len(text) < LONGEST


def test_other_errors_stay_whole():
    assert str(FunctionFailed(1, "f", BadGoal("count", -1, "0 or more"))) == (
        "function 1 (f): field count: -1 is not allowed: 0 or more"
    )
