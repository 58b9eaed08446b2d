"""What comments of messages and words of refusals say about fields, and about the functions that they name."""

from __future__ import annotations

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
