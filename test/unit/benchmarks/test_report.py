from __future__ import annotations

import json

import pytest
from nao_benchmarks.report import Result, record, table, write
from nao_benchmarks.row import Figures, Row, at_least, at_most


class Compared(Row):
    name = "compared"
    subject = "our thing"
    against = "a bare thing"
    unit = "us"
    bound = at_most(1.5)

    def measure(self, stack):
        raise NotImplementedError


class Absolute(Row):
    name = "absolute"
    subject = "speed"
    unit = "x"
    bound = at_least(12.0)

    def measure(self, stack):
        raise NotImplementedError


def line_of(text, name):
    return next(line for line in text.splitlines() if line.startswith(name)).split()


def test_a_result_is_ok_when_its_bound_is_kept():
    assert Result(Compared(), Figures(150.0, 100.0)).ok
    assert not Result(Compared(), Figures(151.0, 100.0)).ok
    assert Result(Absolute(), Figures(12.0)).ok
    assert not Result(Absolute(), Figures(11.0)).ok


def test_a_row_that_could_not_be_measured_is_not_ok():
    assert not Result(Compared(), None, "no robot").ok


def test_the_table_gives_figures_with_units_ratio_and_verdict():
    text = table([Result(Compared(), Figures(120.0, 100.0)), Result(Absolute(), Figures(11.5))])
    assert line_of(text, "name") == "name ours reference ratio bound ok".split()
    assert line_of(text, "compared") == "compared 120 us 100 us 1.200 at most 1.5 yes".split()
    assert line_of(text, "absolute") == "absolute 11.5 x - - at least 12 x NO".split()


def test_columns_are_aligned():
    text = table([Result(Compared(), Figures(120.0, 100.0)), Result(Absolute(), Figures(11.5))])
    head, _, first, second = text.splitlines()[:4]
    for heading, cell in (("bound", "at most"), ("ok", "yes")):
        assert head.index(heading) == first.index(cell)
    assert head.index("bound") == second.index("at least")


def test_the_table_says_what_the_rows_are_and_why_one_has_no_figures():
    text = table([Result(Compared(), None, "the robot sleeps"), Result(Absolute(), Figures(13.0))])
    assert "our thing : a bare thing" in text
    assert "speed (absolute)" in text
    assert "compared: not measured: the robot sleeps" in text


def test_a_note_stands_below_what_the_row_is():
    lines = table([Result(Compared(), Figures(1.0, 2.0, note="a slow day"))]).splitlines()
    assert lines[-1].strip() == "a slow day"
    assert lines[-2].endswith("our thing : a bare thing")


def test_the_record_has_every_figure_and_the_machine():
    figures = Figures(120.0, 100.0, {"runs": 5}, "quiet machine")
    content = record([Result(Compared(), figures), Result(Absolute(), None, "gone")], {"cores": 2})
    assert content["machine"] == {"cores": 2}
    compared, absolute = content["rows"]
    assert compared == {
        "name": "compared",
        "subject": "our thing",
        "against": "a bare thing",
        "unit": "us",
        "ours": 120.0,
        "reference": 100.0,
        "ratio": pytest.approx(1.2),
        "bound": {"kind": "at most", "limit": 1.5},
        "ok": True,
        "error": None,
        "note": "quiet machine",
        "details": {"runs": 5},
    }
    assert absolute["ours"] is absolute["ratio"] is absolute["against"] is None
    assert (absolute["ok"], absolute["error"]) == (False, "gone")


def test_the_file_is_json_and_its_folder_is_made(tmp_path):
    path = tmp_path / "new" / "folder" / "bench.json"
    content = record([Result(Compared(), Figures(1.0, 2.0))], {"cores": 2})
    write(path, content)
    assert json.loads(path.read_text(encoding="utf-8")) == content
