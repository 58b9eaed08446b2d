"""What the tools compute: options, bounds, searches, frames and files; nothing is simulated."""

from __future__ import annotations

import json
from contextlib import nullcontext
from pathlib import Path

import numpy as np
import pytest

from nao_sim_bridge.paths import config_file
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.posture_moves import FILE, KeyFrame, Move, load_moves, moves_of
from nao_sim_bridge.sim.postures import posture

MODEL = load_model()


def move_named(start, goal):
    return next(move for move in load_moves() if (move.start, move.goal) == (start, goal))


@pytest.mark.parametrize("good, mark, status", [(True, "  ok", 0), (None, "", 0), (np.bool_(False), "  MISSED", 1)])
def test_a_figure_that_misses_its_bound_is_told_and_makes_the_status(tools, capsys, good, mark, status):
    class Checks(tools.measurement.StageChecks):
        def found(self):
            self._tell("faces", "found 0.90", good)

    checks = lambda stage: Checks(stage, 1, 1, seed=1)  # noqa: E731
    assert tools.measurement.measure(nullcontext(None), checks, ["found"]) == status
    first, *misses = capsys.readouterr().out.splitlines()
    assert first.endswith(f"found 0.90{mark}")
    assert misses == ["misses its bound: faces"] * status


def test_a_search_finds_the_bottom_of_a_valley_and_goes_on_where_it_was_stored(tools):
    strategy_of = tools.sep_cma_es.SepCmaEs

    def search(generations, strategy=None):
        """Least at (1, 2, 3, 4), a hundred times steeper along the last coordinate than along the first."""
        strategy = strategy or strategy_of([0.0] * 4, 0.5, 10, seed=3)
        for _ in range(generations):
            before = strategy.ask()
            assert (strategy.ask() == before).all(), "candidates stay the same until they are judged"
            strategy.tell([float(((p - [1, 2, 3, 4]) ** 2) @ [1, 10, 30, 100]) for p in before])
            assert not (strategy.ask() == before).any()
        return strategy

    assert search(120).mean == pytest.approx([1.0, 2.0, 3.0, 4.0], abs=1e-3)
    resumed = search(20, strategy_of.from_state(json.loads(json.dumps(search(20).state()))))
    assert resumed.generation == 40 and resumed.mean.tolist() == search(40).mean.tolist()


def test_one_move_of_the_file_is_replaced_or_added_and_the_others_stay(tools, tmp_path):
    path = tmp_path / "moves.json"
    path.write_text(Path(config_file(FILE)).read_text(encoding="utf-8"), encoding="utf-8")
    goal = KeyFrame(1.5, dict(enumerate(posture(MODEL, "Sit"))))
    tools.posture_moves_file.put(MODEL, Move("Stand", "Sit", (goal,)), runs=20, reached=5, path=path)
    before, after = load_moves(), moves_of(json.loads(path.read_text(encoding="utf-8")))
    assert [str(move) for move in after] == [str(move) for move in before]
    (changed,) = [other for one, other in zip(before, after) if one != other]
    assert (str(changed), changed.certainty) == ("Stand -> Sit", 0.25)
    assert changed.frames[0].angles == pytest.approx(goal.angles, abs=1e-4)


def test_nothing_but_the_named_joints_moves_and_what_cannot_be_is_refused(tools):
    choreographer = tools.choreography.Choreographer(MODEL)
    joints, samples = choreographer.samples({"HeadYaw": [(0.0, 0.0), (0.35, 0.5)]})
    assert joints == ["HeadYaw"] and samples[-1][1] == pytest.approx([0.5])
    assert [time for time, _ in samples] == pytest.approx([0.0, 0.1, 0.2, 0.3, 0.35])
    for channel, line, text in [
        ("Nose", [(0.0, 0.0), (1.0, 1.0)], "Nose is no joint"),
        ("HeadYaw", [(0.5, 0.0), (1.0, 1.0)], "not at 0"),
        ("HeadYaw", [(0.0, 0.0), (1.0, 3.0)], "HeadYaw would be at"),
        ("com_y", [(0.0, 0.0), (1.0, 0.2)], "Roll would be at"),
    ]:
        with pytest.raises(ValueError, match=text):
            choreographer.samples({channel: line})
