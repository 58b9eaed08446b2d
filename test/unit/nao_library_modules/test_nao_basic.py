"""Goals as chains: progress, ends, policies, preemption, clean-up."""

from __future__ import annotations

import pytest
from chain_module import ChainModule, chain
from genpy import Duration

from nao_library_actions.msg import NaoLedGoal
from nao_library_modules.errors import BadGoal, Preempted, UnknownFunction
from nao_library_modules.function_chain import checked_by
from naoqi.errors import RobotUnreachable

LIMIT = 5.0


@pytest.fixture
def module(robot, edge):
    return ChainModule(robot=robot, edge=edge)


def test_functions_run_in_order_and_their_answers_are_the_result(module):
    server = module.server.play(chain(("say", "one"), ("say", "two")))
    assert (server.end, server.text) == ("succeeded", "")
    assert module.done == ["one", "two"]
    assert [(r.function, r.values) for r in server.result.results] == [("say", ["one"]), ("say", ["two"])]
    assert server.result.memList == ["one", "two"]


def test_feedback_tells_which_function_of_how_many_begins(module):
    feedback = module.server.play(chain(("say", "a"), ("ping", ""))).feedback
    assert [(f.index, f.function, f.count) for f in feedback] == [(0, "say", 2), (1, "ping", 2)]


def test_the_server_waits_after_each_function(module, edge):
    server = module.server.play(chain(("say", "a"), ("say", "b"), time=0.02))
    assert edge.clock.waits == [0.02, 0.02]
    assert all(result.elapsed.to_sec() < 0.02 for result in server.result.results), "waits do not count"


def test_a_chain_with_an_error_runs_nothing(module):
    server = module.server.play(chain(("say", "one"), ("sya", "two")))
    assert server.end == "aborted"
    assert server.text == (
        "function 2 (sya): unknown function 'sya': did you mean 'say'?; `nao list Module --all` tells all"
    )
    assert module.done == []
    assert server.feedback == []
    assert server.result.results == []


def test_an_empty_chain_is_aborted(module):
    server = module.server.play(NaoLedGoal([]))
    assert server.end == "aborted"
    assert "the chain is empty" in server.text


def test_an_error_while_running_keeps_the_results_before_it(module):
    server = module.server.play(chain(("say", "one"), ("fail", "x"), ("say", "three")))
    assert server.end == "aborted"
    assert server.text == "function 2 (fail): field str_param: 'x' is not allowed: something else"
    one, failed = server.result.results
    assert (one.values, one.error) == (["one"], "")
    assert (failed.function, failed.values) == ("fail", [])
    assert failed.error == "field str_param: 'x' is not allowed: something else"
    assert module.done == ["one"]


def play_with_policy(module, function, on_error):
    goal = chain(("say", "one"), (function, "x"), ("say", "three"))
    goal.functions[1].on_error = on_error
    return module.server.play(goal)


def test_a_function_that_may_be_skipped_does_not_end_the_chain(module):
    server = play_with_policy(module, "fail", "skip")
    assert (server.end, module.done) == ("succeeded", ["one", "three"])
    assert [bool(result.error) for result in server.result.results] == [False, True, False]
    assert server.result.memList == ["one", "three"]


def test_a_function_is_tried_again_as_often_as_its_goal_says(module):
    tries = iter(["first", "second"])

    def at_the_third(str_param):
        failure = next(tries, None)
        if failure is not None:
            raise BadGoal("str_param", str_param, failure)
        return "at last"

    module.function_table["fail"] = at_the_third
    server = play_with_policy(module, "fail", "retry 2")
    assert (server.end, server.result.memList) == ("succeeded", ["one", "at last", "three"])


@pytest.mark.parametrize(("on_error", "end"), [("retry 2", "aborted"), ("retry 2 skip", "succeeded")])
def test_what_becomes_of_a_function_that_fails_at_every_try(module, on_error, end):
    calls = []
    module.function_table["crash"] = lambda: calls.append(1) or {}["oops"]
    assert play_with_policy(module, "crash", on_error).end == end
    assert len(calls) == 3


@pytest.mark.parametrize("on_error", ["ignore", "retry", "retry 0", "retry 101", "retry -1", "skip 2"])
def test_an_unknown_policy_is_refused_before_anything_runs(module, on_error):
    server = play_with_policy(module, "say", on_error)
    assert (server.end, module.done) == ("aborted", [])
    assert "function 2 (say): field on_error" in server.text


def test_preemption_ends_a_chain_whatever_may_be_skipped(module, robot):
    goal = chain(("last", ""), ("say", "never"))
    goal.functions[0].on_error = "retry 5 skip"
    thread = module.server.play_in_background(goal)
    assert robot.leds.started.wait(LIMIT)
    module.server.preempt()
    thread.join(LIMIT)
    assert (module.server.end, module.done) == ("preempted", [])


def test_an_unexpected_error_is_logged_with_its_trace_and_the_server_lives_on(module, caplog):
    server = module.server.play(chain(("crash", "")))
    assert server.end == "aborted"
    assert server.text == "function 1 (crash): KeyError: 'oops'"
    assert "Traceback" in caplog.text
    assert module.server.play(chain(("say", "again"))).end == "succeeded"


def test_an_unexpected_error_in_a_check_names_the_function_and_runs_nothing(module, caplog):
    def check(str_param):
        raise KeyError("oops")

    module.function_table["odd"] = checked_by(check)(lambda str_param: module.say(str_param))
    server = module.server.play(chain(("say", "one"), ("odd", "two")))
    assert (server.end, server.text) == ("aborted", "function 2 (odd): KeyError: 'oops'")
    assert "Traceback" in caplog.text
    assert module.done == []


def test_preemption_ends_a_wait_and_the_function_before_it_counts_as_done(module, edge):
    thread = module.server.play_in_background(chain(("say", "one"), ("say", "two"), time=60.0))
    assert edge.clock.waiting.wait(LIMIT)
    module.server.preempt()
    thread.join(LIMIT)
    assert (module.server.end, module.server.text) == ("preempted", "preempted in function 1 (say)")
    assert [result.values for result in module.server.result.results] == [["one"]]


def test_preemption_ends_a_call_and_cancels_it_on_the_robot(module, robot):
    thread = module.server.play_in_background(chain(("say", "one"), ("last", "")))
    assert robot.leds.started.wait(LIMIT)
    module.server.preempt()
    thread.join(LIMIT)
    assert module.server.end == "preempted"
    assert robot.leds.pending[0].canceled
    assert [result.function for result in module.server.result.results] == ["say"]


def test_a_preemption_that_came_before_the_goal_began_counts(module):
    module.server.preempt_requested = True
    assert module.server.play(chain(("say", "one"))).end == "preempted"
    assert module.done == []


def test_a_preempted_goal_does_not_preempt_the_next_one(module, edge):
    thread = module.server.play_in_background(chain(("say", "one"), time=60.0))
    assert edge.clock.waiting.wait(LIMIT)
    module.server.preempt()
    thread.join(LIMIT)
    assert module.server.play(chain(("say", "two"), time=0.01)).end == "succeeded"


def test_the_end_of_the_node_interrupts_and_cleans_up_before_it_returns(module, edge):
    thread = module.server.play_in_background(chain(("borrow", "a"), time=60.0))
    assert edge.clock.waiting.wait(LIMIT)
    for action in edge.shutdown_actions:
        action()
    assert module.done == ["borrow a", "return a"]
    assert module.server.end == "preempted"
    thread.join(LIMIT)
    assert module.server.play(chain(("say", "late"))).end == "preempted", "no goal begins after the end"


def test_what_was_borrowed_is_returned_after_the_wait(module):
    module.server.play(chain(("borrow", "a"), ("say", "next")))
    assert module.done == ["borrow a", "return a", "next"]


def test_what_was_borrowed_is_returned_when_the_function_fails(module):
    def borrow_and_fail():
        module.borrow("a")
        raise BadGoal("lights", [], "some")

    module.function_table["try"] = borrow_and_fail
    assert module.server.play(chain(("try", ""))).end == "aborted"
    assert module.done == ["borrow a", "return a"]


def test_a_function_may_run_another_one_each_with_its_own_clean_up(module):
    module.server.play(chain(("nested", "")))
    assert module.done == ["borrow outer", "borrow inner", "return inner", "nested done", "return outer"]


def test_clean_up_that_fails_aborts_a_goal_that_went_well(module):
    def borrow():
        def give_back():
            raise RobotUnreachable("10.0.0.7", 9559, "gone")

        module.after_wait(give_back)

    module.function_table["try"] = borrow
    server = module.server.play(chain(("try", "")))
    assert server.end == "aborted"
    assert server.text == "function 1 (try): NAOqi at 10.0.0.7:9559: gone."


def test_clean_up_that_fails_does_not_hide_the_first_error(module, caplog):
    def fail_twice():
        def give_back():
            raise RobotUnreachable("10.0.0.7", 9559, "gone")

        module.after_wait(give_back)
        raise BadGoal("lights", [], "some")

    module.function_table["try"] = fail_twice
    assert module.server.play(chain(("try", ""))).text.startswith("function 1 (try): field lights")
    assert "clean-up failed: NAOqi at 10.0.0.7:9559: gone." in caplog.text


def test_after_wait_outside_of_a_function_is_a_mistake(module):
    with pytest.raises(RuntimeError, match="after_wait"):
        module.after_wait(lambda: None)


def test_run_calls_a_function_by_name_with_a_list_of_arguments(module):
    assert module.run("say", ["hello"], Duration.from_sec(0.0)) == "hello"
    with pytest.raises(UnknownFunction):
        module.run("sya", [], 0.0)


def test_a_function_is_one_key_value_pair(module):
    module.function_table["shout"] = lambda str_param: str_param.upper()
    assert module.server.play(chain(("shout", "hey"))).result.memList == ["HEY"]


def test_waiting_is_interrupted_outside_of_goals_too(module):
    module.interrupt.trigger()
    with pytest.raises(Preempted):
        module.wait(60.0)
