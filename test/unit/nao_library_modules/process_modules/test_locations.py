"""Objects that are known, and places that descriptions stand for."""

from __future__ import annotations

import math

import pytest

from nao_library_modules.places import Place
from nao_library_modules.process_modules.designators.designator import a, all_, location, object_, the
from nao_library_modules.process_modules.designators.locations import (
    Candidate,
    Verdict,
    next_different_location_solution,
    register_location_generator,
    register_location_validation_function,
)
from nao_library_modules.process_modules.designators.objects import BELIEFS, object_pose
from nao_library_modules.process_modules.failures import AmbiguousPerception, DesignatorError
from nao_library_modules.process_modules.settings import numbers_of_nao
from nao_library_modules.process_modules.space import Point3

pytestmark = pytest.mark.usefixtures("nothing_is_known")
ROBOT_RADIUS = numbers_of_nao().robot_radius


@pytest.fixture
def table():
    return BELIEFS.know("table", position=Point3(1.0, 0.0, 0.15, "odom"), size=(0.7, 1.1, 0.3))


def test_what_is_known_is_found_by_what_is_said_of_it(table):
    BELIEFS.know("ball-1", type="ball", position=Point3(0, 0, 0, "odom"), colour="red")
    BELIEFS.know("ball-2", type="ball", position=Point3(1, 0, 0, "odom"), colour="blue")
    assert the(object_, type="Table").reference() is table
    assert a(object_, type="ball", colour="blue").reference().name == "ball-2"
    assert [thing.name for thing in all_(object_, type="ball").reference()] == ["ball-1", "ball-2"]
    assert object_pose(the(object_, name="ball-1")) == Point3(0, 0, 0, "odom")
    with pytest.raises(AmbiguousPerception, match="several fit: ball-1, ball-2"):
        the(object_, type="ball").reference()
    with pytest.raises(DesignatorError, match="nothing is known that fits: known is table, ball-1, ball-2"):
        a(object_, type="cup").reference()


def test_a_thing_that_is_seen_again_has_moved():
    first = BELIEFS.saw("ball", "", Point3(1.0, 0.0, 0.05, "odom"), 10.0, colour="red")
    near = BELIEFS.saw("ball", "", Point3(1.1, 0.0, 0.05, "odom"), 11.0)
    far = BELIEFS.saw("ball", "", Point3(0.0, 1.0, 0.05, "odom"), 12.0)
    assert (first.name, near.name, far.name) == ("ball", "ball", "ball-2")
    assert near.value("colour") == "red" and near.position.x == 1.1
    assert [thing.name for thing in BELIEFS.fitting(a(object_, type="ball"))] == ["ball-2", "ball"]
    anna = BELIEFS.saw("face", "anna", Point3(1.0, 0.0, 1.0, "odom"), 1.0)
    assert BELIEFS.saw("face", "anna", Point3(3.0, 0.0, 1.0, "odom"), 2.0).name == anna.name
    BELIEFS.forget("anna")
    assert not BELIEFS.fitting(a(object_, name="anna"))


def test_a_pose_is_the_place(table):
    assert a(location, pose=[0.2, 0.1, 1.5]).reference() == (Place(0.2, 0.1, 1.5), "odom")
    assert a(location, pose=[0.2, 0.1], frame="map").reference() == (Place(0.2, 0.1, 0.0), "map")
    with pytest.raises(DesignatorError, match=r"its pose is \['a'\]"):
        a(location, pose=["a"]).reference()


def test_a_pose_inside_of_the_table_will_not_do(table):
    with pytest.raises(DesignatorError, match="none of 1 places will do: not_in_collision rejected 1"):
        a(location, pose=[1.0, 0.2, 0.0]).reference()


def test_places_near_a_thing_look_at_it_from_its_edge(table):
    desig = a(location, near=the(object_, type="table"), distance=0.1)
    place, frame = desig.reference()
    assert frame == "odom" and place == pytest.approx((1.0 - 0.35 - 0.1 - ROBOT_RADIUS, 0.0, 0.0), abs=1e-3)
    places = [each for each, _ in desig.solutions()]
    assert len(places) == 24
    for each in places:
        assert table.distance_to(each.x, each.y) == pytest.approx(0.1 + ROBOT_RADIUS, abs=5e-3)
        bearing = math.atan2(table.position.y - each.y, table.position.x - each.x)
        assert math.cos(bearing - each.yaw) > 0.999


def test_places_to_see_from_are_not_behind_a_wall(table):
    BELIEFS.know("ball", position=Point3(1.0, 1.5, 0.05, "odom"))
    BELIEFS.know("wall", position=Point3(0.55, 1.5, 0.4, "odom"), size=(0.1, 2.0, 0.8))
    places = [place for place, _ in a(location, to="see", object=the(object_, type="ball")).solutions()]
    assert places and all(place.x > 0.6 for place in places)
    assert all(math.hypot(place.x - 1.0, place.y - 1.5) > 0.3 for place in places)


def test_places_to_reach_from_have_the_thing_ahead_of_the_shoulder():
    BELIEFS.know("cup", position=Point3(2.0, 0.0, 0.35, "odom"))
    place, _ = a(location, to="reach", object=the(object_, type="cup"), side="left").reference()
    seen = Place(2.0, 0.0, 0.0).seen_from(place)
    assert (seen.x, seen.y) == pytest.approx((0.16, 0.1), abs=1e-6)
    BELIEFS.know("cup", position=Point3(2.0, 0.0, 0.9, "odom"))
    with pytest.raises(DesignatorError, match=r"none of 144 places will do: in_reach rejected 144"):
        a(location, to="reach", object=the(object_, type="cup")).reference()


def test_the_next_place_is_really_another_one():
    def generator(desig):
        for x in (0.0, 0.01, 0.02, 0.5):
            yield Candidate(Place(x, 0.0, 0.0), "odom")

    register_location_generator(100, generator)
    first = a(location, anywhere=True)
    assert first.reference()[0].x == 0.0
    second = next_different_location_solution(first)
    assert second.reference()[0].x == 0.5
    assert next_different_location_solution(second) is None


def test_users_judge_places_too():
    def generator(desig):
        for x in (-1.0, 0.0, 1.0, 2.0):
            yield Candidate(Place(x, 0.0, 0.0), "odom")

    def not_behind(desig, candidate):
        return Verdict.REJECT if candidate.place.x < 0.0 else Verdict.UNKNOWN

    def rather_far(desig, candidate):
        return Verdict.MAYBE_REJECT if candidate.place.x < 1.5 else Verdict.ACCEPT

    register_location_generator(100, generator)
    register_location_validation_function(50, not_behind)
    register_location_validation_function(40, rather_far)
    desig = a(location, anywhere=True)
    assert [place.x for place, _ in desig.solutions()] == [2.0, 0.0, 1.0]


def test_nobody_knows_what_is_meant():
    with pytest.raises(DesignatorError, match="nobody knows which place is meant"):
        a(location, cosy=True).reference()
    with pytest.raises(DesignatorError, match="its near stands for .* which is no known object"):
        a(location, near=a(location, pose=[0, 0, 0])).reference()
