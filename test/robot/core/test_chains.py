"""Goals as chains of functions: progress, ends, policies, preemption, clean-up. The functions are the test's own."""

from __future__ import annotations

import gc
import weakref

import pytest
from genpy import Duration
from goal_functions import led_with_text as f

from nao_library_actions.msg import NaoLedAction, NaoLedGoal
from nao_library_modules.core.errors import BadGoal, Preempted, UnknownFunction
from nao_library_modules.nao_basic import NaoBasic
from naoqi.errors import NaoError, RobotUnreachable

BRAIN0 = "Head/Led/Front/Right/1"


class ChainModule(NaoBasic):
    """A module whose functions say what they did."""

    def __init__(self, *address, **options):
        super().__init__(*address, **options)
        self.done = []
        for function in (self.say, self.fail, self.crash, self.rasta, self.fades, self.borrow, self.nested):
            self.function_table[function.__name__] = function
        self.serve("Module", NaoLedAction)

    def say(self, str_param):
        self.done.append(str_param)
        return str_param

    def fail(self, str_param):
        raise BadGoal("str_param", str_param, "something else")

    def crash(self):
        raise KeyError("oops")

    def rasta(self):
        self.call(self.robot.proxy("ALLeds"), "rasta", 60.0)

    def fades(self, lights):
        return self.call_all(self.robot.proxy("ALLeds"), "fade", [(light, 0.0, 2.0) for light in lights])

    def borrow(self, str_param):
        self.done.append(f"borrow {str_param}")
        self.after_wait(lambda: self.done.append(f"return {str_param}"))

    def nested(self):
        self.borrow("outer")
        self.run("borrow", ["inner"], 0.0)
        self.borrow("late")


@pytest.fixture
def goals(goals_to):
    return goals_to(ChainModule, NaoLedGoal)


def test_a_cancel_that_came_before_the_goal_was_taken_up_counts(goals):
    server = goals.module.server
    server.preempt_requested = True
    server.execute(NaoLedGoal([f("say", "one")]))
    assert server.end == "preempted" and goals.module.done == []


@pytest.fixture
def done(goals):
    return goals.module.done


def test_functions_run_in_order_and_answers_waits_and_progress_are_told(robot, goals, done):
    began = robot.now.time
    goal = goals.play(f("say", "one", 0.5), f("ping", "", 1.5), f("say", "two"))
    assert (goal.state, goal.text, done) == ("succeeded", "", ["one", "two"])
    assert robot.now.time - began == pytest.approx(2.0, abs=0.2), "the server waits after each function"
    results = goal.result.results
    assert [(r.function, r.values, r.error) for r in results] == [
        ("say", ["one"], ""), ("ping", ["True"], ""), ("say", ["two"], ""),
    ]  # fmt: skip
    assert all(result.elapsed.to_sec() < 0.4 for result in results), "waits do not count"
    assert goal.result.memList == ["one", "True", "two"]
    told = [(f.index, f.function, f.count, f.waiting) for f in goal.feedback]
    assert told == [(0, "say", 3, ""), (1, "ping", 3, ""), (2, "say", 3, "")]


def test_a_chain_with_an_error_runs_nothing_and_the_server_lives_on(goals, done):
    goal = goals.play(f("say", "one"), f("sya", "two"))
    assert (goal.state, done, goal.feedback, goal.result.results) == ("aborted", [], [], [])
    text = "unknown function 'sya': did you mean 'say'?; `nao list Module --all` tells all"
    assert goal.text == f"function 2 (sya): {text}"
    assert "the chain is empty" in goals.refused()
    assert goals.succeed(f("say", "one")).memList == ["one"]


def test_an_error_while_running_keeps_the_results_before_it(goals, done):
    goal = goals.play(f("say", "one"), f("fail", "x"), f("say", "three"))
    assert (goal.state, done) == ("aborted", ["one"])
    assert goal.text == "function 2 (fail): field str_param: 'x' is not allowed: something else"
    told = [(r.function, r.values, r.error) for r in goal.result.results]
    assert told == [("say", ["one"], ""), ("fail", [], "field str_param: 'x' is not allowed: something else")]


def test_a_function_that_may_be_skipped_does_not_end_the_chain(goals, done):
    result = goals.succeed(f("say", "one"), f("fail", "x", on_error="skip"), f("say", "three"))
    assert done == result.memList == ["one", "three"]
    assert [bool(each.error) for each in result.results] == [False, True, False]


def test_a_function_is_tried_again_as_often_as_its_goal_says(goals, done):
    tries = iter(["first", "second"])

    def at_the_third(str_param):
        failure = next(tries, None)
        if failure is not None:
            raise BadGoal("str_param", str_param, failure)
        return "at last"

    goals.module.function_table["fail"] = at_the_third
    goal = goals.play(f("say", "one"), f("fail", "x", on_error="retry 2"), f("say", "three"))
    assert (goal.state, goal.result.memList) == ("succeeded", ["one", "at last", "three"])
    assert [each.function for each in goal.feedback] == ["say", "fail", "fail", "fail", "say"]
    assert [each.error for each in goal.result.results] == ["", "", ""]


@pytest.mark.parametrize(("on_error", "end"), [("retry 2", "aborted"), ("retry 2 skip", "succeeded")])
def test_what_becomes_of_a_function_that_fails_at_every_try(goals, on_error, end):
    calls = []
    goals.module.function_table["crash"] = lambda: calls.append(1) or {}["oops"]
    goal = goals.play(f("crash", on_error=on_error), f("say", "on"))
    assert (goal.state, len(calls)) == (end, 3)
    assert [r.function for r in goal.result.results] == ["crash", "say"][: 2 if end == "succeeded" else 1]


@pytest.mark.parametrize("on_error", ["ignore", "retry", "retry 0", "retry 101"])
def test_an_unknown_policy_is_refused_before_anything_runs(goals, done, on_error):
    assert "function 2 (say): field on_error" in goals.refused(f("say", "one"), f("say", "two", on_error=on_error))
    assert done == []


def test_an_unexpected_error_is_logged_with_its_trace_and_the_server_lives_on(goals, caplog):
    assert goals.refused(f("crash")) == "function 1 (crash): KeyError: 'oops'"
    assert "Traceback" in caplog.text
    goals.succeed(f("say", "again"))


# Preemption


def test_a_cancel_ends_a_wait_and_the_function_before_it_counts_as_done(robot, goals, done):
    goal = goals.send(f("say", "one", 60.0), f("say", "two"))
    robot.advance(1.0)
    before = robot.now.time
    goal.cancel()
    assert (goal.state, goal.text, done) == ("preempted", "preempted in function 1 (say)", ["one"])
    assert [result.values for result in goal.result.results] == [["one"]]
    assert robot.now.time - before < 0.5
    assert goals.play(f("say", "two", 0.01)).state == "succeeded", "the next goal is not preempted"


@pytest.mark.parametrize("on_error", ["", "retry 5 skip"])
def test_a_cancel_ends_a_call_on_the_robot_whatever_may_be_skipped(robot, goals, done, on_error):
    goal = goals.send(f("say", "one"), f("rasta", on_error=on_error), f("say", "never"))
    robot.advance(0.6)
    assert goal.cancel().state == "preempted"
    assert [result.function for result in goal.result.results] == ["say"]
    colours = robot.led("Face/Led/Green/Left/0Deg"), robot.led("Face/Led/Red/Left/0Deg")
    robot.advance(3.0)
    assert colours == (robot.led("Face/Led/Green/Left/0Deg"), robot.led("Face/Led/Red/Left/0Deg"))
    assert done == ["one"]


def test_a_call_that_fails_cancels_those_beside_it(robot, goals):
    text = goals.refused(f("fades", lights=["Brain0", "nothing"]))
    assert text.startswith("function 1 (fades): ALLeds.fade failed: ")
    before = robot.led(BRAIN0)
    robot.advance(1.0)
    assert robot.led(BRAIN0) == before > 0.5


def test_the_end_of_the_node_interrupts_and_cleans_up_before_it_returns(robot, goals, done):
    goal = goals.send(f("borrow", "a", 60.0))
    robot.advance(0.2)
    for action in goals.node.shutdown_actions:
        action()
    assert done == ["borrow a", "return a"]
    assert goal.finish().state == "preempted"
    assert goals.play(f("say", "late")).state == "preempted", "no goal begins after the end"


class Text(str):
    """A text that can be watched."""


# Not "crash": the log of the test keeps what is logged with its trace.
@pytest.mark.parametrize(("function", "end"), [("fail", "aborted"), ("sya", "aborted"), ("rasta", "preempted")])
def test_nothing_of_a_goal_is_kept_when_it_has_failed(goals, function, end):
    """Goals may hold megabytes, and thousands of them may fail before Python looks for rings of objects."""
    gc.collect()
    gc.disable()
    try:
        text = Text("x")
        kept = weakref.ref(text)
        goal = goals.send(f(function, text))
        del text
        assert (goal.cancel() if end == "preempted" else goal.finish()).state == end
        goals.module.server.result = goal.result = None
        assert kept() is None
    finally:
        gc.enable()


# Clean-up


def test_what_was_borrowed_is_returned_when_the_function_fails(goals, done):
    goals.module.function_table["try"] = lambda: goals.module.borrow("a") or goals.module.fail("x")
    assert goals.refused(f("try")).startswith("function 1 (try): field str_param") and done == ["borrow a", "return a"]


def test_a_function_may_run_another_one_each_with_its_own_clean_up(goals, done):
    goals.succeed(f("nested"))
    assert done == ["borrow outer", "borrow inner", "return inner", "borrow late", "return late", "return outer"]


def test_clean_up_that_fails_aborts_a_goal_that_went_well_but_hides_no_error(goals, done, caplog):
    def give_back():
        raise RobotUnreachable("10.0.0.7", 9559, "gone")

    def borrow(str_param):
        goals.module.after_wait(give_back)
        if str_param:
            goals.module.fail(str_param)

    goals.module.function_table["try"] = borrow
    assert goals.refused(f("try")) == "function 1 (try): NAOqi at 10.0.0.7:9559: gone."
    goal = goals.play(f("try", on_error="retry 3 skip"), f("say", "on"))
    assert (goal.state, done) == ("succeeded", ["on"]), "what was done is not tried again"
    assert [(r.function, r.error) for r in goal.result.results] == [("try", ""), ("say", "")]
    assert goals.refused(f("try", "x")).startswith("function 1 (try): field str_param")
    assert "clean-up failed: NAOqi at 10.0.0.7:9559: gone." in caplog.text


# Outside of goals


def test_functions_can_be_run_outside_of_goals(goals):
    module = goals.module
    assert module.run("say", ["hello"], Duration.from_sec(0.0)) == "hello"
    with pytest.raises(UnknownFunction):
        module.run("sya", [], 0.0)
    with pytest.raises(RuntimeError, match="after_wait"):
        module.after_wait(lambda: None)
    module.interrupt.trigger()
    with pytest.raises(Preempted):
        module.wait(60.0)


# --- a module of one's own --------------------------------------------------------------------------------------------


class Declared(NaoBasic):
    """A module whose table is declared in the class, with a lambda that is none of its methods."""

    def rest(self, str_param, *args):
        return [str_param, *args]

    function_table = {"rest": rest, "sum": lambda i_values: sum(i_values)}

    def __init__(self, *address, **options):
        super().__init__(*address, **options)
        self.serve("Module", NaoLedAction)


def test_a_table_is_declared_replaced_and_changed_at_any_time_and_keeps_the_memory_functions(goals_to):
    goals = goals_to(Declared, NaoLedGoal)
    table = {"late": lambda: "late"}
    assert goals.succeed(f("sum", i_values=[1, 2]), f("ping")).memList == ["3", "True"]
    goals.module.function_table = table
    assert goals.succeed(f("late"), f("ping")).memList == ["late", "True"]
    table["later"] = lambda: "later"
    goals.module.function_table["last"] = lambda: "last"
    assert goals.succeed(f("later"), f("last")).memList == ["later", "last"]
    assert "unknown function 'sum'" in goals.refused(f("sum"))


def test_a_table_takes_callables_only_and_names_the_entry_that_is_none(goals_to):
    table = goals_to(Declared, NaoLedGoal).module.function_table
    with pytest.raises(NaoError, match=r"function_table\['green'\] is None: a function or method is needed"):
        table["green"] = None
    with pytest.raises(NaoError, match=r"function_table\['pair'\]"):
        table |= {"pair": ()}
    assert not {"green", "pair"} & set(table)


def test_a_function_with_args_gets_the_other_fields_in_the_order_of_the_message(goals_to):
    goals = goals_to(Declared, NaoLedGoal)
    goals.module.function_table["list"] = lambda args: args[1:3]
    (rest, listed) = goals.succeed(f("rest", "text", lights=["Brain0"]), f("list", i_values=[1.0])).results
    assert rest.values[:4] == ["text", '["Brain0"]', "[]", "False"] and len(rest.values) == 9
    assert listed.values == ["[]", "[1.0]"]


class Paper(ChainModule):
    """A module with an execute_cb of its own: the parameters but name and time are a list, as the paper has it."""

    def execute_cb(self, goal):
        result = self.server.get_default_result()
        for message in goal.functions:
            args = [getattr(message, field) for field in message.__slots__ if field not in ("function", "time")]
            result.memList.append(str(self.run(message.function, args, message.time)))
        self.server.set_succeeded(result)


def test_an_execute_cb_of_ones_own_runs_functions_and_is_preempted_and_refuses(robot, goals_to):
    goals = goals_to(Paper, NaoLedGoal)
    assert goals.succeed(f("say", "one"), f("say", "two")).memList == ["one", "two"]
    goal = goals.send(f("say", "three", 60.0), f("say", "four"))
    robot.advance(1.0)
    assert goal.cancel().state == "preempted" and goals.module.done == ["one", "two", "three"]
    assert "unknown function 'sya'" in goals.refused(f("sya"))
    assert "field str_param: 'x'" in goals.refused(f("fail", "x"))
    assert goals.succeed(f("insertData", "Test/Key=7"), f("getData", "Test/Key")).memList == ["None", "[7]"]
    with pytest.raises(BadGoal, match=r"too many positional arguments.*`args_of\(message\)` gives what"):
        goals.module.run("getData", ["Test/Key", [], []], 0)


def test_results_and_feedback_tell_when_functions_began_ended_and_what_they_waited_for_happened(robot, goals):
    def blink():
        goals.module.happened = (began + 0.1, began + 0.4)

    began = robot.advance(0.5)
    goals.module.function_table["blink"] = blink
    rest = f("say", "rest")
    rest.time = Duration(1)
    goal = goals.play(rest, f("blink"), f("say", "end"))
    say, blink, end = goal.result.results
    assert say.begin.to_sec() == pytest.approx(began, abs=0.05) and say.end - say.begin == say.elapsed
    assert (blink.begin - say.end).to_sec() == pytest.approx(1.0, abs=0.05), "the wait belongs to none"
    assert [time.to_sec() - began for time in (blink.onset, blink.offset)] == pytest.approx([0.1, 0.4], abs=1e-6)
    assert not end.onset and not end.offset, "what the one before knew is not told again"
    assert [each.stamp for each in goal.feedback] == sorted(each.stamp for each in goal.feedback)
    assert abs((goal.feedback[-1].stamp - end.begin).to_sec()) < 0.05
