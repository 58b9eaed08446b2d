"""Designators: descriptions, solutions, chains, the rules that resolve them, and the places that they stand for."""

from __future__ import annotations

import math
import subprocess
import sys

import pytest
from diagnostic_msgs.msg import KeyValue

import nao_library_modules.process_modules as p
from nao_library_actions.msg import PerformDesignatorGoal
from nao_library_modules.core.geometry import Place
from nao_library_modules.process_modules import action_rules  # noqa: F401  the rules of the library
from nao_library_modules.process_modules.action_rules import a_place, a_point, a_position
from nao_library_modules.process_modules.designator_server import read
from nao_library_modules.process_modules.designators.objects_and_locations import (
    Candidate,
    Verdict,
    next_different_location_solution,
    object_pose,
    register_location_generator,
    register_location_validation_function,
)
from nao_library_modules.process_modules.designators.rules import (
    Mismatch,
    Rules,
    number,
    numbers,
    numbers_of_nao,
    one_of,
)
from nao_library_modules.process_modules.failures import AmbiguousPerception, DesignatorError, PerceptionObjectNotFound

HUGE = 10**400
RADIUS = numbers_of_nao().robot_radius


def counting(to, made=None):
    def resolve(_):
        for each in range(to):
            if made is not None:
                made.append(each)
            yield each

    return p.Designator(p.action, {"type": "counting"}, resolve=resolve)


def a_place_where(**description):
    return p.a(p.location, **description)


def test_it_keeps_to_its_first_solution_and_the_next_are_newer_designators_of_the_same_thing():
    made = []
    first = counting(100, made)
    assert not first.resolved and first.reference() == first.reference() == 0 and first.resolved
    second = first.next_solution()
    assert second.reference() == 1 and p.desig_equal(first, second) and not p.desig_equal(first, counting(2))
    assert p.current_desig(first) is second and p.first_desig(second) is first and first.reference() == 0
    assert [solution for solution, _ in zip(first.solutions(), range(3))] == [0, 1, 2]
    assert len(made) <= 4
    last = counting(1)
    assert last.reference() == 0 and last.next_solution() is None
    with pytest.raises(DesignatorError, match=r"an action \(type='counting'\): no solution"):
        counting(0).reference()


def test_a_generator_that_fails_fails_with_its_failure():
    def resolve(_):
        yield 1
        raise PerceptionObjectNotFound("gone")

    desig = p.Designator(p.object_, {"type": "ball"}, resolve=resolve)
    assert desig.reference() == 1
    with pytest.raises(PerceptionObjectNotFound):
        desig.next_solution()
    assert desig.reference() == 1


def test_copies_and_merges():
    ball = p.the(p.object_, type="ball", colour="red")
    assert ball.copy(colour=None, size=0.05).description == {"type": "ball", "size": 0.05}
    assert ball.copy().quantifier == "the" and p.all_(p.object_).quantifier == "all"
    assert ball.merge(p.a(p.object_, size=0.05)).description == {"type": "ball", "colour": "red", "size": 0.05}
    with pytest.raises(DesignatorError, match="colour is 'red' and 'blue'"):
        ball.merge(p.a(p.object_, colour="blue"))
    assert ball["colour"] == "red" and "size" not in ball and ball.get("size", 1) == 1
    with pytest.raises(DesignatorError, match="no key 'size': it has type, colour"):
        ball["size"]
    desig = p.an(p.action, type="looking", target=a_place_where(near=p.the(p.object_, type="ball")))
    assert str(desig) == "an action (type='looking', target=(a location (near=(the object (type='ball')))))"


@pytest.mark.parametrize("given", ["open the gripper", "", "[1, 2]", "{a: ", {1: 2}, 7])
def test_what_has_no_keys_is_an_error(given):
    with pytest.raises(p.PlanError, match="designator: "):
        p.designator(given)
    with pytest.raises(p.PlanError, match="of kind 'thing': action, motion, location, object"):
        p.a("thing")


BOMB = "{a: &a [0,0,0,0,0,0,0,0,0,0], b: &b [*a,*a,*a,*a,*a,*a,*a,*a,*a,*a], c: [*b,*b,*b,*b,*b,*b,*b,*b,*b,*b]}"
MERGES = "{a: &a {k: 1}, b: &b {<<: [*a,*a,*a,*a,*a,*a,*a,*a,*a,*a]}, c: &c {<<: [%s]}, d: {<<: [%s]}}" % (
    ",".join(["*b"] * 10),
    ",".join(["*c"] * 10),
)


@pytest.mark.parametrize(
    "text, told",
    [
        (BOMB, "more than 1000 values"),
        (MERGES, "more than 1000 values"),
        ("{type: looking, at: &a [*a]}", "more than 40 levels deep"),
        ("{type: " + "[" * 50 + "]" * 50 + "}", "more than 40 levels deep"),
        ("[" * 50_000, "more than 100 brackets"),
        ("(type looking at " + "(" * 50_000 + ")" * 49_000, "too many levels"),
        ("(type looking at (" + "1 " * 2000 + "))", "too many values"),
        ("{type: looking, text: " + "a" * 100_000 + "}", "has 100023 characters: at most 100000"),
        ("{type: looking, day: 2024-99-99}", "is no YAML"),
        ("{type: looking, speed: 1" + "0" * 400 + "}", "has 1329 bits: at most 64"),
        ("{type: looking, speed: 1" + "0" * 5000 + "}", "designator: "),
        ("(type looking speed 1" + "0" * 400 + ")", "has 401 characters: 40 at most"),
    ],
    ids=range(12),
)
def test_text_that_stands_for_too_much_is_an_error(text, told):
    with pytest.raises(p.PlanError, match=told) as caught:
        p.designator(text)
    assert len(str(caught.value)) < 1000


def test_keys_and_values_of_a_goal_may_stand_for_no_more_than_one_text():
    many = "[" + "1," * 99 + "1]"
    with pytest.raises(p.PlanError, match="more than 1000 values"):
        read(PerformDesignatorGoal(pairs=[KeyValue(f"key{i}", many) for i in range(12)]))
    with pytest.raises(p.PlanError, match="at most 100000 are read"):
        read(PerformDesignatorGoal(pairs=[KeyValue(f"key{i}", "a" * 10_000) for i in range(11)]))


@pytest.fixture
def rules():
    rules = Rules()

    @p.rule(p.action, rules=rules, type="opening", gripper=one_of("left", "right"))
    def opening(gripper):
        return p.command("manipulation", "open_gripper", side=gripper)

    @p.rule(p.action, rules=rules, type="looking", at=numbers(3, "m"), speed=number(0.0, 1.0).or_else(0.5))
    def looking(at, speed):
        yield p.command("manipulation", "move_head", target=at, speed=speed)
        yield p.command("manipulation", "move_head", target=at, speed=speed / 2.0)

    return rules


def solve(rules, **description):
    return list(rules.solutions(p.an(p.action, **description)))


def test_a_rule_gets_the_values_of_its_keys_may_have_defaults_and_several_solutions_or_none(rules):
    (found,) = solve(rules, type="Opening", gripper="LEFT", colour="does not matter")
    assert found == p.Command("manipulation", "open_gripper", {"side": "left"})
    assert str(found) == "manipulation: open_gripper(side='left')"
    assert [each.arguments["speed"] for each in solve(rules, type="looking", at=[1, 0, 0.5])] == [0.5, 0.25]
    mapped = solve(rules, type="looking", at={"x": 1, "y": 0, "z": 0.5}, speed=1)
    assert mapped[0].arguments == {"target": (1, 0, 0.5), "speed": 1.0}
    p.rule(p.action, rules=rules, type="flying")(lambda: None)
    assert solve(rules, type="flying") == []


@pytest.mark.parametrize(
    "description, told",
    [
        ({"type": "opening", "gripper": "middle"}, "rule 'opening': gripper is 'middle', not 'left' or 'right'"),
        ({"type": "opening"}, "rule 'opening': gripper is missing: 'left' or 'right'"),
        ({"type": "looking"}, "no rule fits: rule 'looking': at is missing"),
        ({"type": "looking", "at": [1, math.nan, 0]}, r"rule 'looking': at is \[1, nan, 0\], not 3 numbers in m"),
        ({"type": "looking", "at": [1, 0, 0], "speed": 2}, "speed is 2, not a number from 0 to 1"),
        ({"typ": "opening"}, "type is missing"),
    ],
)
def test_where_no_rule_fits_the_nearest_is_told_with_the_key_it_failed_on(rules, description, told):
    with pytest.raises(DesignatorError, match=told):
        solve(rules, **description)


def test_rules_go_by_priority_then_by_what_they_say_then_by_age():
    rules, order = Rules(), []

    def add(name, priority=0, **pattern):
        p.rule(p.action, rules=rules, called=name, priority=priority, **pattern)(lambda: order.append(name) or name)

    add("old", type="waving")
    add("new", type="waving")
    add("exact", type="waving", times=2)
    add("last of all", priority=-1, type="waving", times=2, person="Anna")
    add("first", priority=5)
    desig = p.an(p.action, type="waving", times=2, person="Anna")
    assert list(rules.solutions(desig)) == ["first", "exact", "new", "old", "last of all"]


@pytest.mark.parametrize(
    "pattern, good, bad",
    [
        (number(0.0, 1.0, "rad"), 0.5, [True, -0.1, 1.1, math.nan, HUGE]),
        (numbers(2), (1, 2), [(1, 2, 3), 4, (1, HUGE)]),
        (a_point(), [1, 2, 3], ["near", [1, 2], [1, 2, math.nan], [1, None, 3], [1, 2, HUGE], [1, 2, 3, "odom", 5], 7]),
        (a_position(), [2, 3], [["a", "b"], [1, math.inf], [1], "door", [1, 2, "c"]]),
        (a_place(), [1, 2], [["a", 2], [1, math.nan], [1, 2, 3, 4], {"x": "a", "y": 2}, [1, "odom"], {"x": 1}, "door"]),
    ],
)  # fmt: skip
def test_patterns(pattern, good, bad):
    pattern.take(good)
    for each in bad:
        with pytest.raises(Mismatch):
            pattern.take(each)


def test_points_are_in_the_torso_frame_and_places_in_odom_unless_they_name_another():
    assert a_point().take([1, 2, 3]) == p.Point3(1.0, 2.0, 3.0, "torso")
    assert a_point().take([1, 2, 3, "odom"]) == p.Point3(1.0, 2.0, 3.0, "odom")
    assert a_point().take({"x": 1, "frame": "odom"}) == p.Point3(1.0, 0.0, 0.0, "odom")
    assert a_position().take([2, 3]) == p.Point3(2.0, 3.0, 0.19, "torso"), "at the height of the eyes"
    assert a_place().take([1, 2]) == a_place().take({"x": 1, "y": 2}) == (Place(1.0, 2.0, 0.0), "odom")
    assert a_place().take([1, 2, 0.5, "map"]) == (Place(1.0, 2.0, 0.5), "map")
    assert a_place().take((Place(1.0, 2.0, 0.0), "map")) == (Place(1.0, 2.0, 0.0), "map")


@pytest.mark.parametrize(
    "given, module, name, arguments",
    [
        ("{type: action, name: to open, side: left}", "manipulation", "open_gripper", {"side": "left"}),
        ("{name: to look, position: [2, 3]}", "manipulation", "move_head", {"target": (2.0, 3.0, 0.19, "torso")}),
        ("{name: to walk, target: [1, 0]}", "navigation", "walk_to", {"target": (1.0, 0.0, 0.0), "frame": "odom"}),
        ("{type: navigation, goal: {location: {pose: [1, 2, 3]}}}", "navigation", "walk_to", {"target": (1, 2, 3)}),
        ("{type: going, target: [1, 0, 0, base_footprint]}", "navigation", "walk_to", {"frame": "base_footprint"}),
        ("{name: to say, text: Hello}", "speech", "text_to_speech", {"text": "Hello"}),
        ("{name: to say, sentence: Hello, wait: true}", "speech", "say", {"text": "Hello"}),
        ("{type: saying, text: Hello}", "speech", "text_to_speech", {"text": "Hello"}),
        ("{name: go stable}", "manipulation", "go_stable", {}),
        ([("left", "open")], "manipulation", "open_gripper", {"side": "left"}),
        ([("right", "grasp")], "manipulation", "close_gripper", {"side": "right", "grasp": True}),
        ("{type: moving-gripper-joint, gripper: left, joint_angle: 1}", "manipulation", "move_gripper", {"opening": 1}),
    ],
)  # fmt: skip
def test_all_forms_of_actions_are_understood(given, module, name, arguments):
    solution = p.designator(given).reference()
    assert (solution.module, solution.name) == (module, name)
    assert {key: solution.arguments[key] for key in arguments} == arguments


@pytest.fixture
def table():
    return p.BELIEFS.know("table", position=p.Point3(1.0, 0.0, 0.15, "odom"), size=(0.7, 1.1, 0.3))


def test_what_is_known_is_found_by_what_is_said_of_it(table):
    p.BELIEFS.know("ball-1", type="ball", position=p.Point3(0, 0, 0, "odom"), colour="red")
    p.BELIEFS.know("ball-2", type="ball", position=p.Point3(1, 0, 0, "odom"), colour="blue")
    assert p.the(p.object_, type="Table").reference() is table
    assert p.a(p.object_, type="ball", colour="blue").reference().name == "ball-2"
    assert [thing.name for thing in p.all_(p.object_, type="ball").reference()] == ["ball-1", "ball-2"]
    assert object_pose(p.the(p.object_, name="ball-1")) == p.Point3(0, 0, 0, "odom")
    with pytest.raises(AmbiguousPerception, match="several fit: ball-1, ball-2"):
        p.the(p.object_, type="ball").reference()
    with pytest.raises(DesignatorError, match="nothing is known that fits: known is table, ball-1, ball-2"):
        p.a(p.object_, type="cup").reference()


def test_a_thing_that_is_seen_again_has_moved():
    places = (("ball", "", 1.0, 0.0), ("ball", "", 1.1, 0.0), ("ball", "", 0.0, 1.0), ("face", "anna", 1.0, 0.0))
    found = [p.BELIEFS.saw(kind, name, p.Point3(x, y, 0, "odom"), 1.0 + x, colour="red") for kind, name, x, y in places]
    assert [each.name for each in found] == ["ball", "ball", "ball-2", "anna"]
    assert found[1].value("colour") == "red" and found[1].position.x == 1.1
    assert [thing.name for thing in p.BELIEFS.fitting(p.a(p.object_, type="ball"))] == ["ball", "ball-2"]
    assert p.BELIEFS.saw("face", "anna", p.Point3(3.0, 0.0, 1.0, "odom"), 2.0).name == "anna"
    p.BELIEFS.forget("anna")
    assert not p.BELIEFS.fitting(p.a(p.object_, name="anna"))


def test_a_pose_is_the_place_unless_something_is_in_the_way(table):
    assert a_place_where(pose=[0.2, 0.1, 1.5]).reference() == (Place(0.2, 0.1, 1.5), "odom")
    assert a_place_where(pose=[0.2, 0.1], frame="map").reference() == (Place(0.2, 0.1, 0.0), "map")
    with pytest.raises(DesignatorError, match=r"its pose is \['a'\]"):
        a_place_where(pose=["a"]).reference()
    with pytest.raises(DesignatorError, match="none of 1 places will do: not_in_collision rejected 1"):
        a_place_where(pose=[1.0, 0.2, 0.0]).reference()


def test_places_near_a_thing_look_at_it_from_its_edge(table):
    desig = a_place_where(near=p.the(p.object_, type="table"), distance=0.1)
    place, frame = desig.reference()
    assert frame == "odom" and place == pytest.approx((1.0 - 0.35 - 0.1 - RADIUS, 0.0, 0.0), abs=1e-3)
    places = [each for each, _ in desig.solutions()]
    assert len(places) == 24 and a_place_where(near=table, distance=0.1).reference() == (place, frame)
    for each in places:
        assert table.distance_to(each.x, each.y) == pytest.approx(0.1 + RADIUS, abs=5e-3)
        bearing = math.atan2(table.position.y - each.y, table.position.x - each.x)
        assert math.cos(bearing - each.yaw) > 0.999


def test_places_to_see_from_are_not_behind_a_wall(table):
    p.BELIEFS.know("ball", position=p.Point3(1.0, 1.5, 0.05, "odom"))
    p.BELIEFS.know("wall", position=p.Point3(0.55, 1.5, 0.4, "odom"), size=(0.1, 2.0, 0.8))
    places = [place for place, _ in a_place_where(to="see", object=p.the(p.object_, type="ball")).solutions()]
    assert places and all(place.x > 0.6 for place in places)
    assert all(math.hypot(place.x - 1.0, place.y - 1.5) > 0.3 for place in places)


def test_places_to_reach_from_have_the_thing_ahead_of_the_shoulder():
    cup = p.the(p.object_, type="cup")
    p.BELIEFS.know("cup", position=p.Point3(2.0, 0.0, 0.35, "odom"))
    for side, y in (("left", 0.1), ("right", -0.1)):
        place, _ = a_place_where(to="reach", object=cup, side=side).reference()
        seen = Place(2.0, 0.0, 0.0).seen_from(place)
        assert (seen.x, seen.y) == pytest.approx((0.16, y), abs=1e-6)
    p.BELIEFS.know("cup", position=p.Point3(2.0, 0.0, 0.9, "odom"))
    with pytest.raises(DesignatorError, match=r"none of 144 places will do: in_reach rejected 144"):
        a_place_where(to="reach", object=p.the(p.object_, type="cup")).reference()


def test_users_give_places_and_judge_them_and_the_next_is_really_another_one():
    def along_x(desig):
        yield from (Candidate(Place(x, 0.0, 0.0), "odom") for x in desig.get("along_x", ()))

    def not_behind(desig, candidate):
        return Verdict.REJECT if candidate.place.x < 0.0 else Verdict.UNKNOWN

    def rather_far(desig, candidate):
        return Verdict.MAYBE_REJECT if "far" in desig and candidate.place.x < 1.5 else Verdict.ACCEPT

    register_location_generator(100, along_x)
    register_location_validation_function(50, not_behind)
    register_location_validation_function(40, rather_far)
    try:
        places = a_place_where(along_x=(-1.0, 0.0, 1.0, 2.0), far=True).solutions()
        assert [place.x for place, _ in places] == [2.0, 0.0, 1.0]
        first = a_place_where(along_x=(0.0, 0.01, 0.02, 0.5))
        second = next_different_location_solution(first)
        assert (first.reference()[0].x, second.reference()[0].x) == (0.0, 0.5)
        assert next_different_location_solution(second) is None
    finally:
        register_location_validation_function(50, lambda *_: Verdict.UNKNOWN, "not_behind")
        register_location_validation_function(40, lambda *_: Verdict.UNKNOWN, "rather_far")


def test_designators_are_read_as_lisp_writes_them():
    desig = p.designator('(an action (type looking) (target (a location (at "the table") (height 0.7))))')
    place = desig["target"]
    assert (desig.kind, desig["type"], place.kind, place["at"]) == ("action", "looking", "location", "the table")
    assert place["height"] == 0.7
    for text in ("(type: action (name:(to open)) (side :left))", "(type: action(name:(to open) (side :left)))"):
        told = p.designator(text)
        assert (told.kind, told["name"], told["side"]) == ("action", "to open", "left")
    for text, problem in (
        ("(an action (type opening)", r"the bracket at 1 is not closed"),
        ("(an action (type opening)))", r"a bracket too many at 27"),
        ('(an action (type "opening))', "an open quotation mark"),
        ("(an action opening)", "opening is no key with a value"),
    ):
        with pytest.raises(p.PlanError, match=problem):
            p.designator(text)


def test_a_process_module_comes_with_the_rules_that_resolve_what_it_gets():
    program = """if True:
        import nao_library_modules.process_modules as p
        assert p.ManipulationProcessModule
        print(p.designator("(type: action(name:(to open)) (side :left))").reference())
    """
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
    assert done.stdout == "manipulation: open_gripper(side='left')\n", done.stderr


def test_where_no_rules_are_imported_the_error_says_how_to_have_those_of_a_nao():
    with pytest.raises(DesignatorError, match=r"no rules for actions: import .*action_rules"):
        solve(Rules(), type="opening")
