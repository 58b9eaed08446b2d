from __future__ import annotations

import json

import pytest
from nao_benchmarks.cli import main
from nao_benchmarks.errors import BenchmarkError
from nao_benchmarks.machine import describe, processor
from nao_benchmarks.row import Figures, Row, at_most
from nao_benchmarks.rows import ROWS


class Fixed(Row):
    """A row whose figures are known."""

    subject = "ours"
    against = "theirs"
    unit = "ms"
    bound = at_most(1.5)

    def __init__(self, name, ours, error=None):
        self.name = name
        self.measured = 0
        self._ours = ours
        self._error = error

    def measure(self, stack):
        self.measured += 1
        if self._error is not None:
            raise self._error
        return Figures(self._ours, 10.0)


@pytest.fixture
def output(tmp_path):
    return tmp_path / "out" / "bench.json"


def rows_of(path):
    return {row["name"]: row for row in json.loads(path.read_text(encoding="utf-8"))["rows"]}


def test_all_rows_are_measured_once_and_written(output, capsys):
    rows = [Fixed("one", 10.0), Fixed("two", 15.0)]
    assert main(rows, ["--output", str(output)]) == 0
    assert [row.measured for row in rows] == [1, 1]
    assert {name: row["ratio"] for name, row in rows_of(output).items()} == {"one": 1.0, "two": 1.5}
    printed = capsys.readouterr().out
    assert "all bounds are kept" in printed
    assert "cores" in printed.splitlines()[0]


def test_a_missed_bound_is_an_exit_status_and_is_named(output, capsys):
    assert main([Fixed("good", 10.0), Fixed("slow", 16.0)], ["--output", str(output)]) == 1
    assert "missed: slow" in capsys.readouterr().out
    assert [row["ok"] for row in rows_of(output).values()] == [True, False]


@pytest.mark.parametrize(
    "error, text", [(BenchmarkError("no robot"), "no robot"), (RuntimeError("boom"), "RuntimeError: boom")]
)
def test_a_row_that_fails_does_not_keep_the_others_from_running(output, capsys, error, text):
    rows = [Fixed("broken", 0.0, error), Fixed("good", 10.0)]
    assert main(rows, ["--output", str(output)]) == 1
    assert rows[1].measured == 1
    assert rows_of(output)["broken"]["error"] == text
    assert f"broken: not measured: {text}" in capsys.readouterr().out


def test_only_measures_what_is_named(output):
    rows = [Fixed("one", 10.0), Fixed("two", 99.0), Fixed("three", 10.0)]
    assert main(rows, ["--only", "three", "--only", "one", "--output", str(output)]) == 0
    assert [row.measured for row in rows] == [1, 0, 1]
    assert list(rows_of(output)) == ["one", "three"]


def test_an_unknown_name_is_refused_with_the_names_there_are(output, capsys):
    with pytest.raises(SystemExit) as ended:
        main([Fixed("one", 10.0)], ["--only", "two", "--output", str(output)])
    assert ended.value.code == 2
    assert "'one'" in capsys.readouterr().err
    assert not output.exists()


def test_help_lists_the_rows_and_their_bounds(capsys):
    with pytest.raises(SystemExit) as ended:
        main([Fixed("one", 10.0)], ["--help"])
    assert ended.value.code == 0
    printed = capsys.readouterr().out
    assert "one  ours; at most 1.5" in printed
    assert "--only" in printed and "--output" in printed


def test_rows_have_names_of_their_own_and_say_what_they_measure():
    names = [row.name for row in ROWS]
    assert len(set(names)) == len(names)
    for row in ROWS:
        assert row.name.replace("_", "").isalnum()
        assert row.subject and row.unit and row.bound.limit > 0.0


def test_the_processor_is_named_where_the_system_tells_it():
    assert processor("processor\t: 0\nmodel name\t: Fast One @ 3 GHz\n") == "Fast One @ 3 GHz"
    assert processor("processor : 0\n") != ""


def test_the_machine_has_cores_and_a_load():
    machine = describe()
    assert machine["cores"] >= 1
    assert machine["load"] >= 0.0
