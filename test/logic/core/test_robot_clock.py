"""Times of the robot's memory in ROS time."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from nao_library_modules.core.robot_events import FRESH, RobotClock


class Memory:
    """A robot's memory: its clock goes `ahead` of ROS time in steps of `tick`; calls take `ways` there and back; s."""

    def __init__(self, ahead, ways=(0.001,), simulated=False, tick=0.0):
        self.ahead, self.ways, self.time, self.stamp, self.calls = ahead, list(ways), 1000.0, 0.0, 0
        self.tick = tick
        self.clock = SimpleNamespace(now=lambda: self.time, simulated=simulated)
        self.connection = SimpleNamespace(generation=1)
        self.robot_clock = RobotClock(self, self.clock)

    def proxy(self, name):
        return self

    def call(self, proxy, method, key, *value):
        way = self.ways[self.calls // 2 % len(self.ways)]
        self.calls += 1
        self.time += way / 2.0
        if method == "insertData":
            self.stamp = self.time + self.ahead
            if self.tick:
                self.stamp -= self.stamp % self.tick
        self.time += way / 2.0
        return ["pressed", int(self.stamp), round(self.stamp % 1 * 1e6)]


@pytest.mark.parametrize("ahead", [-600.0, -0.3, 2.0, 1.7e9])
def test_times_of_a_robot_with_a_clock_of_its_own_are_mapped(ahead):
    robot = Memory(ahead, ways=(0.030, 0.002, 0.050))
    assert robot.robot_clock.ros_time(robot.call, 999.5 + ahead) == pytest.approx(999.5, abs=0.001)


def test_a_clock_that_goes_in_ticks_is_known_better_than_to_a_tick():
    robot = Memory(2.0, ways=(0.0011, 0.0007, 0.0009), tick=1.0 / 120.0)
    assert robot.robot_clock.ros_time(robot.call, 1001.5) == pytest.approx(999.5, abs=0.002)


def test_in_simulated_time_the_robots_clock_is_ours_even_when_ours_is_late():
    robot = Memory(0.09, simulated=True)
    assert robot.robot_clock.ros_time(robot.call, 999.25) == 999.25
    assert robot.robot_clock.ros_time(robot.call, 1000.05) == 1000.05
    assert robot.calls == 0


def test_no_time_comes_before_simulated_time_began():
    robot = Memory(32.0, simulated=True)
    robot.time = 0.0  # nothing of /clock has come so far
    assert robot.robot_clock.ros_time(robot.call, 0.4) == 0.4
    assert robot.robot_clock.ros_time(robot.call, 20.0) == 0.0


def test_clocks_are_compared_again_after_a_while_and_behind_another_connection():
    robot = Memory(10.0)
    for change in (lambda: None, lambda: setattr(robot, "time", robot.time + FRESH + 1.0)):
        change()
        robot.robot_clock.ros_time(robot.call, 1000.0)
        calls = robot.calls
        robot.robot_clock.ros_time(robot.call, 1000.0)
        assert robot.calls == calls + 2, "one look that it still goes so"
    robot.ahead, robot.connection.generation = 20.0, 2
    assert robot.robot_clock.ros_time(robot.call, robot.time + 19.0) == pytest.approx(robot.time - 1.0, abs=0.03)


def test_a_clock_that_was_set_is_noticed_at_once():
    robot = Memory(10.0)
    robot.robot_clock.ros_time(robot.call, 1000.0)
    robot.ahead = -300.0
    assert robot.robot_clock.ros_time(robot.call, robot.time - 301.0) == pytest.approx(robot.time - 1.0, abs=0.03)


def test_an_event_that_was_raised_again_has_the_time_of_its_arrival():
    robot = Memory(0.0, simulated=True)
    robot.stamp = 999.5
    assert robot.robot_clock.event_time(robot.call, "Touched", "pressed", 999.9) == 999.5
    assert robot.robot_clock.event_time(robot.call, "Touched", "pressed", 999.48) == 999.5, "our clock is late"
    assert robot.robot_clock.event_time(robot.call, "Touched", "let go", 999.9) == 999.9
