"""Running programs: order, times, failures, limits, ends."""

from __future__ import annotations

import threading

import pytest
from fake_clients import FakeClient

from nao_library_actions.msg import NaoLedFeedback
from nao_library_modules.behaviors import StepFailed
from nao_library_modules.behaviors.report import MOST_NOT_RUN
from nao_library_modules.errors import RobotLost
from nao_library_modules.process_modules.failures import ActionlibActionTimedOut, PlanFailure


def names(goals):
    return [goal.text for goal in goals]


def hold(clients, count):
    """Wait for so many goals."""
    for _ in range(count):
        clients.next_goal()
    return clients.goals


def test_a_list_is_a_sequence(start, clients):
    run = start("- NaoLights.x: {str_param: hold 1}\n- NaoMotion.x: {str_param: b}\n- [{NaoLights.x: {str_param: c}}]")
    clients.next_goal()
    assert names(clients.goals) == ["hold 1"]
    clients.goals[0].succeed(["7"])
    records = run.ended()
    assert names(clients.goals) == ["hold 1", "b", "c"]
    assert [record.state for record in records.values()] == ["ended"] * 4
    assert list(records) == ["1", "2", "3", "3.1"]
    assert records["1"].results[0].values == ["7"]
    assert all(a.ended <= b.began for a, b in zip(list(records.values())[:2], list(records.values())[1:3]))


def test_branches_run_at_once_and_all_have_to_end(start, clients):
    run = start(
        """
        - parallel:
            - NaoLights.x: {str_param: hold a}
            - [{NaoMotion.x: {str_param: hold b}}, {NaoMotion.x: {str_param: c}}]
        - NaoVision.x: {str_param: d}
        """
    )
    first, second = sorted(hold(clients, 2), key=lambda goal: goal.text)
    second.succeed()
    clients.next_goal()
    assert "c" in names(clients.goals)
    first.succeed()
    assert set(run.states().values()) == {"ended"}
    assert names(clients.goals)[-1] == "d"


def test_entries_begin_at_their_times(start, clients, clock):
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
    hold(clients, 1)
    clock.somebody_waits(2.0, 1.0, 1.5)
    clock.advance(1.0)
    assert names(hold(clients, 1)) == ["hold a", "c"]
    clients.goals[0].succeed()
    clock.somebody_waits(2.0, 1.5, 1.5)
    clock.advance(0.5)
    assert sorted(names(hold(clients, 2))[2:]) == ["d", "e"]
    clock.advance(0.5)
    records = run.ended()
    assert names(clients.goals)[-1] == "b"
    assert {path: record.began for path, record in records.items()} == {
        "1": 0.0, "1.1": 0.0, "1.2": 2.0, "1.3": 1.0, "1.4": 1.5, "1.5": 1.5,
    }  # fmt: skip
    assert {record.late for record in records.values()} == {0.0}


def test_a_server_runs_one_goal_at_a_time_and_it_is_told_who_is_late(start, clients, clock):
    run = start(
        """
        - timeline:
            - {NaoLights.x: {str_param: hold a}}
            - {NaoLights.x: {str_param: b}}
            - {NaoLights.x: {str_param: c}, at: 0.5}
        """,
        clock,
    )
    hold(clients, 1)
    clock.somebody_waits(0.5)
    clock.advance(2.0)
    clients.goals[0].succeed()
    records = run.ended()
    assert names(clients.goals) == ["hold a", "b", "c"]
    assert clients.most == {"NaoLights": 1}
    assert (records["1.2"].late, records["1.3"].late) == (2.0, 1.5)
    assert [event.text for event in run.events if event.state == "late"] == ["2.000 s late", "1.500 s late"]


def test_a_barrier_on_a_timeline_waits_for_all_above(start, clients, clock):
    run = start(
        """
        - timeline:
            - {NaoLights.x: {str_param: hold a}}
            - {NaoMotion.x: {str_param: hold b}}
            - {barrier: both}
            - {NaoVision.x: {str_param: c}, at: both + 1.0}
        """,
        clock,
    )
    hold(clients, 2)[0].succeed()
    clients.goals[1].succeed()
    clock.somebody_waits(1.0)
    assert len(clients.goals) == 2
    clock.advance(1.0)
    assert run.ended()["1.4"].began == 1.0


def test_branches_meet_at_barriers_also_when_one_of_them_is_over(start, clients):
    run = start(
        """
        - parallel:
            - [{NaoLights.x: {str_param: hold a}}, {barrier: here}, {NaoLights.x: {str_param: b}}]
            - [{barrier: here}, {NaoMotion.x: {str_param: c}}]
            - {do: [{NaoVision.x: {str_param: fail}}, {barrier: here}], on_error: skip}
        """
    )
    hold(clients, 2)
    assert sorted(names(clients.goals)) == ["fail", "hold a"]
    next(goal for goal in clients.goals if goal.text == "hold a").succeed()
    states = run.states()
    assert sorted(names(clients.goals)) == ["b", "c", "fail", "hold a"]
    assert (states["1.3"], states["1.3.1"], states["1.3.2"]) == ("skipped", "failed", "not run")


def test_a_failure_ends_the_others_and_the_behaviour(start, clients):
    run = start(
        """
        - parallel:
            - NaoLights.x: {str_param: hold a}
            - [{NaoMotion.x: {str_param: hold b}}, {wait: 1}]
        - {wait: 1}
        """
    )
    hold(clients, 2)
    next(goal for goal in clients.goals if goal.server == "NaoMotion").abort("no way")
    records = run.ended()
    assert isinstance(run.error, StepFailed)
    assert str(run.error) == "step 1.2.1 (NaoMotion.x): no way"
    assert {path: record.state for path, record in records.items()} == {
        "1": "failed", "1.1": "preempted", "1.2": "failed", "1.2.1": "failed", "1.2.2": "not run", "2": "not run",
    }  # fmt: skip
    assert records["1.1"].results[0].values == ["cancelled"]  # what it did until then
    assert (records["1.2.1"].error, records["1"].error) == ("no way", "step 1.2.1 (NaoMotion.x): no way")
    assert not clients.running()


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
    assert records["3.1"].attempts == 2
    assert names(clients.goals).count("b") == 2
    assert run.told().count(("4", "retried")) == 2
    assert "step 4" in str(run.error)


def test_a_limit_ends_a_step_as_if_it_were_done(start, clients, clock):
    run = start(
        """
        - {NaoLights.x: {str_param: hold a}, for: 2.0}
        - {parallel: [{NaoLights.x: {str_param: hold b}}, {NaoMotion.x: {str_param: hold c}}], for: 1.0}
        - {NaoLights.x: {str_param: d}, for: 1.0}
        """,
        clock,
    )
    hold(clients, 1)
    clock.somebody_waits(2.0)
    clock.advance(2.0)
    hold(clients, 2)
    clock.somebody_waits(3.0)
    clock.advance(1.0)
    records = run.ended()
    assert run.error is None
    assert {path: record.state for path, record in records.items()} == {
        "1": "ended", "2": "ended", "2.1": "preempted", "2.2": "preempted", "3": "ended",
    }  # fmt: skip
    assert (records["1"].ended, records["2"].ended) == (2.0, 3.0)
    assert not clients.running()


@pytest.mark.parametrize(
    ("feedback", "text"),
    [
        (
            NaoLedFeedback(count=2, waiting="the robot at 10.0.0.7:9559"),
            "waits for the robot at",
        ),
        (NaoLedFeedback(index=1, function="on", count=2), "function 2 of 2: on"),
        (NaoLedFeedback(index=0, function="on", count=1), ""),
    ],
)
def test_what_a_server_tells_meanwhile_is_passed_on(start, clients, monkeypatch, feedback, text):
    call = FakeClient.call

    def telling(self, goal, on_feedback=None, on_end=None):
        on_feedback(feedback)
        return call(self, goal, on_feedback, on_end)

    monkeypatch.setattr(FakeClient, "call", telling)
    run = start("- NaoLights.x: {str_param: a}")
    run.ended()
    told = [event.text for event in run.events if event.state == "told"]
    assert len(told) == bool(text) and all(each.startswith(text) for each in told)


def test_rounds_are_told_apart(start, clients):
    run = start("- {repeat: 2, as: i, do: [{NaoLights.x: {str_param: 'round ${i}'}}]}\n- {repeat: 0, do: [{wait: 9}]}")
    records = run.ended()
    assert list(records) == ["1", "1#1.1", "1#2.1", "2"]
    assert names(clients.goals) == ["round 1", "round 2"]


def test_rounds_that_never_began_are_told_like_other_steps(start, clients):
    texts = "{repeat: 3, as: i, do: [{repeat: 2, do: [{NaoLights.x: {str_param: '${i}'}}, {wait: 0}]}]}"
    run = start(f"- NaoLights.x: {{str_param: hold}}\n- {texts}")
    hold(clients, 1)
    run.interrupt.trigger()
    states = run.states()
    assert states.pop("1") == "preempted"
    rounds = [f"2#{i}.1#{j}.{step}" for i in (1, 2, 3) for j in (1, 2) for step in (1, 2)]
    assert states == dict.fromkeys(["2", *(f"2#{i}.1" for i in (1, 2, 3)), *rounds], "not run")


def test_rounds_behind_a_failure_are_not_run(start, clients, texts):
    texts["bow"] = "help: Bows.\ndo: [{wait: 0}]"
    states = start("- {repeat: 3, as: i, do: [{NaoLights.x: {str_param: 'fail'}}, {behavior: bow}]}").states()
    assert (states["1#1.1"], states["1#1.2"], states["1#2.1"], states["1#3.2/1"]) == (
        "failed", "not run", "not run", "not run",
    )  # fmt: skip


def test_of_very_many_rounds_that_never_began_some_are_told(start, clients):
    run = start("- NaoLights.x: {str_param: hold}\n- {repeat: 10000, do: [{repeat: 10000, do: [{wait: 0}]}]}")
    hold(clients, 1)
    run.interrupt.trigger()
    assert len(run.ended()) == MOST_NOT_RUN + 4  # the goal, and the repetitions with their first rounds


def test_an_interrupt_ends_all_goals(start, clients):
    run = start(
        """
        - parallel:
            - NaoLights.x: {str_param: hold a}
            - NaoMotion.x: {str_param: hold b}
            - nao_audio_out.x: {str_param: hold c}
        - {wait: 1}
        """
    )
    hold(clients, 3)
    run.interrupt.trigger()
    states = run.states()
    assert isinstance(run.error, PlanFailure)
    assert states == {"1": "preempted", "1.1": "preempted", "1.2": "preempted", "1.3": "preempted", "2": "not run"}
    assert not clients.running()


def test_a_step_that_waits_to_be_tried_again_is_cut_short(start, clients):
    run = start(
        """
        - timeline:
            - {NaoLights.x: {str_param: hold a}, on_error: retry 5, at: 0}
            - {NaoLights.x: {str_param: hold b}, at: 0}
        """
    )
    first = hold(clients, 1)[0]
    queue, asked = run.execution._turns._queues["NaoLights"], threading.Event()
    queue.listen(asked.set)
    while not queue.value[1]:
        assert asked.wait(10.0)
        asked.clear()
    first.abort()  # the other one has asked for the server before, and is first now
    assert names(hold(clients, 1)) == ["hold a", "hold b"]
    run.interrupt.trigger()
    record = run.ended()["1.1"]
    assert record.state == "preempted"
    assert record.ended >= record.began >= 0.0


def test_an_interrupt_that_came_before_lets_nothing_begin(program, clients):
    from nao_library_modules.behaviors.execution import Execution
    from nao_library_modules.clock import WallClock
    from nao_library_modules.interrupt import Interrupt

    interrupt = Interrupt()
    interrupt.trigger(RobotLost("10.0.0.7:9559", "gone"))
    execution = Execution(program("- NaoLights.x: {str_param: a}"), clients, WallClock(), lambda event: None)
    with pytest.raises(PlanFailure):
        execution.run(interrupt)
    assert clients.goals == []
    assert [record.state for record in execution.report.records()] == ["not run"]


def test_a_server_that_is_not_there_is_told_before_anything_moves(start, clients):
    clients.missing.add("NaoMotion")
    run = start("- NaoLights.x: {str_param: a}\n- NaoMotion.x: {str_param: b}")
    assert set(run.states().values()) == {"not run"}
    assert isinstance(run.error, ActionlibActionTimedOut) and "NaoMotion" in str(run.error)
    assert clients.goals == []


def test_what_happens_is_told_in_order(start, clients):
    run = start("- {label: eyes, NaoLights.x: {str_param: a}}\n- {NaoLights.x: {str_param: fail}, on_error: skip}")
    run.ended()
    assert run.told() == [("1", "began"), ("1", "ended"), ("2", "began"), ("2", "skipped")]
    times = [event.time for event in run.events]
    assert times == sorted(times)
    assert (run.events[0].node.label, run.events[3].text) == ("eyes", "bad luck")


def test_nothing_is_told_when_it_is_over(start):
    run = start("- {wait: 0}")
    run.ended()
    told = run.told()
    assert told[-1] == ("1", "ended")
    run.execution.report.tell(run.events[0].node, "told", "too late")
    assert run.told() == told
