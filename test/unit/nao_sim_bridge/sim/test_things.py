"""Things that come, move and go while the simulation runs."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from nao_sim_bridge.sim.errors import BadValue, NotAllowed, UnknownName
from nao_sim_bridge.sim.world_objects import read_object

BALL = {"name": "b", "ball": 0.03, "position": [0.6, 0.2, 0.03]}
PERSON = {"name": "p", "person": "anna", "position": [1.5, 0.0, 0.0], "heading": 3.0}


@pytest.fixture
def one(bench):
    return bench(posture="Crouch", world="lab")


def place(one, **entry):
    one.simulation.things.place(read_object(entry, "entry", Path))


def where(one, name):
    return one.simulation.things.places()[name]


def test_a_placed_thing_is_there_for_the_physics_and_for_pictures(one):
    place(one, **{**BALL, "position": [0.4, 0.3, 0.5]})
    things, snapshot = one.simulation.things, one.now
    assert [thing.name for thing in things.placed] == ["b"]
    assert snapshot.placed is things.placed, "also while time stands still"
    assert snapshot.objects["b"].position == pytest.approx((0.4, 0.3, 0.5))
    state = one.simulation.render_state(snapshot)
    assert state.placed is things.placed and "b" in state.objects
    fallen = one.run(1.5).objects["b"].position
    assert fallen[2] == pytest.approx(0.03, abs=0.003)


def test_placed_is_replaced_and_never_changed(one):
    before = one.simulation.things.placed
    place(one, **BALL)
    between = one.simulation.things.placed
    one.run(0.1)
    assert one.now.placed is between, "what does not change stays the same value"
    one.simulation.things.remove("b")
    assert before == () and len(between) == 1 and one.simulation.things.placed == ()


def test_what_cannot_be_moved_holds_the_robot_up(bench):
    one = bench(posture="StandInit", world="empty")
    place(one, name="wall", box=[0.04, 1.0, 0.8], position=[0.25, 0.0, 0.4])
    one.robot.push((60.0, 0.0, 0.0), 0.3, "torso")
    x = [one.run(0.1).torso.position[0] for _ in range(20)]
    assert max(x) < 0.24


def test_a_thing_without_support_falls_also_when_it_slept(one):
    one.run(4.0)
    height = one.now.objects["blue_cube"].position[2]
    one.simulation.things.remove("table")
    assert one.run(1.0).objects["blue_cube"].position[2] == pytest.approx(height - 0.3, abs=0.01)


def test_things_of_the_world_can_go_and_their_names_are_free_then(one):
    one.simulation.things.remove("ball")
    assert one.now.gone == {"ball"} and "ball" not in one.now.objects
    place(one, **{**BALL, "name": "ball"})
    assert one.now.gone == {"ball"}
    assert one.now.objects["ball"].position == pytest.approx((0.6, 0.2, 0.03))
    one.simulation.things.remove("ball")
    assert one.now.placed == () and one.now.gone == {"ball"}


def test_a_reset_returns_to_the_world_file(one):
    before = where(one, "chair_left")
    place(one, **BALL)
    one.simulation.things.remove("table")
    one.simulation.things.move("chair_left", [0.0, 1.5, 0.0], None)
    task = one.simulation.things.move("b", [2.0, 0.0, 0.1], None, 5.0)
    one.run(0.5)
    one.simulation.reset()
    assert (one.now.placed, one.now.gone) == ((), frozenset())
    assert where(one, "chair_left") == pytest.approx(before, abs=1e-6)
    assert "table" in one.simulation.things.things and "b" not in one.simulation.things.things
    assert task.killed


# --- moving -----------------------------------------------------------------------------------------------------------


def test_a_person_walks_by_at_constant_speed(one):
    place(one, **PERSON)
    task = one.simulation.things.move("p", [1.5, -1.0, 0.0], None, 2.0)
    start = one.now.time
    ways = [(one.run(0.5).time - start, where(one, "p")) for _ in range(5)]
    for time, place_now in ways:
        assert place_now[:3] == pytest.approx((1.5, -min(time / 2.0, 1.0), 0.0), abs=0.01)
        assert place_now[5] == pytest.approx(3.0, abs=1e-5)
    assert task.finished and not task.killed
    assert one.now.objects["p"].position[1] == pytest.approx(-1.0, abs=1e-3)


def test_a_thing_on_its_way_pushes_what_is_there(one):
    place(one, name="block", box=[0.1, 0.3, 0.2], position=[0.9, -0.55, 0.1])
    start = one.now.objects["ball"].position[0]
    one.simulation.things.move("block", [0.35, -0.55, 0.1], None, 2.0)
    assert one.run(2.0).objects["ball"].position[0] < start - 0.02


def test_where_something_is_can_be_told_back_to_move(one):
    place(one, **PERSON)
    assert where(one, "p") == pytest.approx((1.5, 0.0, 0.0, 0.0, 0.0, 3.0), abs=1e-6)
    for name in ("p", "chair_left", "poster_left"):
        before = one.simulation.things.places()[name]
        one.simulation.things.move(name, before[:3], before[3:])
        assert where(one, name) == pytest.approx(before, abs=1e-6)


def test_a_turn_alone_and_a_way_with_a_turn(one):
    place(one, **PERSON)
    one.simulation.things.move("p", [1.5, 0.0, 0.0], [0.0, 0.0, -3.0], 1.0)
    halfway = one.run(0.5)
    assert abs(where(one, "p")[5]) == pytest.approx(math.pi, abs=0.02), "the short way round"
    assert halfway.objects["p"].position[:2] == pytest.approx((1.5, 0.0), abs=0.1)


def test_another_move_ends_the_one_before(one):
    place(one, **PERSON)
    first = one.simulation.things.move("p", [1.5, -1.0, 0.0], None, 2.0)
    one.run(1.0)
    second = one.simulation.things.move("p", [1.5, 0.5, 0.0], None, 1.0)
    assert first.killed and not second.finished
    one.run(0.5)
    assert where(one, "p")[1] == pytest.approx(0.0, abs=0.02)
    one.simulation.things.remove("p")
    assert second.killed
    one.run(0.1)


def test_a_killed_move_stops_where_it_is(one):
    place(one, **PERSON)
    task = one.simulation.things.move("p", [1.5, -1.0, 0.0], None, 2.0)
    one.run(1.0)
    task.kill()
    one.run(1.0)
    assert where(one, "p")[1] == pytest.approx(-0.5, abs=0.02)


def test_on_a_slope_places_count_from_the_floor(bench):
    one = bench(posture="Crouch", world="slope_3deg")
    place(one, name="post", box=[0.1, 0.1, 0.4], position=[1.0, 0.3, 0.2])
    assert where(one, "post") == pytest.approx((1.0, 0.3, 0.2, 0.0, 0.0, 0.0), abs=1e-6)
    assert one.now.objects["post"].position[2] == pytest.approx(0.2 + math.tan(math.radians(3.0)), abs=0.01)
    one.simulation.things.move("post", [1.5, 0.3, 0.2], [0.0, 0.0, 0.5])
    assert where(one, "post") == pytest.approx((1.5, 0.3, 0.2, 0.0, 0.0, 0.5), abs=1e-6)


def test_equal_commands_give_equal_runs(bench):
    ends = []
    for _ in range(2):
        one = bench(posture="StandInit", world="lab", seed=3)
        one.run(0.3)
        place(one, **BALL)
        one.simulation.things.move("chair_left", [0.9, 0.6, 0.0], None, 0.5)
        ends.append(one.run(1.0).objects)
    assert ends[0] == ends[1]


# --- errors -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "entry, message",
    [
        ({"name": "table"}, r"name is 'table', allowed is one that is free .*; taken: ball, .*wall_right"),
        ({"name": "floor"}, "name is 'floor'"),
        ({"name": "x" * 65}, "1 to 64 characters"),
        ({"ball": 11.0, "position": [50, 0, 0]}, "size is 11.0, allowed is 10 m at most"),
        ({"position": [101, 0, 0]}, r"position is .*each -100..100"),
    ],
)
def test_what_cannot_be_placed_is_refused(one, entry, message):
    with pytest.raises(BadValue, match=message):
        place(one, **{**BALL, **entry})
    assert one.simulation.things.placed == ()


def test_nothing_appears_inside_the_robot(one):
    with pytest.raises(NotAllowed, match=r"'b' cannot be there: it would be 0\.\d+ m inside the robot"):
        place(one, **{**BALL, "ball": 0.1, "position": [0.0, 0.0, 0.3]})
    assert one.simulation.things.placed == ()
    place(one, **BALL)
    with pytest.raises(NotAllowed):
        one.simulation.things.move("b", [0.0, 0.0, 0.3], None)
    assert where(one, "b")[:3] == pytest.approx((0.6, 0.2, 0.03))


def test_there_is_a_limit_to_things(one):
    for number in range(64):
        place(one, **{**BALL, "name": f"b{number}", "position": [1.8 + 0.1 * (number % 8), 0.1 * (number // 8), 0.03]})
    with pytest.raises(BadValue, match="number of placed things is 65, allowed is 64 at most"):
        place(one, **BALL)


def test_unknown_names_tell_what_is_there(one):
    things = one.simulation.things
    for call in (lambda: things.remove("tabel"), lambda: things.move("tabel", [0, 0, 0], None)):
        with pytest.raises(UnknownName, match=r"unknown object 'tabel': did you mean 'table'.*\(there are: ball, "):
            call()


@pytest.mark.parametrize(
    "arguments, message",
    [
        (([0, 0], None, 0.0), "position is"),
        (([0, 0, math.nan], None, 0.0), "position is"),
        (([2, 0, 0], [0, 0], 0.0), "rpy is"),
        (([2, 0, 0], [0, 0, math.inf], 0.0), "rpy is"),
        (([2, 0, 0], None, -1.0), "duration is -1.0, allowed is 0 to 3600 s"),
    ],
)
def test_wrong_moves_are_refused(one, arguments, message):
    before = where(one, "chair_left")
    with pytest.raises(BadValue, match=message):
        one.simulation.things.move("chair_left", *arguments)
    assert where(one, "chair_left") == before
