"""Which orders wait, and which are left out."""

from __future__ import annotations

import pytest

from nao_library_modules.driver.walk_commands import Step, Target, Velocity
from nao_library_modules.driver.walk_orders import Order, OrderBox, Stop, WalkEnded

FORWARD, STAND = Velocity(0.5, 0.0, 0.0), Velocity(0.0, 0.0, 0.0)
STEP = Step("LLeg", 0.02, 0.1, 0.0)


@pytest.fixture
def box():
    return OrderBox()


def put(box, *commands):
    orders = [Order(command, f"source {n}") for n, command in enumerate(commands)]
    for order in orders:
        box.put(order)
    return orders


def taken(box):
    return list(iter(box.take, None))


def test_the_newest_replaces_what_waits_and_says_so(box):
    first, second, third = put(box, FORWARD, Target(1.0, 0.0, 0.0), STAND)
    assert taken(box) == [third]
    for old, newer in ((first, 1), (second, 2)):
        with pytest.raises(WalkEnded, match=f"source {newer} came after it"):
            old.answer.result(0)


def test_steps_queue_up(box):
    orders = put(box, FORWARD, STEP, STEP)
    assert taken(box) == orders


def test_a_stop_is_never_left_out_and_leaves_steps_out(box):
    step, stop, velocity = put(box, STEP, Stop(), FORWARD)
    assert box.halts
    assert taken(box) == [stop, velocity]
    assert step.answer.done() and not stop.answer.done()
    assert not box.halts and box.first is None


def test_the_first_end_of_an_order_counts():
    order = Order(Target(1.0, 0.0, 0.0), "me")
    order.succeed()
    order.fail(ValueError())
    order.overtaken("late")
    assert order.answer.result(0) is None


@pytest.mark.parametrize("command, halts", [(Stop(), True), (STAND, True), (FORWARD, False), (STEP, False)])
def test_what_halts_the_robot(command, halts):
    assert Order(command, "me").halts is halts
