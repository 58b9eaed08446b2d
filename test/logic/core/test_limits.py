"""Bounds of the numbers that come in by goals: declared once, and no function takes one that is outside."""

from __future__ import annotations

import math
from types import SimpleNamespace

import pytest
from boundary import EXAMPLES, variants
from trajectory_msgs.msg import JointTrajectoryPoint

from nao_library_modules.core import fields
from nao_library_modules.core.chain import fields_taken
from nao_library_modules.core.describe import offline_servers, read_fields
from nao_library_modules.core.errors import BadGoal
from nao_library_modules.core.fields import fields_of, require_rising
from nao_library_modules.core.goal_checks import check_goals, offline_module
from nao_library_modules.core.joint_trajectory import expand_names, read_trajectory
from nao_library_modules.core.memory_functions import MemoryFunctions
from nao_library_modules.core.server_types import server_type
from nao_library_modules.driver.joints.planar_frames import read_path
from nao_library_modules.driver.walk.nao_footsteps import read_steps
from nao_library_modules.motion.joint_motion import StiffnessFunctions, _key_angles
from nao_library_modules.motion.motion_plan import MotionFacts
from nao_library_modules.motion.walk import WalkFunctions
from nao_library_modules.motion.walk_fields import GaitRange, places, read_gait, steps
from nao_library_msgs.msg import StepTarget

OF_THE_ROBOT = {("setParameter", "values.0"), ("killTask", "values.0")}
"""Numbers of the robot's own: any of 32 bits."""


def test_every_declared_bound_is_a_number_and_tells_where_it_holds():
    for row in fields.table():
        assert math.isfinite(row.lowest) and row.lowest < row.highest < 1e12 and row.where, row


def trajectory(count):
    return SimpleNamespace(joint_names=["Body"], points=[JointTrajectoryPoint()] * count)


BODY = {"Body": [f"J{i}" for i in range(26)]}
FACTS = MotionFacts(BODY, {})
STIFFNESS = SimpleNamespace(body=SimpleNamespace(joints=FACTS.joints))
STEPS = fields_of(WalkFunctions.set_foot_steps, ["names"])
TIMES = [0.01 * i for i in range(1, 20_002)]


@pytest.mark.parametrize(
    "field, call",
    [
        ("joint_names", lambda: expand_names(["J0"] * 1001, BODY)),
        ("trajectory.points", lambda: read_trajectory(trajectory(3847), BODY)),
        ("times", lambda: _key_angles(FACTS, ["Body"], [0.0], TIMES)),
        (
            "times",
            lambda: StiffnessFunctions._check_interpolation(STIFFNESS, ["Body"], [0.5] * len(TIMES), TIMES),
        ),
        ("times", lambda: require_rising("times", TIMES, fields.limit("duration"), fields.limit("poses"))),
        ("values", lambda: places([0.0] * 30_003)),
        ("names", lambda: STEPS["names"].require("names", ["LLeg", "RLeg"] * 501)),
        ("footsteps", lambda: read_steps([StepTarget()] * 1001)),
        ("path.poses", lambda: read_path(SimpleNamespace(poses=[None] * 10_001))),
    ],
)
def test_no_list_is_longer_than_its_declared_bound(field, call):
    with pytest.raises(BadGoal, match=rf"field {field}: \d+ are too many: at most \d+"):
        call()


def given(example):
    """Fields that an example fills, and the one that all functions have."""
    empty = type(example)()
    return {name for name in example.__slots__ if getattr(example, name) != getattr(empty, name)} | {"time"}


def numeric_fields(server, function, message_type):
    fields = read_fields(message_type._full_text)
    taken = fields_taken(server.table[function], message_type.__slots__)
    return [name for name in taken if name != "time" and (fields[name].numeric or name == "trajectory")]


@pytest.mark.parametrize("server", offline_servers(), ids=lambda server: server.name)
def test_every_function_that_takes_numbers_has_an_example(server):
    examples = EXAMPLES[server.name]
    kind = type(examples[0])
    shared = MemoryFunctions.functions
    filled = {name: set() for name in server.table}
    for example in examples:
        filled[example.function] |= given(example)
    lacking = {
        name: missing
        for name in server.table
        if name not in shared
        for missing in [set(numeric_fields(server, name, kind)) - filled[name] - {"frame", "trajectory", "angles"}]
        if missing
    }
    assert lacking == {}


@pytest.mark.parametrize("name", EXAMPLES)
def test_no_function_takes_a_number_that_is_none_or_without_bounds(name):
    module = offline_module(server_type(name).module)
    server = next(server for server in offline_servers() if server.name == name)
    goal = type(server.action().action_goal.goal)
    taken = []
    for example in EXAMPLES[name]:
        fields = {*numeric_fields(server, example.function, type(example)), "time"}
        for place, value, message in variants(example, given(example) & fields):
            where = (example.function, place)
            mad = math.isnan(value) or abs(value) >= (2**31 if where in OF_THE_ROBOT or place == "sound_id" else 1e9)
            if not mad or "header" in place:
                continue
            found = check_goals(module, [goal([message])], elsewhere=name == "NaoMotion")
            named = [p for p in found.problems if p.field.split(".")[0].split("[")[0] == place.split(".")[0]]
            if not named:
                taken.append((example.function, place, value, [str(p) for p in (*found.problems, *found.unchecked)]))
    assert not taken, "\n".join(map(str, taken))


def refusal(check, *values):
    with pytest.raises(BadGoal) as error:
        check(*values)
    return str(error.value)


def test_a_number_out_of_the_bounds_of_its_field_is_refused_with_their_unit():
    wrong, looked_at = [], 0
    for server in offline_servers():
        message = server_type(server.name).function
        for function in server.table:
            for name, field in fields_of(server.table[function], message.__slots__).items():
                if field.unit and field.check and math.isfinite(field.maximum):
                    looked_at += 1
                    value = field.maximum * 2 + 1
                    listed = read_fields(message._full_text)[name].type.endswith("]")
                    told = refusal(field.require, name, [value] if listed else value)
                    if "wx wy wz (Head)" in told:  # it takes a whole pose, so one number is too few
                        told = refusal(field.require, name, [value] * 6)
                    if field.unit.replace("Hz", "frames a second") not in told and field.unit not in told:
                        wrong.append(f"{server.name} {function} {name} ({field.unit}): {told}")
    assert looked_at > 50 and not wrong, "\n".join(wrong)


@pytest.mark.parametrize(
    "place, unit", [((1e3, 0, 0), "m"), ((0, -1e3, 0), "m"), ((0, 0, 90), "rad"), ((0, 0, math.nan), "rad")]
)
def test_of_a_place_x_and_y_are_in_m_and_theta_in_rad(place, unit):
    ways = fields_of(WalkFunctions.move_to, ["values"])["values"]
    assert f"to {100 if unit == 'm' else '3.1417'} {unit}" in refusal(ways.require, "values", place)
    velocity = fields_of(WalkFunctions.move, ["values"])["values"]
    assert f" {unit}/s (" in refusal(velocity.require, "values", place)
    step = [beside + by for beside, by in zip((0.0, 0.1, 0.0), place)]
    assert f" {unit}, seen from the other foot" in refusal(steps, ["LLeg"], step)


@pytest.mark.parametrize(
    "name, unit",
    [("MaxStepX", "m"), ("MaxStepTheta", "rad"), ("TorsoWy", "rad"), ("MaxStepFrequency", "of the highest")],
)
def test_parameters_of_a_walk_are_refused_with_their_unit(name, unit):
    told = refusal(read_gait, [name], [9.0], {name: GaitRange(0.1, 0.0, 0.5)}, False)
    assert told.endswith(f"0 to 0.5 {unit}")
