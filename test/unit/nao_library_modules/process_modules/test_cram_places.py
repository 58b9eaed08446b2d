"""Places that plans are at, that are lost and found again."""

from __future__ import annotations

import pytest

from nao_library_modules.places import Place
from nao_library_modules.process_modules import action_rules, perception  # noqa: F401
from nao_library_modules.process_modules.control import do, top_level
from nao_library_modules.process_modules.designators import locations
from nao_library_modules.process_modules.designators.designator import a, location
from nao_library_modules.process_modules.failures import (
    NavigationGoalNotReached,
    NavigationHighLevelFailure,
    PlanFailure,
    fail,
)
from nao_library_modules.process_modules.flow import sleep
from nao_library_modules.process_modules.fluents import Fluent
from nao_library_modules.process_modules.perception import at_location, go_to
from nao_library_modules.process_modules.process_module import ProcessModule
from nao_library_modules.process_modules.registry import with_process_modules_running
from nao_library_modules.process_modules.waiting import wait_for

pytestmark = pytest.mark.usefixtures("nothing_is_known")


class Walker(ProcessModule):
    """Walks at once; may be stuck on its way to some places."""

    name = "navigation"

    def __init__(self, stuck=()):
        super().__init__()
        self.here = Fluent("place", Place(0.0, 0.0, 0.0))
        self.walks = []
        self.stuck = stuck

    def execute(self, command):
        target = command.arguments["target"]
        self.walks.append(target)
        if target.x in self.stuck:
            fail(NavigationGoalNotReached, "stuck")
        self.here.value = target
        return target


def some_places(*xs):
    def generator(desig):
        for x in xs:
            yield locations.Candidate(Place(x, 0.0, 0.0), "odom")

    locations.register_location_generator(100, generator)
    return a(location, anywhere=True)


def test_the_body_begins_when_the_robot_is_there_and_only_there():
    walker = Walker()
    with with_process_modules_running(walker):
        answer = top_level(lambda: at_location(a(location, pose=[1, 0, 0]), lambda: walker.here.value, walker.here))
    assert answer == Place(1.0, 0.0, 0.0) and len(walker.walks) == 1


def test_a_place_that_is_lost_is_found_again():
    walker, begun = Walker(), []

    def body():
        begun.append(walker.here.value)
        if len(begun) < 4:
            walker.here.value = Place(5.0, 0.0, 0.0)
            sleep(1000.0)
        return "done"

    with with_process_modules_running(walker):
        assert top_level(lambda: at_location(a(location, pose=[1, 0, 0]), body, walker.here)) == "done"
    assert len(walker.walks) == 4 and begun == [Place(1.0, 0.0, 0.0)] * 4


def test_a_robot_that_turns_away_has_lost_its_place():
    walker, begun = Walker(), []

    def body():
        begun.append(True)
        if len(begun) == 1:
            walker.here.value = Place(1.0, 0.0, 2.0)
            sleep(1000.0)

    with with_process_modules_running(walker):
        top_level(lambda: at_location(a(location, pose=[1, 0, 0]), body, walker.here))
    assert len(begun) == 2


def test_a_place_is_lost_ten_times_and_not_more_often():
    walker, begun = Walker(), []

    def body():
        begun.append(True)
        walker.here.value = Place(5.0, 0.0, 0.0)
        sleep(1000.0)

    with with_process_modules_running(walker), pytest.raises(NavigationHighLevelFailure, match="lost 10 times"):
        top_level(lambda: at_location(a(location, pose=[1, 0, 0]), body, walker.here))
    assert len(begun) == len(walker.walks) == 10


def test_a_failure_of_the_body_is_no_loss_of_the_place():
    walker = Walker()
    with with_process_modules_running(walker), pytest.raises(PlanFailure, match="cold"):
        top_level(lambda: at_location(a(location, pose=[1, 0, 0]), do(fail, "cold"), walker.here))
    assert len(walker.walks) == 1


def test_a_suspended_plan_at_a_place_goes_on_there(beside):
    walker, there, go = Walker(), Fluent("there", False), Fluent("go", False)

    def body():
        there.value = True
        wait_for(go)
        return "done"

    with with_process_modules_running(walker):
        plan = beside(lambda: at_location(a(location, pose=[1, 0, 0]), body, walker.here))
        assert top_level(lambda: wait_for(there, timeout=10.0))
        plan.root.suspend()
        go.value = True
        plan.root.wake_up()
        assert plan.ended() == "done"


def test_places_that_cannot_be_reached_give_way_to_the_next():
    walker = Walker(stuck=(1.0, 2.0))
    desig = some_places(1.0, 2.0, 3.0)
    with with_process_modules_running(walker):
        assert top_level(lambda: go_to(desig)) == Place(3.0, 0.0, 0.0)
    assert [walk.x for walk in walker.walks] == [1.0, 2.0, 3.0]


def test_no_place_that_can_be_reached_is_a_failure_that_says_so():
    walker = Walker(stuck=(1.0, 2.0))
    desig = some_places(1.0, 2.0)
    with with_process_modules_running(walker), pytest.raises(NavigationHighLevelFailure, match="no way to .*stuck"):
        top_level(lambda: go_to(desig))


def test_not_more_than_ten_other_places_are_tried():
    xs = [float(x) for x in range(1, 30)]
    walker = Walker(stuck=xs)
    desig = some_places(*xs)
    with with_process_modules_running(walker), pytest.raises(NavigationHighLevelFailure):
        top_level(lambda: go_to(desig))
    assert len(walker.walks) == perception.TRIES + 1
