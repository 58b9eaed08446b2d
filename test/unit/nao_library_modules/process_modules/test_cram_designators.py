"""Designators from several threads, and rules of users."""

from __future__ import annotations

import threading

import pytest

from nao_library_modules.process_modules import action_rules, perception  # noqa: F401
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
    object_,
)
from nao_library_modules.process_modules.designators.patterns import number
from nao_library_modules.process_modules.designators.rules import Command, Rules, rule
from nao_library_modules.process_modules.failures import (
    DesignatorError,
    NavigationGoalNotReached,
    PerceptionObjectNotFound,
    fail,
)

pytestmark = pytest.mark.usefixtures("nothing_is_known")
THREADS = 8


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
