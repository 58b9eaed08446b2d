"""Ways between postures: the shortest one, and none where none leads."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.posture_graph import leaves_feet, path_to
from nao_sim_bridge.sim.posture_moves import KeyFrame, Move
from nao_sim_bridge.sim.posture_recognition import UNKNOWN, Recognition
from nao_sim_bridge.sim.postures import load_postures, posture

MODEL = load_model()
STANDING_GROUP = ("Stand", "StandInit", "StandZero", "Crouch")


def move(start, goal, duration=5.0, certainty=1.0):
    frames = (KeyFrame(duration, dict(enumerate(posture(MODEL, goal)))),)
    return Move(start, goal, frames, certainty=certainty)


def way(goal, seen, moves=(), fraction=1.0, like=None):
    """The way as texts, from a robot that is where it recognises itself, or whose joints are `like` a posture."""
    name = seen.posture if seen.posture != UNKNOWN else (like or "Stand")
    found = path_to(goal, seen, posture(MODEL, name), fraction, MODEL, moves)
    return found and [str(one) for one in found]


def at(name):
    return Recognition(name, load_postures().by_name[name].family)


@pytest.mark.parametrize("start", STANDING_GROUP)
@pytest.mark.parametrize("goal", STANDING_GROUP)
def test_postures_on_the_feet_are_one_straight_move_apart(start, goal):
    assert way(goal, at(start)) == [f"{start} -> {goal}"]


def test_any_pose_on_the_feet_leads_straight_to_a_posture_on_them():
    assert way("StandInit", Recognition(UNKNOWN, "Crouching")) == ["Crouching -> StandInit"]


def test_sitting_postures_are_one_straight_move_apart():
    assert way("SitRelax", at("Sit")) == ["Sit -> SitRelax"]
    assert way("Sit", Recognition(UNKNOWN, "Sitting"), like="Sit") == ["Sitting -> Sit"]


def test_moves_of_the_file_join_what_straight_ones_do_not():
    assert way("Crouch", at("Sit")) is None
    assert way("Crouch", at("Sit"), [move("Sit", "Stand")]) == ["Sit -> Stand", "Stand -> Crouch"]
    assert way("Crouch", at("SitRelax"), [move("Sit", "Stand")]) == [
        "SitRelax -> Sit",
        "Sit -> Stand",
        "Stand -> Crouch",
    ]


def test_a_move_from_a_family_begins_in_each_of_its_poses():
    moves = [move("LyingBelly", "Stand")]
    expected = ["LyingBelly -> Stand"]
    assert way("Stand", Recognition(UNKNOWN, "LyingBelly"), moves, like="LyingBack") == expected
    assert way("Stand", at("LyingBelly"), moves) == expected


def test_a_move_from_a_posture_does_not_begin_in_any_pose_of_its_family():
    moves = [move("Sit", "Stand")]
    assert way("Stand", Recognition(UNKNOWN, "Sitting"), moves, like="Sit") == ["Sitting -> Sit", "Sit -> Stand"]


def test_the_quickest_way_wins():
    slow, there, on = move("LyingBack", "Stand", 9.0), move("LyingBack", "Sit", 3.0), move("Sit", "Stand", 4.0)
    assert way("Stand", at("LyingBack"), [slow, there, on]) == ["LyingBack -> Sit", "Sit -> Stand"]
    assert way("Stand", at("LyingBack"), [slow, there]) == ["LyingBack -> Stand"]
    quick = move("LyingBack", "Stand", 5.0)
    assert way("Stand", at("LyingBack"), [quick, there, on]) == ["LyingBack -> Stand"]


def test_a_quick_way_that_often_misses_is_not_the_quickest():
    there, on = move("LyingBack", "Sit", 3.0), move("Sit", "Stand", 4.0)
    assert way("Stand", at("LyingBack"), [move("LyingBack", "Stand", 5.0, 0.9), there, on]) == ["LyingBack -> Stand"]
    risky = move("LyingBack", "Stand", 5.0, 0.5)
    assert way("Stand", at("LyingBack"), [risky, there, on]) == ["LyingBack -> Sit", "Sit -> Stand"]


def test_speed_slows_straight_moves_only():
    (straight,) = path_to("StandInit", at("Stand"), posture(MODEL, "Stand"), 0.2, MODEL, ())
    (quick,) = path_to("StandInit", at("Stand"), posture(MODEL, "Stand"), 1.0, MODEL, ())
    assert straight.duration == pytest.approx(5 * quick.duration)
    (dynamic,) = path_to("Stand", at("Sit"), posture(MODEL, "Sit"), 0.2, MODEL, [move("Sit", "Stand", 4.0)])
    assert dynamic.duration == 4.0


@pytest.mark.parametrize("family", [UNKNOWN, "SittingOnChair"])
@pytest.mark.parametrize("like", STANDING_GROUP)
def test_what_is_no_posture_but_nearly_stands_goes_to_the_nearest_standing_one(family, like):
    first, *_ = way("StandZero", Recognition(UNKNOWN, family), like=like)
    assert first == f"{family} -> {like}"


@pytest.mark.parametrize("family", ["LyingLeft", "LyingRight"])
def test_who_lies_on_a_side_tips_over_first(family):
    moves = [move("LyingBack", "Stand")]
    expected = [f"{family} -> LyingBack", "LyingBack -> Stand"]
    assert way("Stand", Recognition(UNKNOWN, family), moves, like="LyingBack") == expected


@pytest.mark.parametrize("goal", ["Stand", "Crouch", "Sit", "LyingBack"])
def test_no_way_leads_out_of_where_no_move_begins(goal):
    assert way(goal, at("LyingBelly"), [move("LyingBack", "Stand"), move("Stand", "Sit")]) is None


@pytest.mark.parametrize(
    "seen, goal, leaves",
    [
        (at("Stand"), "Crouch", False),
        (Recognition(UNKNOWN, "Standing"), "StandInit", False),
        (at("Stand"), "Sit", True),
        (at("LyingBelly"), "Stand", True),
        (at("Sit"), "SitRelax", True),
        (Recognition(UNKNOWN, UNKNOWN), "Stand", True),
    ],
)
def test_moves_off_the_feet_are_told_from_those_on_them(seen, goal, leaves):
    assert leaves_feet(seen, move("Stand", goal)) is leaves
