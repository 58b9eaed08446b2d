"""Things that plans look for and examine."""

from __future__ import annotations

import pytest

from nao_library_modules.process_modules import action_rules, perception  # noqa: F401
from nao_library_modules.process_modules.control import do, par, top_level
from nao_library_modules.process_modules.designators.designator import (
    a,
    current_desig,
    desig_equal,
    location,
    object_,
    the,
)
from nao_library_modules.process_modules.failures import PerceptionObjectNotFound, PlanError, PlanFailure, fail
from nao_library_modules.process_modules.handling import give, with_failure_handling
from nao_library_modules.process_modules.modules.vision import SeenThing
from nao_library_modules.process_modules.perception import examine, perceive
from nao_library_modules.process_modules.process_module import ProcessModule
from nao_library_modules.process_modules.registry import perform, with_process_modules_running
from nao_library_modules.process_modules.space import Point3

pytestmark = pytest.mark.usefixtures("nothing_is_known")


class Eyes(ProcessModule):
    """Sees what it is told."""

    name = "vision"

    def __init__(self, *seen):
        super().__init__()
        self.seen = list(seen)

    def execute(self, command):
        if not self.seen:
            fail(PerceptionObjectNotFound, "nothing was seen")
        return list(self.seen)


def ball(x, y, confidence=1.0, name=""):
    return SeenThing("ball", name, Point3(x, y, 0.05, "odom"), 1.0, confidence, 0.0, 0.0)


def test_examining_tells_what_is_asked_for_and_what_is_not_known_is_none():
    with with_process_modules_running(Eyes(ball(1.0, 0.5))):
        told = top_level(lambda: examine(a(object_, type="ball", colour="red"), "position", "colour", "type"))
    assert told["position"] == Point3(1.0, 0.5, 0.05, "odom")
    assert told["colour"] == "red" and told["type"] == "ball"


def test_examining_what_is_not_there_fails():
    with with_process_modules_running(Eyes()), pytest.raises(PerceptionObjectNotFound):
        top_level(lambda: examine(a(object_, type="ball"), "position"))


def test_a_thing_that_is_perceived_twice_is_the_same_and_where_it_is_now():
    eyes, desig = Eyes(ball(1.0, 0.0)), a(object_, type="ball")
    with with_process_modules_running(eyes):
        first = top_level(lambda: perceive(desig))
        eyes.seen = [ball(1.1, 0.0)]
        second = top_level(lambda: perceive(desig))
    assert desig_equal(first, second) and desig_equal(desig, second)
    assert current_desig(desig).reference().position.x == 1.1
    assert current_desig(desig).reference().name == first.reference().name


def test_perceiving_in_many_branches_at_once():
    with with_process_modules_running(Eyes(ball(1.0, 0.0))):
        found = top_level(lambda: par(*[do(perceive, a(object_, type="ball"))] * 6))
    assert {each.reference().name for each in found} == {"ball"}


def test_the_best_of_several_is_taken_and_all_of_them_when_that_is_asked():
    with with_process_modules_running(Eyes(ball(1.0, 0.0, 0.3), ball(3.0, 0.0, 0.9))):
        assert top_level(lambda: perceive(a(object_, type="ball"))).reference().position.x == 3.0
        assert len(top_level(lambda: perceive(a(object_, type="ball"), "all"))) == 2
        with pytest.raises(PlanFailure):
            top_level(lambda: perceive(the(object_, type="ball")))


def test_a_thing_that_was_not_found_can_be_looked_for_elsewhere():
    eyes = Eyes()

    def look_elsewhere(failure):
        eyes.seen.append(ball(2.0, 0.0))
        give(perceive(a(object_, type="ball")))

    def plan():
        return with_failure_handling(do(perceive, a(object_, type="ball")), {PerceptionObjectNotFound: look_elsewhere})

    with with_process_modules_running(eyes):
        assert top_level(plan).reference().position.x == 2.0


def test_performing_what_is_no_action_is_told():
    with pytest.raises(PlanError, match="no designator of an action or a motion"):
        top_level(lambda: perform(a(location, pose=[0, 0, 0])))
