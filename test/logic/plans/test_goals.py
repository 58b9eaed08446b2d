"""Goals, plans that achieve them, things that are perceived, and places that plans are at, lose and find again."""

from __future__ import annotations

import pytest
from plan_tools import fails, forever

import nao_library_modules.process_modules as p
from nao_library_modules.core.geometry import Place
from nao_library_modules.process_modules import perception  # noqa: F401  the rules of the library
from nao_library_modules.process_modules.designators.objects_and_locations import Candidate, register_location_generator
from nao_library_modules.process_modules.failures import (
    GoalNotAchieved,
    NavigationGoalNotReached,
    NavigationHighLevelFailure,
    PerceptionObjectNotFound,
)
from nao_library_modules.process_modules.nao_modules import SeenThing
from nao_library_modules.process_modules.plans import achieved_by


@pytest.fixture
def grippers():
    return p.Fluent("grippers", {"left": 0.0, "right": 1.0})


@pytest.fixture
def is_open(grippers):
    @p.declare_goal
    def is_open(side, share=1.0):
        return grippers.value.get(side, 0.0) >= share

    return is_open


def opens(grippers, opened=None):
    def act(side="left", share=1.0):
        p.sleep(0.001)
        grippers.update(lambda known: {**known, side: share})
        if opened is not None:
            opened.append(side)
        return "opened"

    return act


def test_only_what_does_not_hold_is_done_also_for_goals_beside_each_other(is_open, grippers):
    opened = []
    p.def_goal(is_open)(opens(grippers, opened))
    both = p.do(p.par, p.do(p.achieve, is_open("left")), p.do(p.achieve, is_open, "right"))
    assert p.top_level(both) == ["opened", None] and opened == ["left"]
    assert p.holds(is_open("left")) and p.holds(is_open, "left", 0.5)
    many = [p.do(p.achieve, is_open(str(number))) for number in range(8)]
    p.top_level(lambda: p.par(*many))
    p.top_level(lambda: p.par(*many))
    assert sorted(opened[1:]) == [str(number) for number in range(8)]


def test_a_state_is_perceived_and_nothing_is_done(is_open):
    assert p.top_level(lambda: p.perceive_state(is_open, "right")) == {"side": "right", "share": 1.0}
    assert p.top_level(lambda: p.perceive_state(is_open("left"))) is None


def test_the_most_specific_pattern_is_tried_first(is_open, grippers):
    chosen = []

    def plan(name):
        return lambda *given: (chosen.append((name, given)), opens(grippers)())

    p.def_goal(is_open)(plan("any"))
    p.def_goal(is_open, p.ANY, lambda share: share < 0.5)(plan("a little"))
    p.def_goal(is_open, "left", 0.9)(plan("left, nearly"))
    for share in (0.9, 0.3, 0.8):
        grippers.value = {}
        p.top_level(p.do(p.achieve, is_open, "left", share))
    assert chosen == [("left, nearly", ()), ("a little", ("left", 0.3)), ("any", ("left", 0.8))]


def test_a_plan_that_does_not_reach_its_goal_fails_and_can_be_tried_again(is_open, grippers):
    tries = []
    p.def_goal(is_open)(lambda side, share: tries.append(side) or (len(tries) >= 4 and opens(grippers)()))
    achieve = p.do(p.achieve, is_open, "left")
    fails(GoalNotAchieved, r"is_open\('left', 1.0\) does not hold, although", achieve)
    p.top_level(lambda: p.with_failure_handling(achieve, {GoalNotAchieved: lambda failure: p.retry()}))
    assert len(tries) == 4


def test_a_goal_or_an_action_that_is_made_and_dropped_says_so(is_open, grippers, recwarn):
    p.def_goal(is_open)(opens(grippers))
    desig = p.an(p.action, type="opening", gripper="left")
    p.holds(is_open("left")), p.do(p.achieve, is_open("left")), p.top_level(p.do(p.achieve, is_open("left")))
    p.do(p.perform, desig), p.an(p.action, type="trying", what=[p.an(p.action, type="waving")]).get("what")
    del desig
    assert not recwarn.list
    with pytest.warns(RuntimeWarning, match=r"is_open\('left', 1.0\) was made, and .*: achieve\(is_open") as told:
        is_open("left")
    assert told[0].filename == __file__
    with pytest.warns(RuntimeWarning, match="an action .type='opening'. was made, and .*: perform"):
        p.an(p.action, type="opening")


def test_a_function_that_acts_when_it_is_called_means_a_goal(is_open, grippers):
    opened = []
    act = opens(grippers)
    achieved_by(act, is_open)
    p.def_goal(act)(opens(grippers, opened))
    p.top_level(p.do(p.achieve, act, "left"))
    assert opened == ["left"] and p.holds(act, "left") and is_open.plans


def test_mistakes_about_goals_are_told(is_open):
    for arguments, named in ((("left", 1.0, 2.0), {}), ((), {"sid": "left"})):
        with pytest.raises(p.PlanError, match=r"is_open takes \(side, share\)"):
            is_open(*arguments, **named)
    told = r"no plan achieves is_open\('left', 1.0\): there are plans for nothing"
    fails(p.PlanError, told, p.do(p.achieve, is_open("left")))
    fails(p.PlanError, "'open' is no goal with its arguments", p.do(p.achieve, "open"))


class Eyes(p.ProcessModule):
    """Sees what the test says."""

    name = "vision"

    def __init__(self, *balls):
        super().__init__()
        self.balls = list(balls)

    def execute(self, command):
        if not self.balls:
            p.fail(PerceptionObjectNotFound, "nothing was seen")
        places = [(p.Point3(x, 0.5, 0.05, "odom") if x else None, confidence) for x, confidence in self.balls]
        return [SeenThing("ball", "", place, 12.0, confidence, 0.0, 0.0) for place, confidence in places]


@pytest.fixture
def eyes():
    with p.with_process_modules_running(Eyes((1.0, 1.0))) as (module,):
        yield module


def a_ball(**description):
    return p.a(p.object_, type="ball", **description)


def test_what_is_perceived_is_known_and_examined(eyes):
    desig = a_ball(colour="red")
    first = p.top_level(lambda: p.perceive(desig))
    assert first.reference().seen == 12.0 and first.reference().value("colour") == "red"
    told = p.top_level(lambda: p.examine(a_ball(colour="red"), "position", "colour", "type"))
    assert told == {"position": p.Point3(1.0, 0.5, 0.05, "odom"), "colour": "red", "type": "ball"}
    eyes.balls = [(1.1, 1.0)]
    second = p.top_level(lambda: p.perceive(desig))
    assert p.desig_equal(first, second) and p.desig_equal(desig, second)
    assert p.current_desig(desig).reference().position.x == 1.1 and second.reference().name == "ball"


def test_what_is_not_seen_fails_and_can_be_looked_for_elsewhere(eyes):
    eyes.balls = []
    fails(PerceptionObjectNotFound, "nothing was seen", lambda: p.examine(a_ball(), "position"))

    def look_elsewhere(failure):
        eyes.balls = [(2.0, 1.0)]
        p.give(p.perceive(a_ball()))

    handlers = {PerceptionObjectNotFound: look_elsewhere}
    found = p.top_level(lambda: p.with_failure_handling(p.do(p.perceive, a_ball()), handlers))
    assert found.reference().position.x == 2.0
    eyes.balls = [(None, 1.0)]
    fails(PerceptionObjectNotFound, "was seen, but not where it is", lambda: p.perceive(a_ball()))
    fails(p.PlanError, "is no object with a type", lambda: p.perceive(p.a(p.object_, name="Anna")))


class Walker(p.ProcessModule):
    """Is at once where it is told to walk, or stuck on the way there."""

    name = "navigation"

    def __init__(self):
        super().__init__()
        self.here, self.walks, self.stuck = p.Fluent("place", Place(0.0, 0.0, 0.0)), [], ()

    def execute(self, command):
        target = command.arguments["target"]
        self.walks.append(target.x)
        if target.x in self.stuck:
            p.fail(NavigationGoalNotReached, "stuck")
        self.here.value = target
        return target

    def at(self, body):
        return lambda: p.at_location(p.a(p.location, pose=[1, 0, 0]), body, self.here)


@pytest.fixture
def walker():
    with p.with_process_modules_running(Walker()) as (module,):
        yield module


@pytest.mark.parametrize("away", [(5.0, 0.0, 0.0), (1.0, 0.0, 2.0), (1.0, -0.25, 0.0)])
def test_a_place_that_is_lost_is_found_again_and_the_body_begins_there_anew(walker, away):
    begun = []

    def body():
        begun.append(walker.here.value)
        if len(begun) == 4:
            walker.here.value = Place(1.1, 0.1, 0.5)  # still there
            return "done"
        walker.here.value = Place(*away)
        forever()

    assert p.top_level(walker.at(body)) == "done"
    assert walker.walks == [1.0] * 4 and begun == [Place(1.0, 0.0, 0.0)] * 4


def test_places_that_cannot_be_reached_give_way_to_the_next_ten(walker):
    def in_a_row(desig):
        yield from (Candidate(Place(float(x), 0.0, 0.0), "odom") for x in desig.get("in_a_row", ()))

    register_location_generator(100, in_a_row)
    walker.stuck = [float(x) for x in range(1, 30) if x != 3]
    assert p.top_level(lambda: p.go_to(p.a(p.location, in_a_row=range(1, 4)))) == Place(3.0, 0.0, 0.0)
    assert walker.walks == [1.0, 2.0, 3.0]
    fails(NavigationHighLevelFailure, "no way to .*: stuck", lambda: p.go_to(p.a(p.location, in_a_row=[1, 2])))
    fails(NavigationHighLevelFailure, "no way to .*: stuck", lambda: p.go_to(p.a(p.location, in_a_row=range(4, 30))))
    assert walker.walks[5:] == [float(x) for x in range(4, 4 + perception.TRIES + 1)]
