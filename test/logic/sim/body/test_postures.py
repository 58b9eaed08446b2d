"""Postures: recognised from readings, ways between them, and moves of the file. Gestures on the head."""

from __future__ import annotations

import math
import random
from math import radians

import numpy as np
import pytest

from nao_sim_bridge.body.touch_gestures import (
    FREE,
    GESTURES,
    HOLD_TIME,
    SEQUENCE_TIME,
    SETTLE_TIME,
    GestureBook,
    GestureRecogniser,
    Seen,
    Times,
)
from nao_sim_bridge.control.balance.posture_recognition import FAMILIES, UNKNOWN, Recognition, recognise_readings
from nao_sim_bridge.core.posture_graph import path_to
from nao_sim_bridge.core.posture_moves import Ground, KeyFrame, Move, direct, load_moves, moves_of
from nao_sim_bridge.model.frames import frame_of
from nao_sim_bridge.model.kinematics import link_transforms
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.postures import load_postures, posture, start_pitch
from nao_sim_bridge.tracking.approach import Relative, goal_beside
from nao_sim_bridge.tracking.geometry import HEAD, arm_angles, distance_of, head_angles, seen_place, turn_to
from nao_sim_bridge.walk.footsteps import FootPose

MODEL = load_model()
FAMILY = {name: entry.family for name, entry in load_postures().by_name.items()}
STANDING_GROUP = ("Stand", "StandInit", "StandZero", "Crouch")
# Roll and pitch of the torso (degrees) with flat feet, on the seat, or lying; share of the weight on the feet.
READINGS = {
    "Stand": (0, 0, 1.0),
    "StandInit": (0, 6, 1.0),
    "StandZero": (0, 0, 1.0),
    "Crouch": (0, -3, 1.0),
    "Sit": (0, -10, 0.4),
    "SitRelax": (0, -15, 0.2),
    "LyingBelly": (0, 85, 0.2),
    "LyingBack": (0, -85, 0.2),
}


def seen(angles, roll=0, pitch=0, load=1.0):
    """Recognition with angles of the torso in degrees."""
    return recognise_readings(MODEL, angles, radians(roll), radians(pitch), load)


def changed(name, **joints):
    """The angles of a posture, some of them others (rad); a name without a side is of both legs."""
    sided = {side + joint: angle for joint, angle in joints.items() for side in ("", "L", "R")}
    return [sided.get(joint.name, angle) for joint, angle in zip(MODEL.joints, posture(MODEL, name))]


@pytest.mark.parametrize("name", FAMILY)
def test_a_predefined_posture_is_recognised_in_spite_of_noise_and_not_in_the_air(name):
    chance, (roll, pitch, load) = random.Random(name), READINGS[name]
    assert seen(posture(MODEL, name), *READINGS[name]) == Recognition(name, FAMILY[name])
    assert FAMILY[name] in FAMILIES
    for _ in range(20):
        angles = [angle + chance.uniform(-0.1, 0.1) for angle in posture(MODEL, name)]
        lean = roll + chance.uniform(-5, 5), pitch + chance.uniform(-5, 5)
        assert seen(angles, *lean, load * chance.uniform(0.9, 1.1)) == Recognition(name, FAMILY[name])
    if load == 1.0:
        assert seen(posture(MODEL, name), roll, pitch, load=0.0) == Recognition(UNKNOWN, UNKNOWN)
    assert (start_pitch(name) is None) == (name in STANDING_GROUP), "only off the feet it has a pitch to start with"


@pytest.mark.parametrize(
    "angles, readings, recognition",
    [
        (changed("Stand", HeadYaw=1.0), {}, ("Stand", "Standing")),
        (changed("Stand", ShoulderPitch=-1.5), {}, (UNKNOWN, "Standing")),
        (changed("StandInit", RHipPitch=-1.0, RKneePitch=1.6, RAnklePitch=-0.6), {"pitch": 6}, (None, "Standing")),
        # A chair takes the weight off bent legs.
        (changed("StandZero", HipPitch=-1.5, KneePitch=1.5, AnklePitch=0), {"load": 0.35}, (None, "SittingOnChair")),
        (changed("StandInit", HipPitch=-1.0, KneePitch=2.0, AnklePitch=-1.0), {}, (None, "Crouching")),
        (posture(MODEL, "StandZero"), {"roll": 25}, (None, UNKNOWN)),
        # Feet stay flat as far as the ankles let them.
        (changed("StandZero", AnklePitch=-radians(40)), {"pitch": 40, "load": 0.8}, (None, UNKNOWN)),
        (posture(MODEL, "StandZero"), {"pitch": 60, "load": 0.8}, (None, "LyingBelly")),
        (posture(MODEL, "StandZero"), {"pitch": -60, "load": 0.8}, (None, "LyingBack")),
        (posture(MODEL, "StandZero"), {"roll": 60, "load": 0.8}, (None, "LyingRight")),
        (posture(MODEL, "StandZero"), {"roll": -60, "load": 0.8}, (None, "LyingLeft")),
    ],
)
def test_families_go_beyond_the_predefined_postures(angles, readings, recognition):
    name, family = recognition
    found = seen(angles, **readings)
    assert found.family == family and name in (None, found.posture)


def move(start, goal, duration=5.0, certainty=1.0):
    return Move(start, goal, (KeyFrame(duration, dict(enumerate(posture(MODEL, goal)))),), certainty=certainty)


def at(name):
    return Recognition(name, FAMILY[name])


def lost(family):
    return Recognition(UNKNOWN, family)


UP, SIT_UP, SLOW = move("LyingBelly", "Stand"), move("Sit", "Stand"), move("LyingBack", "Stand", 9.0)
THERE, ON = move("LyingBack", "Sit", 3.0), move("Sit", "Stand", 4.0)
FAIR, RISKY = (move("LyingBack", "Stand", 5.0, certainty) for certainty in (0.9, 0.5))


@pytest.mark.parametrize(
    "goal, seen, like, moves, way",
    [
        *[(b, at(a), a, [], [f"{a} -> {b}"]) for a in STANDING_GROUP for b in STANDING_GROUP],
        ("StandInit", lost("Crouching"), "Stand", [], ["Crouching -> StandInit"]),
        ("SitRelax", at("Sit"), "Sit", [], ["Sit -> SitRelax"]),
        # Moves of the file join what straight ones do not.
        ("Crouch", at("Sit"), "Sit", [], None),
        ("Crouch", at("SitRelax"), "SitRelax", [SIT_UP], ["SitRelax -> Sit", "Sit -> Stand", "Stand -> Crouch"]),
        # A move from a family begins in each of its poses, one from a posture does not.
        ("Stand", lost("LyingBelly"), "LyingBack", [UP], ["LyingBelly -> Stand"]),
        ("Stand", lost("Sitting"), "Sit", [SIT_UP], ["Sitting -> Sit", "Sit -> Stand"]),
        # The quickest way wins, where one that often misses is not quick.
        ("Stand", at("LyingBack"), "LyingBack", [SLOW, THERE, ON], ["LyingBack -> Sit", "Sit -> Stand"]),
        ("Stand", at("LyingBack"), "LyingBack", [FAIR, THERE, ON], ["LyingBack -> Stand"]),
        ("Stand", at("LyingBack"), "LyingBack", [RISKY, THERE, ON], ["LyingBack -> Sit", "Sit -> Stand"]),
        # Who lies on a side tips over first.
        ("Stand", lost("LyingLeft"), "LyingBack", [SLOW], ["LyingLeft -> LyingBack", "LyingBack -> Stand"]),
        *[(g, at("LyingBelly"), "LyingBelly", [SLOW, move("Stand", "Sit")], None) for g in ("Stand", "Crouch", "Sit")],
    ],
)
def test_ways_between_postures(goal, seen, like, moves, way):
    found = path_to(goal, seen, posture(MODEL, like), 1.0, MODEL, moves)
    assert (found and [str(one) for one in found]) == way


HEAD_YAW, KNEE = MODEL.joint_index["HeadYaw"], MODEL.joint_index["LKneePitch"]
FRAME = {"time": 0.5, "angles": {"HeadYaw": 0.1}}


def content(**changes):
    """A file with one move."""
    move = {"from": "LyingBelly", "to": "Stand", "frames": [FRAME], **changes}
    return {"moves": [{key: value for key, value in move.items() if value is not None}]}


def test_a_move_is_read_and_is_as_certain_as_it_was_found():
    second = {"time": 1.0, "angles": {"HeadYaw": 0, "LKneePitch": 0.5}}
    (move,) = moves_of(content(frames=[FRAME, second], note="why"))
    frames = (KeyFrame(0.5, {HEAD_YAW: 0.1}), KeyFrame(1.0, {HEAD_YAW: 0.0, KNEE: 0.5}))
    assert move == Move("LyingBelly", "Stand", frames, dynamic=True)
    assert (move.duration, move.goal_family, str(move), move.certainty) == (1.5, "Standing", "LyingBelly -> Stand", 1.0)
    (tried,) = moves_of(content(checked={"runs": 20, "reached": 5}))
    assert tried.certainty == 0.25 and tried.expected_duration == 4 * tried.duration


def test_a_straight_move_takes_the_slowest_joint_its_time_and_what_is_safe():
    start, goal = posture(MODEL, "StandZero"), posture(MODEL, "Crouch")
    move = direct(MODEL, "StandZero", "Crouch", start, 1.0, Ground((), 0.0))
    needed = max(abs(a - b) / joint.max_velocity for a, b, joint in zip(goal, start, MODEL.joints))
    assert move.duration == pytest.approx(1.5 * needed) and not move.dynamic
    assert (move.goal, move.frames[-1].angles) == ("Crouch", dict(enumerate(goal)))
    for fraction, duration in ((1.0, 0.8), (0.25, 3.2)):
        move = direct(MODEL, "Stand", "Stand", posture(MODEL, "Stand"), fraction, Ground((), 0.8))
        assert move.duration == pytest.approx(duration)
    slow, quick = (path_to("StandInit", at("Stand"), posture(MODEL, "Stand"), f, MODEL, ()) for f in (0.2, 1.0))
    assert slow[0].duration == pytest.approx(5 * quick[0].duration)
    (dynamic,) = path_to("Stand", at("Sit"), posture(MODEL, "Sit"), 0.2, MODEL, [ON])
    assert dynamic.duration == 4.0, "moves of the file are played as they are"


def test_what_a_camera_sees_is_where_its_ray_goes():
    place = seen_place((0.1, 0.2, 0.5, 0.0, 0.3, 0.7), 0.0, 0.0, 2.0)
    assert math.dist(place, (0.1, 0.2, 0.5)) == pytest.approx(2.0)
    assert math.atan2(place[1] - 0.2, place[0] - 0.1) == pytest.approx(0.7)
    assert seen_place((0.0,) * 6, 0.3, 0.0, 1.0)[1] > 0.0 > seen_place((0.0,) * 6, 0.0, 0.3, 1.0)[2]
    assert (distance_of(0.1, 0.1), distance_of(0.1, 0.05)) == pytest.approx((1.0, 2.0), abs=0.01)
    assert (turn_to(3.0, -3.0), turn_to(0.2, 0.5)) == pytest.approx((2.0 * math.pi - 6.0, 0.3))
    goal = goal_beside(FootPose(0.0, 0.0, 1.0), (1.0, 1.0, 0.0), Relative(-0.5))
    assert (goal.yaw, math.hypot(1.0 - goal.x, 1.0 - goal.y)) == pytest.approx((math.pi / 4.0, 0.5))
    assert math.hypot(goal.x, goal.y) == pytest.approx(math.sqrt(2.0) - 0.5), "on the robot's side"


TICK = 1.0 / 120.0


def told(*touches, book=None, times=None):
    """[(time, seen)] of touches after 0.2 s without, each a pattern and how long it lasts, s."""
    recogniser, news, now = GestureRecogniser(book or GestureBook(), times or Times()), [], 0.0
    for pattern, duration in ((FREE, 0.2), *touches):
        for _ in range(round(duration / TICK)):
            now += TICK
            news.append((now, recogniser.feed(pattern, now)))
    return [(time, seen) for time, seen in news if seen != Seen()]


@pytest.mark.parametrize("name", GESTURES)
def test_a_gesture_is_recognised_when_it_is_over_and_what_is_held_again_and_again(name):
    *first, last = GESTURES[name]
    if last == FREE:
        ((when, seen),) = told(*((pattern, 0.12) for pattern in first), (FREE, 1.0))
        assert seen == Seen(name, released=True)
        assert when == pytest.approx(0.2 + 0.12 * len(first) + SETTLE_TIME + SEQUENCE_TIME, abs=3 * TICK)
    else:
        news, begin = told((last, 2.0), (FREE, 1.0)), 0.2 + SETTLE_TIME
        assert [seen for _, seen in news] == [Seen(name), Seen(name), Seen(released=True)]
        times = [begin + HOLD_TIME, begin + 2 * HOLD_TIME, begin + 2.0]
        assert [when for when, _ in news] == pytest.approx(times, abs=3 * TICK)


def test_arms_that_make_way_go_aside_first_and_come_down_from_above():
    start, goal = posture(MODEL, "Sit"), posture(MODEL, "SitRelax")
    move = direct(MODEL, "Sit", "SitRelax", start, 1.0, Ground((), 0.5, arms_aside=True))
    aside, over, above, there = (frame.angles for frame in move.frames)
    shoulders, elbows = ([MODEL.joint_index[side + name] for side in "LR"] for name in ("ShoulderRoll", "ElbowRoll"))
    assert [aside[i] for i in shoulders] == [over[i] for i in shoulders] == [0.9, -0.9]
    assert [above[i] for i in elbows] == [-1.5, 1.5] and aside[KNEE] == start[KNEE]
    assert over[KNEE] == above[KNEE] == there[KNEE] == goal[KNEE] and there == dict(enumerate(goal))


def off(name, angles, place):
    """Angle between the X axis of a frame for joint angles by name, others 0, and the way from it to a place, rad."""
    frame = frame_of(MODEL, name)
    body = [angles.get(joint.name, 0.0) for joint in MODEL.joints]
    way = np.linalg.inv(link_transforms(MODEL, body)[frame.link] @ frame.offset) @ np.array((*place, 1.0))
    return math.acos(way[0] / np.linalg.norm(way[:3]))


def test_cameras_and_arms_turn_to_a_place():
    for place in ((1.0, 0.0, 0.2), (1.0, 0.6, 0.5), (0.5, -0.4, 0.1), (2.0, 1.5, -0.3)):
        assert off("CameraTop", dict(zip(HEAD, head_angles(MODEL, place))), place) < 1e-6
    place = (1.0, 0.2, -0.2)
    yaw, pitch = head_angles(MODEL, place, camera=1)
    assert pitch < head_angles(MODEL, place)[1] - 0.5, "for the other camera the head is higher"
    assert off("CameraBottom", dict(zip(HEAD, (yaw, pitch))), place) < 1e-6
    for arm, side in (("LArm", 1.0), ("RArm", -1.0)):
        for place in ((1.0, 0.4 * side, height) for height in (-0.3, 0.1, 0.6)):
            assert off(arm, arm_angles(MODEL, arm, place), place) < math.radians(4.0)
    for place in ((0.0, 0.0, 0.1265), (-1.0, 0.1, 0.2), (0.1, 0.0, -1.0), (0.0, 0.0, 5.0)):
        for name, angle in zip(HEAD, head_angles(MODEL, place)):
            assert MODEL.joint(name).lower <= angle <= MODEL.joint(name).upper, "out of reach"


def test_the_moves_of_the_file_end_in_their_postures():
    legs = [MODEL.joint_index[name] for chain in ("LLeg", "RLeg") for name in MODEL.chains[chain]]
    assert load_moves()
    for move in load_moves():
        final = posture(MODEL, move.goal)
        reached = {index: angle for frame in move.frames for index, angle in frame.angles.items()}
        assert {i: reached[i] for i in legs} == pytest.approx({i: final[i] for i in legs}, abs=0.01), str(move)
