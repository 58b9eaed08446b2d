from __future__ import annotations

from pathlib import Path

import pytest
from summarize_tests import (
    Case,
    Outcome,
    closing_line,
    collect_run,
    describe_status,
    find_scenarios,
    is_success,
    main,
)

PASSING = '<testsuite><testcase classname="Leds" name="test_on"/></testsuite>'
FAILING = (
    '<testsuite><testcase classname="Leds" name="test_on">'
    '<failure message="expected 1&#10;got 0"/></testcase></testsuite>'
)
SKIPPING = '<testsuite><testcase classname="Leds" name="test_on"><skipped message="dark"/></testcase></testsuite>'
DIED = (
    '<testsuite><testcase classname="RosTest" name="testlights">'
    "<failure>test [lights] did not generate test results</failure></testcase></testsuite>"
)
EMPTY = "<testsuite/>"


def leave_run(directory: Path, status: int | None, **files: str) -> Path:
    """Write what a run leaves; `rostest_x` as a keyword becomes the file rostest-x.xml."""
    directory.mkdir(parents=True)
    if status is not None:
        (directory / "status").write_text(f"{status}\n")
    for name, text in files.items():
        (directory / f"{name.replace('_', '-')}.xml").write_text(text)
    return directory


def outcomes(cases: list[Case]) -> list[Outcome]:
    return [case.outcome for case in cases]


def test_a_passed_a_failed_and_a_skipped_test_are_told_apart(tmp_path):
    cases = collect_run(leave_run(tmp_path / "run", 1, a=PASSING, b=FAILING, c=SKIPPING), "unit")
    assert outcomes(cases) == [Outcome.PASSED, Outcome.FAILED, Outcome.SKIPPED]
    assert [case.message for case in cases] == ["", "expected 1", "dark"]
    assert cases[1].name == "Leds.test_on"


@pytest.mark.parametrize("status, files", [(0, {}), (0, {"a": EMPTY}), (5, {"a": EMPTY})])
def test_a_run_without_tests_has_failed(tmp_path, status, files):
    assert outcomes(collect_run(leave_run(tmp_path / "run", status, **files), "unit")) == [Outcome.FAILED]


def test_a_run_that_left_nothing_has_failed(tmp_path):
    assert outcomes(collect_run(tmp_path / "absent", "unit")) == [Outcome.FAILED]


def test_a_run_without_status_has_failed_whatever_it_reports(tmp_path):
    cases = collect_run(leave_run(tmp_path / "run", None, a=PASSING), "unit")
    assert outcomes(cases) == [Outcome.FAILED]


def test_a_crash_after_the_last_test_is_a_failure(tmp_path):
    cases = collect_run(leave_run(tmp_path / "run", -11, a=PASSING), "unit")
    assert outcomes(cases) == [Outcome.PASSED, Outcome.FAILED]
    assert "signal 11" in cases[1].message


def test_unreadable_results_are_a_failure(tmp_path):
    cases = collect_run(leave_run(tmp_path / "run", 0, a="<testsuite><testcase"), "unit")
    assert outcomes(cases) == [Outcome.FAILED]


def test_the_report_of_rostest_itself_counts_only_where_it_fails(tmp_path):
    ran = collect_run(leave_run(tmp_path / "ran", 0, rostest_lights=PASSING, rosunit_lights=PASSING), "lights.test")
    died = collect_run(leave_run(tmp_path / "died", 1, rostest_lights=DIED), "lights.test")
    assert outcomes(ran) == [Outcome.PASSED]
    assert outcomes(died) == [Outcome.FAILED]
    assert "did not generate" in died[0].message


def test_a_scenario_without_results_of_its_own_has_failed(tmp_path):
    cases = collect_run(leave_run(tmp_path / "run", 0, rostest_lights=PASSING), "lights.test")
    assert outcomes(cases) == [Outcome.FAILED]


def test_a_test_whose_teardown_fails_as_well_counts_once(tmp_path):
    twice = (
        '<testsuite><testcase classname="a" name="b"/>'
        '<testcase classname="a" name="b"><error message="teardown"/></testcase></testsuite>'
    )
    assert outcomes(collect_run(leave_run(tmp_path / "run", 1, a=twice), "unit")) == [Outcome.FAILED]


@pytest.mark.parametrize(
    "wanted, line, success",
    [
        ([Outcome.PASSED] * 3, "3 passed, 0 failed", True),
        ([Outcome.PASSED, Outcome.FAILED], "1 passed, 1 failed", False),
        ([Outcome.PASSED, Outcome.SKIPPED], "1 passed, 0 failed, 1 skipped", True),
        ([Outcome.SKIPPED], "0 passed, 0 failed, 1 skipped", False),
        ([], "0 passed, 0 failed", False),
    ],
)
def test_closing_line_and_verdict(wanted, line, success):
    cases = [Case("unit", str(number), outcome) for number, outcome in enumerate(wanted)]
    assert closing_line(cases) == line
    assert is_success(cases) is success


@pytest.mark.parametrize("status, words", [(124, "in time"), (-9, "signal 9"), (139, "signal 11"), (2, "status 2")])
def test_exit_statuses_are_told_in_words(status, words):
    assert words in describe_status(status)


def test_scenarios_are_found_at_any_depth_and_picked_by_part_of_their_path(tmp_path):
    for name in ("walk/far.test", "lights.test", "lights.py"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).touch()
    assert find_scenarios(tmp_path) == [Path("lights.test"), Path("walk/far.test")]
    assert find_scenarios(tmp_path, ["walk", "nothing"]) == [Path("walk/far.test")]


def test_a_scenario_on_request_runs_when_it_is_named_only(tmp_path):
    (tmp_path / "short.test").write_text("<launch/>")
    (tmp_path / "long.test").write_text("<launch><!-- on request: many minutes --></launch>")
    assert find_scenarios(tmp_path) == [Path("short.test")]
    assert find_scenarios(tmp_path, ["long"]) == [Path("long.test")]


def test_main_misses_the_scenario_that_left_nothing(tmp_path, capsys):
    scenarios = tmp_path / "rostest"
    scenarios.mkdir()
    (scenarios / "lights.test").touch()
    (scenarios / "walk.test").touch()
    results = tmp_path / "results"
    leave_run(results / "unit", 0, results=PASSING)
    leave_run(results / "rostest" / "lights", 0, rostest_lights=PASSING, rosunit_lights=PASSING)
    status = main(["--results", str(results), "--unit", "--scenarios", str(scenarios)])
    lines = capsys.readouterr().out.splitlines()
    assert status == 1
    assert lines[-1] == "2 passed, 1 failed"
    assert lines[0].startswith("FAILED walk.test:")
    assert (results / "summary.txt").read_text() == "2 passed, 1 failed\n"


def test_main_judges_only_the_scenarios_that_were_asked_for(tmp_path, capsys):
    scenarios = tmp_path / "rostest"
    scenarios.mkdir()
    (scenarios / "lights.test").touch()
    (scenarios / "walk.test").touch()
    results = tmp_path / "results"
    leave_run(results / "rostest" / "lights", 0, rosunit_lights=PASSING)
    assert main(["--results", str(results), "--scenarios", str(scenarios), "lights"]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == "1 passed, 0 failed"


def test_main_does_not_accept_a_folder_without_scenarios(tmp_path, capsys):
    (tmp_path / "rostest").mkdir()
    assert main(["--results", str(tmp_path / "results"), "--scenarios", str(tmp_path / "rostest")]) == 1
    assert capsys.readouterr().out.splitlines()[-1] == "0 passed, 1 failed"
