"""Trials: controls, what is logged of them, what survives a kill, and the table."""

from __future__ import annotations

import csv
import os
import signal
import subprocess
import sys
import textwrap
import threading
from dataclasses import asdict
from pathlib import Path

import played_study
import pytest
from played_study import LIMIT, PROTOCOL, PlayedRobot, Trial

from nao_library_modules.studies import studies as module
from nao_library_modules.studies import trial_recordings
from nao_library_modules.studies.protocol import StudyError
from nao_library_modules.studies.robot_events import Touches
from nao_library_modules.studies.studies import Studies
from nao_library_modules.studies.study_table import summaries_of, table_of
from nao_library_modules.studies.trial_log import DELAY, EVENTS, TABLE, TrialLog, TrialState, guarded, read_events


@pytest.fixture(autouse=True)
def no_ros(monkeypatch):
    monkeypatch.setattr(module, "settings", lambda namespace: {})
    monkeypatch.setattr(module, "ros_after", lambda seconds, callback: lambda: None)


@pytest.fixture
def trial(tmp_path):
    return Trial(tmp_path)


def test_a_trial_does_its_steps_and_measures_the_reaction(trial):
    state = trial.begin().play("no")
    assert state.status == "finished"
    assert [each.path for each in state.outcomes] == ["1.1", "2.1", "2.2", "2.3.b1.1", "2.4"]
    assert (state.outcomes[1].answer, state.outcomes[1].seconds) == ("front head", pytest.approx(0.7))
    assert trial.robot.runs[-1].command.chain[0][1]["str_param"] in ("Thanks, P01", "Right")


def test_a_value_of_the_protocol_can_be_another_one_in_a_trial(tmp_path):
    trial = Trial(
        tmp_path, text=PROTOCOL.replace("say: Hello", 'say: "Hello {spoken_name}"') + "values: {spoken_name: you}"
    )
    for given, said in (({}, "Hello you"), ({"spoken_name": "Ann"}, "Hello Ann")):
        trial.runner = trial.studies.begin(trial.protocol, "P01", trial.robot, listener=trial.tell, values=given)
        trial.at("2.1").runner.abort()
        assert trial.end().outcomes[0].text.endswith(said)
    assert "spoken_name: Ann" in (tmp_path / "two_by_two/P01-2/trial.yaml").read_text()
    assert trial.files.newest_protocol() == ""
    with pytest.raises(StudyError, match="did you mean 'spoken_name'"):
        trial.studies.begin(trial.protocol, "P01", trial.robot, values={"spokenname": "Ann"})


def test_the_protocol_of_the_newest_trial_is_known(trial):
    (trial.files.folder / "protocols").mkdir()
    (trial.files.folder / "protocols/other.yaml").write_text(PROTOCOL)
    trial.begin().runner.abort()
    trial.end()
    assert trial.files.newest_protocol() == "other"


def test_next_ends_a_step_without_answer_and_a_late_answer_counts_no_more(trial):
    trial.begin().at("2.1").runner.next("ann")
    trial.at("2.2").runner.next()
    assert [each.outcome for each in trial.end().outcomes] == ["done", "skipped", "skipped", "done"]
    assert trial.runner.state.values["head"] == "none"


def test_a_touch_counts_that_came_before_the_server_waited_for_it(trial, monkeypatch):
    monkeypatch.setattr(module, "ros_after", lambda seconds, callback: callback() or (lambda: None))
    trial.begin().at("2.1")
    trial.robot.events.add("touched", "chest pressed", stamp=100.1, sensor="chest", touched=True)
    trial.robot.events.add("touched", "rear head pressed", stamp=100.2, sensor="rear head", touched=True)
    trial.at("2.2")
    assert trial.runner.state.values["head"] == "rear head"
    assert trial.runner.state.values["head_seconds"] == pytest.approx(0.2)
    trial.runner.abort()
    trial.end()


STEPS = "name: steps\nphases:\n  - steps:\n"


def steps_of(folder, steps, plays=("say",)):
    return Trial(folder, PlayedRobot(plays), STEPS + textwrap.indent(textwrap.dedent(steps), "      "))


def test_a_touch_during_the_steps_before_a_wait_answers_it_with_a_time_below_zero(tmp_path):
    trial = steps_of(
        tmp_path,
        """
        - {say: Touch my head, label: question}
        - {run: nod}
        - {wait: touch, sensors: [head], label: head}
        - {run: bow}
        - {wait: touch, sensors: [head], label: again, since: now}
        """,
    ).begin()
    trial.at("1.2").feel("front head", 100.5)
    trial.feel("middle head", 100.6)
    trial.robot.time = 102.0
    trial.goal("runBehavior").end()
    trial.at("1.4").feel("rear head", 103.0)  # the same hand still
    trial.goal("runBehavior").end()
    trial.at("1.5")
    values = trial.runner.state.values
    assert (values["head"], values["head_seconds"]) == ("front head", pytest.approx(-1.5))
    (
        trial.feel("front head", 104.0, False),
        trial.feel("middle head", 104.0, False),
        trial.feel("rear head", 104.0, False),
    )
    trial.feel("front head", 105.0)
    trial.goal("waitForTouch").end(touched=["front head"], results=[{"onset": 105.0}])
    assert trial.end().values["again_seconds"] == pytest.approx(3.0)


@pytest.mark.parametrize(
    "told, begins",
    [
        ([("front head", 1.0, True), ("rear head", 1.1, True)], [True, False]),
        ([("front head", 1.0, True), ("chest", 1.1, True)], [True, True]),
        ([("left hand back", 1.0, True), ("right hand back", 1.0, True)], [True, True]),
        ([("chest", 1.0, True), ("chest", 1.05, False), ("chest", 1.06, True)], [True, False, False]),
        ([("chest", 1.0, True), ("chest", 1.2, False), ("chest", 1.4, True)], [True, False, True]),
    ],
)
def test_a_touch_begins_where_nothing_was_pressed(told, begins):
    touches = Touches()
    found = [touches.begins({"sensor": sensor, "touched": on}, stamp) for sensor, stamp, on in told]
    assert found == begins


def test_a_touch_that_a_goal_has_told_of_is_not_told_again_by_topics():
    touches = Touches()
    touches.answered(["front head"], 1.0)
    assert not touches.begins({"sensor": "front head", "touched": True}, 1.02)
    touches.begins({"sensor": "front head", "touched": False}, 1.3)
    assert touches.begins({"sensor": "front head", "touched": True}, 1.6)
    assert touches.goes_on(["rear head"], 2.5) and not touches.goes_on(["chest"], 2.5)


def test_a_reaction_counts_from_the_end_of_the_step_that_since_names(tmp_path):
    trial = steps_of(
        tmp_path,
        """
        - {run: ask, label: question}
        - {run: nod}
        - {wait: touch, sensors: [head], label: head, since: question}
        """,
    )
    trial.robot.time = 99.0
    trial.begin().at("1.1")
    trial.robot.time = 101.5
    trial.goal("runBehavior").end(results=[{"offset": 101.0, "end": 101.4}])
    trial.at("1.2")
    trial.robot.time = 104.0
    trial.goal("runBehavior").end()
    trial.at("1.3")
    trial.goal("waitForTouch").end(touched=["front head"], results=[{"onset": 105.0}])
    assert trial.end().values["head_seconds"] == pytest.approx(4.0)


def test_the_robot_listens_ahead_of_a_word_but_not_while_it_speaks(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "behavior_speaks", lambda robot, name: name == "hello")
    trial = steps_of(
        tmp_path,
        """
        - {run: hello}
        - {run: nod}
        - {wait: word, words: ["yes"], label: answer}
        """,
    ).begin()
    trial.at("1.1").goal("runBehavior").end()
    trial.at("1.2").goal("listen").end(words=["yes"], results=[{"onset": 100.0}])
    trial.robot.time = 102.0
    trial.goal("runBehavior").end()
    state = trial.end()
    assert (state.values["answer"], state.values["answer_seconds"]) == ("yes", pytest.approx(-2.0))
    assert [run.command.chain[0][0] for run in trial.robot.runs] == ["runBehavior", "listen", "runBehavior"]


WHILE = """
    - while: {do: [{run: nod, label: nodded}, {call: NaoTactile2.look}], until: touch, sensors: [head], label: head}
    - {when: head == front head, then: [{say: Thanks}]}
"""


def test_a_while_does_its_steps_until_a_touch_ends_the_one_that_runs(tmp_path):
    trial = steps_of(tmp_path, WHILE).begin()
    for number in (1, 2):
        trial.begun(f"1.1.w{number}.1")
        trial.goal("runBehavior").end()
        trial.robot.time += 1.0
        look = trial.goal("look")
        if number == 1:
            look.end()
    trial.goal("waitForTouch").end(touched=["front head"], results=[{"onset": 101.5}])
    state = trial.end()
    assert look.state == "preempted"
    assert [(each.path, each.outcome) for each in state.outcomes] == [
        *(("1.1", "done"), ("1.1.w1.1", "done"), ("1.1.w1.2", "done"), ("1.1.w2.1", "done"), ("1.1.w2.2", "cut")),
        ("1.2.b1.1", "done"),
    ]
    assert (state.values["head"], state.values["head_seconds"]) == ("front head", pytest.approx(1.5))
    assert TrialState.of(read_events(trial.files.trial("steps/P01-1").path)) == state
    rows = [(row["path"], row["round"]) for row in table_of(trial.files, "steps").rows]
    assert rows[2:5] == [("1.1.w1.2", 1), ("1.1.w2.1", 2), ("1.1.w2.2", 2)]


def test_a_while_is_skipped_paused_and_restarted_as_a_whole(tmp_path):
    trial = steps_of(tmp_path, WHILE).begin()
    trial.begun("1.1.w1.1")
    assert trial.runner.outcome.path == "1.1"
    trial.runner.pause()
    trial.until(lambda: trial.runner.state.status == "paused")
    assert all(run.done for run in trial.robot.runs)
    trial.feel("front head", 100.2)  # while it is paused
    trial.robot.time = 103.0
    trial.runner.go_on()
    trial.begun("1.1.w1.1", 2)
    trial.runner.next()
    state = trial.end()
    assert [each.outcome for each in state.outcomes if each.path == "1.1"] == ["stopped", "skipped"]
    assert state.values["head"] == "none"


def test_a_failure_in_a_while_holds_the_while(tmp_path):
    trial = steps_of(tmp_path, WHILE).begin()
    trial.goal("runBehavior").end("aborted", "fell")
    trial.until(lambda: trial.runner.state.status == "held")
    assert (trial.runner.outcome.path, trial.runner.outcome.error) == ("1.1", "step 1.1.w1.1: fell")
    trial.runner.next()
    assert trial.end().status == "finished"


@pytest.mark.parametrize(
    "results, answer, path",
    [
        ([{"values": ["0.7"]}], "0.7", "1.2.b1.1"),
        ([{"values": ["True"]}], "true", "1.2.b2.1"),
        ([{"values": []}], "none", "1.2.b2.1"),
        ([{"values": ["front head", "chest"]}, {"values": []}], "front head, chest", "1.2.b2.1"),
    ],
)
def test_what_a_function_answers_is_seen_by_conditions_and_the_table(tmp_path, results, answer, path):
    trial = steps_of(
        tmp_path,
        """
        - {call: NaoTactile2.look, label: x}
        - {when: x > 0.5, then: [{say: "{x}"}], else: [{say: no}]}
        """,
    ).begin()
    trial.goal("look").end(results=results)
    state = trial.end()
    assert (state.values["x"], state.outcomes[-1].path) == (answer, path)
    assert table_of(trial.files, "steps").trials[0]["x"] == answer


def test_repeat_begins_a_step_anew(trial):
    trial.begin().at("2.1").runner.repeat()
    trial.at("2.1", 2).touch(1.0)
    trial.at("2.2").runner.choose("yes")
    assert [each.outcome for each in trial.end().outcomes[1:3]] == ["repeated", "done"]


def test_pages_look_at_a_robot_whose_trial_begins_and_nobody_begins_another(trial):
    asked, go, now, seen = threading.Event(), threading.Event(), trial.robot.now, []
    trial.robot.now = lambda: asked.set() or go.wait(LIMIT) and now()
    beginning = threading.Thread(target=trial.begin)
    beginning.start()
    assert asked.wait(LIMIT)
    looking = threading.Thread(target=lambda: seen.append(trial.studies.running(trial.robot.namespace)))
    looking.start()
    looking.join(60.0)
    looked = list(seen)
    with pytest.raises(StudyError, match="about to begin"):
        trial.studies.begin(trial.protocol, "P02", trial.robot)
    go.set()
    beginning.join(LIMIT)
    assert looked == [None]
    trial.runner.abort()
    trial.end()


def test_a_trial_is_not_shown_before_it_is_known_whose_it_is(trial):
    subscribe, seen = trial.robot.events.subscribe, []

    def look(listener):
        runner = trial.studies.running(trial.robot.namespace)
        seen.append(runner and runner.state.about.get("participant"))
        return subscribe(listener)

    trial.robot.events.subscribe = look
    trial.begin()
    assert seen == [None] and trial.studies.running(trial.robot.namespace).state.about["participant"] == "P01"
    trial.runner.abort()
    trial.end()


def test_who_stops_the_robot_pauses_its_trial(trial):
    trial.begin().at("2.1").robot.events.add("stopped", "everything is told to stop", "ann")
    trial.until(lambda: trial.runner.state.status == "paused")
    trial.runner.abort()
    trial.end()


def by_another(act):
    thread = threading.Thread(target=act)
    thread.start()
    thread.join(LIMIT)


def test_a_stop_between_the_begin_of_a_step_and_its_goal_holds_the_goal_back(trial):
    def stop_once(event):
        if event.text == "step 1.1: say Hello" and not trial.robot.stops:
            by_another(trial.robot.stop)

    trial.robot.events.subscribe(stop_once)
    trial.begin().until(lambda: trial.runner.state.status == "paused")
    assert trial.robot.runs == []
    trial.runner.go_on()
    state = trial.at("2.1").runner.state
    assert [(each.path, each.outcome) for each in state.outcomes] == [("1.1", "stopped"), ("1.1", "done"), ("2.1", "")]
    trial.runner.abort()
    trial.end()


def test_a_stop_whose_event_comes_late_holds_the_next_goal_back(trial):
    trial.begin().at("2.1")
    sent = len(trial.robot.runs)
    trial.robot.stops += 1
    trial.touch(0.5)
    trial.at("2.2").runner.choose("yes")
    trial.until(lambda: trial.runner.state.status == "paused")
    assert len(trial.robot.runs) == sent
    trial.runner.abort()
    trial.end()


def test_a_stop_while_a_trial_is_prepared_holds_its_first_goal_back(trial, monkeypatch):
    monkeypatch.setattr(module, "settings", lambda namespace: by_another(trial.robot.stop) or {})
    trial.begin().until(lambda: trial.runner.state.status == "paused")
    assert trial.robot.runs == []
    trial.runner.abort()
    trial.end()


@pytest.mark.parametrize("on_error", ["hold", "skip", "stop"])
@pytest.mark.parametrize("first", ["stop", "goal"])
@pytest.mark.parametrize("step", ["{run: nod, on_error: %s}", "{wait: touch, timeout: 5}"])
def test_a_step_that_a_stop_has_ended_restarts_however_late_the_stop_is_heard(tmp_path, step, first, on_error):
    trial = steps_of(tmp_path, f"- {step.replace('%s', on_error)}\n- {{say: Behind it}}").begin()
    trial.at("1.1")
    assert trial.robot.sent.acquire(timeout=LIMIT)
    acts = [lambda: by_another(trial.robot.stop), lambda: trial.robot.runs[0].end("preempted", "cancelled")]
    for act in acts if first == "stop" else reversed(acts):
        act()
    trial.until(lambda: trial.runner.state.status == "paused")
    assert [each.outcome for each in trial.runner.state.outcomes] == ["stopped"]
    trial.runner.go_on()
    trial.at("1.1", 2).runner.abort()
    trial.end()


def test_a_goal_that_somebody_cancels_without_a_stop_fails(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "ros_after", lambda seconds, callback: callback() or (lambda: None))
    trial = steps_of(tmp_path, "- {run: nod}", plays=()).begin()
    assert trial.robot.sent.acquire(timeout=LIMIT)
    trial.robot.runs[0].end("preempted", "another goal came")
    trial.until(lambda: trial.runner.state.status == "held")
    assert trial.runner.state.outcomes[0].error == "another goal came"
    trial.runner.abort()
    trial.end()


def test_a_trial_that_stops_the_robot_itself_goes_on(tmp_path):
    begin, _, _ = PROTOCOL.partition("phases:")
    trial = Trial(tmp_path, text=begin + "phases: [{steps: [{stop: true}, {say: Hello}, {stop: true}]}]").begin()
    assert [each.outcome for each in trial.end().outcomes] == ["done", "done", "done"]


def test_a_wait_for_a_time_ends_though_nothing_happens(tmp_path):
    begin, _, _ = PROTOCOL.partition("phases:")
    text = begin + "phases: [{steps: [{wait: until, until: seconds >= 0.3}, {wait: until, until: seconds >= 0.1}]}]"
    trial = Trial(tmp_path, text=text).begin()
    now = trial.robot.now
    trial.at("1.1")
    trial.robot.now = lambda: now() + 1.0
    assert [each.outcome for each in trial.end().outcomes] == ["done", "done"]


def test_a_pause_ends_a_wait_that_begins_anew_behind_it(trial):
    trial.begin().at("2.1").runner.pause()
    trial.until(lambda: trial.runner.state.status == "paused")
    trial.runner.go_on()
    trial.at("2.1", 2).touch(1.0)
    trial.at("2.2").runner.choose("yes")
    assert trial.end().status == "finished"


def test_abort_ends_the_goal_and_the_trial(trial):
    trial.begin().at("2.1").runner.abort("ann")
    assert trial.end().status == "aborted"
    assert all(run.done for run in trial.robot.runs)


def test_a_step_that_fails_waits_for_the_wizard(tmp_path):
    trial = Trial(tmp_path, PlayedRobot(plays=())).begin().at("1.1")
    assert trial.robot.sent.acquire(timeout=LIMIT)
    trial.robot.runs[-1].end("aborted", "no voice")
    trial.until(lambda: trial.runner.state.status == "held")
    assert trial.runner.outcome.error == "no voice"
    trial.runner.repeat()
    trial.at("1.1", 2).runner.abort()
    trial.end()


def test_what_a_server_remarks_on_a_step_that_is_done_is_kept(tmp_path):
    trial = steps_of(tmp_path, "- {say: Hi, animated: true}").begin()
    trial.goal("animatedSay").end(text="no gestures")
    (outcome,) = trial.end().outcomes
    assert (outcome.outcome, outcome.error) == ("done", "no gestures")


def test_a_choice_that_there_is_not_is_refused(trial):
    trial.begin().at("2.1")
    with pytest.raises(StudyError, match="no choice 'yes'"):
        trial.runner.choose("yes")
    trial.runner.abort()
    trial.end()


def test_one_trial_at_a_time_runs_on_a_robot(trial):
    trial.begin()
    with pytest.raises(StudyError, match="runs on this robot"):
        trial.studies.begin(trial.protocol, "P02", trial.robot)
    trial.runner.abort()
    trial.end()


def test_a_participant_goes_on_with_the_first_trial_that_is_not_finished(trial):
    trial.begin().runner.abort()
    trial.end()
    for _ in range(4):
        trial.begin()
        if trial.runner.state.values["trial"] > 1:
            trial.at("2.1")
        trial.play()
    states = [each.state() for each in trial.files.trials("two_by_two")]
    assert [state.about["position"] for state in states] == [1, 1, 2, 3, 4]
    assert len({tuple(state.about["condition"].items()) for state in states[1:]}) == 4
    with pytest.raises(StudyError, match="has done all 4 trials"):
        trial.begin()


def test_the_table_has_a_row_a_trial_and_the_round_of_each_step(tmp_path):
    trial = steps_of(
        tmp_path,
        """
        - repeat: 2
          as: i
          steps:
            - {wizard: "Round {i}", choices: [left, right], label: side}
            - {when: side == left, then: [{say: Left, label: told}]}
        """,
    ).begin()
    for path, choice in (("1.1.r1.1", "left"), ("1.1.r2.1", "right")):
        trial.at(path).runner.choose(choice)
        trial.until(lambda path=path: any(each.path == path and each.ended for each in trial.runner.state.outcomes))
    trial.end()
    table = table_of(trial.files, "steps")
    (row,) = csv.DictReader(table.trials_csv().splitlines())
    assert (row["side_r1"], row["side_r2"], row["trial_state"]) == ("left", "right", "finished")
    assert float(row["duration_s"]) >= 0.0 and "told_r1" not in row
    found = [(each.label, each.round, dict(each.answers)) for each in summaries_of(table, by_round=True)]
    assert found == [("side", 1, {"left": 1}), ("side", 2, {"right": 1})]
    assert [each.count for each in summaries_of(table)] == [2]


def test_what_is_drawn_is_in_the_log_and_the_table(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "ros_after", lambda seconds, callback: callback() or (lambda: None))
    steps = "- wait: [2, 5]\n- {repeat: 3, as: i, order: random, steps: [{say: 'Item {i}'}]}"
    trial = steps_of(tmp_path, steps).begin()
    state = trial.end()
    began = [each["data"] for each in read_events(trial.files.trial("steps/P01-1").path)]
    began = [each for each in began if each.get("what") == "step began"]
    assert began[0]["title"] == f"wait {began[0]['seconds']:g} s" and 2 <= began[0]["seconds"] <= 5
    rows = table_of(trial.files, "steps").rows[1:]
    assert [f"say Item {row['round_value']}" for row in rows] == [row["text"] for row in rows]
    assert [each["rounds"]["i"] for each in began[1:]] == [row["round_value"] for row in rows]
    assert state.about["seed"] == 0 and sorted(row["round_value"] for row in rows) == [1, 2, 3]


def test_all_that_happens_to_the_robot_is_logged_with_notes_and_deviations(trial):
    trial.begin().at("2.1")
    trial.robot.events.add("heard", "a noise", loud=True)
    trial.runner.note("looks away", "ann")
    trial.runner.deviation("the door opened", "ann")
    state = trial.play()
    events = read_events(trial.files.trial("two_by_two/P01-1").path)
    assert {"heard", "note", "deviation", "trial"} <= {each["kind"] for each in events}
    assert (state.notes, state.deviations) == (1, 1)
    assert (trial.files.folder / "two_by_two/P01-1" / TABLE).read_text().count("\n") == len(events) + 1


KILLED = """
    import os, signal, sys
    from pathlib import Path
    sys.path.append({support!r})
    from played_study import Trial
    from nao_library_modules.studies import studies as module
    module.settings = lambda namespace: {{}}
    trial = Trial(Path({folder!r})).begin().at("2.1")
    trial.touch(0.25)
    trial.at("2.2")
    trial.runner.note("the last words")
    os.kill(os.getpid(), signal.SIGKILL)
"""


def test_a_trial_whose_program_was_killed_is_resumed_at_the_step_that_had_not_ended(tmp_path):
    code = KILLED.format(support=str(Path(played_study.__file__).parent), folder=str(tmp_path))
    killed = subprocess.run([sys.executable, "-c", textwrap.dedent(code)], timeout=60, check=False)
    assert killed.returncode == -signal.SIGKILL
    trial = Trial(tmp_path)
    ((folder, state),) = trial.studies.open_trials()
    assert (folder.id, state.status, state.path, state.notes) == ("two_by_two/P01-1", "interrupted", "2.1", 1)
    trial.resume().at("2.2", 2).runner.choose("yes")
    state = trial.end()
    assert state.status == "finished"
    assert state.values["head_seconds"] == pytest.approx(0.25)
    assert [each.outcome for each in state.outcomes] == ["done", "done", "stopped", "done", "done"]


def test_a_trial_that_a_program_runs_is_not_interrupted_and_cannot_be_given_up(trial):
    folder = trial.begin().at("2.1").files.trial("two_by_two/P01-1")
    others = Studies(trial.files)
    assert [(each.runs(), state.status) for each, state in others.open_trials()] == [(True, "running")]
    with pytest.raises(StudyError, match="another program"):
        others.abort(folder.id)
    trial.runner.abort()
    trial.end()
    assert not folder.runs()


def test_a_trial_that_was_left_is_given_up_with_its_recording(trial, monkeypatch):
    ended = []
    monkeypatch.setattr(
        trial_recordings, "end_bag", lambda file, about, own: ended.append((file.name, about["pid"], own))
    )
    trial.begin().at("2.1")
    events = trial.robot.events.last()
    trial.runner.abort()
    trial.end()
    folder = trial.files.new_trial("two_by_two", "P02")
    log = TrialLog(folder.path)
    for event in events:
        log.add(asdict(event))
    log.add({"kind": "trial", "data": {"what": "recording began", "recording": "bag", "file": "trial.bag", "pid": 7}})
    log.close()
    assert folder.state().status == "interrupted"
    trial.studies.abort(folder.id, by="ann")
    assert ended == [("trial.bag", 7, None)]
    assert (folder.state().status, folder.state().recordings) == ("aborted", {})
    with pytest.raises(StudyError, match="is aborted"):
        trial.studies.abort(folder.id)


def test_a_line_that_was_cut_short_is_left_out_and_written_over(tmp_path):
    log = TrialLog(tmp_path)
    log.add({"kind": "note", "text": "whole"})
    log.close()
    with (tmp_path / EVENTS).open("ab") as file:
        file.write(b'{"kind": "no')
    assert [each["text"] for each in read_events(tmp_path)] == ["whole"]
    log = TrialLog(tmp_path)
    log.add({"kind": "note", "text": "next", "data": {"x": float("nan")}})
    log.close()
    assert [(each["n"], each["text"]) for each in read_events(tmp_path)] == [(1, "whole"), (2, "next")]


def test_two_programs_do_not_write_one_log(tmp_path):
    log = TrialLog(tmp_path)
    with pytest.raises(StudyError, match="another program"):
        TrialLog(tmp_path)
    log.close()


def test_what_is_logged_is_put_on_the_disk_within_half_a_second(tmp_path, monkeypatch):
    synced, real = threading.Event(), os.fsync
    log = TrialLog(tmp_path)
    monkeypatch.setattr(os, "fsync", lambda descriptor: (real(descriptor), synced.set()))
    log.add({"kind": "note"})
    assert synced.wait(LIMIT) and DELAY < 0.5
    log.close()


def test_the_table_has_a_row_for_each_trial_and_step_and_no_formulas(trial):
    for seconds in (0.5, 1.0):
        trial.begin()
        trial.play(seconds=seconds)
    table = table_of(trial.files, "two_by_two")
    rows = list(csv.DictReader(table.csv().splitlines()))
    heads = [row for row in rows if row["label"] == "head"]
    assert [row["reaction_s"] for row in heads] == ["0.5", "1.0"]
    assert {"voice", "reply"} <= {*rows[0]}
    found = [(each.label, each.count, each.mean) for each in summaries_of(table) if each.label == "head"]
    assert sorted(found) == [("head", 1, 0.5), ("head", 1, 1.0)]


@pytest.mark.parametrize("cell, cells", [("=1+1", "'=1+1"), ("-x", "'-x"), ("@a", "'@a"), (-1.5, -1.5), ("a=b", "a=b")])
def test_cells_are_no_formulas(cell, cells):
    assert guarded(cell) == cells


@pytest.mark.parametrize("name", ["../x", "events.jsonl", "video.mp4/../trial.yaml", "video.mp4"])
def test_only_videos_and_sounds_of_a_trial_are_given_to_pages(trial, name):
    trial.begin().play()
    with pytest.raises(StudyError):
        trial.files.media("two_by_two/P01-1", name)


@pytest.mark.parametrize("name", ["../up", "a/b", "", "protocols"])
def test_names_of_studies_stay_inside_of_the_folder(trial, name):
    with pytest.raises(StudyError):
        trial.files.trials(name)


def test_the_state_of_a_log_is_that_of_its_trial(trial):
    state = trial.begin().play()
    assert TrialState.of(read_events(trial.files.trial("two_by_two/P01-1").path)) == state
