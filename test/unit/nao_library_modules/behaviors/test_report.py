"""Which rounds of repetitions a result lists that did not run."""

from __future__ import annotations

import pytest

from nao_library_modules.behaviors.report import MOST_NOT_RUN


def states_after(run, clients, clock, held, limit):
    """Let a run come to its limit with so many goals held."""
    for _ in range(held):
        clients.next_goal()
    clock.somebody_waits(limit)
    clock.advance(limit)
    return run.states()


@pytest.mark.parametrize("inside", ["{NaoLights.x: {str_param: hold}}, {NaoMotion.x: {str_param: b}}"])
def test_rounds_that_a_limit_left_over_are_not_listed(start, clients, clock, inside):
    run = start(f"- {{repeat: 10000, for: 2, do: [{inside}]}}", clock)
    assert states_after(run, clients, clock, 1, 2.0) == {"1": "ended", "1#1.1": "preempted", "1#1.2": "not run"}
    assert run.error is None


def test_rounds_that_the_limit_of_a_step_around_left_over_are_not_listed(start, clients, clock):
    steps = "{repeat: 50, do: [{NaoLights.x: {str_param: hold}}]}, {repeat: 50, do: [{wait: 1}]}"
    run = start(f"- {{do: [{steps}], for: 2}}", clock)
    assert states_after(run, clients, clock, 1, 2.0) == {
        "1": "ended", "1.1": "preempted", "1.1#1.1": "preempted", "1.2": "not run", "1.2#1.1": "not run",
    }  # fmt: skip


def test_of_a_repetition_that_failed_only_what_its_rounds_left_over_is_listed(start, clients, clock):
    """Inside of each round is a repetition that ends by its own limit."""
    inner = "{repeat: 300, for: 2, do: [{NaoLights.x: {str_param: hold}}]}"
    run = start(f"- {{repeat: 2, do: [{inner}, {{NaoMotion.x: {{str_param: fail}}}}]}}", clock)
    states = states_after(run, clients, clock, 1, 2.0)
    assert (states["1#1.1"], states["1#1.2"]) == ("ended", "failed")
    assert [path for path in states if path.startswith("1#1.1#")] == ["1#1.1#1.1"]
    assert len([path for path in states if path.startswith("1#2.1#")]) == 300
    assert run.error is not None


def test_rounds_of_what_was_skipped_are_listed_also_where_the_behaviour_goes_on(start):
    run = start("- {repeat: 3, on_error: skip, do: [{NaoLights.x: {str_param: fail}}]}")
    assert run.states() == {"1": "skipped", "1#1.1": "failed", "1#2.1": "not run", "1#3.1": "not run"}
    run = start("- [{do: [{NaoLights.x: {str_param: fail}}, {repeat: 2, do: [{wait: 0}]}], on_error: skip}]")
    states = run.states()
    assert (states["1"], states["1.1"]) == ("ended", "skipped")
    assert [states[f"1.1.2#{number}.1"] for number in (1, 2)] == ["not run", "not run"]


def test_each_repetition_has_rounds_of_its_own_that_are_listed(start, clients):
    many = "{repeat: 10000, do: [{wait: 0}]}"
    run = start(f"- NaoLights.x: {{str_param: hold}}\n- {many}\n- {many}\n- {{repeat: 3, do: [{{wait: 0}}]}}")
    clients.next_goal()
    run.interrupt.trigger()
    paths = list(run.states())
    later = {step: [p for p in paths if p.startswith(f"{step}#") and p != f"{step}#1.1"] for step in (2, 3, 4)}
    assert {step: len(found) for step, found in later.items()} == {2: MOST_NOT_RUN, 3: MOST_NOT_RUN, 4: 2}
