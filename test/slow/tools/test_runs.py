"""One cheap run of each tool."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from nao_library_modules.motion.recorded_motion import MotionStore
from nao_sim_bridge.core.posture_moves import KeyFrame, Move, load_moves

SHIPPED = Path(__file__).resolve().parents[3] / "nao_library_modules" / "config" / "motions"
pytestmark = pytest.mark.timeout(1800)
FEW = ["--population", "4", "--starts", "1", "--runs", "1", "--sigma", "0.3", "--generations", "1"]


def move_named(start, goal):
    return next(move for move in load_moves() if (move.start, move.goal) == (start, goal))


def test_what_is_drawn_in_the_lab_is_found_within_its_bounds(run):
    status, text = run("check_detection", "ball", "lab", "--count", "1", "--frames", "2")
    assert status == 0 and "MISSED" not in text and text.count("  ok") >= 4


def test_level_sources_are_found_and_quiet_rooms_are(tools, run):
    lines = list(tools.check_localisation.measure_places("level", 2, seed=1))
    assert len(lines) == 8 and sum(line.kept for line in lines) >= 7
    status, text = run("check_localisation", "quiet", "--sounds", "1", "--seconds", "2", "--seed", "1")
    assert status == 0 and text.count("0 beginnings and ends detected, 0 sounds located in 2 s") == 6


def test_changes_of_posture_that_get_there_are_a_success(run, tools):
    status, text = run("check_posture_graph", "--start", "Crouch", "--goal", "Stand", "--noise", "0.02")
    assert status == 0 and "1 of 1 changes reached their posture" in text
    status, text = run("check_posture_graph", "--start", "StandZero", "--goal", "Stand", "--noise", "0.6")
    assert status == 1 and "BEGAN" in text and "0 of 1 changes" in text
    lay, outcome = tools.check_posture_graph.stand_up(180.0, 1.0, 0)
    assert lay == "LyingBack" and outcome.reached and outcome.time > 5.0


@pytest.mark.parametrize("impulse, status, survived", [("1.0", 0, "1"), ("6.0", 1, "0")])
def test_survived_pushes_are_counted_for_each_side(run, impulse, status, survived):
    found, text = run("check_pushes", "--postures", "Stand", "--impulses", impulse, "--runs", "1")
    expected = [["Stand", side, survived, "of", "1"] for side in ("front", "left", "back", "right")]
    assert (found, [line.split()[:5] for line in text.splitlines()[1:]]) == (status, expected)


def test_the_lead_of_the_fall_manager_is_printed_for_eight_directions(run):
    status, text = run("check_pushes", "--postures", "Stand", "--impulses", "5.0", "--runs", "1", "--falls")
    leads = [float(line.split()[5]) for line in text.splitlines()[1:]]
    assert status == 0 and len(leads) == 8 and min(leads) > 0.15


def test_each_part_of_recognition_gives_its_lines(tools):
    tool = tools.check_recognition
    bench = tool.Bench()
    try:
        for part, count in (("words", 3), ("quiet", 30)):
            lines = list(
                getattr(tool.Check(bench, False, tool.Effort(("slt",), every=40, quiet_s=1.0, bursts=1)), part)()
            )
            assert len(lines) == count and all(line.what in str(line) for line in lines)
    finally:
        bench.close()
    one, again = (tools.recognition_bench.sudden(2) for _ in range(2))
    assert len({sound[:60000].tobytes() for sound in one.values()}) == 5
    assert all(np.array_equal(one[kind], again[kind]) for kind in one)


def test_walks_are_measured(tools):
    runs = tools.walk_runs
    made = runs.straight((0.08, 0.0, 0.0), {}, 4.2)
    assert made["up"] and made["x"] == pytest.approx(0.08, rel=0.05)
    assert made["odometry"] < 0.02 and 0.3 < made["fastest"] < 1.2
    assert runs.stop_somewhere(2) is True
    fall = runs.push(1, 1, 8.0, get_up=False)
    assert fall["fell"] and fall["impact"] and fall["early"] > 0.0


@pytest.mark.long
def test_moves_of_the_file_get_there_from_starts_no_search_has_seen(tools, run):
    def attempt(start, move, seed):
        attempts = tools.posture_attempt.Attempts(start)
        try:
            return attempts.run(move, seed)
        finally:
            attempts.close()

    for start, goal in (("LyingBelly", "Stand"), ("Stand", "Sit")):
        move = move_named(start, goal)
        outcome = attempt(start, move, 424242)
        assert (outcome.reached, outcome.ended) == (True, goal) and outcome.speed <= 1.0 + 1e-9
        assert len(outcome.marks) == len(move.frames) + 1
    assert min(mark.upright for mark in outcome.marks) > 0.85 and outcome.impact < 300.0, "sitting down is no fall"
    assert attempt("Stand", move, 424242) == outcome != attempt("Stand", move, 6)
    whole = move_named("LyingBelly", "Stand")
    cut = Move(whole.start, whole.goal, (*whole.frames[:2], KeyFrame(1.5, whole.frames[-1].angles)))
    good, bad = (attempt("LyingBelly", move, 3) for move in (whole, cut))
    cost = tools.find_posture_moves.cost
    assert good.reached and not bad.reached and cost(whole, good) < cost(cut, bad) - 3.0
    status, text = run("find_posture_moves", "check", "--move", "Sit", "LyingBack", "--runs", "1")
    row = ["Sit", "->", "LyingBack", "1/1", f"{move_named('Sit', 'LyingBack').duration:.1f}"]
    assert status == 0 and text.splitlines()[-1].split()[:5] == row


@pytest.mark.long
def test_a_search_leaves_a_state_goes_on_from_it_and_writes_only_when_asked(tools, run, tmp_path, monkeypatch):
    state, written = tmp_path / "state.json", []
    monkeypatch.setattr(tools.find_posture_moves, "put", lambda *arguments: written.append(arguments))
    for generation in (1, 2):
        _, text = run("find_posture_moves", "search", "Sit", "LyingBack", *FEW, "--state", str(state))
        assert json.loads(state.read_text(encoding="utf-8"))["generation"] == generation
    assert f"goes on with generation 1 of {state}" in text and written == []


def test_motions_are_what_their_tables_say(run, tools, tmp_path):
    names = ("bow_small", "offer", "wave")
    assert run("make_motions", "--folder", str(tmp_path), *names)[0] == 0
    made, shipped = MotionStore(tmp_path), MotionStore(SHIPPED)
    assert sorted(make.__name__ for make in tools.make_motions.MOTIONS) == shipped.names()
    assert made.names() == list(names)
    for name in names:
        one, other = made.load(name), shipped.load(name)
        assert one.joints == other.joints and one.times == pytest.approx(other.times)
        np.testing.assert_allclose(one.angles, other.angles, atol=1e-4)
