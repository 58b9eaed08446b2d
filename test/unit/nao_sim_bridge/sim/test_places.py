"""Where robots stand when a simulation starts."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.sim.errors import BadValue
from nao_sim_bridge.sim.places import CIRCLE, NEAREST, ORIGIN, RobotPlace, checked_places, on_circle, parse_places
from nao_sim_bridge.sim.world import WorldError, load_world

WORLD = "floor: {friction: 1.0}\nrobots: "


@pytest.mark.parametrize("count", [2, 3, 5, 8])
def test_on_a_circle_all_look_at_the_middle_and_nobody_is_too_near(count):
    places = checked_places(on_circle(count), count)
    for place in places:
        assert math.hypot(place.x, place.y) == pytest.approx(CIRCLE, abs=1e-5)
        ahead = (place.x + CIRCLE * math.cos(place.yaw), place.y + CIRCLE * math.sin(place.yaw))
        assert ahead == pytest.approx((0.0, 0.0), abs=1e-5)
    assert places[0].yaw == 0.0


def test_one_that_is_alone_stands_at_the_origin():
    assert on_circle(1) == (ORIGIN,) == (RobotPlace(0.0, 0.0, 0.0),)


def test_places_are_read_from_a_line():
    assert parse_places("0,0,0; 1.5,-2,90;3,4") == (
        RobotPlace(0.0, 0.0, 0.0),
        RobotPlace(1.5, -2.0, math.pi / 2),
        RobotPlace(3.0, 4.0, 0.0),
    )


@pytest.mark.parametrize("text", ["", "1", "1,2,3,4", "1,2,north", "0,0;", "1e9,0,0", "nan,0,0", "0,0,inf"])
def test_a_line_that_is_none_is_refused(text):
    with pytest.raises(BadValue, match="place"):
        parse_places(text)


def test_too_few_and_too_near_places_are_refused():
    with pytest.raises(BadValue, match="one for each of the 3 robots"):
        checked_places(on_circle(2), 3)
    with pytest.raises(BadValue, match=f"{NEAREST:g} m or more"):
        checked_places((ORIGIN, RobotPlace(0.2, 0.1)), 2)
    with pytest.raises(BadValue, match="1 to 8"):
        checked_places(on_circle(2), 9)
    assert checked_places(on_circle(3), 2) == on_circle(3)[:2]


def test_a_world_file_says_where_robots_stand(tmp_path):
    file = tmp_path / "two.yaml"
    file.write_text(WORLD + "[{position: [1, 2], yaw: 0.5}, {position: [-1, 0]}]", encoding="utf-8")
    assert load_world(str(file)).robots == (RobotPlace(1.0, 2.0, 0.5), RobotPlace(-1.0, 0.0, 0.0))
    assert load_world("empty").robots == ()


@pytest.mark.parametrize(
    "entry", ["{position: [1]}", "{yaw: 1}", "{position: [1, 2], turn: 3}", "{position: [99, 0]}", "7"]
)
def test_a_wrong_entry_of_a_world_file_is_named(tmp_path, entry):
    file = tmp_path / "wrong.yaml"
    file.write_text(f"{WORLD}[{entry}]", encoding="utf-8")
    with pytest.raises(WorldError, match=r"wrong.yaml: robots\[0\]"):
        load_world(str(file))
