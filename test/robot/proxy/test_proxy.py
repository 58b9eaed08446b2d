"""Remote modules through ALProxy, against a real libqi server."""

from __future__ import annotations

import pytest

import naoqi
from naoqi import errors


def test_a_remote_method_is_an_attribute(proxy):
    assert proxy.add(1, 2) == 3
    assert proxy.call("add", "a", "b") == "ab"


def test_overloads_are_found_by_the_number_of_arguments(proxy):
    assert proxy.setColor("Face", 1.0, 0.0, 0.0) is None
    assert proxy.setColor("Face", "red") is None
    with pytest.raises(errors.BadArguments):
        proxy.setColor("Face")


@pytest.mark.parametrize("value", [None, True, -3, "grün", [[0.5], [1.0, 2.0]], {"a": 1}])
def test_values_make_the_round_trip(proxy, value):
    assert proxy.echo(value) == value


def test_raw_data_arrive_as_bytes(proxy):
    assert proxy.raw() == bytes(range(256))
    image = proxy.image()
    assert image[4] == b"\xff\x00\x80\x01\x02\x03"
    assert type(image[4]) is bytes
    assert proxy.sizeOfRaw(b"\xff\x00\xfe") == 3


def test_unknown_method_is_named_with_what_comes_close(proxy):
    with pytest.raises(errors.UnknownMethod, match="did you mean 'setIntensity'") as caught:
        proxy.setIntensty("Face", 1.0)
    assert caught.value.closest == ["setIntensity"]
    assert "fails" in caught.value.methods
    with pytest.raises(errors.UnknownMethod):
        proxy.post.setIntensty("Face", 1.0)


def test_unknown_module_is_named_with_what_comes_close(robot):
    with pytest.raises(errors.UnknownModule, match="did you mean 'ALMemory'") as caught:
        robot.proxy("ALMemori")
    assert "ALTest" in caught.value.modules


def test_bad_arguments_are_shown_with_what_is_allowed(proxy):
    with pytest.raises(errors.BadArguments) as caught:
        proxy.setIntensity("Face")
    assert caught.value.signatures == ["setIntensity(string, float)"]
    assert caught.value.__cause__ is not None


@pytest.mark.parametrize("value", [object(), 2**63])
def test_what_cannot_travel_is_refused_and_nothing_breaks(proxy, value):
    with pytest.raises(errors.BadArguments):
        proxy.echo(value)
    assert proxy.echo(1) == 1


def test_errors_of_a_service_carry_its_text(proxy):
    with pytest.raises(errors.RobotError) as caught:
        proxy.fails()
    assert (caught.value.kind, caught.value.text) == ("ValueError", "too hot: 81 degrees")


def test_a_time_limit_ends_the_call_on_both_sides(robot, eventually):
    hasty = robot.proxy(timeout=0.05)
    before = hasty.cancellations()
    with pytest.raises(errors.CallTimeout, match="0.05 s"):
        hasty.begin()
    eventually(lambda: hasty.cancellations() == before + 1, "the robot hears of the cancellation")


def test_what_a_module_lacks_is_derived_from_its_description(proxy):
    assert proxy.ping() is True
    assert len(proxy.getMethodList()) == len(set(proxy.getMethodList()))
    assert proxy.getMethodHelp("setIntensity")[:3] == ["setIntensity", [["string", ""], ["float", ""]], "nothing"]
    assert "setColor(string, string) -> nothing" in proxy.getUsage("setColor").splitlines()
    assert "Add two numbers." in proxy.getUsage("add")


def test_a_module_that_left_and_came_back_is_found_again(robot, eventually):
    switch = robot.proxy("Switch")
    switch.arrive("Visitor")
    visitor = robot.proxy("Visitor")
    assert visitor.add(1, 1) == 2
    switch.leave("Visitor")
    eventually(lambda: not _is_lost(visitor), "the news that the module has left is there")
    with pytest.raises(errors.UnknownModule):
        visitor.add(1, 1)
    switch.arrive("Visitor")
    assert visitor.add(1, 1) == 2
    assert visitor.call_async("add", 2, 2).result() == 4
    switch.leave("Visitor")


def _is_lost(proxy):
    """Whether a call has crossed the news that its module has left, and is lost with it."""
    try:
        return bool(proxy.add(1, 1))
    except errors.ConnectionLost:
        return True
    except errors.UnknownModule:
        return False


@pytest.mark.parametrize("arguments", [("",), (None,), ("X", ""), ("X", "nao", 0), ("X", "nao", "9559")])
def test_senseless_addresses_are_refused(arguments):
    with pytest.raises(errors.BadArguments):
        naoqi.ALProxy(*arguments)


def test_proxies_to_one_robot_share_one_connection(robot):
    assert robot.proxy().connection is robot.proxy("ALMemory").connection
    assert robot.proxy().connection is naoqi.connection(*robot.address)
