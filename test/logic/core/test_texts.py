"""Texts: answers of functions, errors that can be read, the closest names; and files that are written as a whole."""

from __future__ import annotations

import json
import os

import numpy as np
import pytest

from nao_library_modules.core.errors import LONGEST, BadGoal, FunctionFailed, closest, did_you_mean
from nao_library_modules.core.files import FileTrouble, write_whole
from nao_library_modules.core.memory_functions import json_of, text_of, values_of

KNOWN = ["setIntensity", "setColor", "getColor", "LeftFaceLeds", "LeftFaceLed1"]


def test_one_value_is_a_text_and_a_list_gives_one_a_member():
    for value, text in (
        ("as it is", "as it is"), (0.5, "0.5"), (7, "7"), (True, "True"), (None, "None"),
        ([1, [2.5, "x"]], '[1, [2.5, "x"]]'), ({"a": None}, '{"a": null}'),
    ):  # fmt: skip
        assert text_of(value) == text
    for answer, values in (
        (None, []), ("one", ["one"]), (0.5, ["0.5"]), (["a", 1], ["a", "1"]), ([[0.0, 1.0]], ["[0.0, 1.0]"]), ([], []),
    ):  # fmt: skip
        assert values_of(answer) == values


def test_json_takes_what_robots_send():
    assert json_of(b"\x00\xff") == '"00ff"' and "object" in json_of(object())
    assert json.loads(json_of({"angles": np.array([0.5, 1.0])})) == {"angles": [0.5, 1.0]}
    for number in (float("nan"), float("inf"), -float("inf"), np.float64("nan")):
        assert json_of(number) == "null"
        assert (
            json_of([1, number, {"a": (number, b"\x01"), "b": "NaN"}]) == '[1, null, {"a": [null, "01"], "b": "NaN"}]'
        )


def test_a_goal_of_megabytes_has_an_error_that_can_be_read():
    huge = BadGoal("id", "x" * 1000000, "one of a, b", problem=f"there is no stream {'x' * 1000000!r}")
    text = str(FunctionFailed(2, "stopThread", huge))
    assert text.startswith("function 2 (stopThread): field id: there is no stream 'xxx")
    assert text.endswith("xxx': one of a, b") and "characters) ..." in text and len(text) < LONGEST
    other = FunctionFailed(1, "f", BadGoal("count", -1, "0 or more"))
    assert str(other) == "function 1 (f): field count: -1 is not allowed: 0 or more"


def test_the_closest_name_comes_first():
    for typed, known, best in (
        ("setColour", KNOWN, "setColor"), ("SETCOLOR", KNOWN, "setColor"), ("LeftFaceLed", KNOWN, "LeftFaceLeds"),
        # Of equally close names one of many comes last, then the beginning counts.
        ("FaceLed", [*(f"FaceLed{n}" for n in range(8)), "FaceLeds"], "FaceLeds"),
        ("gaze", ["maze", "gate"], "gate"),
    ):  # fmt: skip
        assert closest(typed, known)[0] == best
    assert closest("zzz", KNOWN) == [] and did_you_mean("zzz", KNOWN) == ""
    assert closest("Led", ["Leds", "Led2", "Led1", "Other"]) == ["Leds", "Led2", "Led1"]
    assert len(closest("getColor", KNOWN, count=1)) == 1
    assert did_you_mean("LeftFaceLed", ["LeftFaceLeds"]) == ": did you mean 'LeftFaceLeds'?"


@pytest.mark.parametrize("mask", [0o022, 0o077])
def test_who_may_read_a_file_is_up_to_the_umask(tmp_path, mask):
    former = os.umask(mask)
    try:
        file = write_whole(tmp_path / "photo.jpg", b"")
    finally:
        os.umask(former)
    assert file.stat().st_mode & 0o777 == 0o666 & ~mask


def test_files_are_written_as_a_whole_or_stay_as_they_were(tmp_path):
    file = tmp_path / "new" / "notes.yaml"
    write_whole(file, "größer: 1, a much longer text than the next\n")
    assert file.read_text(encoding="utf-8").startswith("größer: 1")
    write_whole(file, "short\n")
    with pytest.raises(UnicodeEncodeError):
        write_whole(file, "half a character: \ud800")
    assert file.read_text() == "short\n" and list(file.parent.iterdir()) == [file]
    (tmp_path / "folder.yaml").mkdir()
    with pytest.raises(FileTrouble, match=r"folder\.yaml cannot be written: Is a directory"):
        write_whole(tmp_path / "folder.yaml", "text")
    assert not list(tmp_path.glob(".*"))
