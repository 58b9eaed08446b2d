"""The tables of features in README.md, and how their commands are run: read, in order, none in another's way."""

from __future__ import annotations

import fcntl
import os
import re
import threading

import pytest
from feature_runner import Outcome, run, run_all
from feature_table import ALL, BEGIN, END, README, Feature, FeatureTableError, features

ROWS = features(README.read_text(encoding="utf-8"))


def table(*rows):
    return "\n".join((BEGIN, "", "| feature | command |", "| --- | --- |", *rows, "", END))


def feature(command):
    return Feature("a feature", command, starred=False)


def test_rows_are_read_with_star_and_pipe():
    rows = features(table("| says `it` | `nao say a \\| cat` |", "| all | `make demo` ★ |"))
    assert rows == [Feature("says `it`", "nao say a | cat", False), Feature("all", "make demo", True)]


@pytest.mark.parametrize("row", ["| a | nao say |", "| a | `nao say` * |", "| a | b | `nao say` |", "| a | `` |"])
def test_what_is_no_row_is_told(row):
    with pytest.raises(FeatureTableError, match="not a row"):
        features(table(row))


@pytest.mark.parametrize("text", ["", BEGIN, END + BEGIN, table() + BEGIN])
def test_marks_come_once_and_in_order(text):
    with pytest.raises(FeatureTableError, match="there has to be one"):
        features(text)


def test_the_readme_shows_no_command_twice():
    commands = [row.command for row in ROWS]
    assert sorted({command for command in commands if commands.count(command) > 1}) == []


def test_what_starts_a_stack_or_a_build_has_a_star():
    own = re.compile(r"make |scripts/|roslaunch |rosrun nao_library_modules add_a_(function|module)")
    assert [row.command for row in ROWS if row.starred != bool(own.match(row.command))] == []


def test_what_nothing_is_known_of_has_all_for_itself():
    assert feature("frobnicate").uses == ALL
    assert feature("nao leds FaceLeds red && nao say red").uses == {"lights", "sound"}
    assert feature("nao get Some/Key").uses == frozenset()


def test_a_command_runs_as_in_a_shell_with_the_port_of_the_robot(tmp_path):
    outcome = run(feature("echo 9559 19559 > port; cat port; ! false"), tmp_path, os.environ, 20001, 10.0)
    assert (outcome.status, outcome.output) == (0, "20001 19559\n")


def test_a_command_that_does_not_end_is_killed_with_what_it_started(tmp_path):
    outcome = run(feature("exec 9> lock; flock 9; sleep 1000 & echo begun; wait"), tmp_path, os.environ, 20001, 1.0)
    assert (outcome.status, outcome.output) == (None, "begun\n")
    with (tmp_path / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)  # as long as one of them lives, this waits


def test_commands_in_each_others_way_keep_their_order_and_others_run_beside_them():
    rows = [feature(c) for c in ("nao say a", "nao say b", "nao leds c off", "nao run d", "nao leds e off")]
    began, running, together = [], [], threading.Barrier(2)

    def run_one(row):
        began.append(row.command)
        assert not any(row.uses & other.uses for other in running)
        running.append(row)
        if row.command in ("nao say a", "nao leds c off"):
            together.wait(10.0)
        running.remove(row)
        return Outcome(row, 0, "", 0.0)

    outcomes = run_all(rows, run_one, at_once=3)
    assert len(outcomes) == 5
    assert set(began[:2]) == {"nao say a", "nao leds c off"}
    assert (set(began[2:4]), began[4]) == ({"nao say b", "nao leds e off"}, "nao run d")
