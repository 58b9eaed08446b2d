"""Goals of ALMotion.moveTo, one after the other."""

from __future__ import annotations

import pytest

from nao_library_modules.driver.moveto_walk import Goal, MoveToWalk
from nao_library_modules.health import Level
from nao_library_modules.places import Place
from naoqi.errors import NaoError, RobotError


class MovingMotion:
    """ALMotion whose walk ends when the test says so; a new one, and stopMove, end the old one."""

    def __init__(self, make_call):
        self._make_call = make_call
        self.walk = None

    def moveTo(self, x, y, theta):
        if self.walk is not None:
            self.walk.end(False)
        self.walk = self._make_call("ALMotion.moveTo")
        return self.walk

    def stopMove(self):
        if self.walk is not None:
            self.walk.end(False)


@pytest.fixture
def motion(make_call):
    return MovingMotion(make_call)


@pytest.fixture
def walk(robot):
    walk = MoveToWalk(robot)
    yield walk
    walk.close()


def goal(name, *way):
    return Goal(name, lambda: Place(*way))


def told(walk, eventually, words, level=Level.OK):
    eventually(lambda: words in walk.report().message)
    assert walk.report().level == level


def test_a_goal_is_walked_to(walk, proxy, motion, eventually):
    assert walk.report().message == "no goal yet"
    walk.go(goal("door", 1.0, 0.5, 0.25))
    told(walk, eventually, "walks to door: 1.00 m ahead, 0.50 m left")
    motion.walk.end(True)
    told(walk, eventually, "door is reached")
    assert proxy.calls == [("moveTo", 1.0, 0.5, 0.25)]


def test_a_new_goal_takes_over_without_a_stop(walk, proxy, motion, eventually):
    walk.go(goal("door", 1.0, 0.0, 0.0))
    told(walk, eventually, "walks to door")
    walk.go(goal("window", 0.0, 1.0, 0.0))
    told(walk, eventually, "walks to window")
    motion.walk.end(True)
    told(walk, eventually, "window is reached")
    assert [call[0] for call in proxy.calls] == ["moveTo", "moveTo"]


def test_a_cancelled_walk_is_stopped(walk, proxy, eventually):
    walk.go(goal("door", 1.0, 0.0, 0.0))
    told(walk, eventually, "walks to door")
    walk.cancel()
    told(walk, eventually, "was stopped")
    assert proxy.calls[-1] == ("stopMove",)


def test_a_walk_that_others_stop_is_told(walk, motion, eventually):
    walk.go(goal("door", 1.0, 0.0, 0.0))
    told(walk, eventually, "walks to door")
    motion.walk.end(False)
    told(walk, eventually, "door was not reached", Level.WARN)


@pytest.mark.parametrize(
    "error, words", [(RobotError("ALMotion", "moveTo", "the legs are limp"), "limp"), (NaoError("lost"), "door: lost")]
)
def test_what_goes_wrong_on_the_way_is_told(walk, motion, eventually, error, words):
    walk.go(goal("door", 1.0, 0.0, 0.0))
    told(walk, eventually, "walks to door")
    motion.walk.end(error=error)
    told(walk, eventually, words, Level.ERROR)


def test_a_goal_nobody_can_find_leaves_the_walk_alone(walk, proxy, eventually):
    def nowhere():
        raise NaoError("no such frame")

    walk.go(goal("door", 1.0, 0.0, 0.0))
    told(walk, eventually, "walks to door")
    walk.go(Goal("nowhere", nowhere))
    told(walk, eventually, "nowhere: no such frame", Level.ERROR)
    assert [call[0] for call in proxy.calls] == ["moveTo"]


def test_the_end_of_the_node_stops_a_walk_and_nothing_else(robot, proxy, eventually):
    idle = MoveToWalk(robot)
    idle.close()
    assert proxy.calls == []
    busy = MoveToWalk(robot)
    busy.go(goal("door", 1.0, 0.0, 0.0))
    told(busy, eventually, "walks to door")
    busy.close()
    assert proxy.calls[-1] == ("stopMove",)
