"""Modules of this process, called by the robot."""

from __future__ import annotations

import itertools
import socket

import numpy as np
import pytest
import qi

import naoqi
from naoqi import ALBehavior, ALBroker, ALDocable, ALModule, createModule, errors

EVENT = "FrontTactilTouched"
numbers = itertools.count()


class Buttons(ALModule):
    """Listens to touches."""

    def __init__(self, name):
        ALModule.__init__(self, name)
        self.heard = []

    def on_touch(self, key, value, message):
        """Remember a touch."""
        self.heard.append((key, value, message))
        return value

    def two(self, key, value):
        self.heard.append((key, value))

    def none(self):
        self.heard.append(())

    def fails(self, key, value, message):
        raise KeyError("a callback with a fault")

    def sum_of(self, first, second=10):
        return np.float64(first + second)

    def processRemote(self, channels, frames, time, sound):
        self.heard.append((channels, frames, time, sound))

    def _hidden(self, key, value, message):
        self.heard.append("hidden")


def broker_to(robot, **options):
    return ALBroker("testBroker", "0.0.0.0", 0, *robot.address, **options)


@pytest.fixture
def broker(robot):
    broker = broker_to(robot)
    yield broker
    broker.shutdown()


@pytest.fixture
def buttons(broker):
    """A module under a name of its own: a robot may remember for a moment who had a name before."""
    return Buttons(f"Buttons{next(numbers)}")


@pytest.fixture
def raised(memory, eventually):
    """Raises the event until all answers are as expected.

    After a change of who serves a module, a robot may send an event to the one that has gone.
    """

    def until(value, answers):
        def answered():
            try:
                return memory.raiseEvent(EVENT, value) == answers
            except errors.NaoError:
                return False

        eventually(answered, f"the event is answered with {answers}")

    return until


@pytest.fixture
def memory(robot):
    memory = robot.proxy("ALMemory")
    yield memory
    for module in memory.getSubscribers(EVENT):
        memory.unsubscribeToEvent(EVENT, module)


def test_without_a_broker_the_text_says_what_to_do():
    for use in (lambda: naoqi.ALProxy("ALTest"), lambda: Buttons("Buttons")):
        with pytest.raises(errors.BrokerError, match="create ALBroker"):
            use()


def test_a_broker_tells_who_it_is(broker, buttons):
    assert broker.getName() == buttons.getBrokerName() == "testBroker"
    assert broker.getIP() == "127.0.0.1"  # loopback suffices for a robot on this computer
    assert broker.getPort() > 0
    assert broker.isModulePresent("ALMemory") and broker.isModulePresent(buttons.getName())
    assert not broker.isModulePresent("ALNothing")


def test_a_broker_without_a_robot_fails(robot):
    with pytest.raises(errors.RobotUnreachable):
        ALBroker("testBroker", "", 0, "127.0.0.1", 1)
    with pytest.raises(errors.BrokerError, match="no broker"):
        naoqi.ALProxy("ALTest")


def test_shutdown_takes_modules_and_port_back(robot, eventually):
    broker = broker_to(robot)
    Buttons("Buttons")
    port = broker.getPort()
    broker.shutdown()
    broker.shutdown()
    connection = naoqi.connection(*robot.address)
    eventually(lambda: "Buttons" not in connection.module_names(), "the robot forgets the module")
    assert broker.getPort() == 0
    with pytest.raises(OSError):
        socket.create_connection(("127.0.0.1", port), timeout=1.0)
    with pytest.raises(errors.BrokerError):
        Buttons("Buttons")


def test_a_connection_that_is_closed_shuts_its_brokers_down_first(robot):
    broker = broker_to(robot)
    Buttons("Buttons")
    naoqi.connection(*robot.address).close()
    assert broker.getPort() == 0
    with pytest.raises(errors.BrokerError, match="no broker"):
        Buttons("Buttons")


def test_events_call_the_module_in_order(buttons, memory):
    memory.subscribeToEvent(EVENT, buttons.getName(), "on_touch")
    for value in range(20):
        assert memory.raiseEvent(EVENT, value) == [value]
    assert buttons.heard == [(EVENT, value, "") for value in range(20)]
    memory.subscribeToEvent(EVENT, buttons.getName(), "head", "on_touch")
    memory.raiseEvent(EVENT, 1.0)
    assert buttons.heard[-1] == (EVENT, 1.0, "head")


def test_callbacks_may_take_fewer_arguments(buttons, memory):
    for method in ("two", "none"):
        memory.subscribeToEvent(EVENT, buttons.getName(), method)
        memory.raiseEvent(EVENT, 1.0)
    assert buttons.heard == [(EVENT, 1.0), ()]


def test_a_failing_callback_is_logged_and_kills_nothing(buttons, memory, caplog):
    memory.subscribeToEvent(EVENT, buttons.getName(), "fails")
    (answer,) = memory.raiseEvent(EVENT, 1.0)
    assert "KeyError" in answer and "in fails" in caplog.text
    memory.subscribeToEvent(EVENT, buttons.getName(), "on_touch")
    assert memory.raiseEvent(EVENT, 2.0) == [2.0]


def test_a_module_is_called_through_a_proxy_like_any_other(robot, buttons):
    proxy = robot.proxy(buttons.getName())
    assert proxy.sum_of(1, 2) == 3.0
    assert proxy.sum_of(1) == 11.0
    assert proxy.getName() == buttons.getName()
    assert "Remember a touch." in proxy.getUsage("on_touch")
    with pytest.raises(errors.RobotError, match="takes 1 to 2 arguments, 4 given"):
        proxy.sum_of(1, 2, 3, 4)
    with pytest.raises(errors.BadArguments):
        proxy.on_touch(1)
    assert not hasattr(proxy, "_hidden") and not hasattr(proxy, "exit")


def test_bind_python_serves_what_is_not_served_by_itself(buttons, memory, raised):
    memory.subscribeToEvent(EVENT, buttons.getName(), "_hidden")
    assert "error" in memory.raiseEvent(EVENT, 1.0)[0]
    buttons.BIND_PYTHON(buttons.getName(), "_hidden")
    raised(1.0, [None])
    assert buttons.heard == ["hidden"]


def test_binding_a_method_that_is_not_there_is_no_error_but_in_the_log(buttons, caplog):
    buttons.BIND_PYTHON(buttons.getName(), "on_tuch")
    assert "did you mean 'on_touch'" in caplog.text


def test_a_name_can_be_taken_only_once(robot, buttons):
    with pytest.raises(errors.BrokerError, match="already"):
        Buttons(buttons.getName())
    with pytest.raises(errors.BrokerError, match="robot has a module 'ALTest' already"):
        Buttons("ALTest")


def test_a_module_that_exits_is_gone_and_its_name_is_free(robot, buttons, memory):
    memory.subscribeToEvent(EVENT, buttons.getName(), "on_touch")
    buttons.exit()
    assert buttons.getName() not in naoqi.connection(*robot.address).module_names()
    assert len(naoqi.connection(*robot.address).subscriptions) == 0
    Buttons(buttons.getName()).exit()


class TestAfterALoss:
    @pytest.fixture
    def robot(self, fragile_robot):
        return fragile_robot

    def test_modules_and_subscriptions_come_back(
        self, robot, broker, buttons, memory, raised, states, eventually, caplog
    ):
        for event in (EVENT, "Gone"):
            memory.subscribeToEvent(event, buttons.getName(), "on_touch")
        memory.unsubscribeToEvent("Gone", buttons.getName())
        memory.subscribeToEvent("Other", "ALTest", "add")
        followed = states(broker.connection)
        robot.kill()
        followed.wait_for("lost")
        robot.start()
        followed.wait_for("lost", "connected")
        eventually(lambda: caplog.text.count("1 event subscriptions made again") == 2, "ours and the other one")
        assert f"modules registered again: {buttons.getName()}" in caplog.text
        raised(5.0, [5.0])
        assert buttons.heard == [(EVENT, 5.0, "")]
        assert memory.getSubscribers("Gone") == []
        assert memory.getSubscribers("Other") == ["ALTest"]


def test_sound_arrives_as_bytes(robot, buttons):
    """As ALAudioDevice calls it: for a parameter of any type libqi would make text of the bytes."""
    sound = bytes(range(256)) * 4
    session = qi.Session()
    session.connect(f"tcp://127.0.0.1:{robot.port}")
    try:
        session.service(buttons.getName()).call("processRemote", 4, 128, [3, 170000], sound)
    finally:
        session.close()
    assert buttons.heard == [(4, 128, [3, 170000], sound)]


class Box(ALBehavior):
    """The script of a box of Choregraphe."""

    def onInput_onStart(self):
        self.setParameter("Sum", self.session().service("ALTest").add(1, self.getParameter("Number")))
        self.onStopped()

    def onStopped(self):
        self.log("stopped")

    def onInput_onStop(self):
        self.getParentTimeline().pause()


def test_the_script_of_a_box_runs_in_a_program(robot, broker, caplog):
    box = Box("Box")
    with pytest.raises(errors.NaoError, match="box Box has no parameter 'Number'; set it by setParameter"):
        box.onInput_onStart()
    served = robot.proxy("Box")
    served.setParameter("Number", 2)
    with caplog.at_level("INFO", "Box"):
        served.onInput_onStart()
    assert served.getParameter("Sum") == 3 and "stopped" in caplog.text
    with pytest.raises(errors.NaoError, match="box Box is in no timeline"):
        box.onInput_onStop()
    assert not {"session", "log", "onLoad", "playTimeline", "BIND_PYTHON"} & set(served.getMethodList())


def test_a_bare_module_is_made_by_its_name_and_kept(robot, broker):
    assert issubclass(ALModule, ALDocable)
    createModule("Bare")
    assert robot.proxy("Bare").ping() and ALModule.getModule("Bare").getName() == "Bare"
    with pytest.raises(errors.BrokerError, match="module 'Other' does not exist in this process"):
        ALModule.getModule("Other")
