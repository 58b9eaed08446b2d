"""Plain classes as libqi services: signatures, errors, and calls that take time."""

from __future__ import annotations

import logging

import pytest

from nao_sim_bridge.services.binding import DEFECT, offered
from nao_sim_bridge.sim.errors import BadValue
from nao_sim_bridge.sim.tasks import Task, TaskIds


class Motion:
    """Some methods of ALMotion, which remember how they were called."""

    def __init__(self):
        self.calls = []
        self.tasks = []
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

    def killTask(self, task_id):
        """A command that leads to a further task."""
        command = Task("command", 0)
        self.tasks.append(self.ids.make("follow"))
        command.finish(self.tasks[-1])
        return command

    def robotIsWakeUp(self):
        """A command that somebody else ends."""
        self.tasks.append(Task("command", 0))
        return self.tasks[-1]

    def notOfNaoqi(self):
        raise AssertionError("published though NAOqi has no such method")

    def _getRobotConfig(self):
        raise AssertionError("published though it is private")


@pytest.fixture
def motion():
    return Motion()


@pytest.fixture
def proxy(serve, motion):
    return serve("ALMotion", motion)


def flat(values):
    """The single values of nested lists: floats travel as single precision, and pytest.approx takes no nests."""
    return [leaf for value in values for leaf in (flat(value) if isinstance(value, (list, tuple)) else [value])]


def published(proxy):
    """Descriptions of the methods that a client sees, by name."""
    return {method["name"]: method for method in proxy.metaObject()["methods"].values()}


# --- signatures -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "method, arguments",
    [
        ("rest", ()),
        ("rest", ("Arms",)),
        ("moveTo", (0.5, 0.0, 1.0)),
        ("moveTo", (0.5, 0.0, 1.0, 3.0)),
        ("moveTo", (0.5, 0.0, 1.0, [["MaxStepX", 0.02]])),
        ("moveTo", ([[0.1, 0.0, 0.0], [0.2, 0.0, 0.0]],)),
        ("setAngles", ("HeadYaw", 0.5, 0.1)),
        ("setAngles", (["HeadYaw", "HeadPitch"], [0.5, 0.1], 0.1)),
        ("setAngles", (["HeadYaw", "HeadPitch"], [0.5, 0.1], [0.1, 0.2])),
    ],
)
def test_every_overload_arrives_as_it_was_sent(proxy, motion, method, arguments):
    getattr(proxy, method)(*arguments)
    ((called, arrived),) = motion.calls
    assert called == method
    assert flat(arrived) == pytest.approx(flat(arguments))


@pytest.mark.parametrize("name", [0, 1.5, True, None, [], ["HeadYaw"], {"a": 1}])
def test_what_is_no_text_is_refused_where_only_texts_are_taken(proxy, name):
    with pytest.raises(RuntimeError, match=r"^ALMotion::getBodyNames name is .*, allowed is a text$"):
        proxy.getBodyNames(name)


@pytest.mark.parametrize("arguments", [(), ("HeadYaw",), ("HeadYaw", 0.5), ("HeadYaw", 0.5, 0.1, 0.1), ("a", 1, "x")])
def test_wrong_arguments_are_refused_with_the_candidates(proxy, motion, arguments):
    with pytest.raises(RuntimeError, match="setAngles::.*mmf"):
        proxy.setAngles(*arguments)
    assert motion.calls == []


def test_only_methods_of_naoqis_table_are_published(proxy):
    names = set(published(proxy))
    assert {"setAngles", "ping"} <= names
    assert not {"notOfNaoqi", "_getRobotConfig", "getRobotConfig", "calls", "moveInit"} & names


def test_methods_come_with_their_summaries(proxy):
    assert published(proxy)["wakeUp"]["description"] == "stiffens the body and takes the start posture"


def test_the_return_type_is_naoqis(proxy):
    signatures = [published(proxy)[name]["returnSignature"] for name in ("rest", "getBodyNames", "getLimits")]
    assert signatures == ["v", "[s]", "m"]
    assert proxy.getBodyNames("a") == ["a", "b"]


def test_several_objects_make_one_module(serve, motion):
    class Walk:
        def moveIsActive(self):
            return True

        def rest(self):
            raise AssertionError("the first part that has a method wins")

    proxy = serve("ALMotion", motion, Walk())
    assert proxy.moveIsActive() is True
    proxy.rest()
    assert motion.calls == [("rest", ())]


def test_what_is_offered_and_what_is_missing(motion):
    answers, missing = offered("ALMotion", [motion])
    assert {"rest", "ping", "isStatsEnabled"} <= set(answers)
    assert "moveInit" in missing and "notOfNaoqi" not in [*answers, *missing]
    assert not set(answers) & set(missing)


# --- errors -----------------------------------------------------------------------------------------------------------


def test_an_error_arrives_as_its_text_with_module_and_method(proxy):
    with pytest.raises(RuntimeError) as caught:
        proxy.getLimits("Hed")
    assert str(caught.value).strip() == "ALMotion::getLimits name is 'Hed', allowed is a joint"


def test_an_error_about_a_book_is_short(proxy, motion, patience):
    with pytest.raises(RuntimeError) as caught:
        proxy.getLimits("Head " * 20000)
    assert str(caught.value).startswith("ALMotion::getLimits name is 'Head Head")
    assert str(caught.value).strip().endswith("allowed is a joint")
    future = proxy.wakeUp(_async=True)
    proxy.ping()
    motion.tasks[0].finish(error=BadValue("name", "Head " * 20000, "a joint"))
    with pytest.raises(RuntimeError, match="allowed is a joint") as failed:
        future.value(round(patience * 1000))
    assert len(str(caught.value)) < 1300 and len(str(failed.value)) < 1300


def test_a_defect_is_logged_with_its_place_and_answered(proxy, caplog):
    with caplog.at_level(logging.ERROR, "nao_sim.services"), pytest.raises(RuntimeError, match="getCOM a defect"):
        proxy.getCOM("Body", 0, True)
    assert "ALMotion::getCOM failed" in caplog.text
    assert "AttributeError" in caplog.text


def test_what_python_says_of_its_objects_is_not_answered(proxy, motion, patience):
    with pytest.raises(RuntimeError) as caught:
        proxy.getMass("Head")
    assert str(caught.value).strip() == f"ALMotion::getMass {DEFECT}"
    future = proxy.wakeUp(_async=True)
    proxy.ping()
    motion.tasks[0].finish(error=TypeError("unhashable type: 'list'"))
    with pytest.raises(RuntimeError, match=f"^ALMotion::wakeUp {DEFECT}"):
        future.value(int(1000 * patience))


def test_a_posted_call_is_checked_like_any_other(proxy):
    for call, told in (
        ((), "method is None, allowed is the name of a method"),
        (("getLimits", 3), "name is 3, allowed is a text"),
        (("getLimits", "a", "b"), r"was called with 2 arguments, allowed is getLimits\(string name\)"),
    ):
        with pytest.raises(RuntimeError, match=f"ALMotion::pCall {told}"):
            proxy.pCall(*call)


def test_a_failed_task_arrives_as_its_error(proxy, motion, patience):
    future = proxy.wakeUp(_async=True)
    proxy.ping()
    motion.tasks[0].finish(error=BadValue("speed", -1, "above 0"))
    with pytest.raises(RuntimeError, match="ALMotion::wakeUp speed is -1, allowed is above 0"):
        future.value(int(1000 * patience))


# --- calls that take time ---------------------------------------------------------------------------------------------


def test_a_blocking_call_answers_when_its_task_ends(proxy, motion, patience):
    future = proxy.wakeUp(_async=True)
    proxy.ping()
    assert future.isRunning()
    motion.tasks[0].finish()
    assert future.value(int(1000 * patience)) is None


def test_blocking_calls_hold_up_nobody(proxy, motion, patience):
    futures = [proxy.wakeUp(_async=True) for _ in range(40)]
    assert proxy.ping() is True
    assert len(motion.tasks) == 40
    assert all(future.isRunning() for future in futures)
    for task in motion.tasks:
        task.finish()
    for future in futures:
        future.value(int(1000 * patience))


def test_a_killed_task_answers_as_if_it_had_ended(proxy, motion, patience):
    future = proxy.wakeUp(_async=True)
    proxy.ping()
    motion.tasks[0].kill()
    assert future.value(int(1000 * patience)) is None


def test_cancelling_the_call_kills_the_task(proxy, motion, patience):
    future = proxy.wakeUp(_async=True)
    proxy.ping()
    future.cancel()
    future.wait(int(1000 * patience))
    assert motion.tasks[0].killed
    assert future.isCanceled()


def test_cancelling_reaches_the_task_that_a_command_led_to(proxy, motion, patience):
    future = proxy.killTask(3, _async=True)
    proxy.ping()
    assert future.isRunning()
    future.cancel()
    future.wait(int(1000 * patience))
    assert motion.tasks[0].killed


def test_a_call_cancelled_before_its_command_ran_is_cancelled_all_the_same(proxy, motion, patience):
    future = proxy.robotIsWakeUp(_async=True)
    proxy.ping()
    future.cancel()
    proxy.ping()
    (command,) = motion.tasks
    following = motion.ids.make("follow")
    command.finish(following)
    future.wait(int(1000 * patience))
    assert following.killed
    assert future.isCanceled()
