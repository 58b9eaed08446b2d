"""Plain classes as libqi services: signatures, errors, calls that take time, posted calls, other parts later."""

import logging
import threading

import pytest
from simulator import PATIENCE, connected

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.tasks import Task, TaskIds
from nao_sim_bridge.naoqi.binding.binding import DEFECT, Service, offered
from nao_sim_bridge.naoqi.binding.later import Later
from nao_sim_bridge.server.broker import Broker

BOOK = "Head " * 20000


class Motion:
    """Some methods of ALMotion, which remember how they were called."""

    def __init__(self):
        self.calls, self.tasks, self.commands = [], [], []
        self.ids = TaskIds()
        self.ids.ask = Task.kill

    def rest(self, *arguments):
        self.calls.append(("rest", arguments))

    def moveTo(self, *arguments):
        self.calls.append(("moveTo", arguments))
        return True

    def setAngles(self, names, angles, fraction):
        self.calls.append(("setAngles", (names, angles, fraction)))

    def getLimits(self, name):
        raise BadValue("name", name, "a joint")

    def getMass(self, name):
        return {}[name]

    def getCOM(self, *_):
        raise AttributeError("a defect")

    def getBodyNames(self, name):
        return [name, "b"]

    def wakeUp(self):
        """A task that somebody else ends."""
        self.tasks.append(self.ids.make("wakeUp"))
        return self.tasks[-1]

    def moveInit(self):
        """A command of the simulation thread, which has not run yet."""
        self.commands.append(Task("command", 0))
        return self.commands[-1]

    def run_command(self):
        """Run the oldest command, which leads to a further task."""
        self.tasks.append(self.ids.make("follow"))
        self.commands.pop(0).finish(self.tasks[-1])
        return self.tasks[-1]

    def notOfNaoqi(self):
        raise AssertionError("published though NAOqi has no such method")

    def _getRobotConfig(self):
        raise AssertionError("published though it is private")


class Battery:
    """All that ALBattery has."""

    def enablePowerMonitoring(self, enable):
        raise AssertionError("not called")

    def getBatteryCharge(self):
        return 80


@pytest.fixture(scope="module")
def broker():
    made = Broker("test_broker")
    made.listen("127.0.0.1", 0)
    yield made
    made.close()


@pytest.fixture
def served(broker):
    """Registers a service and gives a client that connects after it.

    Under load libqi refuses the calls of a client whose connection and the service were made at the same moment. New
    for each test: it must not remember what another one served under the same name.
    """
    names, clients = [], []

    def serve(name, made):
        broker.register(name, made.object)
        names.append(name)
        clients.append(connected(broker.port))
        return clients[-1]

    yield serve
    for client in clients:
        client.close()
    for name in names:
        broker.unregister(name)


@pytest.fixture
def motion():
    return Motion()


@pytest.fixture
def service(broker, motion):
    return Service("ALMotion", [motion], broker)


@pytest.fixture
def session(served, service):
    return served("ALMotion", service)


@pytest.fixture
def proxy(session):
    return session.service("ALMotion")


def begun(proxy, method, *arguments):
    """The future of a call that has arrived."""
    future = proxy.call(method, *arguments, _async=True)
    assert proxy.ping()
    return future


def ended(future):
    return future.value(int(1000 * PATIENCE))


def flat(values):
    """The single values of nested lists: floats travel as single precision, and pytest.approx takes no nests."""
    return [leaf for value in values for leaf in (flat(value) if isinstance(value, (list, tuple)) else [value])]


def test_every_overload_arrives_as_it_was_sent_and_others_are_refused(proxy, motion):
    for method, *arguments in (
        ("rest",),
        ("rest", "Arms"),
        ("moveTo", 0.5, 0.0, 1.0),
        ("moveTo", 0.5, 0.0, 1.0, [["MaxStepX", 0.02]]),
        ("moveTo", [[0.1, 0.0, 0.0], [0.2, 0.0, 0.0]]),
        ("setAngles", ["HeadYaw", "HeadPitch"], [0.5, 0.1], [0.1, 0.2]),
    ):
        getattr(proxy, method)(*arguments)
        called, arrived = motion.calls.pop()
        assert called == method and flat(arrived) == pytest.approx(flat(arguments))
    for name in (0, 1.5, True, None, [], ["HeadYaw"], {"a": 1}):
        with pytest.raises(RuntimeError, match=r"^ALMotion::getBodyNames name is .*, allowed is a text$"):
            proxy.getBodyNames(name)
    for arguments in ((), ("HeadYaw",), ("HeadYaw", 0.5), ("HeadYaw", 0.5, 0.1, 0.1), ("a", 1, "x")):
        with pytest.raises(RuntimeError, match="setAngles::.*mmf"):
            proxy.setAngles(*arguments)
    assert motion.calls == []


def test_what_is_published_is_naoqis_with_its_types_and_summaries(broker, proxy, motion):
    published = {method["name"]: method for method in proxy.metaObject()["methods"].values()}
    assert {"setAngles", "ping"} <= set(published)
    assert not {"notOfNaoqi", "_getRobotConfig", "getRobotConfig", "calls", "killAll"} & set(published)
    assert published["wakeUp"]["description"] == "stiffens the body and takes the start posture"
    assert [published[name]["returnSignature"] for name in ("rest", "getBodyNames", "getLimits")] == ["v", "[s]", "m"]
    assert proxy.getBodyNames("a") == ["a", "b"]
    answers, missing = offered("ALMotion", [motion])
    assert {"rest", "ping", "isStatsEnabled"} <= set(answers) and not set(answers) & set(missing)
    assert "killAll" in missing and "notOfNaoqi" not in [*answers, *missing]


def test_other_objects_may_take_over_the_work_of_a_module(service, proxy, motion):
    wake, posted, other = begun(proxy, "wakeUp"), proxy.pCall("wakeUp"), Motion()
    end = service.rebind([other])
    proxy.rest()
    assert (motion.calls, other.calls) == ([], [("rest", ())]) and wake.isRunning()
    with pytest.raises(RuntimeError, match=f"no posted call has the id {posted}"):
        proxy.isRunning(posted)
    end()
    assert ended(wake) is None and motion.tasks[0].killed


def test_a_module_for_later_is_made_once_by_its_first_call_and_left_unmade_by_another_one(broker, served):
    made = []

    def make():
        made.append(Battery())
        return made[-1:]

    service = Service("ALBattery", Later(make), broker)
    battery = served("ALBattery", service).service("ALBattery")
    assert "getBatteryCharge" in {method["name"] for method in battery.metaObject()["methods"].values()}
    assert made == []
    calls = [battery.call("getBatteryCharge", _async=True) for _ in range(20)]
    assert [ended(call) for call in calls] == [80] * 20 and len(made) == 1
    service.rebind(Later(make))
    assert len(made) == 1
    assert battery.getBatteryCharge() == 80 and len(made) == 2


def test_a_module_that_could_not_be_made_fails_its_call_and_is_made_by_the_next(broker, served):
    tries = []

    def make():
        tries.append(1)
        if len(tries) == 1:
            raise BadValue("battery", None, "a battery")
        return [Battery()]

    battery = served("ALBattery", Service("ALBattery", Later(make), broker)).service("ALBattery")
    with pytest.raises(RuntimeError, match="^ALBattery::getBatteryCharge battery is None, allowed is a battery"):
        battery.getBatteryCharge()
    assert battery.getBatteryCharge() == 80


def test_an_error_arrives_as_a_short_text_with_module_and_method(proxy, motion):
    for name, allowed in (("Hed", "a joint"), (BOOK, "a name of 1000 characters at most")):
        with pytest.raises(RuntimeError) as caught:
            proxy.getLimits(name)
        text = str(caught.value).strip()
        assert text.startswith(f"ALMotion::getLimits name is '{name[:3]}") and text.endswith(f"allowed is {allowed}")
        assert len(text) < 1300
    future = begun(proxy, "wakeUp")
    motion.tasks[-1].finish(error=BadValue("name", "Hed", "a joint"))
    with pytest.raises(RuntimeError, match="ALMotion::wakeUp name is 'Hed', allowed is a joint"):
        ended(future)


def test_a_defect_is_logged_with_its_place_and_what_python_says_of_its_objects_is_not_answered(proxy, motion, caplog):
    with caplog.at_level(logging.ERROR, "nao_sim.services"), pytest.raises(RuntimeError, match="getCOM a defect"):
        proxy.getCOM("Body", 0, True)
    assert "ALMotion::getCOM failed" in caplog.text and "AttributeError" in caplog.text
    with pytest.raises(RuntimeError) as caught:
        proxy.getMass("Head")
    assert str(caught.value).strip() == f"ALMotion::getMass {DEFECT}"


@pytest.mark.parametrize("when", ["command has run", "command waits"])
def test_cancelling_the_call_kills_what_it_leads_to(proxy, motion, when):
    future = begun(proxy, "moveInit")
    if when == "command has run":
        motion.run_command()
    future.cancel()
    proxy.ping()
    if when == "command waits":
        motion.run_command()
    future.wait(int(1000 * PATIENCE))
    assert motion.tasks[0].killed and future.isCanceled()


def test_a_module_tells_about_itself_and_leaves_when_it_is_told_to(proxy, session):
    assert proxy.getBrokerName() == "test_broker" and proxy.version().count(".") == 3
    methods = proxy.getMethodList()
    assert methods == sorted(methods) and {"rest", "ping", "pCall", "wait", "exit"} <= set(methods)
    assert "killAll" not in methods
    assert proxy.getMethodHelp("getLimits")[:3] == ["getLimits", [["name", "string"]], "ALValue"]
    assert proxy.getUsage("getMass") == "float getMass(string pName)"
    with pytest.raises(RuntimeError, match="unknown method 'rets': did you mean 'rest'"):
        proxy.pCall("rets")
    # Whether the answer or the news of the end comes first is up to libqi.
    proxy.exit(_async=True).wait(int(1000 * PATIENCE))
    with pytest.raises(RuntimeError, match="ALMotion"):
        session.service("ALMotion")


def test_posted_calls_have_numbers_and_run_until_their_tasks_end(proxy, motion):
    number, other = proxy.pCall("moveInit"), proxy.pCall("rest")
    assert number > 0 and number != other and not proxy.isRunning(other) and not proxy.wait(other)
    assert proxy.isRunning(number) is True
    task = motion.run_command()
    assert proxy.isRunning(number) is True and proxy.wait(number, 1) is True  # the time is up
    task.finish()
    assert proxy.isRunning(number) is False
    with pytest.raises(RuntimeError, match="no posted call has the id 4711"):
        proxy.isRunning(4711)


def test_a_posted_call_can_be_stopped_and_waited_for_before_it_began(proxy, motion):
    stopped, waited = proxy.pCall("moveInit"), proxy.pCall("moveInit")
    proxy.stop(stopped)
    future = begun(proxy, "wait", waited, 0)
    motion.run_command(), motion.run_command()
    assert motion.tasks[0].killed and proxy.isRunning(stopped) is False
    assert proxy.ping() and future.isRunning()
    motion.tasks[1].finish()
    assert ended(future) is False


def test_a_wait_that_is_cancelled_or_over_leaves_nothing_with_what_it_waited_for(proxy, motion):
    posted = proxy.pCall("wakeUp")
    threads = threading.active_count()
    waiting = [begun(proxy, "wait", posted, milliseconds) for milliseconds in (0, 1, 3600000)]
    assert threading.active_count() == threads
    assert ended(waiting[1]) is True
    for future in (waiting[0], waiting[2]):
        future.cancel()
        future.wait(int(1000 * PATIENCE))
        assert future.isCanceled()
    callbacks = motion.tasks[0]._callbacks
    assert len(callbacks) == 2, callbacks  # those of the posted call itself
