"""Designators from several threads, rules of users, goals that are aimed at together, places that are lost."""

from __future__ import annotations

import threading

import pytest

from nao_library_modules.places import Place
from nao_library_modules.process_modules import action_rules, perception  # noqa: F401
from nao_library_modules.process_modules.control import do, par, top_level
from nao_library_modules.process_modules.designators import locations
from nao_library_modules.process_modules.designators.designator import (
    Designator,
    a,
    action,
    an,
    current_desig,
    desig_equal,
    designator,
    equate,
    first_desig,
    location,
    object_,
    the,
)
from nao_library_modules.process_modules.designators.objects import BELIEFS
from nao_library_modules.process_modules.designators.patterns import number
from nao_library_modules.process_modules.designators.rules import Command, Rules, rule
from nao_library_modules.process_modules.failures import (
    DesignatorError,
    GoalNotAchieved,
    NavigationGoalNotReached,
    NavigationHighLevelFailure,
    PerceptionObjectNotFound,
    PlanError,
    PlanFailure,
    fail,
)
from nao_library_modules.process_modules.flow import sleep
from nao_library_modules.process_modules.fluents import Fluent
from nao_library_modules.process_modules.goals import achieve, declare_goal, def_goal, holds
from nao_library_modules.process_modules.handling import give, with_failure_handling
from nao_library_modules.process_modules.modules.vision import SeenThing
from nao_library_modules.process_modules.perception import at_location, examine, go_to, perceive
from nao_library_modules.process_modules.process_module import ProcessModule
from nao_library_modules.process_modules.registry import perform, with_process_modules_running
from nao_library_modules.process_modules.space import Point3
from nao_library_modules.process_modules.waiting import wait_for

THREADS = 8


@pytest.fixture(autouse=True)
def nothing_is_known(monkeypatch):
    monkeypatch.setattr(locations, "_generators", list(locations._generators))
    monkeypatch.setattr(locations, "_validators", list(locations._validators))
    BELIEFS.clear()
    yield
    BELIEFS.clear()


def everywhere(body):
    """What a body answers in many threads that begin at the same moment."""
    barrier, answers = threading.Barrier(THREADS), []

    def run():
        barrier.wait(10.0)
        try:
            answers.append(body())
        except Exception as error:
            answers.append(error)

    threads = [threading.Thread(target=run) for _ in range(THREADS)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(30.0)
        assert not thread.is_alive()
    return answers


def counted(count, made=None):
    def resolve(_):
        for each in range(count):
            if made is not None:
                made.append(each)
            yield each

    return Designator(action, {"type": "counting"}, resolve=resolve)


def test_all_threads_get_the_same_first_solution_which_is_made_once():
    for _ in range(30):
        made = []
        desig = counted(3, made)
        assert everywhere(desig.reference) == [0] * THREADS
        assert made.count(0) == 1


def test_all_threads_walk_the_same_chain():
    for _ in range(10):
        made = []
        first = counted(20, made)

        def walk(first=first):
            found, desig = [], first
            while desig is not None:
                found.append(desig.reference())
                desig = desig.next_solution()
            return found

        assert everywhere(walk) == [list(range(20))] * THREADS
        assert made == list(range(20))
        assert current_desig(first).reference() == 19 and first_desig(current_desig(first)) is first


def test_next_solutions_of_one_designator_are_one_designator():
    first = counted(2)
    nexts = everywhere(first.next_solution)
    assert len({id(each) for each in nexts}) == 1 and desig_equal(first, nexts[0])
    assert nexts[0].next_solution() is None and nexts[0].next_solution() is None


def test_a_generator_that_fails_fails_everywhere_with_the_same():
    def resolve(_):
        yield 1
        raise PerceptionObjectNotFound("gone")

    desig = Designator(object_, {"type": "ball"}, resolve=resolve)
    assert desig.reference() == 1
    answers = everywhere(desig.next_solution)
    assert all(isinstance(each, PerceptionObjectNotFound) or each is None for each in answers)
    assert desig.reference() == 1


def test_designators_are_equated_from_many_threads():
    root = a(object_, type="ball")
    others = [a(object_, type="ball", number=number) for number in range(THREADS)]
    left = list(others)
    everywhere(lambda: equate(root, left.pop()))
    chain = {id(first_desig(each)) for each in others}
    assert chain == {id(root)}
    assert len({id(current_desig(each)) for each in others}) == 1
    assert current_desig(root) in others


# --- rules ------------------------------------------------------------------------------------------------------------


def test_rules_go_by_priority_then_by_what_they_say_then_by_age():
    rules, order = Rules(), []

    def add(name, priority=0, **pattern):
        @rule(action, rules=rules, called=name, priority=priority, **pattern)
        def solve():
            order.append(name)
            return name

    add("old", type="waving")
    add("new", type="waving")
    add("exact", type="waving", times=2)
    add("last of all", priority=-1, type="waving", times=2, person="Anna")
    add("first", priority=5)
    desig = an(action, type="waving", times=2, person="Anna")
    assert list(rules.solutions(desig)) == ["first", "exact", "new", "old", "last of all"]
    order.clear()
    assert next(iter(rules.solutions(desig))) == "first" and order == ["first"], "later rules are asked when needed"


def test_rules_that_come_while_others_are_asked_harm_nobody():
    rules = Rules()

    @rule(action, rules=rules, type="counting", to=number(0, 1000))
    def count(to):
        return int(to)

    def ask():
        found = []
        for turn in range(50):

            @rule(action, rules=rules, called=f"{threading.get_ident()} {turn}", type="other")
            def other():
                return None

            found += rules.solutions(an(action, type="counting", to=turn))
        return found

    assert everywhere(ask) == [list(range(50))] * THREADS


def test_a_rule_of_a_user_fails_with_its_own_failure():
    rules = Rules()

    @rule(action, rules=rules, type="flying")
    def flying():
        fail(NavigationGoalNotReached, "no wings")

    with pytest.raises(NavigationGoalNotReached, match="no wings"):
        list(rules.solutions(an(action, type="flying")))


@pytest.mark.parametrize(
    "given, module, name",
    [
        ("{type: action, name: to open, side: left}", "manipulation", "open_gripper"),
        ("{name: to close, side: left}", "manipulation", "close_gripper"),
        ("{name: to look, position: [2, 3]}", "manipulation", "move_head"),
        ("{name: to reach, side: left, target: [0.15, 0.1, 0.1]}", "manipulation", "move_arm"),
        ("{name: to walk, target: [1, 0]}", "navigation", "walk_to"),
        ("{name: to say, text: Hello}", "speech", "text_to_speech"),
        ("{name: go stable}", "manipulation", "go_stable"),
        ("{type: trajectory, to: open, side: left}", "manipulation", "open_gripper"),
    ],
)
def test_the_forms_of_old_are_understood(given, module, name):
    solution = designator(given).reference()
    assert isinstance(solution, Command) and solution.module == module
    assert solution.name == name or module == "speech"


@pytest.mark.parametrize(
    "given, told",
    [
        ({"type": "opening", "gripper": "middle"}, "gripper"),
        ({"type": "opening"}, "gripper"),
        ({"type": "going"}, "target"),
        ({"type": "going", "target": "there"}, "target"),
        ({"type": "moving-gripper-joint", "gripper": "left", "joint_angle": 2}, "joint_angle"),
    ],
)
def test_what_is_wrong_with_a_key_is_told_with_the_key(given, told):
    with pytest.raises(DesignatorError, match=told):
        an(action, **given).reference()


# --- goals ------------------------------------------------------------------------------------------------------------


def test_goals_beside_each_other_each_keep_their_own():
    state = Fluent("state", frozenset())
    done = []

    @declare_goal
    def there(name):
        return name in state.value

    @def_goal(there)
    def bring(name):
        sleep(0.001)
        done.append(name)
        state.update(lambda names: names | {name})

    top_level(lambda: par(*(do(achieve, there(str(number))) for number in range(10))))
    top_level(lambda: par(*(do(achieve, there(str(number))) for number in range(10))))
    assert sorted(done) == [str(number) for number in range(10)] and holds(there("3"))


def test_a_goal_of_goals_fails_with_what_failed():
    @declare_goal
    def everything():
        return False

    @declare_goal
    def one_thing():
        return False

    @def_goal(one_thing)
    def try_it():
        fail(NavigationGoalNotReached, "stuck")

    @def_goal(everything)
    def all_of_it():
        par(do(achieve, one_thing()), do(sleep, 1000.0))

    with pytest.raises(NavigationGoalNotReached, match="stuck"):
        top_level(do(achieve, everything()))


def test_a_goal_that_somebody_else_reaches_meanwhile_is_reached():
    state = Fluent("state", False)

    @declare_goal
    def reached():
        return state.value

    @def_goal(reached)
    def nothing():
        wait_for(state)

    top_level(lambda: par(do(achieve, reached()), lambda: setattr(state, "value", True)))


def test_a_goal_that_does_not_hold_afterwards_can_be_tried_again():
    tries = []

    @declare_goal
    def lucky():
        return len(tries) >= 3

    @def_goal(lucky)
    def throw():
        tries.append(True)

    from nao_library_modules.process_modules.handling import retry

    top_level(
        lambda: with_failure_handling(do(achieve, lucky()), {GoalNotAchieved: lambda failure: retry()}),
    )
    assert len(tries) == 3


# --- places -----------------------------------------------------------------------------------------------------------


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


# --- seeing -----------------------------------------------------------------------------------------------------------


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
