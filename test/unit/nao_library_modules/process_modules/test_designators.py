"""Designators: descriptions, solutions, chains; and the rules that resolve them."""

from __future__ import annotations

import math

import pytest

from nao_library_modules.process_modules.designators import patterns
from nao_library_modules.process_modules.designators.designator import (
    Designator,
    a,
    action,
    all_,
    an,
    current_desig,
    desig_equal,
    designator,
    equate,
    first_desig,
    location,
    newest_effective_designator,
    object_,
    the,
)
from nao_library_modules.process_modules.designators.patterns import described, number, numbers, one_of, text
from nao_library_modules.process_modules.designators.rules import Command, Rules, command, rule
from nao_library_modules.process_modules.failures import DesignatorError, PlanError


def of_numbers(*found):
    return Designator(action, {"type": "counting"}, resolve=lambda desig: iter(found))


def test_it_keeps_to_its_first_solution():
    desig = of_numbers(1, 2, 3)
    assert not desig.resolved
    assert desig.reference() == desig.reference() == 1
    assert desig.resolved


def test_next_solutions_are_newer_designators_of_the_same_thing():
    first = of_numbers(1, 2)
    second = first.next_solution()
    assert second.reference() == 2 and second.next_solution() is None
    assert desig_equal(first, second) and current_desig(first) is second and first_desig(second) is first
    assert first.reference() == 1


def test_solutions_are_worked_out_when_they_are_needed():
    made = []

    def resolve(desig):
        for each in range(100):
            made.append(each)
            yield each

    desig = Designator(action, {}, resolve=resolve)
    assert [solution for solution, _ in zip(desig.solutions(), range(3))] == [0, 1, 2]
    assert len(made) <= 4


def test_without_a_solution_it_says_so():
    with pytest.raises(DesignatorError, match=r"an action \(type='counting'\): no solution"):
        of_numbers().reference()


def test_equated_designators_are_one_chain():
    one, two, three = (a(object_, type="ball", place=place) for place in ("shelf", "table", "floor"))
    equate(one, two)
    equate(one, three)
    assert current_desig(one) is three and first_desig(three) is one
    assert newest_effective_designator(one) is None
    equate(three, one)
    assert current_desig(one) is three
    with pytest.raises(DesignatorError, match="the kinds differ"):
        equate(one, a(location, near=one))
    assert not desig_equal(one, a(object_, type="ball"))


def test_copies_and_merges():
    ball = the(object_, type="ball", colour="red")
    assert ball.copy(colour=None, size=0.05).description == {"type": "ball", "size": 0.05}
    assert ball.copy().quantifier == "the"
    assert ball.merge(a(object_, size=0.05)).description == {"type": "ball", "colour": "red", "size": 0.05}
    with pytest.raises(DesignatorError, match="colour is 'red' and 'blue'"):
        ball.merge(a(object_, colour="blue"))
    assert ball["colour"] == "red" and "size" not in ball and ball.get("size", 1) == 1
    with pytest.raises(DesignatorError, match="no key 'size': it has type, colour"):
        ball["size"]


@pytest.mark.parametrize(
    "given",
    [
        {"type": "action", "name": "to open", "side": "left"},
        [("type", "action"), ("name", "to open"), ("side", "left")],
        "{type: action, name: to open, side: left}",
        "type: action\nname: to open\nside: left",
    ],
)
def test_the_form_of_keys_and_values(given):
    desig = designator(given)
    assert desig.kind == action and desig.description == {"name": "to open", "side": "left"}


def test_designators_inside_of_designators():
    desig = designator("{name: to walk, goal: {location: {near: {type: object, name: table}}, speed: 1}}")
    assert desig["goal"] == {"location": {"near": desig["goal"]["location"]["near"]}, "speed": 1}
    assert desig["goal"]["location"]["near"].kind == object_
    desig = designator("{type: going, target: {location: {near: {object: {type: ball}}}}}")
    assert desig.kind == action and desig["type"] == "going"
    assert desig["target"].kind == location and desig["target"]["near"]["type"] == "ball"


@pytest.mark.parametrize("given", ["open the gripper", "", "[1, 2]", "{a: ", {1: 2}, 7])
def test_what_has_no_keys_is_an_error(given):
    with pytest.raises(PlanError, match="designator: "):
        designator(given)


def test_designators_are_told_as_they_are_written():
    desig = an(action, type="looking", target=a(location, near=the(object_, type="ball")))
    told = "an action (type='looking', target=(a location (near=(the object (type='ball')))))"
    assert str(desig) == told
    assert all_(object_).quantifier == "all"
    with pytest.raises(PlanError, match="of kind 'thing': action, motion, location, object"):
        a("thing")


# --- rules ------------------------------------------------------------------------------------------------------------


@pytest.fixture
def rules():
    rules = Rules()

    @rule(action, rules=rules, type="opening", gripper=one_of("left", "right"))
    def opening(gripper):
        return command("manipulation", "open_gripper", side=gripper)

    @rule(action, rules=rules, type="looking", at=numbers(3, "m"), speed=number(0.0, 1.0).or_else(0.5))
    def looking(at, speed):
        yield command("manipulation", "move_head", target=at, speed=speed)
        yield command("manipulation", "move_head", target=at, speed=speed / 2.0)

    return rules


def solve(rules, **description):
    return list(rules.solutions(an(action, **description)))


def test_a_rule_gets_the_values_of_its_keys(rules):
    found = solve(rules, type="Opening", gripper="LEFT", colour="does not matter")
    assert found == [Command("manipulation", "open_gripper", {"side": "left"})]
    assert str(found[0]) == "manipulation: open_gripper(side='left')"


def test_a_rule_may_have_several_solutions_and_defaults(rules):
    found = solve(rules, type="looking", at=[1, 0, 0.5])
    assert [each.arguments["speed"] for each in found] == [0.5, 0.25]
    assert solve(rules, type="looking", at={"x": 1, "y": 0, "z": 0.5}, speed=1)[0].arguments["target"] == (1, 0, 0.5)


@pytest.mark.parametrize(
    "description, told",
    [
        ({"type": "opening", "gripper": "middle"}, "rule 'opening': gripper is 'middle', not 'left' or 'right'"),
        ({"type": "opening"}, "rule 'opening': gripper is missing: 'left' or 'right'"),
        ({"type": "looking", "at": [1, math.nan, 0]}, r"rule 'looking': at is \[1, nan, 0\], not 3 numbers in m"),
        ({"type": "looking", "at": [1, 0, 0], "speed": 2}, "speed is 2, not a number from 0 to 1"),
        ({"typ": "opening"}, "type is missing"),
    ],
)
def test_no_rule_fits_tells_which_failed_on_which_key(rules, description, told):
    with pytest.raises(DesignatorError, match=told):
        solve(rules, **description)


def test_the_nearest_rule_is_told_first(rules):
    with pytest.raises(DesignatorError, match="no rule fits: rule 'looking': at is missing"):
        solve(rules, type="looking")


def test_rules_of_users_go_first_and_priorities_before_all(rules):
    @rule(action, rules=rules, type="opening", gripper=one_of("left", "right"))
    def mine(gripper):
        return "mine"

    @rule(action, rules=rules, type="opening", gripper="left")
    def left(gripper):
        return "left"

    @rule(action, rules=rules, priority=1, type="opening")
    def first(desig):
        return desig["gripper"]

    ours = Command("manipulation", "open_gripper", {"side": "left"})
    assert solve(rules, type="opening", gripper="left") == ["left", "left", "mine", ours]


def test_a_rule_of_the_same_name_takes_the_place_of_the_old_one(rules):
    @rule(action, rules=rules, called="opening", type="opening")
    def other():
        return ["a", "b"]

    assert solve(rules, type="opening", gripper="left") == ["a", "b"]
    rules.remove(rules.of(action)[0])
    assert len(rules.of(action)) == 1


def test_a_rule_that_fits_may_have_no_solution(rules):
    @rule(action, rules=rules, type="flying")
    def flying():
        return None

    assert solve(rules, type="flying") == []


def test_rules_are_about_designators(rules):
    with pytest.raises(PlanError, match="its argument side is none of its keys type, desig"):
        rule(action, rules=rules, type="opening")(lambda side: None)
    with pytest.raises(PlanError, match="not 'place'"):
        rule("place", rules=rules)(lambda: None)
    with pytest.raises(DesignatorError, match="there is no rule about locations"):
        next(rules.solutions(a(location)))


@pytest.mark.parametrize(
    "pattern, good, bad",
    [
        (text(), "a", " "),
        (number(0.0, 1.0, "rad"), 0.5, True),
        (number(), 3, math.inf),
        (numbers(2), (1, 2), (1, 2, 3)),
        (described(object_), the(object_), a(location)),
        (one_of("to open", 3), "To_Open", "open"),
    ],
)
def test_patterns(pattern, good, bad):
    pattern.take(good)
    with pytest.raises(patterns.Mismatch):
        pattern.take(bad)
