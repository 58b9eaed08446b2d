"""What comments of messages say about fields, and about the functions that they name."""

import pytest

from nao_library_modules.describe_fields import NO_UNIT, FieldHelp, read_fields

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
FUNCTIONS = ["goTo", "setPose", "wbFoot", "walkTo", "setAngles", "spread", "relax", "play", "setMaster", "lookAt",
             "setFallEnabled", "getData", "walk_to"]  # fmt: skip


@pytest.fixture
def helps():
    return FieldHelp(read_fields(DEFINITION), FUNCTIONS, {"getData"})


def test_fields_come_in_their_order_with_types_and_whole_comments():
    fields = read_fields(DEFINITION)
    assert list(fields) == [
        "function",
        "time",
        "str_param",
        "angles",
        "volume",
        "bare",
        "values",
        "file",
        "enable",
        "pose",
    ]
    assert fields["angles"].type == "float64[]"
    assert fields["angles"].text.endswith("relax: stiffnesses 0..1 in the same way")
    assert fields["bare"].text == ""


@pytest.mark.parametrize(
    "field, function, text",
    [
        ("str_param", "goTo", "a posture"),
        ("str_param", "wbFoot", "a leg"),
        ("str_param", "walkTo", "a frame (empty: the robot's)"),
        ("str_param", "walk_to", "a frame (empty: the robot's)"),
        ("str_param", "getData", "the argument of a memory function"),
        ("angles", "setAngles", "rad; one each"),
        ("angles", "spread", "rad; all of the first, then those of the second, ..."),
        ("volume", "play", "0..1; of this sound only"),
        ("values", "lookAt", "x y z (m)"),
        ("values", "walkTo", "x y theta (m, rad), again for each point"),
        ("enable", "setFallEnabled", "on or off"),
        ("file", "relax", "to hear; below a folder"),
        ("file", "play", "a name"),
        ("time", "goTo", "how long"),
        ("pose", "goTo", "where"),
    ],
)
def test_a_function_is_told_what_is_meant_for_it_only(helps, field, function, text):
    assert helps.help(field, function) == text


def test_a_function_that_nothing_is_said_about_gets_the_whole_comment(helps):
    assert helps.help("values", "goTo") == helps.fields["values"].text


@pytest.mark.parametrize(
    "field, function, allowed, unit",
    [
        ("time", "goTo", "", "s"),
        ("angles", "setAngles", "", "rad"),
        ("angles", "relax", "", NO_UNIT),
        ("volume", "play", "", NO_UNIT),
        ("volume", "setMaster", "", "%"),
        ("values", "walkTo", "", "m, rad"),
        ("values", "walkTo", "x (m/s) and theta (rad/s)", "m/s, rad/s"),
        ("angles", "setAngles", "a whole number 1..20", NO_UNIT),
        ("bare", "goTo", "", NO_UNIT),
        ("str_param", "goTo", "", ""),
        ("enable", "goTo", "", ""),
        ("pose", "goTo", "", ""),
    ],
)
def test_units_come_from_what_is_allowed_then_from_the_comment(helps, field, function, allowed, unit):
    assert helps.unit(field, function, allowed) == unit
