"""ALNavigation: moves end before obstacles, and ways lead around them."""

import math

import pytest

EVENTS = "Navigation/AvoidanceNavigator/"
WALL = "{{name: {}, box: [0.1, {}, 0.8], position: [{}, {}, 0.4], heading: {}, color: [0.6, 0.6, 0.6], mass: 0.0}}"


@pytest.fixture
def robot(stiff_robot):
    stiff_robot.advance(0.3)  # its feet feel the ground
    return stiff_robot


@pytest.fixture
def hear(robot):
    def listen(event):
        values = []
        robot.server.memory.listen(EVENTS + event, values.append)
        return values

    return listen


@pytest.fixture
def go(robot):
    """Calls a method and lets time pass until it answers."""

    def call(method, *arguments, limit=120.0):
        future = robot.post("ALNavigation", method, *arguments)
        robot.handed_over("ALNavigation")
        robot.advance_until(lambda: not future.isRunning(), limit, 0.25, f"{method} answers")
        return robot.answer(future)

    return call


def where(robot):
    return robot.now.torso.position[:2]


def place(robot, name, width, x, y, heading=0.0):
    robot.NaoSimulation.placeObject(WALL.format(name, width, x, y, heading))


@pytest.mark.parametrize("distance", [0.4, 0.7])
def test_a_move_ends_at_the_security_distance_and_tells_of_the_obstacle(robot, go, hear, distance):
    robot.ALNavigation.setSecurityDistance(distance)
    assert robot.ALNavigation.getSecurityDistance() == pytest.approx(distance)
    assert robot.ALMotion.getOrthogonalSecurityDistance() == pytest.approx(distance)
    place(robot, "wall", 2.0, 1.05, 0.0)
    seen = hear("ObstacleDetected")
    assert go("moveTo", 0.9, 0.0, 0.0, [["Frequency", 0.6]]) is None
    assert 1.0 - where(robot)[0] == pytest.approx(distance, abs=0.13) and where(robot)[0] > 0.1
    ((x, y),) = seen
    assert x == pytest.approx(distance, abs=0.15) and abs(y) < x
    robot.ALNavigation.moveToward(1.0, 0.0, 0.0)
    robot.advance(3.0)
    assert not robot.ALMotion.moveIsActive() and len(seen) == 2


def test_it_goes_to_a_place_and_tells_its_progress(robot, go, hear):
    progress, status = hear("TrajectoryProgress"), hear("Status")
    assert go("navigateTo", 0.4, 0.3, 0.0) is True
    x, y, theta = robot.ALMotion.getRobotPosition(True)
    assert (x, y, theta) == pytest.approx((0.4, 0.3, 0.0), abs=0.07)
    assert progress == sorted(progress) and progress[-1] == 1.0 and len(progress) > 5
    assert status[0] == "Moving" and status[-1] == "Arrived"


def test_it_goes_around_what_is_in_the_way(robot, go, hear):
    place(robot, "box", 0.25, 0.75, 0.0)
    leaves, seen = hear("MovingToFreeZone"), hear("ObstacleDetected")
    assert go("navigateTo", 1.4, 0.0) is True
    assert math.dist(robot.ALMotion.getRobotPosition(True)[:2], (1.4, 0.0)) < 0.12
    assert seen and leaves[:2] == [1.0, 0.0]


def test_it_gives_up_in_a_dead_end_and_a_goal_in_an_obstacle_moves_before_it(robot, go, hear):
    place(robot, "end", 1.4, 0.75, 0.0)
    for name, y in (("left", 0.6), ("right", -0.6)):
        place(robot, name, 2.4, 0.0, y, math.pi / 2)
    status, moved = hear("Status"), hear("AbsTargetModified")
    assert go("navigateTo", 1.5, 0.0) is False
    assert status[-1] == "Blocked" and where(robot)[0] < 0.45 and moved == []
    x, _, theta = robot.ALMotion.getRobotPosition(True)
    assert go("navigateTo", 0.8 - x, 0.0) is True and len(moved) == 1
    assert moved[0][0] < 0.5


def test_it_follows_a_trajectory_and_stops_when_told(robot, go):
    path = ["Composed", ["Holonomic", ["Line", [0.2, 0.0]], 0.0, 2.0], ["Holonomic", ["Line", [0.0, 0.15]], 0.3, 2.0]]
    assert go("moveAlong", path) is True
    assert robot.ALMotion.getRobotPosition(True) == pytest.approx([0.2, 0.15, 0.3], abs=0.05)
    future = robot.post("ALNavigation", "navigateTo", 2.0, 0.0)
    robot.handed_over("ALNavigation")
    robot.advance(3.0)
    robot.ALNavigation.stopNavigateTo()
    robot.advance(2.0)
    assert robot.answer(future) is False and not robot.ALMotion.moveIsActive()


def test_what_a_nao_cannot_do_is_refused_with_the_reason(robot):
    for method, arguments, words in (
        ("explore", (2.0,), "no laser or 3D camera"),
        ("navigateToInMap", (1.0, 0.0), "navigateTo goes by the sonars"),
        ("findFreeZone", (0.6, 0.5), "sonars see ahead only"),
        ("moveAlong", (["Line", [1.0, 0.0]],), "trajectory is"),
    ):
        with pytest.raises(RuntimeError, match=f"^ALNavigation::{method} .*{words}"):
            robot.ALNavigation.call(method, *arguments)


def test_a_move_of_ALMotion_is_neither_watched_nor_stopped_for_a_way_before_it(robot, hear):
    seen = hear("ObstacleDetected")
    robot.ALNavigation.setSecurityDistance(0.6)
    way = robot.post("ALNavigation", "navigateTo", 2.0, 0.0)
    robot.handed_over("ALNavigation")
    robot.advance(2.0)
    robot.ALMotion.setExternalCollisionProtectionEnabled("Move", False)
    robot.ALMotion.moveToward(0.5, 0.0, 0.0)
    robot.advance(0.3)
    assert robot.answer(way) is False
    place(robot, "wall", 2.0, where(robot)[0] + 0.5, 0.0)
    robot.ALNavigation.stopNavigateTo()
    robot.advance(2.0)
    assert robot.ALMotion.moveIsActive() and seen == []


def test_a_way_before_an_obstacle_is_over_when_another_walk_begins(robot, hear):
    place(robot, "wall", 2.0, 0.8, 0.0)
    seen = hear("ObstacleDetected")
    way = robot.post("ALNavigation", "navigateTo", 1.5, 0.0)
    robot.handed_over("ALNavigation")
    robot.advance_until(lambda: seen, 20.0, 0.02, "the wall is seen")
    robot.ALMotion.moveToward(0.0, 0.0, 0.5)
    robot.advance(0.5)
    assert robot.answer(way) is False
    robot.ALNavigation.stopNavigateTo()
    robot.advance(2.0)
    assert robot.ALMotion.moveIsActive()


def test_a_goal_that_is_too_far_away_is_not_gone_to(robot, go, caplog):
    assert go("navigateTo", 3.0, 0.5) is False and "allowed is a place nearer than 3 m" in caplog.text


def test_soft_legs_prevent_a_way_without_an_error_and_say_so_once(robot, go, caplog):
    robot.ALMotion.setStiffnesses("Body", 0.0)
    failed = []
    robot.server.memory.listen("ALMotion/MoveFailed", failed.append)
    assert robot.ALMotion.moveTo(0.2, 0.0, 0.0) is False
    assert [go(name, 0.5, 0.0, *theta) for name, theta in (("navigateTo", ()), ("moveTo", (0.0,)))] == [False, None]
    assert len(failed) == 3 and all("wakeUp first" in cause and status == 0 for cause, status, _ in failed)
    assert caplog.text.count("does not move the robot") == 1
