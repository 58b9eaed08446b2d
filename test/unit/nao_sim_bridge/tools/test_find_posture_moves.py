"""The tool that tries and improves moves between postures: its search, its vectors, its file, and real attempts."""

from __future__ import annotations

import importlib
import json
import sys
from pathlib import Path

import numpy as np
import pytest

from nao_sim_bridge.paths import config_file
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.posture_moves import FILE, KeyFrame, Move, load_moves, moves_of
from nao_sim_bridge.sim.postures import posture

TOOLS = Path(__file__).resolve().parents[4] / "nao_sim_bridge" / "tools"
NAMES = ("sep_cma_es", "symmetric_frames", "posture_moves_file", "posture_attempt", "find_posture_moves")
MODEL = load_model()


@pytest.fixture(scope="module")
def tools():
    """The modules of the tool by name; they find each other as when one is started."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(TOOLS))
        yield {name: importlib.import_module(name) for name in NAMES}
    for name in NAMES:
        sys.modules.pop(name, None)


def move_named(start, goal):
    return next(move for move in load_moves() if (move.start, move.goal) == (start, goal))


def valley(point):
    """Least at (1, 2, 3, 4), a hundred times steeper along the last coordinate than along the first."""
    return float(np.sum(np.array([1.0, 10.0, 30.0, 100.0]) * (point - np.array([1.0, 2.0, 3.0, 4.0])) ** 2))


# --- the search -------------------------------------------------------------------------------------------------------


def search_valley(tools, generations, strategy=None):
    strategy = strategy or tools["sep_cma_es"].SepCmaEs([0.0] * 4, 0.5, 10, seed=3)
    for _ in range(generations):
        strategy.tell([valley(point) for point in strategy.ask()])
    return strategy


def test_a_search_finds_the_bottom_of_a_valley(tools):
    assert search_valley(tools, 120).mean == pytest.approx([1.0, 2.0, 3.0, 4.0], abs=1e-3)


def test_a_search_that_was_stored_goes_on_as_if_it_had_not_stopped(tools):
    stored = json.loads(json.dumps(search_valley(tools, 20).state()))
    resumed = search_valley(tools, 20, tools["sep_cma_es"].SepCmaEs.from_state(stored))
    assert resumed.generation == 40
    assert resumed.mean.tolist() == search_valley(tools, 40).mean.tolist()


def test_candidates_stay_the_same_until_they_are_judged(tools):
    strategy = search_valley(tools, 1)
    before = strategy.ask()
    assert (strategy.ask() == before).all()
    strategy.tell([valley(point) for point in before])
    assert not (strategy.ask() == before).any()


# --- vectors ----------------------------------------------------------------------------------------------------------


def test_frames_become_a_vector_and_frames_again(tools):
    frames = move_named("Stand", "Sit").frames[:-1]
    again = tools["symmetric_frames"].to_frames(MODEL, tools["symmetric_frames"].to_vector(MODEL, frames))
    assert [frame.duration for frame in again] == pytest.approx([frame.duration for frame in frames])
    arms_and_legs = [i for i, joint in enumerate(MODEL.joints) if joint.name[1:] in tools["symmetric_frames"].PAIRS]
    for one, other in zip(frames, again):
        assert {i: other.angles[i] for i in arms_and_legs} == pytest.approx(
            {i: one.angles[i] for i in arms_and_legs}, abs=tools["symmetric_frames"].TOLERANCE
        )


def test_a_wild_vector_still_is_what_the_joints_can_do(tools):
    vector = np.random.default_rng(1).normal(0.0, 3.0, 4 * tools["symmetric_frames"].SIZE)
    frames = tools["symmetric_frames"].to_frames(MODEL, vector)
    for frame in frames:
        assert all(MODEL.joints[i].lower <= angle <= MODEL.joints[i].upper for i, angle in frame.angles.items())
    for before, after in zip(frames, frames[1:]):
        for i, angle in after.angles.items():
            assert 1.5 * abs(angle - before.angles[i]) / after.duration <= MODEL.joints[i].max_velocity + 1e-9


def test_a_pose_that_is_not_the_same_left_and_right_is_noticed(tools):
    mirrored = tools["symmetric_frames"].mirrored
    pose = dict(enumerate(posture(MODEL, "StandInit")))
    assert mirrored(MODEL, [KeyFrame(1.0, pose)])
    assert not mirrored(MODEL, [KeyFrame(1.0, {**pose, MODEL.joint_index["LHipRoll"]: 0.1})])
    assert not mirrored(MODEL, [KeyFrame(1.0, {MODEL.joint_index["HeadYaw"]: 0.1})])


# --- the file ---------------------------------------------------------------------------------------------------------


def test_one_move_is_replaced_and_the_others_stay(tools, tmp_path):
    path = tmp_path / "moves.json"
    path.write_text(Path(config_file(FILE)).read_text(encoding="utf-8"), encoding="utf-8")
    goal = KeyFrame(1.5, dict(enumerate(posture(MODEL, "Sit"))))
    tools["posture_moves_file"].put(MODEL, Move("Stand", "Sit", (goal,)), runs=20, reached=5, path=path)
    before, after = load_moves(), moves_of(json.loads(path.read_text(encoding="utf-8")))
    assert [str(move) for move in after] == [str(move) for move in before]
    changed = [(one, other) for one, other in zip(before, after) if one != other]
    assert [str(other) for _, other in changed] == ["Stand -> Sit"]
    assert changed[0][1].certainty == 0.25
    assert changed[0][1].frames[0].angles == pytest.approx(goal.angles, abs=1e-4)


def test_a_new_move_is_added(tools, tmp_path):
    path = tmp_path / "moves.json"
    path.write_text('{"_meta": {"what": "moves"}, "moves": []}', encoding="utf-8")
    move = move_named("Stand", "Sit")
    tools["posture_moves_file"].put(MODEL, move, runs=20, reached=20, path=path)
    (read,) = moves_of(json.loads(path.read_text(encoding="utf-8")))
    assert (read.start, read.goal, len(read.frames)) == (move.start, move.goal, len(move.frames))


# --- attempts ---------------------------------------------------------------------------------------------------------


@pytest.fixture
def attempts(tools):
    """Makes attempts that are freed after the test."""
    made = []

    def make(*arguments):
        made.append(tools["posture_attempt"].Attempts(*arguments))
        return made[-1]

    yield make
    for one in made:
        one.close()


@pytest.mark.parametrize("start, goal", [("LyingBelly", "Stand"), ("Sit", "Stand"), ("Stand", "Sit")])
def test_moves_of_the_file_get_there_from_starts_no_search_has_seen(attempts, start, goal):
    outcome = attempts(start).run(move_named(start, goal), 424242)
    assert (outcome.reached, outcome.ended) == (True, goal)
    assert outcome.speed <= 1.0 + 1e-9
    assert len(outcome.marks) == len(move_named(start, goal).frames) + 1


def test_sitting_down_is_no_fall(attempts):
    outcome = attempts("Stand").run(move_named("Stand", "Sit"), 7)
    assert min(mark.upright for mark in outcome.marks) > 0.85
    assert outcome.impact < 300.0


def test_equal_seeds_make_equal_attempts(attempts):
    goal = KeyFrame(0.5, dict(enumerate(posture(MODEL, "SitRelax"))))
    move = Move("Sit", "SitRelax", (goal,))
    one, other = attempts("Sit"), attempts("Sit")
    first = one.run(move, 5)
    assert one.run(move, 6) != first
    assert other.run(move, 5) == first


def test_an_attempt_from_a_side_begins_on_that_side(attempts, tools):
    still = Move("LyingLeft", "LyingBack", (KeyFrame(0.5, {MODEL.joint_index["HeadYaw"]: 0.0}),))
    outcome = attempts("LyingLeft").run(still, 1)
    assert (outcome.reached, outcome.ended) == (False, "LyingLeft")


def test_getting_nearer_costs_less(attempts, tools):
    cost = tools["find_posture_moves"].cost
    whole = move_named("LyingBelly", "Stand")
    cut = Move(whole.start, whole.goal, (*whole.frames[:2], KeyFrame(1.5, whole.frames[-1].angles)))
    good, bad = (attempts("LyingBelly").run(move, 3) for move in (whole, cut))
    assert good.reached and not bad.reached
    assert cost(whole, good) < cost(cut, bad) - 3.0


# --- the program ------------------------------------------------------------------------------------------------------


def test_it_explains_itself(tools, capsys):
    with pytest.raises(SystemExit) as end:
        tools["find_posture_moves"].parse(["search", "--help"])
    assert end.value.code == 0
    assert "--minutes" in capsys.readouterr().out


def test_a_check_prints_how_often_a_move_gets_there(tools, capsys):
    assert tools["find_posture_moves"].main(["check", "--move", "Sit", "LyingBack", "--runs", "1"]) == 0
    row = capsys.readouterr().out.splitlines()[-1]
    assert row.split()[:5] == ["Sit", "->", "LyingBack", "1/1", f"{move_named('Sit', 'LyingBack').duration:.1f}"]


def test_a_search_needs_a_move_to_begin_with_and_the_same_on_both_sides(tools, capsys):
    main = tools["find_posture_moves"].main
    assert main(["search", "Crouch", "LyingBelly"]) == 2
    assert "no move Crouch -> LyingBelly" in capsys.readouterr().err
    assert main(["search", "LyingBack", "LyingBelly"]) == 2
    assert "not the same left and right" in capsys.readouterr().err


def test_a_search_leaves_a_state_goes_on_from_it_and_writes_only_when_asked(tools, tmp_path, capsys, monkeypatch):
    tool, state = tools["find_posture_moves"], tmp_path / "state.json"
    written = []
    monkeypatch.setattr(tool, "put", lambda *arguments: written.append(arguments))
    few = ["--population", "4", "--starts", "1", "--runs", "1", "--sigma", "0.3", "--generations", "1"]
    for generation in (1, 2):
        tool.main(["search", "Sit", "LyingBack", *few, "--state", str(state)])
        assert json.loads(state.read_text(encoding="utf-8"))["generation"] == generation
    assert f"goes on with generation 1 of {state}" in capsys.readouterr().out
    assert written == []


@pytest.mark.parametrize(
    "reached, impact, kept", [(20, 100.0, True), (19, 50.0, False), (20, 300.0, False), (0, 1.0, False)]
)
def test_only_a_better_move_is_written(tools, monkeypatch, reached, impact, kept):
    tool = tools["find_posture_moves"]
    before, after = move_named("Sit", "LyingBack"), move_named("Stand", "Sit")
    tallies = {str(before): tool.Tally(20, 20, (), 1.0, 200.0, 0.5, 1.0)}
    tallies[str(after)] = tool.Tally(20, reached, (), 1.0, impact, 0.5, 1.0)
    written = []
    monkeypatch.setattr(tool, "tally", lambda move, *_: tallies[str(move)])
    monkeypatch.setattr(tool, "put", lambda model, *arguments: written.append(arguments))
    options = tool.parse(["search", "Sit", "LyingBack", "--write"])
    assert tool.settle(before, after, options) == (0 if kept else 1)
    assert written == ([(after, 20, 20)] if kept else [])
