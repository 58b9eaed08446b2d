"""Moves between postures: what the file may say, and how a move is played."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.errors import ConfigError
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.posture_moves import FILE, Ground, KeyFrame, Move, direct, load_moves, moves_of, play
from nao_sim_bridge.sim.postures import load_postures, posture

MODEL = load_model()
HEAD, WRIST, KNEE, HIPS = (MODEL.joint_index[name] for name in ("HeadYaw", "LWristYaw", "LKneePitch", "LHipPitch"))
FRAME = {"time": 0.5, "angles": {"HeadYaw": 0.1}}


def content(**changes):
    """A file with one move."""
    move = {"from": "LyingBelly", "to": "Stand", "frames": [FRAME], **changes}
    return {"moves": [{key: value for key, value in move.items() if value is not None}]}


def test_a_move_is_read():
    (move,) = moves_of(content(frames=[FRAME, {"time": 1.0, "angles": {"HeadYaw": 0, "LKneePitch": 0.5}}], note="why"))
    assert move == Move(
        "LyingBelly", "Stand", (KeyFrame(0.5, {HEAD: 0.1}), KeyFrame(1.0, {HEAD: 0.0, KNEE: 0.5})), dynamic=True
    )
    assert move.duration == 1.5
    assert move.goal_family == "Standing"
    assert str(move) == "LyingBelly -> Stand"


def test_a_move_is_as_certain_as_it_was_found():
    (tried,), (untried,) = moves_of(content(checked={"runs": 20, "reached": 5})), moves_of(content())
    assert (tried.certainty, untried.certainty) == (0.25, 1.0)
    assert tried.expected_duration == 4 * tried.duration


@pytest.mark.parametrize(
    "wrong, text",
    [
        ({"moves": {}}, "moves: is a dict, not a list"),
        ({"movs": []}, "unknown key 'movs', did you mean 'moves'"),
        ({**content(), "more": 1}, "unknown key 'more'"),
        (content(**{"from": "Lying"}), r"moves\[0\].from: is 'Lying', allowed is .*LyingBelly"),
        (content(to="Standing"), r"moves\[0\].to: is 'Standing', allowed is .*StandInit"),
        (content(to=None), "missing 'to'"),
        (content(checked=3), "checked: is 3, not a mapping with runs and reached"),
        (content(checked={"runs": 20}), "checked.reached: is None, not a number"),
        (content(checked={"runs": 20, "reached": 0}), "checked: reached is 0 of 20 runs, allowed is above 0 to all"),
        (content(frames=[]), "frames: is no list of key frames, at least one"),
        (content(frames=[{"time": 0, "angles": {}}]), r"frames\[0\].time: is 0.0, not above 0"),
        (content(frames=[{"time": "1", "angles": {}}]), r"frames\[0\].time: is '1', not a number"),
        (
            content(frames=[FRAME, {"time": 1, "angles": {"HedYaw": 0.1}}]),
            r"frames\[1\].angles.*'HedYaw', did you mean",
        ),
        (content(frames=[{"time": 1, "angles": {"HeadYaw": True}}]), "angles.HeadYaw: is True, not a number"),
    ],
)
def test_what_is_wrong_in_the_file_is_named(wrong, text):
    with pytest.raises(ConfigError, match=f"{FILE}.*{text}"):
        moves_of(wrong)


def test_the_moves_of_the_file_end_in_their_postures():
    moves = load_moves()
    assert moves
    legs = [MODEL.joint_index[name] for chain in ("LLeg", "RLeg") for name in MODEL.chains[chain]]
    for move in moves:
        final = posture(MODEL, move.goal)
        reached = {index: angle for frame in move.frames for index, angle in frame.angles.items()}
        assert {i: reached[i] for i in legs} == pytest.approx({i: final[i] for i in legs}, abs=0.01), str(move)


def test_a_straight_move_takes_the_slowest_joint_its_time():
    start, goal = posture(MODEL, "StandZero"), posture(MODEL, "Crouch")
    move = direct(MODEL, "StandZero", "Crouch", start, 1.0, Ground((), 0.0))
    needed = max(abs(a - b) / joint.max_velocity for a, b, joint in zip(goal, start, MODEL.joints))
    assert move.duration == pytest.approx(1.5 * needed)
    assert not move.dynamic
    assert move.frames[-1].angles == dict(enumerate(goal))


@pytest.mark.parametrize("fraction, least, duration", [(1.0, 0.8, 0.8), (0.25, 0.8, 3.2)])
def test_a_straight_move_is_no_faster_than_is_safe(fraction, least, duration):
    move = direct(MODEL, "Stand", "Stand", posture(MODEL, "Stand"), fraction, Ground((), least))
    assert move.duration == pytest.approx(duration)


def test_a_move_is_played_through_its_key_frames(bench):
    one = bench("Stand")
    stand = posture(MODEL, "Stand")
    frames = (KeyFrame(0.25, {HEAD: 0.3}), KeyFrame(0.25, {WRIST: 0.2}), KeyFrame(0.5, {HEAD: -0.2}))
    task = play(one.robot, "goToPosture", Move("Stand", "Stand", frames))
    one.run(0.5)
    assert one.joint("LWristYaw", of="commands") == pytest.approx(0.2)
    assert -0.2 < one.joint("HeadYaw", of="commands") < 0.3
    one.run(0.5)
    assert task.finished
    assert one.joint("HeadYaw", of="commands") == pytest.approx(-0.2)
    assert one.joint("LWristYaw", of="commands") == pytest.approx(0.2)
    assert one.joint("LHipPitch", of="commands") == pytest.approx(stand[HIPS])
    assert one.robot.motion.tasks() == []


def test_a_played_move_holds_the_whole_body(bench):
    one = bench("Stand")
    play(one.robot, "goToPosture", Move("Stand", "Stand", (KeyFrame(0.5, {HEAD: 0.3}),)))
    one.aim(RWristYaw=1.0)
    one.run(0.4)
    assert one.joint("RWristYaw", of="commands") == pytest.approx(0.1)


def test_every_predefined_posture_is_the_goal_of_a_straight_move():
    for name in load_postures().by_name:
        assert direct(MODEL, name, name, posture(MODEL, name), 1.0, Ground((), 1.0)).goal == name


def test_arms_that_make_way_go_aside_first_and_come_down_from_above():
    start, goal = posture(MODEL, "Sit"), posture(MODEL, "SitRelax")
    move = direct(MODEL, "Sit", "SitRelax", start, 1.0, Ground((), 0.5, arms_aside=True))
    aside, over, above, there = (frame.angles for frame in move.frames)
    shoulders = [MODEL.joint_index[f"{side}ShoulderRoll"] for side in "LR"]
    elbows = [MODEL.joint_index[f"{side}ElbowRoll"] for side in "LR"]
    assert [aside[i] for i in shoulders] == [over[i] for i in shoulders] == [0.9, -0.9]
    assert [above[i] for i in elbows] == [-1.5, 1.5]
    assert aside[KNEE] == start[KNEE]
    assert over[KNEE] == above[KNEE] == there[KNEE] == goal[KNEE]
    assert there == dict(enumerate(goal))
