"""Running behaviours: order, times, failures, limits, ends, and what is told of it."""

from __future__ import annotations

import pytest

from nao_library_actions.msg import NaoLedFeedback
from nao_library_modules.behaviors import StepFailed
from nao_library_modules.behaviors.execution import Execution
from nao_library_modules.behaviors.server_functions import NAMES
from nao_library_modules.core.errors import RobotLost
from nao_library_modules.core.waiting import CancellationToken, WallClock
from nao_library_modules.process_modules.failures import ActionlibActionTimedOut, PlanFailure


def test_a_list_is_a_sequence_and_what_happens_is_told_in_order(start, clients):
    run = start("- {label: eyes, NaoLights.x: {str_param: hold 1}}\n- NaoMotion.x: {str_param: b}\n- [{wait: 0}]")
    assert clients.hold()[0].text == "hold 1" and len(clients.goals) == 1
    clients.goals[0].over(3, "", "7")
    records = run.ended()
    assert clients.texts() == ["hold 1", "b"] and list(records) == ["1", "2", "3", "3.1"]
    assert {record.state for record in records.values()} == {"ended"}
    assert (records["1"].results[0].values, records["2"].results[0].values) == (["7"], ["done"])
    assert records["1"].ended <= records["2"].began <= records["2"].ended <= records["3"].began
    assert run.told()[:4] == [("1", "began"), ("1", "ended"), ("2", "began"), ("2", "ended")]
    assert run.events[0].node.label == "eyes" and run.told()[-1] == ("3", "ended")
    times = [event.time for event in run.events]
    assert times == sorted(times)
    run.execution.report.tell(run.events[0].node, "told", "too late")
    assert len(run.events) == len(times)


def test_entries_of_a_timeline_begin_at_their_times(start, clients, clock):
    run = start(
        """
        - timeline:
            - {NaoLights.x: {str_param: hold a}, label: first}
            - {NaoMotion.x: {str_param: b}, at: 2.0}
            - {NaoVision.x: {str_param: c}, at: 1.0}
            - {nao_audio_out.x: {str_param: d}, at: first.end + 0.5}
            - {nao_audio_in.x: {str_param: e}, at: first + 1.5}
        """,
        clock,
    )
    clients.hold()
    clock.somebody_waits(2.0, 1.0, 1.5)
    clock.advance(1.0)
    clients.hold()[0].over()
    assert clients.texts() == ["hold a", "c"]
    clock.somebody_waits(2.0, 1.5, 1.5)
    clock.advance(0.5)
    clients.hold(2)
    assert sorted(clients.texts()[2:]) == ["d", "e"]
    clock.advance(0.5)
    records = run.ended()
    assert {path: record.began for path, record in records.items()} == {
        "1": 0.0, "1.1": 0.0, "1.2": 2.0, "1.3": 1.0, "1.4": 1.5, "1.5": 1.5,
    }  # fmt: skip
    assert clients.texts()[-1] == "b" and {record.late for record in records.values()} == {0.0}


def test_a_server_runs_one_goal_at_a_time_and_it_is_told_who_is_late(start, clients, clock):
    entries = (
        "{NaoLights.x: {str_param: hold a}}, {NaoLights.x: {str_param: b}}, {NaoLights.x: {str_param: c}, at: 0.5}"
    )
    run = start(f"- timeline: [{entries}]", clock)
    clients.hold()
    clock.somebody_waits(0.5)
    clock.advance(2.0)
    clients.goals[0].over()
    records = run.ended()
    assert clients.texts() == ["hold a", "b", "c"] and clients.most == {"NaoLights": 1}
    assert (records["1.2"].late, records["1.3"].late) == (2.0, 1.5)
    assert [event.text for event in run.events if event.state == "late"] == ["2.000 s late", "1.500 s late"]


def test_barriers_wait_for_all_above_and_for_all_branches_that_are_not_over(start, clients, clock):
    run = start(
        """
        - timeline:
            - {NaoLights.x: {str_param: hold a}}
            - {NaoMotion.x: {str_param: hold b}}
            - {barrier: both}
            - {NaoVision.x: {str_param: c}, at: both + 1.0}
        - parallel:
            - [{NaoLights.x: {str_param: hold d}}, {barrier: here}, {NaoLights.x: {str_param: e}}]
            - [{barrier: here}, {NaoMotion.x: {str_param: f}}]
            - {do: [{NaoVision.x: {str_param: fail}}, {barrier: here}], on_error: skip}
        """,
        clock,
    )
    clients.hold(2)[0].over()
    clients.goals[1].over()
    clock.somebody_waits(1.0)
    assert len(clients.goals) == 2
    clock.advance(1.0)
    clients.hold(3)
    assert sorted(clients.texts()[3:]) == ["fail", "hold d"]
    clients.of("hold d").over()
    records = run.ended()
    assert records["1.4"].began == 1.0 and sorted(clients.texts()[5:]) == ["e", "f"]
    assert [records[path].state for path in ("2.3", "2.3.1", "2.3.2")] == ["skipped", "failed", "not run"]


def test_a_failure_ends_the_others_and_the_behaviour(start, clients):
    branches = "[{NaoLights.x: {str_param: hold a}}, [{NaoMotion.x: {str_param: hold b}}, {wait: 1}]]"
    run = start(f"- parallel: {branches}\n- {{wait: 1}}")
    clients.hold(2)
    clients.of("hold b").abort()
    records = run.ended()
    assert isinstance(run.error, StepFailed) and str(run.error) == "step 1.2.1 (NaoMotion.x): bad luck"
    assert run.states() == {
        "1": "failed", "1.1": "preempted", "1.2": "failed", "1.2.1": "failed", "1.2.2": "not run", "2": "not run",
    }  # fmt: skip
    assert records["1.1"].results[0].values == ["cancelled"], "what it did until then"
    assert (records["1.2.1"].error, records["1"].error) == ("bad luck", "step 1.2.1 (NaoMotion.x): bad luck")
    assert not clients.running()
    run = start("- NaoLights.x: {str_param: hold}")
    clients.hold()[-1].over(2, "preempted")
    assert run.states() == {"1": "failed"} and "preempted: a goal of somebody else took its place" in str(run.error)


def test_the_first_branch_of_a_race_that_is_over_ends_the_others(start, clients):
    run = start(
        "- race: [{NaoLights.x: {str_param: hold a}}, [{NaoMotion.x: {str_param: hold b}}, {wait: 1}]]\n- {wait: 0}"
    )
    clients.hold(2)
    clients.of("hold a").over()
    assert run.states() == {
        "1": "ended", "1.1": "ended", "1.2": "preempted", "1.2.1": "preempted", "1.2.2": "not run", "2": "ended",
    }  # fmt: skip
    assert run.error is None and not clients.running()


def test_failures_are_skipped_and_retried(start, clients):
    run = start(
        """
        - {NaoLights.x: {str_param: fail}, on_error: skip}
        - {NaoLights.x: {str_param: fail once}, on_error: retry 3}
        - {do: [{NaoMotion.x: {str_param: b}}, {NaoLights.x: {str_param: fail}}], on_error: retry 1 skip}
        - {NaoLights.x: {str_param: fail}, on_error: retry 2}
        """
    )
    records = run.ended()
    assert [(records[str(i)].state, records[str(i)].attempts) for i in (1, 2, 3, 4)] == [
        ("skipped", 1), ("ended", 2), ("skipped", 2), ("failed", 3),
    ]  # fmt: skip
    assert records["3.1"].attempts == 2 == clients.texts().count("b") and run.told().count(("4", "retried")) == 2
    assert "step 4" in str(run.error) and ("1", "skipped") in run.told() and run.events[1].text == "bad luck"


def test_a_limit_ends_a_step_as_if_it_were_done(start, clients, clock):
    run = start(
        """
        - {NaoLights.x: {str_param: hold a}, for: 2.0}
        - {parallel: [{NaoLights.x: {str_param: hold b}}, {NaoMotion.x: {str_param: hold c}}], for: 1.0}
        - {NaoLights.x: {str_param: d}, for: 1.0}
        """,
        clock,
    )
    clients.hold()
    clock.somebody_waits(2.0)
    clock.advance(2.0)
    clients.hold(2)
    clock.somebody_waits(3.0)
    clock.advance(1.0)
    records = run.ended()
    assert run.states() == {"1": "ended", "2": "ended", "2.1": "preempted", "2.2": "preempted", "3": "ended"}
    assert (run.error, records["1"].ended, records["2"].ended) == (None, 2.0, 3.0) and not clients.running()


def test_an_interrupt_ends_all_goals_and_one_that_came_before_lets_nothing_begin(start, clients, program):
    goals = ", ".join(f"{{{server}.x: {{str_param: hold}}}}" for server in NAMES[:3])
    run = start(f"- parallel: [{goals}]\n- {{wait: 1}}")
    clients.hold(3)
    run.interrupt.trigger()
    assert run.states() == {**dict.fromkeys(["1", "1.1", "1.2", "1.3"], "preempted"), "2": "not run"}
    assert isinstance(run.error, PlanFailure) and not clients.running()
    interrupt = CancellationToken()
    interrupt.trigger(RobotLost("10.0.0.7:9559", "gone"))
    execution = Execution(program("- NaoLights.x: {str_param: a}"), clients, WallClock(), lambda event: None)
    with pytest.raises(PlanFailure):
        execution.run(interrupt)
    clients.missing.add("NaoMotion")  # told before anything moves
    missing = start("- NaoLights.x: {str_param: a}\n- NaoMotion.x: {str_param: b}")
    assert set(missing.states().values()) == {"not run"}
    assert isinstance(missing.error, ActionlibActionTimedOut) and "NaoMotion" in str(missing.error)
    assert len(clients.goals) == 3 and [record.state for record in execution.report.records()] == ["not run"]


def test_what_a_server_tells_meanwhile_is_passed_on(start, clients):
    waiting = NaoLedFeedback(count=2, waiting="the robot at 10.0.0.7:9559")
    again = NaoLedFeedback(index=1, function="on", count=2)
    clients.feedback = [waiting, again, again, NaoLedFeedback(index=0, function="on", count=1)]
    run = start("- NaoLights.x: {str_param: a}")
    run.ended()
    told = [event.text for event in run.events if event.state == "told"]
    assert told == ["waits for the robot at 10.0.0.7:9559", "function 2 of 2: on"]


def test_rounds_behind_a_failure_are_not_run_and_told_apart(start, texts):
    texts["bow"] = "help: Bows.\ndo: [{wait: 0}]"
    states = start("- {repeat: 3, do: [{NaoLights.x: {str_param: fail}}, {behavior: bow}]}").states()
    assert [states[path] for path in ("1#1.1", "1#1.2", "1#2.1", "1#3.2/1")] == ["failed", *["not run"] * 3]
    run = start("- {repeat: 2, on_error: skip, do: [{NaoLights.x: {str_param: fail}}]}\n- {repeat: 0, do: [{wait: 9}]}")
    assert run.states() == {"1": "skipped", "1#1.1": "failed", "1#2.1": "not run", "2": "ended"}
