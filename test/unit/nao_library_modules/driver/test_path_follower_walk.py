"""Leading a robot along a course: a robot of one point, that does as it is told, on a clock that the walk moves."""

from __future__ import annotations

import dataclasses
import math

import pytest

from nao_library_modules.driver import path_follower_walk
from nao_library_modules.driver.path_follower_courses import PathCourse, TargetCourse
from nao_library_modules.driver.path_follower_path import WalkPath
from nao_library_modules.driver.path_follower_settings import Settings
from nao_library_modules.driver.path_follower_walk import lead
from nao_library_modules.errors import Preempted
from nao_library_modules.interrupt import Interrupt
from nao_library_modules.places import ORIGIN, Place
from naoqi.errors import NaoError

SPEED, TURN = 0.095, 0.83
BY_POSES = Settings()
BY_VELOCITIES = dataclasses.replace(BY_POSES, use_vel_ctrl=True)


class PointRobot:
    """Legs and eyes: a point that walks, on simulated time. Waiting makes time pass.

    Attributes:
        place: Where it is.
        able: What `prepare` raises otherwise.
        wall: x it cannot get beyond.
        cause: What has stopped it.
    """

    def __init__(self):
        self.place = ORIGIN
        self.time = 0.0
        self.able = None
        self.wall = math.inf
        self.cause = ""
        self.commands = []
        self.stops = 0
        self.track = [ORIGIN]
        self._goal = None
        self._speed = (0.0, 0.0, 0.0)

    # --- clock ---

    def now(self):
        return self.time

    def wait(self, duration, interrupt):
        self.time += duration
        self._walk(duration)
        self.track.append(self.place)
        return not interrupt.is_set()

    # --- legs ---

    def prepare(self, interrupt):
        if self.able is not None:
            raise self.able

    def go_to(self, way):
        self.commands.append(way)
        self._goal, self._speed = self.place.then(way), (0.0, 0.0, 0.0)

    def go_at(self, *speed):
        self.commands.append(speed)
        self._goal, self._speed = None, speed

    def walking(self):
        return self._goal is not None or any(self._speed)

    def why_stopped(self):
        return self.cause

    def stop(self):
        self.stops += 1
        self._goal, self._speed = None, (0.0, 0.0, 0.0)

    def _walk(self, duration):
        if self._goal is not None:
            way = self._goal.seen_from(self.place)
            share = min(1.0, SPEED * duration / max(way.distance, 1e-9))
            turn = max(-TURN * duration, min(TURN * duration, way.yaw))
            self._move(Place(way.x * share, way.y * share, turn))
            if share == 1.0 and turn == way.yaw:
                self._goal = None
        else:
            x, y, yaw = self._speed
            self._move(Place(SPEED * x * duration, SPEED * y * duration, TURN * yaw * duration))

    def _move(self, way):
        place = self.place.then(way)
        self.place = place._replace(x=min(place.x, self.wall))


@pytest.fixture
def robot(monkeypatch):
    # The clock of this robot is faster than any: nothing has to rest in real time.
    monkeypatch.setattr(path_follower_walk, "FASTEST_ROUND", 0.0)
    monkeypatch.setattr(path_follower_walk, "WALL_GRACE", 0.0)
    return PointRobot()


def walk(robot, course, settings, interrupt=None, report=lambda place, aim: None):
    lead(course, robot, lambda: robot.place, robot, settings, interrupt or Interrupt(), report)


@pytest.mark.parametrize("settings", [BY_POSES, BY_VELOCITIES], ids=["poses", "velocities"])
@pytest.mark.parametrize(
    "target", [Place(1.0, 0.3, 0.8), Place(-0.5, 0.0, 0.0), Place(0.0, 0.4, -2.0), Place(0, 0, 1.0)]
)
def test_a_target_is_reached_and_the_robot_stands(robot, settings, target):
    walk(robot, TargetCourse(lambda: target), settings)
    way = target.seen_from(robot.place)
    assert way.distance < settings.target_distance_threshold
    assert abs(way.yaw) < settings.target_angle_threshold
    assert not robot.walking()
    assert robot.time < 40.0


def test_by_poses_it_is_told_once_and_walks_to_the_very_place(robot):
    walk(robot, TargetCourse(lambda: Place(1.0, 0.3, 0.8)), BY_POSES)
    assert robot.commands == [Place(1.0, 0.3, 0.8)]
    assert robot.place == pytest.approx((1.0, 0.3, 0.8))
    assert robot.stops == 0


def test_a_target_that_drifts_is_told_again(robot):
    walk(robot, TargetCourse(lambda: Place(1.0 + min(0.1, 0.01 * robot.time), 0.0, 0.0)), BY_POSES)
    assert robot.place.x == pytest.approx(1.1, abs=0.03)
    assert 3 <= len(robot.commands) <= 6


def test_who_is_there_does_not_walk(robot):
    walk(robot, TargetCourse(lambda: Place(0.01, 0.0, 0.0)), BY_POSES)
    assert (robot.commands, robot.stops) == ([], 0)


def square(side):
    corners = [(0, 0), (1, 0), (1, 1), (0, 1), (0, 0)]
    return WalkPath([Place(side * x, side * y, 0.0) for x, y in corners])


def s_curve():
    return WalkPath([Place(0.02 * i, 0.2 * math.sin(0.02 * i * 2 * math.pi), 0.0) for i in range(51)])


@pytest.mark.parametrize("settings", [BY_POSES, BY_VELOCITIES], ids=["poses", "velocities"])
@pytest.mark.parametrize("path", [square(1.0), s_curve()], ids=["square", "curve"])
def test_a_path_is_kept_to_from_its_beginning_to_its_end(robot, settings, path):
    indices = []
    walk(robot, PathCourse(path, settings), settings, report=lambda place, aim: indices.append(aim.index))
    offs = [path.nearest(place, 0.0, path.length).off for place in robot.track]
    assert max(offs) < 0.08
    assert robot.place.distance_to(path.waypoints[-1]) < settings.target_distance_threshold
    assert indices == sorted(indices)
    assert len(set(indices)) > 0.8 * len(path.waypoints) - 1
    assert indices[-1] == len(path.waypoints) - 1
    assert robot.time > 0.9 * path.length / SPEED


def test_by_poses_the_end_of_a_path_is_told_to_the_point(robot):
    # Nearly where the robot aimed before, but not quite.
    end = Place(0.405, 0.0, 0.06)
    walk(robot, PathCourse(WalkPath([ORIGIN, end]), BY_POSES), BY_POSES)
    assert robot.place == pytest.approx(end, abs=1e-6)


@pytest.mark.parametrize("settings", [BY_POSES, BY_VELOCITIES], ids=["poses", "velocities"])
def test_a_robot_at_a_wall_gives_up(robot, settings):
    robot.wall = 0.5
    with pytest.raises(NaoError, match="no progress for 10 s, with 0.5. m still to go"):
        walk(robot, TargetCourse(lambda: Place(1.0, 0.0, 0.0)), settings)
    assert robot.time < 20.0


@pytest.mark.parametrize("settings", [BY_POSES, BY_VELOCITIES], ids=["poses", "velocities"])
def test_a_robot_that_cannot_walk_says_why_before_it_is_told(robot, settings):
    robot.able = NaoError("the legs are limp")
    with pytest.raises(NaoError, match="limp"):
        walk(robot, TargetCourse(lambda: Place(1.0, 0.0, 0.0)), settings)
    assert robot.commands == []


@pytest.mark.parametrize("settings", [BY_POSES, BY_VELOCITIES], ids=["poses", "velocities"])
def test_a_robot_that_ceases_to_walk_says_why(robot, settings):
    def fall(place, aim):
        if robot.time > 3.0:
            robot.able = NaoError("the robot has fallen")
            robot.go_at = robot.go_to = lambda *command: None
            robot.stop()

    with pytest.raises(NaoError, match="fallen"):
        walk(robot, TargetCourse(lambda: Place(1.0, 0.0, 0.0)), settings, report=fall)
    assert robot.time < 6.0


@pytest.mark.parametrize("settings", [BY_POSES, BY_VELOCITIES], ids=["poses", "velocities"])
def test_a_robot_that_stops_before_an_obstacle_is_not_sent_nearer(robot, settings):
    def see(place, aim):
        if place.x > 0.4 and not robot.cause:
            robot.cause = "an obstacle 0.39 m ahead"
            robot.stop()

    with pytest.raises(NaoError, match="the robot stopped: an obstacle 0.39 m ahead"):
        walk(robot, TargetCourse(lambda: Place(1.0, 0.0, 0.0)), settings, report=see)
    assert robot.place.x < 0.42


def test_one_that_was_stopped_by_somebody_is_told_again(robot):
    def stop_once(place, aim):
        if robot.stops == 0 and robot.time > 3.0:
            robot.stop()

    walk(robot, TargetCourse(lambda: Place(1.0, 0.0, 0.0)), BY_POSES, report=stop_once)
    assert robot.place.x == pytest.approx(1.0)
    assert len(robot.commands) == 2


def test_an_interrupt_ends_it_and_leaves_the_legs_as_they_are(robot):
    interrupt = Interrupt()

    def trigger(place, aim):
        if robot.time > 2.0:
            interrupt.trigger()

    with pytest.raises(Preempted):
        walk(robot, TargetCourse(lambda: Place(1.0, 0.0, 0.0)), BY_POSES, interrupt, trigger)
    assert robot.stops == 0


def test_a_robot_that_shuffles_near_the_target_is_stopped(robot):
    robot.walking = lambda: robot.stops == 0
    walk(robot, TargetCourse(lambda: Place(0.2, 0.0, 0.0)), BY_POSES)
    assert robot.stops == 1
    assert robot.time < 10.0
