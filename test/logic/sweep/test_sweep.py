"""Many runs over seeds and parameters: what is kept of them, and what is not run again."""

from __future__ import annotations

import csv

import pytest

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.sweep import sweep

OPTIONS = {"workers": 0, "progress": False}


def scaled(seed, factor):
    """A run without a robot."""
    if seed == 3:
        raise RuntimeError("seed 3 stumbles")
    return {"value": seed * factor, "even": seed % 2 == 0}


def test_all_seeds_run_with_all_combinations():
    table = sweep(lambda seed, a, b: seed + a * b, seeds=[5, 7], a=[1, 2], b=[10, 100], **OPTIONS)
    found = [(row["seed"], row["a"], row["b"], row["result"]) for row in table.rows]
    assert found == [(s, a, b, s + a * b) for a in (1, 2) for b in (10, 100) for s in (5, 7)]


def test_a_run_that_raises_is_told_and_does_not_count():
    table = sweep(scaled, seeds=5, factor=[1, 2], **OPTIONS)
    assert [rate.runs for rate in table.rates("value")] == [4, 4]
    assert [rate.mean for rate in table.rates("value")] == [7 / 4, 14 / 4]
    assert "2 runs failed, the first (seed 3) with: RuntimeError: seed 3 stumbles" in str(table)


def test_shares_have_wilsons_interval():
    (rate,) = sweep(lambda seed: seed < 3, seeds=10, **OPTIONS).rates()
    assert (rate.mean, rate.low, rate.high) == pytest.approx((0.3, 0.1078, 0.6032), abs=1e-3)


def test_a_sweep_goes_on_where_it_was_ended(tmp_path):
    file, called = tmp_path / "runs" / "all.csv", []

    def noted(seed, factor):
        called.append((seed, factor))
        return scaled(seed, factor)

    first = sweep(noted, seeds=2, factor=[1, 2], output=file, **OPTIONS)
    assert [dict(row) for row in first.rows] == [
        dict(row) for row in sweep(noted, 2, file, factor=[1, 2], **OPTIONS).rows
    ]
    assert len(called) == 4
    file.write_text(file.read_text().rsplit("\n", 2)[0] + "\n1,2,")  # a write that was cut off
    again = sweep(noted, seeds=3, factor=[1, 2], output=file, **OPTIONS)
    assert called[4:] == [(2, 1), (1, 2), (2, 2)]
    assert [row["value"] for row in again.rows] == [0, 1, 2, 0, 2, 4]
    with file.open(newline="") as lines:
        assert len(list(csv.reader(lines))) == 1 + 6


def test_results_that_come_up_later_get_a_column(tmp_path):
    (tmp_path / "f.csv.part").write_text("somebody's")
    sweep(lambda seed: {"a": 1} if seed == 0 else {"a": 2, "b": 3}, 2, tmp_path / "f.csv", **OPTIONS)
    assert (tmp_path / "f.csv").read_text().splitlines()[0] == "seed,a,b,seconds,error"
    assert (tmp_path / "f.csv.part").read_text() == "somebody's"


def test_runs_that_failed_run_again_and_the_others_do_not(tmp_path, capsys):
    def made(seed):
        runs.append(seed)
        return {"made": 1 / (seed if broken else 1)}

    for broken, expected in ((True, [0, 1]), (False, [0])):
        runs = []
        table = sweep(made, 2, tmp_path / "f.csv", **OPTIONS)
        assert runs == expected and [bool(row["error"]) for row in table.rows] == [broken, False]
        assert (tmp_path / "f.csv").read_text().count("ZeroDivisionError") == broken
        assert ("the first run that failed (seed 0): ZeroDivisionError" in capsys.readouterr().err) == broken


def test_a_file_of_another_sweep_is_left_alone(tmp_path):
    sweep(lambda seed, a: a, 1, tmp_path / "f.csv", a=[1], **OPTIONS)
    before = (tmp_path / "f.csv").read_text()
    with pytest.raises(BadValue, match="a sweep over seed, b"):
        sweep(lambda seed, b: b, 1, tmp_path / "f.csv", b=[1], **OPTIONS)
    assert (tmp_path / "f.csv").read_text() == before


def test_what_no_file_can_keep_is_an_error_of_the_run():
    (row,) = sweep(lambda seed: {"where": [1, 2]}, 1, **OPTIONS).rows
    assert row["error"] == "TypeError: 'where' is a list, not a number, truth value or text"


@pytest.mark.parametrize("seeds, values", [(0, [1]), ([], [1]), (1, []), (1, "abc")])
def test_a_sweep_over_nothing_is_refused(seeds, values):
    with pytest.raises(BadValue):
        sweep(scaled, seeds, factor=values, **OPTIONS)


def test_a_table_tells_runs_counts_rates_and_intervals():
    table = sweep(lambda seed, push: {"fell": seed < push, "lean": 0.5}, 4, push=[0, 3], **OPTIONS)
    assert table.text("fell").splitlines() == [
        "push  runs  fell  rate              95 %",
        "   0     4     0     0       0 to 0.4899",
        "   3     4     3  0.75  0.3006 to 0.9544",
    ]


class Kept:
    """A function that keeps something between runs."""

    def __init__(self):
        self.made = self.closed = 0

    def __call__(self, seed):
        self.made = self.made or 1
        return self.made

    def close(self):
        self.closed += 1


def test_what_a_function_keeps_is_closed_after_the_last_run():
    kept = Kept()
    sweep(kept, 3, **OPTIONS)
    assert (kept.made, kept.closed) == (1, 1)


def test_a_name_of_the_table_is_no_parameter_and_no_result():
    with pytest.raises(BadValue, match="error is .*another name"):
        sweep(lambda seed, error: seed, 2, workers=0, progress=False, error=[1])
    (row,) = sweep(lambda seed, push: {"push": 0.0}, 1, workers=0, progress=False, push=[2.0]).rows
    assert row["push"] == 2.0 and "returns push, which the row has already" in row["error"]
