"""Mistyped pseudonyms are corrected or taken back; rehearsals and aborted trials are no results."""

from __future__ import annotations

import csv
import json
import os

import pytest
from click.testing import CliRunner
from played_study import PROTOCOL, Trial

from nao_library_modules.cli.app import nao
from nao_library_modules.studies import studies as module
from nao_library_modules.studies import study_files as pseudonyms
from nao_library_modules.studies.protocol import StudyError
from nao_library_modules.studies.protocol_reader import read_protocol
from nao_library_modules.studies.study_files import Participant, participants_of, schedule_of
from nao_library_modules.studies.study_table import summaries_of, table_of
from nao_library_modules.studies.trial_log import read_events

STUDY = "two_by_two"


@pytest.fixture
def trial(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "settings", lambda namespace: {})
    monkeypatch.setattr(module, "ros_after", lambda seconds, callback: lambda: None)
    return Trial(tmp_path)


@pytest.fixture
def run(tmp_path):
    return lambda *words: CliRunner().invoke(nao, ["study", *words, "--studies", str(tmp_path)])


def test_a_corrected_pseudonym_keeps_number_order_and_trials(trial):
    trial.begin("P0l").play()
    trial.begin("P0l")
    trial.runner.abort()
    trial.end()
    number = trial.files.participants(STUDY)["P0l"]
    assert trial.studies.correct_pseudonym(STUDY, "P0l", "P01", "ann") == number
    assert trial.files.participants(STUDY) == {"P01": number}
    assert [each.id for each in trial.files.trials(STUDY)] == [f"{STUDY}/P01-1", f"{STUDY}/P01-2"]
    assert trial.studies.position_of(trial.protocol, "P01") == 2
    assert {row["participant"] for row in table_of(trial.files, STUDY).rows} == {"P01"}
    assert "participant: P01\n" in (trial.files.folder / STUDY / "P01-1/trial.yaml").read_text()


def test_the_log_has_both_pseudonyms_and_the_trial_goes_on_with_the_right_one(trial):
    trial.begin("P0l").play()
    trial.studies.correct_pseudonym(STUDY, "P0l", "P01", "ann")
    folder = trial.files.trial(f"{STUDY}/P01-1")
    event = read_events(folder.path)[-1]
    assert (event["by"], event["data"]["old"], event["data"]["participant"]) == ("ann", "P0l", "P01")
    assert (folder.state().values["participant"], folder.state().about["trial"]) == ("P01", folder.id)


def test_no_pseudonym_is_corrected_to_that_of_somebody_else(trial):
    for participant in ("P01", "P02"):
        trial.begin(participant).play()
    with pytest.raises(StudyError, match="P02 is another participant of two_by_two, number 2"):
        trial.studies.correct_pseudonym(STUDY, "P01", "P02")
    assert trial.files.participants(STUDY) == {"P01": 1, "P02": 2}


def test_a_correction_that_a_power_cut_has_ended_is_carried_on_and_nobody_gets_the_number(trial, monkeypatch):
    for _ in range(2):
        trial.begin("P0l").play()
    real, renamed = os.rename, []

    def cut(source, target):
        if renamed:
            raise OSError("the power is gone")
        renamed.append(target)
        real(source, target)

    monkeypatch.setattr(pseudonyms.os, "rename", cut)
    with pytest.raises(Exception, match="the power is gone"):
        trial.studies.correct_pseudonym(STUDY, "P0l", "P01")
    monkeypatch.setattr(pseudonyms.os, "rename", real)
    number = trial.files.participants(STUDY)["P0l"]
    assert trial.files.coming_number(STUDY, "Q") != number
    trial.studies.correct_pseudonym(STUDY, "P0l", "P01")
    assert trial.files.participants(STUDY) == {"P01": number}
    assert [each.path.name for each in trial.files.trials(STUDY)] == ["P01-1", "P01-2"]


def test_who_has_played_nothing_is_taken_back_and_the_number_is_free(trial):
    trial.begin("P01").play()
    number = trial.files.number_of(STUDY, "P0x")
    assert trial.studies.take_back(STUDY, "P0x") == number
    assert trial.files.number_of(STUDY, "Q") == number


def test_a_trial_without_a_step_gives_its_number_back_also_where_the_file_of_numbers_is_lost(trial):
    trial.begin("P01").play()
    events = trial.files.folder / STUDY / "P01-1/events.jsonl"
    events.write_text(events.read_text().splitlines(keepends=True)[0])  # as of a trial that waited for its recordings
    trial.studies.take_back(STUDY, "P01", "ann")
    (trial.files.folder / STUDY / "participants.yaml").unlink()
    assert trial.files.number_of(STUDY, "Q") == 1
    assert trial.files.trial(f"{STUDY}/P01-1").state().status == "aborted"


def test_who_has_played_is_not_taken_back(trial):
    trial.begin("P01").play()
    with pytest.raises(StudyError, match="has played in two_by_two/P01-1: number 1 is used up"):
        trial.studies.take_back(STUDY, "P01")
    assert participants_of(trial.files, STUDY) == [Participant("P01", 1, 1, True)]


def test_a_participant_whose_trial_runs_is_left_alone(trial):
    trial.begin("P01").at("2.1")
    with pytest.raises(StudyError, match="is run by another program"):
        trial.studies.correct_pseudonym(STUDY, "P01", "P02")
    trial.runner.abort()
    trial.end()
    assert trial.files.participants(STUDY) == {"P01": 1}


def test_what_is_before_a_participant_is_known_before_anything_is_written(trial):
    schedule = schedule_of(trial.files, trial.protocol, "P03")
    assert (schedule.number, schedule.new, schedule.next, len(schedule.order)) == (3, True, 1, 4)
    assert trial.files.studies() == []
    trial.begin("P03").play()
    assert schedule_of(trial.files, trial.protocol, "P03").lines(blind=False)[2].endswith("(next)")


def test_a_wizard_who_is_blind_sees_no_condition(trial, run, tmp_path):
    file = tmp_path / "blind.yaml"
    file.write_text(f"{PROTOCOL}blind: true\n")
    assert read_protocol(file.read_text(), "blind").blind
    told = run("order", str(file), "P03")
    assert (told.exit_code, told.output) == (
        0,
        "4 trials; the wizard is blind: number, order and conditions are not shown\n",
    )
    assert {*json.loads(run("order", str(file), "P03", "--json").output)} == {"name", "participant", "blind"}


def test_a_shell_tells_the_order_and_corrects_and_takes_back(trial, run, tmp_path):
    file = tmp_path / "two.yaml"
    file.write_text(PROTOCOL)
    trial.begin("P0l").play()
    told = run("order", str(file), "P0l").output
    assert "Participant 1, 4 trials in this order:" in told and "2. voice: " in told and "(next)" in told
    assert run("rename", STUDY, "P0l", "P01").output == "P0l is P01 now, participant 1 of two_by_two\n"
    assert run("take-back", STUDY, "P01").exit_code == 1
    trial.files.number_of(STUDY, "P09")
    assert "number 9 of two_by_two is free" in run("take-back", STUDY, "P09").output


def rehearse(trial, participant="P01"):
    trial.runner = trial.studies.begin(trial.protocol, participant, trial.robot, listener=trial.tell, rehearsal=True)
    return trial.play("no")


def test_a_rehearsal_uses_up_no_number_and_is_no_trial_of_the_participant(trial):
    assert rehearse(trial).rehearsal
    assert trial.files.participants(STUDY) == {}
    assert trial.studies.position_of(trial.protocol, "P01") == 1
    assert trial.files.number_of(STUDY, "Q") == 1


def test_aborted_and_rehearsed_trials_are_marked_and_left_out_of_summaries_unless_asked_for(trial, run):
    rehearse(trial)
    trial.begin("P01").play()
    trial.begin("P01").at("2.1").touch(0.5)
    trial.at("2.2").runner.abort()
    trial.end()
    table = table_of(trial.files, STUDY)
    assert sum(each.count for each in summaries_of(table) if each.label == "head") == 1
    assert sum(each.count for each in summaries_of(table, all_trials=True) if each.label == "head") == 3
    assert table.left_out == ((f"{STUDY}/P01-1", "finished, rehearsal"), (f"{STUDY}/P01-3", "aborted"))
    rows = list(csv.DictReader(table.trials_csv().splitlines()))
    assert [(row["trial_state"], row["rehearsal"]) for row in rows] == [
        ("finished", "True"),
        ("finished", "False"),
        ("aborted", "False"),
    ]
    assert f"{STUDY}/P01-3: not counted, aborted" in run("table", STUDY).output
    counted = json.loads(run("table", STUDY, "--all-trials", "--json").output)
    assert sum(each["count"] for each in counted["summaries"] if each["step"] == "head") == 3


def test_the_steps_that_are_told_are_the_rows_of_the_table(trial):
    trial.begin().at("2.1").runner.next()
    trial.at("2.2").runner.choose("yes")
    state = trial.end()
    table = table_of(trial.files, STUDY)
    assert state.steps_text == "4 steps: 3 done, 1 skipped"
    assert (len(table.rows), table.trials[0]["steps"]) == (4, 4)


def test_the_tables_have_the_words_of_notes_and_deviations(trial):
    trial.begin().at("2.1")
    trial.runner.note("looks away")
    trial.runner.deviation("=the door opened")
    trial.runner.note("and back")
    trial.play()
    table = table_of(trial.files, STUDY)
    (row,) = csv.DictReader(table.trials_csv().splitlines())
    assert (row["note_text"], row["deviation_text"]) == ("looks away; and back", "'=the door opened")
    steps = {row["path"]: row["note_text"] for row in csv.DictReader(table.csv().splitlines())}
    assert steps["2.1"] == "looks away; and back" and not steps["1.1"] and not steps["2.2"]
