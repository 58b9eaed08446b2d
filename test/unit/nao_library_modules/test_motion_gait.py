"""Parameters of a walk: asked of the robot once, read from messages, and what they mean for its time."""

from __future__ import annotations

import pytest
from fake_locomotion import RANGES

from nao_library_modules.errors import BadGoal
from nao_library_modules.motion_gait import SETTABLE, GaitAccess, GaitRange, read_gait, walk_time
from nao_library_modules.places import Place

ROWS = {name: GaitRange(*RANGES[name]) for name in SETTABLE}


class FakeMotion:
    def getMoveConfig(self, which):
        column = ("Default", "Min", "Max").index(which)
        return [[name, row[column]] for name, row in RANGES.items()]


def make_access(robot):
    robot.add("ALMotion", FakeMotion())
    return GaitAccess(robot, lambda proxy, method, *args: proxy.call_async(method, *args).result(0))


def test_the_robot_is_asked_once_for_each_connection(robot):
    access = make_access(robot)
    assert access.ranges["MaxStepX"] == GaitRange(0.04, 0.001, 0.08)
    assert access.ranges["TorsoWx"] == GaitRange(0.0, -0.122, 0.122)
    assert len(robot.proxy("ALMotion").calls) == 3
    robot.connection.become("connected")
    assert access.ranges == ROWS
    assert len(robot.proxy("ALMotion").calls) == 6


def test_fixed_parameters_cannot_be_set(robot):
    assert "MinStepPeriod" not in make_access(robot).ranges


def test_the_limits_themselves_are_allowed_as_the_robot_rounds_them():
    ranges = {"MaxStepX": GaitRange(0.04, 0.0010000000475, 0.0799999982)}
    assert read_gait(["MaxStepX"], [0.08], ranges, False) == [["MaxStepX", 0.08]]
    with pytest.raises(BadGoal, match="MaxStepX cannot be 0.081: 0.001 to 0.08"):
        read_gait(["MaxStepX"], [0.081], ranges, False)


def test_one_foot_has_the_range_of_both():
    assert read_gait(["RightStepHeight", "Frequency"], [0.035, 0.0], ROWS, True) == [
        ["RightStepHeight", 0.035],
        ["Frequency", 0.0],
    ]
    with pytest.raises(BadGoal, match="RightStepHeight cannot be 0.1: 0.005 to 0.035"):
        read_gait(["RightStepHeight"], [0.1], ROWS, True)


def test_longer_steps_are_quicker_and_lower_frequencies_slower():
    way = [Place(1.0, 0.0, 0.0)]
    usual = walk_time(way, [], ROWS)
    assert usual == pytest.approx(2.0 + 25 * 0.42)
    assert walk_time(way, [["MaxStepX", 0.08]], ROWS) == pytest.approx(2.0 + 12.5 * 0.42)
    assert walk_time(way, [["MaxStepFrequency", 0.0]], ROWS) == pytest.approx(2.0 + 25 * 0.6)


def test_a_way_with_places_between_is_as_long_as_its_parts():
    there_and_back = [Place(0.5, 0.0, 0.0), Place(0.0, 0.0, 0.0)]
    assert walk_time(there_and_back, [], ROWS) == pytest.approx(walk_time([Place(1.0, 0.0, 0.0)], [], ROWS))
    assert walk_time([Place(0.0, 0.0, 0.0)], [], ROWS) == 0.0
