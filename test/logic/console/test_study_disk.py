"""A disk that is full for a moment, or for long: what becomes of the log of a trial and its files."""

from __future__ import annotations

import json
import os
import random
import shutil
import subprocess
import sys

import pytest
from logged_trial import LoggedTrial
from played_study import LIMIT, Trial
from scripted_disk import ScriptedDisk

from nao_library_modules.core.files import FileTrouble
from nao_library_modules.studies import studies as module
from nao_library_modules.studies import trial_log as log_module
from nao_library_modules.studies import trial_runner as runner_module
from nao_library_modules.studies.study_files import PARTICIPANTS, StudyFiles
from nao_library_modules.studies.study_table import table_of
from nao_library_modules.studies.trial_log import EVENTS, TABLE, TrialLog, TrialState, read_events
from nao_sim_bridge.testing import wait_until
from naoqi.errors import NaoError

MOMENTS = 50


@pytest.fixture(autouse=True)
def no_ros(monkeypatch):
    monkeypatch.setattr(module, "settings", lambda namespace: {})
    monkeypatch.setattr(module, "ros_after", lambda seconds, callback: lambda: None)
    monkeypatch.setattr(log_module, "DELAY", 0.005)


@pytest.fixture
def disk(tmp_path, monkeypatch):
    return ScriptedDisk(tmp_path, monkeypatch)


@pytest.fixture
def texts(tmp_path):
    return lambda: [event["text"] for event in read_events(tmp_path)]


def gaps(events):
    return [event for event in events if event["kind"] == "deviation" and event["data"].get("what") == "log gap"]


# --- the log ----------------------------------------------------------------------------------------------------------


def test_a_trial_on_a_disk_that_is_full_at_a_random_moment_is_in_its_log_as_it_was_played(tmp_path, disk):
    """The disk gets full after a random number of bytes, within a line or not, and has room some answers later."""
    failed = 0
    for seed in range(MOMENTS):
        chance = random.Random(seed)
        trial = LoggedTrial(tmp_path / str(seed), seed).begin()
        acts = list(trial.acts())
        begin = chance.randrange(len(acts))
        end = begin + chance.randint(1, 4)
        before = disk.failed
        for number, act in enumerate(acts):
            if number == begin:
                disk.room, disk.syncs = chance.randrange(900), chance.random() < 0.7
            if number == end:
                disk.room, disk.syncs = None, True
            act()
        disk.room, disk.syncs = None, True
        trial.end()
        events = trial.compare()
        assert bool(gaps(events)) == (disk.failed > before), f"moment {seed}"
        failed += disk.failed > before
    assert failed > MOMENTS / 2, "the disk was hardly ever full"


def test_lost_events_are_written_first_and_in_order_with_their_own_times(tmp_path, disk, texts):
    log = TrialLog(tmp_path)
    log.add({"text": "before"})
    disk.room = 20
    waited = [log.add({"text": f"waits {i}"}) for i in range(3)]
    assert texts() == ["before"]
    disk.room = None
    log.add({"text": "after"})
    assert log.close() == 0
    assert texts() == ["before", "waits 0", "waits 1", "waits 2", "after"]
    assert read_events(tmp_path)[1:4] == waited


def test_what_a_failed_sync_leaves_open_is_written_again(tmp_path, disk, texts):
    log = TrialLog(tmp_path)
    disk.syncs = False
    log.add({"text": "in the cache"})
    wait_until(lambda: log.trouble, LIMIT, "the sync to fail")
    with (tmp_path / EVENTS).open("r+b") as file:  # as when the computer drops the pages that it could not write
        file.write(bytes(10))
    disk.syncs = True
    assert log.close() == 0
    assert texts() == ["in the cache"]


def test_a_log_that_ends_within_a_line_goes_on_behind_the_last_whole_one(tmp_path, disk):
    log = TrialLog(tmp_path)
    log.add({"text": "whole"})
    disk.room = 20
    log.add({"text": "torn"})
    left = tmp_path / "left"
    left.mkdir()
    shutil.copy(tmp_path / EVENTS, left / EVENTS)  # as a power cut leaves it
    disk.room = None
    log.close()
    assert not (left / EVENTS).read_bytes().endswith(b"\n")
    again = TrialLog(left)
    again.add({"text": "next"})
    again.close()
    assert [(event["n"], event["text"]) for event in read_events(left)] == [(1, "whole"), (2, "next")]


@pytest.mark.parametrize(
    "line", [b'{"n": 1e999}', b"[" * 100_000, b'{"n": null}', b"\xff"], ids=["infinite", "nested", "null", "bytes"]
)
def test_a_line_that_is_no_event_is_passed_over(tmp_path, line):
    (tmp_path / EVENTS).write_bytes(b'{"n": 1, "text": "before"}\n' + line + b"\n")
    log = TrialLog(tmp_path)
    log.add({"text": "after"})
    log.close()
    texts = [event["text"] for event in read_events(tmp_path) if "text" in event]
    assert texts == ["before", "after"]


def test_events_that_find_no_room_in_the_end_are_counted(tmp_path, disk):
    log = TrialLog(tmp_path)
    disk.room = 0
    for _ in range(3):
        log.add({"text": "lost"})
    assert "No space left on device" in log.trouble and "3 events wait" in log.trouble
    assert log.close(patience=0.0) == 3


# --- a trial ----------------------------------------------------------------------------------------------------------


def test_trouble_is_shown_until_somebody_has_seen_it_and_is_a_deviation_with_its_times(tmp_path, disk):
    trial = Trial(tmp_path).begin().at("2.1")
    disk.room = 0
    began = trial.robot.now()
    trial.runner.note("waits")
    trial.robot.time += 5.0
    assert "1 events wait" in trial.runner.trouble
    disk.room = None
    trial.until(lambda: trial.runner.state.trouble)
    trial.runner.note("written at once")
    trouble = trial.runner.trouble
    assert "1 events waited in memory" in trouble
    trial.runner.seen("ann")
    assert trial.runner.trouble == ""
    trial.play()
    events = read_events(tmp_path / "two_by_two/P01-1")
    (gap,) = gaps(events)
    assert (gap["text"], gap["data"]["began"], gap["data"]["ended"]) == (trouble, began, began + 5.0)
    assert [event["by"] for event in events if event["data"].get("what") == "trouble seen"] == ["ann"]
    assert trial.runner.state.deviations == 1


def test_a_trial_that_cannot_be_logged_waits_before_its_next_step_and_goes_on_by_itself(tmp_path, disk, monkeypatch):
    monkeypatch.setattr(runner_module, "LOG_PATIENCE", 0.0)
    trial = Trial(tmp_path).begin().at("2.1")
    disk.room = 0
    trial.touch(0.5)
    trial.until(lambda: trial.runner.state.status == "paused")
    assert trial.runner.step is None
    disk.room = None
    trial.at("2.2").runner.choose("yes")
    assert trial.end().status == "finished"
    assert "waits before step 2.2" in next(e["text"] for e in read_events(tmp_path / "two_by_two/P01-1")
                                           if e["data"].get("what") == "paused")  # fmt: skip


def test_who_goes_on_does_not_wait_for_the_log_and_nothing_is_lost(tmp_path, disk, monkeypatch):
    monkeypatch.setattr(runner_module, "LOG_PATIENCE", 0.0)
    trial = Trial(tmp_path).begin().at("2.1")
    disk.room = 0
    trial.touch(0.5)
    trial.until(lambda: trial.runner.state.status == "paused")
    trial.runner.go_on()
    trial.at("2.2").runner.choose("yes")
    trial.until(lambda: trial.runner.state.status == "paused")  # at its end it waits in any case
    disk.room = None
    assert trial.end().status == "finished"
    assert TrialState.of(read_events(tmp_path / "two_by_two/P01-1")).status == "finished"


def test_who_aborts_a_trial_that_waits_at_its_end_is_told_what_is_lost(tmp_path, disk, monkeypatch):
    monkeypatch.setattr(runner_module, "LOG_PATIENCE", 0.0)
    monkeypatch.setattr(module, "PATIENCE", 0.0)
    trial = Trial(tmp_path).begin().at("2.1")
    disk.room = 0
    trial.runner.abort()
    trial.until(lambda: trial.runner.state.status == "paused")
    trial.runner.abort()
    trial.end()
    assert trial.runner.lost > 0
    assert f"the last {trial.runner.lost} events" in trial.runner.trouble
    assert trial.files.trial("two_by_two/P01-1").state().status == "interrupted"


def test_the_table_of_the_events_waits_for_room(tmp_path, disk):
    trial = Trial(tmp_path).begin()
    closed = TrialLog.close

    def close(log, patience):
        lost = closed(log, patience)
        disk.room = 0
        return lost

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(TrialLog, "close", close)
        trial.at("2.1").touch(0.5)
        trial.at("2.2").runner.choose("yes")
        wait_until(lambda: disk.failed, LIMIT, "a disk that is full")
    disk.room = None
    trial.end()
    assert (tmp_path / "two_by_two/P01-1" / TABLE).is_file()


# --- what a log lacks -------------------------------------------------------------------------------------------------


def without(folder, lacks):
    """Rewrite a log without some of its events, as the log of an older version may be."""
    lines = [line for line in (folder / EVENTS).read_bytes().splitlines(True) if not lacks(json.loads(line))]
    (folder / EVENTS).write_bytes(b"".join(lines))


def is_about(event, what, path):
    return event["data"].get("what") == what and event["data"].get("path") == path


@pytest.mark.parametrize(
    "lost, answers, told",
    [
        (["ended 2.1"], {"2.2": "yes"}, ["end of step 2.1"]),
        (["began 2.2"], {"2.1": "front head", "2.2": "yes"}, ["begin of step 2.2"]),
        (["ended 2.1", "began 2.2"], {"2.2": "yes"}, ["end of step 2.1", "begin of step 2.2"]),
        (["began 2.1", "ended 2.1"], {"2.2": "yes"}, []),
    ],
    ids=["an end", "a begin", "an end and the next begin", "a step"],
)
def test_answers_stand_under_their_own_question_whatever_the_log_lacks(tmp_path, lost, answers, told):
    trial = Trial(tmp_path).begin()
    trial.play("yes", 0.7)
    events = [(f"step {what}", path) for what, path in map(str.split, lost)]
    without(trial.files.trial("two_by_two/P01-1").path, lambda event: any(is_about(event, *each) for each in events))
    table = table_of(trial.files, "two_by_two")
    assert {row["path"]: row["answer"] for row in table.rows if row["answer"]} == answers
    gaps = [gap for _, gap in table.gaps]
    assert [gap for gap in gaps if "step" in gap] == [f"the {each} is not in the log" for each in told]
    assert any(gap.startswith("event") for gap in gaps), "a number is missing"
    assert {row["deviations"] for row in table.rows} == {len(gaps)}


# --- files and numbers ------------------------------------------------------------------------------------------------


def test_the_files_of_a_trial_are_on_the_disk_before_it_begins(tmp_path, monkeypatch):
    synced, real = set(), os.fsync

    def sync(file):
        synced.add(os.fstat(file).st_ino)
        real(file)

    monkeypatch.setattr(os, "fsync", sync)
    trial = Trial(tmp_path).begin().at("2.1")
    folder = tmp_path / "two_by_two"
    names = (
        folder,
        folder / PARTICIPANTS,
        folder / "P01-1",
        folder / "P01-1/protocol.yaml",
        folder / "P01-1/trial.yaml",
    )
    assert all(path.stat().st_ino in synced for path in (tmp_path, *names))
    trial.runner.abort()
    trial.end()


def test_a_trial_that_cannot_be_described_does_not_begin(tmp_path, monkeypatch):
    trial = Trial(tmp_path)
    real = module.StudyFiles.describe

    def describe(files, folder, about, protocol):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(os, "replace", _full)
            real(files, folder, about, protocol)

    monkeypatch.setattr(module.StudyFiles, "describe", describe)
    with pytest.raises(FileTrouble, match="No space left"):
        trial.begin()
    assert trial.files.trials("two_by_two") == []
    assert trial.files.participants("two_by_two") == {"P01": 1}


def test_a_number_is_given_when_it_is_on_the_disk_and_not_before(tmp_path, monkeypatch):
    files = StudyFiles(tmp_path)
    assert files.number_of("study", "ann") == 1
    with monkeypatch.context() as patch:
        patch.setattr(os, "replace", _full)
        with pytest.raises(FileTrouble):
            files.number_of("study", "bea")
    assert files.participants("study") == {"ann": 1}
    assert files.number_of("study", "eva") == 2


ENROL = """
import sys
from pathlib import Path
from nao_library_modules.studies.study_files import StudyFiles
files = StudyFiles(Path(sys.argv[1]))
sys.stdin.read()
for i in range(10):
    print(files.number_of("study", f"p_{sys.argv[2]}_{i}x"))
"""


def test_programs_that_enrol_at_once_give_no_number_twice(tmp_path):
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    programs = [subprocess.Popen([sys.executable, "-c", ENROL, str(tmp_path), str(i)], **pipes) for i in range(3)]
    for program in programs:
        program.stdin.close()
        program.stdin = None
    numbers = [int(line) for program in programs for line in program.communicate(timeout=60)[0].split()]
    assert sorted(numbers) == list(range(1, 31))


def test_numbers_of_trials_are_not_given_again_though_the_file_of_numbers_is_gone(tmp_path):
    trial = Trial(tmp_path)
    for name in ("ann", "bea"):
        trial.begin(name).at("2.1").runner.abort()
        trial.end()
    (tmp_path / "two_by_two" / PARTICIPANTS).unlink()
    assert [trial.files.number_of("two_by_two", name) for name in ("eva", "bea", "ann")] == [3, 2, 1]


@pytest.mark.parametrize("content", ["", "ann: 1\nbea", "[1"])
def test_no_number_is_given_from_a_file_of_numbers_that_is_damaged(tmp_path, content):
    (tmp_path / "study").mkdir()
    (tmp_path / "study" / PARTICIPANTS).write_text(content)
    with pytest.raises(NaoError, match=PARTICIPANTS):
        StudyFiles(tmp_path).number_of("study", "P01")


def _full(*_):
    raise OSError(28, os.strerror(28))
