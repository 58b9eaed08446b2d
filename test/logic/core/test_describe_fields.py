"""What comments of messages and words of refusals say about fields, and about the functions that they name."""

from __future__ import annotations

import math

import pytest

from nao_library_modules.describe_fields import NO_UNIT, FieldHelp, read_fields
from nao_library_modules.describe_limits import limits, told_by, words

DEFINITION = """\
# A message. Fields that a function does not use are ignored.

string function       # which one
duration time         # how long (all functions)
string str_param      # a posture (goTo), a pose file (setPose), a leg (wb...), a frame (walkTo; empty: the robot's), or
                      # the argument of a memory function
float64[] angles      # rad. setAngles, setPose: one each. spread: all of the first, then those of the second, ...
                      # relax: stiffnesses 0..1 in the same way
float64 volume        # 0..1; of this sound only (play). Of everything: 0..100 % (setMaster)
float64 bare
float64[] values      # lookAt: x y z (m). Walks: x y theta (m, rad), again for each point (walkTo)
string file           # the file to write (spread) or to hear (relax): below a folder; a name (play)
bool enable           # set...Enabled: on or off
geometry_msgs/Pose pose # where
================================================================================
MSG: geometry_msgs/Pose
float64 hidden # not of this message
"""
FUNCTIONS = (
    "goTo setPose wbFoot walkTo setAngles spread relax play setMaster lookAt setFallEnabled getData walk_to".split()
)


def test_a_function_is_told_what_is_meant_for_it_only_and_its_unit():
    fields = read_fields(DEFINITION)
    names = "function time str_param angles volume bare values file enable pose".split()
    assert list(fields) == names and (fields["angles"].type, fields["bare"].text) == ("float64[]", "")
    assert fields["angles"].text.endswith("relax: stiffnesses 0..1 in the same way")
    helps = FieldHelp(fields, FUNCTIONS, {"getData"})
    for field, function, text in (
        ("str_param", "goTo", "a posture"), ("str_param", "wbFoot", "a leg"),
        ("str_param", "walkTo", "a frame (empty: the robot's)"),
        ("str_param", "walk_to", "a frame (empty: the robot's)"),
        ("str_param", "getData", "the argument of a memory function"), ("angles", "setAngles", "rad; one each"),
        ("angles", "spread", "rad; all of the first, then those of the second, ..."),
        ("volume", "play", "0..1; of this sound only"), ("values", "lookAt", "x y z (m)"),
        ("values", "walkTo", "x y theta (m, rad), again for each point"), ("enable", "setFallEnabled", "on or off"),
        ("file", "relax", "to hear; below a folder"), ("file", "play", "a name"), ("time", "goTo", "how long"),
        ("pose", "goTo", "where"), ("values", "goTo", fields["values"].text),
    ):  # fmt: skip
        assert helps.help(field, function) == text
    for field, function, allowed, unit in (
        ("time", "goTo", "", "s"), ("angles", "setAngles", "", "rad"), ("angles", "relax", "", NO_UNIT),
        ("volume", "play", "", NO_UNIT), ("volume", "setMaster", "", "%"), ("values", "walkTo", "", "m, rad"),
        ("values", "walkTo", "x (m/s) and theta (rad/s)", "m/s, rad/s"), ("bare", "goTo", "", NO_UNIT),
        ("angles", "setAngles", "a whole number 1..20", NO_UNIT), ("str_param", "goTo", "", ""),
        ("enable", "goTo", "", ""), ("pose", "goTo", "", ""),
    ):  # fmt: skip
        assert helps.unit(field, function, allowed) == unit


def test_limits_and_choices_are_read_from_words():
    for text, low, high in (
        ("0..1", 0, 1), ("a whole number 0..100 (%)", 0, 100), ("-1 (left) .. 1 (right)", -1, 1),
        ("50..400 %, or 0 for the robot's own", 0, 400), ("above 0 to 3600 s", 0, 3600),
        ("up to 3600 s, or 0 for the default", 0, 3600), ("0 s or more", 0, math.nan), ("more than 0 s", 0, math.nan),
        ("the name of a file", math.nan, math.nan), ("one of 16000, 22050 (Hz)", math.nan, math.nan),
    ):  # fmt: skip
        assert limits(text) == pytest.approx((low, high), nan_ok=True)
    for text, expected in (
        ("one of a, b", ("a", "b")), ("'#RRGGBB' or one of red, green", ("red", "green")),
        ("for each step one of LLeg, RLeg", ("LLeg", "RLeg")), ("one of Left Arm, b", ()), ("anything", ()),
    ):  # fmt: skip
        assert words(text) == expected
    told = told_by(["at least one", "0..1", "one of a, b"])
    assert (told.text, told.choices) == ("at least one; 0..1; one of a, b", ("a", "b"))
    assert (told.minimum, told.maximum) == (0.0, 1.0)
