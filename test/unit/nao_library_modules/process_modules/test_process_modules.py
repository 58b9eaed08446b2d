"""Process modules: one thing at a time or several, cancelled, suspended, stopped, found for a designator."""

from __future__ import annotations

import logging

import pytest

from nao_library_modules.process_modules.control import do, par, pursue, seq, top_level
from nao_library_modules.process_modules.designators.designator import Designator, action, an
from nao_library_modules.process_modules.designators.rules import Command
from nao_library_modules.process_modules.failures import (
    DesignatorError,
    GoalNotAchieved,
    GripperGoalNotReached,
    NoMatchingProcessModule,
    PlanError,
    ProcessModuleNotRunning,
    ProcessModuleRunning,
    TaskEvaporatedFailure,
    UnknownProcessModule,
    fail,
)
from nao_library_modules.process_modules.flow import uninterrupted, wait_until
from nao_library_modules.process_modules.fluents import Fluent
from nao_library_modules.process_modules.goals import declare_goal
from nao_library_modules.process_modules.process_module import (
    AsynchronousProcessModule,
    ModuleState,
    ProcessModule,
    pm_cancel,
    pm_status,
)
from nao_library_modules.process_modules.registry import (
    available_process_module,
    get_process_module,
    matching_process_module,
    monitor_process_module,
    perform,
    pm_execute,
    pm_execute_matching,
    wait_for_process_module_running,
    with_process_modules_running,
)
from nao_library_modules.process_modules.waiting import wait_for


class Hands:
    """What both kinds of modules do here: named steps that wait for the test, and what came of them."""

    def __init__(self):
        self.begun = Fluent("begun", ())
        self.ended = Fluent("ended", ())
        self.go = Fluent("go", False)

    def act(self, command):
        name = command.name
        self.begun.update(lambda names: (*names, name))
        try:
            if name == "fail":
                fail(GripperGoalNotReached, "stuck", side=command.arguments["side"])
            if name == "bug":
                raise KeyError("side")
            if name == "wait":
                wait_for(self.go)
            if name == "quick":
                return command.arguments.get("value")
            return name
        finally:
            with uninterrupted():
                self.ended.update(lambda names: (*names, name))


class OneHand(ProcessModule):
    name = "hand"

    def __init__(self, hands):
        super().__init__()
        self.hands = hands

    def execute(self, command):
        return self.hands.act(command)


class TwoHands(AsynchronousProcessModule):
    name = "hands"

    def __init__(self, hands):
        super().__init__()
        self.hands = hands

    def execute(self, command):
        return self.hands.act(command)

    def resources(self, command):
        return frozenset({command.arguments["side"]})


@pytest.fixture
def hands():
    return Hands()


@pytest.fixture
def hand(hands):
    module = OneHand(hands)
    with with_process_modules_running(module, gripper="hand"):
        yield module


def to(name, module="hand", **arguments):
    """A designator of an action with one solution."""
    return Designator(action, {"type": name}, resolve=lambda desig: [Command(module, name, arguments)])


def test_a_designator_is_carried_out_and_answered(hand):
    assert top_level(lambda: pm_execute(hand, to("quick", value=3))) == 3
    assert top_level(lambda: pm_execute("hand", to("quick", value=4))) == 4
    assert top_level(lambda: pm_execute_matching(to("quick", value=5))) == 5
    assert top_level(lambda: perform(to("quick", value=6))) == 6
    assert top_level(lambda: perform(Command("hand", "quick", {"value": 7}))) == 7


def test_what_goes_wrong_in_a_module_goes_wrong_in_the_plan(hand, hands):
    with pytest.raises(GripperGoalNotReached, match="stuck") as caught:
        top_level(lambda: perform(to("fail", side="left")))
    assert caught.value.side == "left"
    assert pm_status(hand) is ModuleState.FAILED
    with pytest.raises(KeyError):
        top_level(lambda: perform(to("bug")))
    top_level(lambda: perform(to("quick")))
    assert pm_status(hand) is ModuleState.WAITING


def test_one_thing_at_a_time(hand, hands):
    def second():
        wait_for(hands.begun.eq(("wait",)))
        hands.go.value = True
        return perform(to("quick", value="second"))

    assert top_level(lambda: par(do(perform, to("wait")), second)) == ["wait", "second"]
    assert hands.begun.value == hands.ended.value == ("wait", "quick")


def test_several_things_at_once_but_not_with_the_same_hand(hands):
    def of(name, side):
        return do(perform, to(name, "hands", side=side, value=side))

    with with_process_modules_running(TwoHands(hands)):

        def watch():
            wait_for(hands.begun.eq(("wait", "quick")))
            assert hands.ended.value == ("quick",)
            hands.go.value = True

        def then():
            wait_for(hands.begun.eq(("wait",)))
            return par(of("quick", "right"), of("other", "left"))

        assert top_level(lambda: par(of("wait", "left"), then, watch))[1] == ["right", "other"]
    assert hands.begun.value == ("wait", "quick", "other")


def test_a_plan_that_ends_cancels_what_it_asked_for_and_sees_it_end(hand, hands):
    def leave():
        wait_for(hands.begun.eq(("wait",)))
        return "left"

    assert top_level(lambda: pursue(do(perform, to("wait")), leave)) == "left"
    assert hands.ended.value == ("wait",)
    assert pm_status(hand) is ModuleState.WAITING


def test_what_has_not_begun_is_taken_back(hand, hands):
    def leave():
        wait_for(hands.begun.eq(("wait",)))
        pursue(do(perform, to("quick")), lambda: None)
        hands.go.value = True

    top_level(lambda: par(do(perform, to("wait")), leave))
    assert hands.begun.value == ("wait",)


def test_pm_cancel_is_a_failure_of_who_asked(hand, hands):
    def cancel():
        wait_for(hands.begun.eq(("wait",)))
        pm_cancel(hand)
        wait_until(lambda: False)

    with pytest.raises(TaskEvaporatedFailure, match="cancelled"):
        top_level(lambda: pursue(do(perform, to("wait")), cancel))
    assert pm_status(hand) is ModuleState.WAITING


def test_a_suspension_takes_the_command_back_and_sends_it_again(beside, hand, hands):
    plan = beside(do(perform, to("wait")))
    top_level(lambda: wait_for(hands.begun.eq(("wait",))))
    plan.root.suspend()
    top_level(lambda: wait_for(hands.ended.eq(("wait",))))
    plan.root.wake_up()
    top_level(lambda: wait_for(hands.begun.eq(("wait", "wait"))))
    hands.go.value = True
    assert plan.ended() == "wait"


def test_an_offline_module_is_waited_for_with_a_warning(beside, hands):
    module, warned = OneHand(hands), Fluent("warned", "")
    handler = logging.Handler()
    handler.emit = lambda record: setattr(warned, "value", record.getMessage())
    logger = logging.getLogger("nao_library_modules.process_modules.process_module")
    logger.addHandler(handler)
    try:
        plan = beside(do(pm_execute, module, to("quick", value=1)))
        told = top_level(lambda: wait_for(warned, timeout=10.0))
    finally:
        logger.removeHandler(handler)
    assert told == "the process module hand is offline: hand: quick(value=1) waits for it"
    with with_process_modules_running(module):
        assert plan.ended() == 1


def test_a_module_that_is_stopped_fails_who_waits_for_it(beside, hands):
    module = OneHand(hands)
    with with_process_modules_running(module):
        plan = beside(do(perform, to("wait")))
        top_level(lambda: wait_for(hands.begun.eq(("wait",))))
    with pytest.raises(TaskEvaporatedFailure):
        plan.ended()
    assert module.state is ModuleState.OFFLINE and hands.ended.value == ("wait",)


def test_modules_run_once_and_are_known_by_name_and_alias(hand, hands):
    with pytest.raises(ProcessModuleRunning, match="hand runs already"):
        hand.start()
    with pytest.raises(ProcessModuleRunning), with_process_modules_running(OneHand(hands)):
        pass
    assert get_process_module("gripper") is hand and available_process_module("gripper")
    with pytest.raises(UnknownProcessModule, match="no process module 'foot': there are .*gripper, hand"):
        get_process_module("foot")
    assert top_level(lambda: wait_for_process_module_running("hand", timeout=5.0))
    assert matching_process_module(to("quick")) == "hand"
    with pytest.raises(NoMatchingProcessModule, match="is for the process module foot, which does not run"):
        top_level(lambda: perform(to("kick", "foot")))


def test_a_stopped_module_is_told(hands):
    module = OneHand(hands)
    with with_process_modules_running(module):
        pass
    assert not available_process_module("hand")
    with pytest.raises(ProcessModuleNotRunning):
        module.stop()
    with with_process_modules_running(module):
        assert top_level(lambda: perform(to("quick", value=1))) == 1


def test_somebody_else_may_watch_a_module(hand, hands):
    def watch():
        hands.go.value = True
        return monitor_process_module(hand)

    def act():
        wait_for(hands.go)
        return perform(to("wait"))

    assert top_level(lambda: par(watch, act)) == ["wait", "wait"]
    with pytest.raises(GripperGoalNotReached):
        top_level(lambda: pursue(do(monitor_process_module, hand), lambda: seq(do(perform, to("fail", side=1)))))


def test_a_goal_of_an_action_holds_before_or_afterwards(hand, hands):
    there = Fluent("there", False)

    @declare_goal
    def at_table():
        return there.value

    going = Designator(action, {"goal": at_table()}, resolve=lambda desig: [Command("hand", "quick")])
    with pytest.raises(GoalNotAchieved, match=r"at_table\(\) does not hold after"):
        top_level(do(perform, going))
    there.value = True
    begun = hands.begun.value
    assert top_level(do(perform, going)) is None and hands.begun.value == begun


def test_an_action_may_be_a_plan_of_other_actions(hand):
    def twice():
        return [perform(to("quick", value=value)) for value in (1, 2)]

    desig = Designator(action, {"type": "fetching"}, resolve=lambda desig: [twice])
    assert top_level(do(perform, desig)) == [1, 2]


def test_what_cannot_be_performed_is_told(hand):
    with pytest.raises(PlanError, match="'open' is no designator"):
        top_level(lambda: perform("open"))
    with pytest.raises(DesignatorError, match="its solution 3 is nothing that a process module carries out"):
        top_level(lambda: pm_execute(hand, Designator(action, {}, resolve=lambda desig: [3])))
    with pytest.raises(DesignatorError):
        top_level(lambda: perform(an(action, type="juggling with knives")))


@pytest.mark.parametrize("base", [ProcessModule, AsynchronousProcessModule])
def test_a_module_that_executes_nothing_cannot_be_made(base):
    class Idle(base):
        name = "idle"

    with pytest.raises(TypeError, match="abstract.*execute"):
        Idle()
