"""Process modules where they meet plans: cancelled in each state, suspended, several inputs, watched, renamed."""

from __future__ import annotations

import threading

import pytest

from nao_library_modules.process_modules.control import do, par, pursue, seq, top_level, try_in_order
from nao_library_modules.process_modules.designators.designator import Designator, action
from nao_library_modules.process_modules.designators.rules import Command
from nao_library_modules.process_modules.failures import (
    GripperGoalNotReached,
    NavigationGoalNotReached,
    PlanFailure,
    ProcessModuleNotRunning,
    TaskEvaporatedFailure,
    UnknownProcessModule,
    fail,
)
from nao_library_modules.process_modules.flow import sleep, uninterrupted, wait_until
from nao_library_modules.process_modules.fluents import Fluent
from nao_library_modules.process_modules.handling import give, retry, with_failure_handling
from nao_library_modules.process_modules.policies import timeout_policy, with_policy
from nao_library_modules.process_modules.process_module import (
    AsynchronousProcessModule,
    ModuleState,
    ProcessModule,
    pm_cancel,
    pm_run,
    pm_status,
)
from nao_library_modules.process_modules.registry import (
    available_process_module,
    get_process_module,
    monitor_process_module,
    perform,
    pm_execute,
    start_process_modules,
    stop_process_modules,
    with_process_module_aliases,
    with_process_modules_running,
)
from nao_library_modules.process_modules.tasks import TaskState
from nao_library_modules.process_modules.waiting import wait_for

LIMIT = 10.0
SHORT = 0.02


class Log:
    """What a module has done: (what, word) pairs; commands wait for `go` of their word."""

    def __init__(self):
        self.events = Fluent("events", ())
        self.open = Fluent("open", frozenset())

    def tell(self, *event):
        self.events.update(lambda events: (*events, event))

    def let(self, *words):
        self.open.update(lambda there: there | set(words))

    def count(self, what):
        return sum(event[0] == what for event in self.events.value)

    def wait(self, *event):
        """From a test: until this has happened."""
        there = lambda: event in self.events.value  # noqa: E731
        assert top_level(lambda: wait_until(there, [self.events], LIMIT)), f"{event} did not happen"

    def carry_out(self, command):
        word, how = command.arguments.get("word", ""), command.name
        self.tell("begun", word)
        try:
            if how == "wait":
                wait_until(lambda: word in self.open.value, [self.open])
            elif how == "stumble":
                wait_until(lambda: word in self.open.value, [self.open])
                fail(NavigationGoalNotReached, f"{word} is far", word=word)
            elif how == "protected":
                with uninterrupted():
                    wait_until(lambda: word in self.open.value, [self.open])
            elif how == "stumble at the end":
                wait_until(lambda: False)
            return word
        except NavigationGoalNotReached:
            self.tell("failed", word)
            raise
        finally:
            self.tell("over", word)
            if how == "stumble at the end":
                fail(GripperGoalNotReached, "while it was ended")


class One(ProcessModule):
    name = "one"

    def __init__(self, log, name=""):
        super().__init__(name)
        self.log = log

    def execute(self, command):
        return self.log.carry_out(command)


class Many(AsynchronousProcessModule):
    name = "many"

    def __init__(self, log, name=""):
        super().__init__(name)
        self.log = log

    def execute(self, command):
        return self.log.carry_out(command)

    def resources(self, command):
        return frozenset(command.arguments.get("needs", ()))


@pytest.fixture
def log():
    return Log()


@pytest.fixture
def one(log):
    with with_process_modules_running(One(log)) as (module,):
        yield module


@pytest.fixture
def many(log):
    with with_process_modules_running(Many(log)) as (module,):
        yield module


def to(how, word="", module="one", **arguments):
    arguments = {"word": word, **arguments}
    return Designator(action, {"type": how}, resolve=lambda desig: [Command(module, how, arguments)])


def state_of(module, state):
    assert top_level(lambda: wait_for(module.status.eq(state), timeout=LIMIT)), module.state


# --- cancelled in each state ------------------------------------------------------------------------------------------


def test_cancelling_a_module_that_does_nothing_does_nothing(one):
    pm_cancel(one)
    assert pm_status(one) is ModuleState.WAITING
    assert top_level(lambda: perform(to("quick", "a"))) == "a"


def test_cancelling_an_offline_module_does_nothing(log):
    module = One(log)
    pm_cancel(module)
    assert pm_status(module) is ModuleState.OFFLINE


def test_cancelling_a_module_that_works_ends_that_and_what_waits(one, log, beside):
    plans = [beside(do(perform, to("wait", "a")))]
    log.wait("begun", "a")
    plans += [beside(do(perform, to("wait", word))) for word in "bc"]
    assert top_level(lambda: wait_until(lambda: len(one._waiting) == 2, (), 0.0)) or wait_here(one, 2)
    pm_cancel(one)
    for plan in plans:
        with pytest.raises(TaskEvaporatedFailure):
            plan.ended()
    assert log.events.value == (("begun", "a"), ("over", "a"))
    assert pm_status(one) is ModuleState.WAITING


def wait_here(module, count):
    def plan():
        while len(module._waiting) < count:
            sleep(0.001)

    top_level(plan)
    return True


def test_a_plan_that_is_ended_while_it_waits_for_its_turn_takes_its_place_back(one, log, beside):
    first = beside(do(perform, to("wait", "a")))
    log.wait("begun", "a")
    second = beside(do(perform, to("wait", "b")))
    wait_here(one, 1)
    second.root.evaporate("changed my mind")
    with pytest.raises(TaskEvaporatedFailure):
        second.ended()
    log.let("a", "b")
    assert first.ended() == "a"
    assert ("begun", "b") not in log.events.value


def test_a_failed_module_can_be_cancelled_and_goes_on(one, log):
    log.let("far")
    with pytest.raises(NavigationGoalNotReached):
        top_level(lambda: perform(to("stumble", "far")))
    assert pm_status(one) is ModuleState.FAILED
    pm_cancel(one)
    assert top_level(lambda: perform(to("quick", "b"))) == "b"
    state_of(one, ModuleState.WAITING)


def test_a_command_that_fails_while_it_is_ended_does_not_hide_why_the_plan_failed(one, log):
    def second():
        top = lambda: ("begun", "a") in log.events.value  # noqa: E731
        wait_until(top, [log.events])
        fail(NavigationGoalNotReached, "first")

    with pytest.raises(NavigationGoalNotReached, match="first"):
        top_level(lambda: par(do(perform, to("stumble at the end", "a")), second))
    assert log.count("over") == 1


def test_a_plan_waits_for_commands_that_put_things_right(one, log, beside):
    plan = beside(do(perform, to("protected", "a")))
    log.wait("begun", "a")
    plan.root.evaporate("over")
    assert plan.root.join(SHORT) is False
    log.let("a")
    with pytest.raises(TaskEvaporatedFailure):
        plan.ended()
    assert log.events.value[-1] == ("over", "a")


# --- failures ---------------------------------------------------------------------------------------------------------


def test_a_failure_of_a_module_ends_what_runs_beside_it_in_another_module(one, many, log):
    log.let("far")

    def stumble():
        wait_until(lambda: ("begun", "walk") in log.events.value, [log.events])
        perform(to("stumble", "far", "many"))

    with pytest.raises(NavigationGoalNotReached) as caught:
        top_level(lambda: par(do(perform, to("wait", "walk")), stumble))
    assert caught.value.word == "far"
    assert ("over", "walk") in log.events.value
    assert one.state is ModuleState.WAITING and many.state is ModuleState.FAILED


def test_a_failed_command_is_tried_again(one, log):
    log.let("far")
    tries = []

    def again(failure):
        tries.append(failure.word)
        if len(tries) < 3:
            retry()
        give("gave up")

    body = do(perform, to("stumble", "far"))
    assert top_level(lambda: with_failure_handling(body, {NavigationGoalNotReached: again})) == "gave up"
    assert tries == ["far"] * 3 and log.count("begun") == 3


def test_the_next_solution_is_tried_when_one_fails(one, log):
    log.let("far")
    desig = Designator(
        action,
        {"type": "either"},
        resolve=lambda _: [Command("one", "stumble", {"word": "far"}), Command("one", "quick", {"word": "near"})],
    )
    assert top_level(lambda: try_in_order(do(perform, desig), lambda: perform(desig.next_solution()))) == "near"


def test_a_policy_ends_a_command(one, log):
    with pytest.raises(PlanFailure, match="at most 0.02 s"):
        top_level(lambda: with_policy(timeout_policy(0.02), do(perform, to("wait", "a"))))
    assert log.events.value == (("begun", "a"), ("over", "a"))


# --- suspension -------------------------------------------------------------------------------------------------------


def test_a_suspended_plan_that_waits_for_its_turn_asks_again(one, log, beside):
    first = beside(do(perform, to("wait", "a")))
    log.wait("begun", "a")
    second = beside(do(perform, to("wait", "b")))
    wait_here(one, 1)
    second.root.suspend()
    top_level(lambda: while_waiting(one, 0))
    log.let("a", "b")
    assert first.ended() == "a"
    assert ("begun", "b") not in log.events.value
    second.root.wake_up()
    assert second.ended() == "b"


def while_waiting(module, count):
    while len(module._waiting) != count:
        sleep(0.001)


def test_what_was_done_when_the_suspension_came_is_not_done_again(log, beside):
    module, suspended = One(log), []

    def suspend_at_the_end(task):
        if task.parent is None and task.state is TaskState.SUCCEEDED and not suspended:
            suspended.append(True)
            plan.root.suspend("just now")

    module.observers.append(suspend_at_the_end)
    with with_process_modules_running(module):
        plan = beside(do(perform, to("wait", "a")))
        log.wait("begun", "a")
        log.let("a")
        state_of(module, ModuleState.WAITING)
        assert plan.root.join(SHORT) is False and plan.root.state is TaskState.SUSPENDED
        plan.root.wake_up()
        assert plan.ended() == "a"
    assert log.count("begun") == 1


def test_par_of_two_modules_is_suspended_and_both_begin_again(one, many, log, beside):
    plan = beside(lambda: par(do(perform, to("wait", "a")), do(perform, to("wait", "b", "many"))))
    log.wait("begun", "a")
    log.wait("begun", "b")
    plan.root.suspend()
    log.wait("over", "a")
    log.wait("over", "b")
    log.let("a", "b")
    plan.root.wake_up()
    assert plan.ended() == ["a", "b"]
    assert log.count("begun") == 4


def test_a_suspended_command_is_ended(one, log, beside):
    plan = beside(do(perform, to("wait", "a")))
    log.wait("begun", "a")
    plan.root.suspend()
    log.wait("over", "a")
    plan.root.evaporate("over")
    with pytest.raises(TaskEvaporatedFailure, match="over"):
        plan.ended()
    assert log.count("begun") == 1


def test_a_command_in_a_failure_handler_is_suspended(one, log, beside):
    handlers = {PlanFailure: lambda failure: give(perform(to("wait", "a")))}
    plan = beside(lambda: with_failure_handling(do(fail, "no"), handlers))
    log.wait("begun", "a")
    plan.root.suspend()
    log.wait("over", "a")
    log.let("a")
    plan.root.wake_up()
    assert plan.ended() == "a"


# --- several at once --------------------------------------------------------------------------------------------------


def test_an_asynchronous_module_does_all_at_once(many, log):
    def let_all():
        wait_until(lambda: log.count("begun") == 20, [log.events])
        log.let(*map(str, range(20)))

    plans = [do(perform, to("wait", str(number), "many")) for number in range(20)]
    answers = top_level(lambda: par(let_all, *plans))
    assert answers[1:] == [str(number) for number in range(20)]


def test_commands_that_need_the_same_take_turns_in_their_order(many, log):
    def step(word, *needs):
        return do(perform, to("wait", word, "many", needs=needs))

    def let():
        wait_until(lambda: {("begun", "a"), ("begun", "d")} <= set(log.events.value), [log.events])
        assert ("begun", "b") not in log.events.value
        log.let("a", "b", "c", "d")

    top_level(lambda: par(step("a", "left"), step("d", "right"), do(later, step, log), let))
    order = [word for what, word in log.events.value if what == "begun"]
    assert order.index("a") < order.index("b")
    events = log.events.value
    assert events.index(("over", "a")) < events.index(("begun", "b"))


def later(step, log):
    wait_until(lambda: ("begun", "a") in log.events.value, [log.events])
    return step("b", "left", "right").call()


def test_one_of_several_commands_is_ended_and_the_others_go_on(many, log, beside):
    plan = beside(
        lambda: try_in_order(
            lambda: par(
                do(perform, to("wait", "a", "many"), name="a"),
            ),
            lambda: "second way",
        )
    )
    other = beside(do(perform, to("wait", "b", "many")))
    log.wait("begun", "a")
    log.wait("begun", "b")
    plan.root.find("a").evaporate("not this")
    assert plan.ended() == "second way"
    log.let("b")
    assert other.ended() == "b"


def test_what_waits_for_a_limb_is_cancelled_without_being_begun(many, log, beside):
    first = beside(do(perform, to("wait", "a", "many", needs=["left"])))
    log.wait("begun", "a")
    second = beside(do(perform, to("wait", "b", "many", needs=["left"])))
    third = None
    wait_here(many, 1)
    third = beside(do(perform, to("wait", "c", "many", needs=["left"])))
    wait_here(many, 2)
    second.root.evaporate("no")
    with pytest.raises(TaskEvaporatedFailure):
        second.ended()
    log.let("a", "c")
    assert (first.ended(), third.ended()) == ("a", "c")
    assert ("begun", "b") not in log.events.value


# --- watched ----------------------------------------------------------------------------------------------------------


def test_a_monitor_does_not_miss_an_end_that_another_one_follows(many, log):
    """Both end at the same moment: the second must not hide the first."""
    for turn in range(30):
        first, others = to("quick", f"first {turn}", "many"), [to("quick", "x", "many") for _ in range(6)]
        ready = Fluent("ready", False)

        def watch(first=first, ready=ready):
            ready.value = True
            return monitor_process_module("many", first)

        def act(first=first, others=others, ready=ready):
            wait_for(ready)
            sleep(0.001)
            par(do(perform, first), *(do(perform, other) for other in others))

        answer = top_level(lambda watch=watch, act=act: with_policy(timeout_policy(LIMIT), do(par, watch, act)))
        assert answer[0] == f"first {turn}"


def test_a_monitor_waits_for_its_designator_only(many, log):
    mine, other = to("wait", "mine", "many"), to("quick", "other", "many")
    watching = Fluent("watching", False)

    def watch():
        watching.value = True
        return monitor_process_module(many, mine)

    def act():
        wait_for(watching)
        sleep(0.002)
        perform(other)
        log.let("mine")
        return perform(mine)

    assert top_level(lambda: par(watch, act)) == ["mine", "mine"]


def test_several_monitors_see_the_same_failure(one, log):
    log.let("far")
    watching = Fluent("watching", 0)
    seen = []

    def watch():
        watching.update(lambda count: count + 1)
        try:
            monitor_process_module("one")
        except NavigationGoalNotReached as failure:
            seen.append(failure.word)

    def act():
        wait_for(watching >= 3)
        sleep(0.005)
        with_failure_handling(do(perform, to("stumble", "far")), {PlanFailure: lambda failure: give()})

    top_level(lambda: par(watch, watch, watch, act))
    assert seen == ["far"] * 3


def test_a_monitor_is_told_of_a_cancel(one, log):
    def watch():
        with pytest.raises(TaskEvaporatedFailure):
            monitor_process_module(one)

    def act():
        wait_until(lambda: ("begun", "a") in log.events.value, [log.events])
        sleep(0.002)
        pm_cancel(one)

    def do_it():
        return with_failure_handling(do(perform, to("wait", "a")), {PlanFailure: lambda failure: give()})

    top_level(lambda: par(watch, act, do_it))


# --- beginning, ending, names -----------------------------------------------------------------------------------------


def test_pm_run_in_a_thread_of_ones_own_ends_with_stop(log):
    module, stopped = One(log), threading.Event()
    after = []

    def mine():
        pm_run(module)
        after.append(module.state)
        stopped.wait(LIMIT)

    thread = threading.Thread(target=mine)
    thread.start()
    state_of(module, ModuleState.WAITING)
    assert top_level(lambda: pm_execute(module, Command("one", "quick", {"word": "a"}))) == "a"
    stopper = threading.Thread(target=module.stop)
    stopper.start()
    stopper.join(LIMIT / 2.0)
    hung = stopper.is_alive()
    stopped.set()
    thread.join(LIMIT)
    stopper.join(LIMIT)
    assert not hung, "stop waits for a thread that has long left pm_run"
    assert after == [ModuleState.OFFLINE]
    with with_process_modules_running(module):
        assert module.state is ModuleState.WAITING


def test_plans_that_wait_for_an_offline_module_go_on_when_it_starts_all_of_them(log, beside):
    module = One(log)
    plans = [beside(do(pm_execute, module, Command("one", "quick", {"word": word}))) for word in "abcd"]
    plans[0].root.evaporate("too late")
    with pytest.raises(TaskEvaporatedFailure):
        plans[0].ended()
    plans[1].root.suspend()
    with with_process_modules_running(module):
        assert [plan.ended() for plan in plans[2:]] == ["c", "d"]
        plans[1].root.wake_up()
        assert plans[1].ended() == "b"


def test_stopping_ends_what_runs_and_what_waits(log, beside):
    module = One(log)
    start_process_modules(module)
    plans = [beside(do(perform, to("wait", "a")))]
    log.wait("begun", "a")
    plans.append(beside(do(perform, to("wait", "b"))))
    wait_here(module, 1)
    stop_process_modules()
    for plan in plans:
        with pytest.raises((TaskEvaporatedFailure, ProcessModuleNotRunning)):
            plan.ended()
    assert module.state is ModuleState.OFFLINE and log.count("begun") == log.count("over") == 1


def test_modules_that_are_started_while_another_one_cannot_are_stopped_again(log, one):
    other = Many(log)
    with pytest.raises(PlanFailure if issubclass(ProcessModuleNotRunning, PlanFailure) else Exception):
        with with_process_modules_running(other, One(log)):
            pass
    assert other.state is ModuleState.OFFLINE and one.state is ModuleState.WAITING


def test_a_failure_in_the_block_stops_the_modules(log):
    module = One(log)
    with pytest.raises(ZeroDivisionError), with_process_modules_running(module):
        1 / 0  # noqa: B018
    assert module.state is ModuleState.OFFLINE


def test_aliases_last_as_long_as_their_block_and_hide_others(one, many):
    with with_process_module_aliases(hand="one"):
        assert get_process_module("hand") is one
        with with_process_module_aliases(hand="many", foot="many"):
            assert get_process_module("hand") is many and available_process_module("foot")
        assert get_process_module("hand") is one
        with pytest.raises(UnknownProcessModule):
            get_process_module("foot")
    with pytest.raises(UnknownProcessModule):
        get_process_module("hand")


def test_aliases_of_plans_beside_each_other_do_not_take_each_others_away(one, many):
    first_in, second_in, first_out = (Fluent(name, False) for name in ("first in", "second in", "first out"))

    def first():
        with with_process_module_aliases(hand="one"):
            first_in.value = True
            wait_for(second_in)
        first_out.value = True

    def second():
        wait_for(first_in)
        with with_process_module_aliases(foot="many"):
            second_in.value = True
            wait_for(first_out)
            assert get_process_module("foot") is many
        with pytest.raises(UnknownProcessModule):
            get_process_module("hand")

    top_level(lambda: par(first, second))


def test_commands_go_to_modules_by_their_aliases(one, log):
    with with_process_module_aliases(anything="one"):
        assert top_level(lambda: perform(to("quick", "a", "anything"))) == "a"
        assert top_level(lambda: pm_execute("anything", to("quick", "b", "anything"))) == "b"


def test_many_plans_use_a_module_from_many_threads(one, log):
    outcome = []

    def user(number):
        outcome.append(top_level(lambda: seq(*(do(perform, to("quick", f"{number}")) for _ in range(10)))))

    threads = [threading.Thread(target=user, args=(number,)) for number in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(30.0)
    assert sorted(outcome) == [str(number) for number in range(8)]
    # One thing at a time: each ends before the next begins.
    events = [what for what, _ in log.events.value]
    assert events == ["begun", "over"] * 80


def test_whichever_module_is_first_decides(one, many, log):
    log.let("b")
    answer = top_level(lambda: pursue(do(perform, to("wait", "a")), do(perform, to("wait", "b", "many"))))
    assert answer == "b"
    assert {event for event in log.events.value if event[1] == "a"} in (set(), {("begun", "a"), ("over", "a")})
