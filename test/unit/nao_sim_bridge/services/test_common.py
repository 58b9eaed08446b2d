"""What every module answers: help about itself, and posted calls."""

from __future__ import annotations

import weakref

import pytest

from nao_sim_bridge.services.common import REMEMBERED
from nao_sim_bridge.sim.tasks import Task, TaskIds


class Leds:
    """Two methods of ALLeds; `rasta` is a command that leads to a task, as in the simulator."""

    def __init__(self):
        self.commands = []
        self.tasks = []
        self.ids = TaskIds()
        self.ids.ask = Task.kill

    def on(self, name):
        return None

    def rasta(self, duration):
        self.commands.append(Task("command", 0))
        return self.commands[-1]

    def begin(self):
        """Run the oldest command."""
        self.tasks.append(self.ids.make("rasta"))
        self.commands.pop(0).finish(self.tasks[-1])


@pytest.fixture
def leds():
    return Leds()


@pytest.fixture
def proxy(serve, leds):
    return serve("ALLeds", leds)


# --- help -------------------------------------------------------------------------------------------------------------


def test_a_module_tells_what_it_is(proxy):
    assert proxy.ping() is True
    assert proxy.version().count(".") == 2
    assert proxy.getBrokerName() == "test_broker"


def test_the_methods_are_listed(proxy):
    methods = proxy.getMethodList()
    assert methods == sorted(methods)
    assert {"on", "rasta", "ping", "pCall", "wait", "exit"} <= set(methods)
    assert "fadeRGB" not in methods


def test_help_of_a_method(proxy):
    name, parameters, returns, summary = proxy.getMethodHelp("rasta")
    assert (name, parameters, returns) == ("rasta", [["duration", "float"]], "void")
    assert "green, yellow, red" in summary
    assert proxy.getUsage("on") == "void on(string name)"
    description, examples = proxy.getModuleHelp()
    assert "ALLeds" in description and examples[0][0] == "python"


@pytest.mark.parametrize("method", ["getMethodHelp", "getUsage", "pCall"])
def test_an_unknown_method_offers_the_closest(proxy, method):
    with pytest.raises(RuntimeError, match="unknown method 'rosta': did you mean 'rasta'"):
        getattr(proxy, method)("rosta")


def test_exit_takes_the_module_off_the_network(proxy, session, patience):
    # Whether the answer or the news of the end comes first is up to libqi.
    proxy.exit(_async=True).wait(int(1000 * patience))
    with pytest.raises(RuntimeError, match="ALLeds"):
        session.service("ALLeds")


def test_native_methods_of_libqi_are_left_alone(proxy):
    assert proxy.call("isStatsEnabled") is False
    assert proxy.call("isTraceEnabled") is False
    proxy.call("clearStats")


# --- posted calls -----------------------------------------------------------------------------------------------------


def test_a_posted_call_runs_until_its_task_ends(proxy, leds):
    number = proxy.pCall("rasta", 1.0)
    assert number > 0
    assert proxy.isRunning(number) is True
    leds.begin()
    assert proxy.isRunning(number) is True
    leds.tasks[0].finish()
    assert proxy.isRunning(number) is False


def test_a_posted_call_that_takes_no_time_is_over_at_once(proxy):
    number = proxy.pCall("on", "FaceLeds")
    assert proxy.isRunning(number) is False
    assert proxy.wait(number) is False


def test_posted_calls_have_numbers_of_their_own(proxy):
    numbers = [proxy.pCall("rasta", 1.0) for _ in range(5)]
    assert len(set(numbers)) == 5


@pytest.mark.parametrize("begun", [True, False])
def test_a_posted_call_can_be_stopped_before_and_after_it_began(proxy, leds, begun):
    number = proxy.pCall("rasta", 1.0)
    if begun:
        leds.begin()
        proxy.stop(number)
    else:
        proxy.stop(number)
        leds.begin()
    assert leds.tasks[0].killed
    assert proxy.isRunning(number) is False


@pytest.mark.parametrize("begun", [True, False])
def test_waiting_for_a_posted_call_ends_with_its_task(proxy, leds, patience, begun):
    number = proxy.pCall("rasta", 1.0)
    if begun:
        leds.begin()
    future = proxy.wait(number, 0, _async=True)
    proxy.ping()
    if not begun:
        leds.begin()
    assert proxy.ping() and future.isRunning()
    leds.tasks[0].finish()
    assert future.value(int(1000 * patience)) is False


def test_waiting_is_given_up_when_the_time_is_up(proxy, leds):
    number = proxy.pCall("rasta", 1.0)
    leds.begin()
    assert proxy.wait(number, 1) is True
    assert proxy.isRunning(number) is True


@pytest.mark.parametrize("method", ["isRunning", "stop", "wait"])
def test_a_number_that_was_never_given_is_refused(proxy, method):
    with pytest.raises(RuntimeError, match="no posted call has the id 4711"):
        getattr(proxy, method)(4711)


def test_calls_that_still_run_are_remembered_however_many_follow(proxy, leds):
    first = proxy.pCall("rasta", 1.0)
    leds.begin()
    over = proxy.pCall("on", "FaceLeds")
    numbers = [future.value() for future in [proxy.pCall("on", "FaceLeds", _async=True) for _ in range(REMEMBERED)]]
    assert proxy.isRunning(first) is True
    assert proxy.isRunning(max(numbers)) is False
    with pytest.raises(RuntimeError, match=f"no posted call has the id {over}"):
        proxy.isRunning(over)


def test_what_a_posted_call_gave_is_not_kept(proxy, leds):
    """A picture, for example: thousands of them would fill the memory."""

    class Large:
        pass

    picture = Large()
    kept = weakref.ref(picture)
    call_id = proxy.pCall("rasta", 1.0)
    leds.commands.pop(0).finish(picture)
    del picture
    assert kept() is None
    assert proxy.isRunning(call_id) is False and proxy.wait(call_id, 0) is False
