"""How orders to walk reach the robot: the newest wins, a stop always gets through, commands that cease stop it."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from types import SimpleNamespace

import fake_walk
import pytest
from fake_proxy import FakeProxy
from fake_robot import FakeConnection
from set_clock import SetClock

from nao_library_modules.driver.walk_commands import Step, Target, Velocity
from nao_library_modules.driver.walk_orders import Overtaken, Stop, WalkEnded
from nao_library_modules.driver.walker import Walker
from naoqi.errors import ConnectionLost, NaoError, RobotError, RobotUnreachable

LIMIT = 5.0
FORWARD, FASTER, STAND = Velocity(0.5, 0.0, 0.0), Velocity(1.0, 0.0, 0.0), Velocity(0.0, 0.0, 0.0)
STOP = Stop()
LOST = RobotUnreachable("nao", 9559, "connection lost")


@pytest.fixture
def walk(make_call):
    return fake_walk.FakeWalk(make_call)


@pytest.fixture
def proxy(walk, make_call):
    return FakeProxy(walk, make_call)


@pytest.fixture
def robot(proxy):
    return SimpleNamespace(address="nao:9559", connection=FakeConnection(), proxy={"ALMotion": proxy}.__getitem__)


@pytest.fixture
def clock():
    return SetClock()


@pytest.fixture
def walker(robot, clock):
    walker = Walker(robot, clock, cmd_vel_timeout=0.5)
    yield walker
    walker.close(1.0)


def done(order):
    """Wait until the order was carried out."""
    return order.answer.result(LIMIT)


def steer(walker, velocity):
    return walker.order(velocity, "cmd_vel from /stick", watched=True)


def methods(proxy):
    return [call[0] for call in proxy.calls]


def test_a_velocity_goes_to_the_robot_with_frequency_and_gait(walker, proxy):
    walker.frequency, walker.gait = 0.25, [["StepHeight", 0.03]]
    done(steer(walker, Velocity(0.5, -0.25, 0.125)))
    config = [["Frequency", 0.25], ["StepHeight", 0.03]]
    assert proxy.calls == [("moveToward", 0.5, -0.25, 0.125, config)]
    assert walker.doing == "walking at (0.50, -0.25, 0.12) of the top speed"


def test_the_same_velocity_is_sent_once_and_a_change_at_once(walker, proxy):
    for _ in range(20):
        done(steer(walker, FORWARD))
    done(steer(walker, STAND))
    done(steer(walker, STAND))
    assert [call[1] for call in proxy.calls] == [0.5, 0.0]


def test_many_velocities_at_once_become_a_few_calls_and_the_last_one_counts(walker, proxy):
    orders = [steer(walker, Velocity(n / 100.0, 0.0, 0.0)) for n in range(1, 101)]
    done(orders[-1])
    assert proxy.calls[-1][1] == 1.0
    assert len(proxy.calls) <= 5
    assert all(order.answer.done() for order in orders)


def test_a_robot_that_is_slow_gets_only_the_newest(walker, proxy, walk, make_call, eventually):
    slow = make_call()
    walk.moveToward = lambda *_: slow
    first = steer(walker, FORWARD)
    eventually(lambda: proxy.calls)
    overtaken = [steer(walker, Velocity(n / 100.0, 0.0, 0.0)) for n in range(10, 90)]
    last = steer(walker, FASTER)
    slow.end()
    done(first)
    done(last)
    assert [call[1] for call in proxy.calls] == [0.5, 1.0]
    assert all(isinstance(order.answer.exception(LIMIT), Overtaken) for order in overtaken)


def test_a_walk_whose_commands_cease_is_stopped(walker, proxy, clock, walk, eventually, caplog):
    done(steer(walker, FORWARD))
    clock.advance(0.4)
    done(steer(walker, FORWARD))  # the same again: it keeps the walk alive
    clock.advance(0.4)
    assert walk.walking
    clock.advance(0.15)
    eventually(lambda: not walk.walking)
    assert methods(proxy) == ["moveToward", "stopMove", "waitUntilMoveIsFinished"]
    assert walker.watchdog_stops == 1
    assert "no command on cmd_vel for 0.5 s" in caplog.text
    done(steer(walker, FORWARD))  # and walks again when told to
    assert walk.walking


@pytest.mark.parametrize("end", [STAND, STOP, Target(1.0, 0.0, 0.0)])
def test_after_another_command_nothing_has_to_be_renewed(walker, clock, walk, end):
    done(steer(walker, FORWARD))
    order = walker.order(end, "another")
    if not isinstance(end, Target):
        done(order)
    done(walker.order(Step("LLeg", 0.02, 0.1, 0.0), "step"))
    clock.advance(10.0)
    done(walker.order(Step("RLeg", 0.02, -0.1, 0.0), "step"))  # the thread has looked at the time before
    assert walker.watchdog_stops == 0
    assert walk.walking


def test_velocities_of_services_and_without_a_limit_last(robot, clock, walk):
    walker = Walker(robot, clock, cmd_vel_timeout=0.0)
    done(steer(walker, FORWARD))
    clock.advance(60.0)
    assert walk.walking
    walker.close(1.0)
    walker = Walker(robot, clock, cmd_vel_timeout=0.5)
    done(walker.order(FASTER, "cmd_vel_srv from /me"))
    clock.advance(60.0)
    done(walker.order(Step("LLeg", 0.02, 0.1, 0.0), "step"))
    assert (walk.walking, walker.watchdog_stops) == (True, 0)
    walker.close(1.0)


def test_a_target_ends_when_the_robot_is_there(walker, walk, proxy, eventually):
    walker.gait = [["MaxStepX", 0.03]]
    order = walker.order(Target(1.0, 0.5, 0.1), "cmd_pose_srv from /me")
    eventually(lambda: walk.walks)
    assert proxy.calls == [("moveTo", 1.0, 0.5, 0.1, [["MaxStepX", 0.03]])]
    assert walker.doing == "walking to (1.00 m, 0.50 m, 0.10 rad)"
    assert not order.answer.done()
    walk.arrive()
    done(order)
    assert walker.doing == "nothing"


def test_a_stop_overtakes_a_target_and_both_end_with_the_robot_standing(walker, walk, eventually):
    walk.holds.add("stopMove")
    target = walker.order(Target(3.0, 0.0, 0.0), "cmd_pose_srv from /me")
    eventually(lambda: walk.walks)
    stop = walker.order(STOP, "stop_walk_srv from /you")
    eventually(lambda: walk.pending)
    assert not target.answer.done() and not stop.answer.done()
    walk._stand()
    walk.pending.pop().end(True)
    done(stop)
    with pytest.raises(WalkEnded, match=r"walking to \(3.00 m.*stop_walk_srv from /you stopped it"):
        done(target)


@pytest.mark.parametrize("newer", [FORWARD, Target(0.2, 0.0, 0.0)])
def test_a_newer_command_replaces_a_target(walker, walk, newer, eventually):
    target = walker.order(Target(3.0, 0.0, 0.0), "cmd_pose from /me")
    eventually(lambda: walk.walks)
    walker.order(newer, "cmd_vel from /you")
    with pytest.raises(Overtaken, match="cmd_vel from /you came after it"):
        done(target)
    assert walk.walking


def test_a_robot_that_stops_on_the_way_is_told(walker, walk, eventually):
    target = walker.order(Target(3.0, 0.0, 0.0), "cmd_pose from /me")
    eventually(lambda: walk.walks)
    walk._stand()
    with pytest.raises(WalkEnded, match="another client or a protection") as caught:
        done(target)
    assert not isinstance(caught.value, Overtaken)


def test_steps_queue_up_and_can_be_waited_for(walker, walk, proxy, eventually):
    steps = [Step("LLeg", 0.02, 0.1, 0.0), Step("RLeg", 0.03, -0.1, 0.1)]
    done(walker.order(steps[0], "cmd_step from /me"))
    last = walker.order(steps[1], "cmd_step_srv from /me", to_the_end=True)
    eventually(lambda: walk.waits)
    assert proxy.calls[:2] == [
        ("setFootSteps", ["LLeg"], [[0.02, 0.1, 0.0]], [0.5], False),
        ("setFootSteps", ["RLeg"], [[0.03, -0.1, 0.1]], [0.5], False),
    ]
    assert not last.answer.done()
    walk.arrive()
    done(last)


def test_a_step_that_is_stopped_was_not_made(walker, walk, eventually):
    step = walker.order(Step("LLeg", 0.02, 0.1, 0.0), "cmd_step_srv from /me", to_the_end=True)
    eventually(lambda: walk.waits)
    done(walker.order(STOP, "stop_walk_srv from /you"))
    with pytest.raises(WalkEnded, match="stop_walk_srv from /you stopped it"):
        done(step)


def test_what_the_robot_refuses_is_told_and_not_repeated_with_every_message(walker, walk, proxy):
    walk.limp = True
    with pytest.raises(RobotError, match=fake_walk.LIMP):
        done(steer(walker, FORWARD))
    for _ in range(10):
        done(steer(walker, FORWARD))
    assert len(proxy.calls) == 1
    with pytest.raises(RobotError, match=fake_walk.LIMP):
        done(walker.order(Target(1.0, 0.0, 0.0), "cmd_pose_srv from /me"))


@pytest.mark.parametrize("refused", [Target(1.0, 0.0, 0.0), Step("LLeg", 0.02, 0.1, 0.0), FASTER])
def test_a_command_that_is_refused_leaves_no_older_walk_unwatched(walker, walk, eventually, refused):
    done(steer(walker, FORWARD))
    walk.limp = True
    with pytest.raises(RobotError):
        done(walker.order(refused, "another"))
    eventually(lambda: not walk.walking)


def test_a_target_that_others_end_does_not_stop_what_they_do(walker, walk, proxy, eventually):
    done(steer(walker, FORWARD))
    target = walker.order(Target(3.0, 0.0, 0.0), "cmd_pose from /me")
    eventually(lambda: walk.walks)
    walk.moveTo(1.0, 0.0, 0.0)  # by another client
    with pytest.raises(WalkEnded):
        done(target)
    done(walker.order(Step("LLeg", 0.02, 0.1, 0.0), "step"))
    assert "stopMove" not in methods(proxy)


def test_a_velocity_of_a_service_is_always_sent(walker, walk):
    walk.limp = True
    for _ in range(2):
        with pytest.raises(RobotError, match=fake_walk.LIMP):
            done(walker.order(FORWARD, "cmd_vel_srv from /me"))
    walk.limp = False
    done(walker.order(FORWARD, "cmd_vel_srv from /me"))
    assert walk.walking


def test_the_pose_for_walking_comes_first_and_once(walker, walk, proxy):
    walker.needs_walk_pose = True
    done(steer(walker, FORWARD))
    done(walker.order(STOP, "stop"))
    done(steer(walker, FORWARD))
    assert methods(proxy).count("moveInit") == 1
    assert methods(proxy)[:2] == ["moveInit", "moveToward"]


def test_a_stop_interrupts_the_pose_for_walking(walker, walk, proxy, eventually):
    walker.needs_walk_pose = True
    walk.holds.add("moveInit")
    order = steer(walker, FORWARD)
    eventually(lambda: walk.pending)
    done(walker.order(STOP, "stop"))
    assert walk.pending[0].canceled
    with pytest.raises(WalkEnded, match="order to stand"):
        done(order)
    assert "moveToward" not in methods(proxy)
    assert walker.needs_walk_pose


def test_a_stop_that_did_not_reach_the_robot_is_sent_when_it_is_back(
    walker, walk, proxy, robot, clock, caplog, eventually
):
    done(steer(walker, FORWARD))
    proxy.lost = LOST
    robot.connection.become("lost")
    clock.advance(0.6)
    eventually(lambda: "cannot be stopped" in caplog.text)
    assert walk.walking
    proxy.lost = None
    robot.connection.become("connected")
    eventually(lambda: not walk.walking)


def test_nothing_is_sent_to_a_robot_that_comes_back_and_owes_nothing(walker, walk, proxy, robot):
    proxy.lost = LOST
    robot.connection.become("lost")
    with pytest.raises(RobotUnreachable):
        done(steer(walker, FORWARD))
    proxy.lost = None
    robot.connection.become("connected")
    done(walker.order(Step("LLeg", 0.02, 0.1, 0.0), "step"))
    assert methods(proxy) == ["setFootSteps"]


def test_a_walk_ends_with_an_error_when_the_connection_breaks(walker, walk, eventually):
    target = walker.order(Target(3.0, 0.0, 0.0), "cmd_pose_srv from /me")
    eventually(lambda: walk.walks)
    walk.walks[0].end(error=ConnectionLost("nao", 9559, "broken", "ALMotion.moveTo"))
    with pytest.raises(ConnectionLost):
        done(target)
    assert walker.doing == "nothing"


def test_the_end_stops_the_walk_and_takes_no_orders(robot, clock, walk):
    walker = Walker(robot, clock, cmd_vel_timeout=0.5)
    done(steer(walker, FORWARD))
    walker.close(LIMIT)
    assert not walk.walking
    assert robot.connection.listeners == []
    with pytest.raises(WalkEnded, match="the node ends"):
        done(steer(walker, FORWARD))


def test_the_end_does_not_wait_for_a_robot_that_is_lost(robot, clock, walk, proxy, caplog):
    walker = Walker(robot, clock, cmd_vel_timeout=0.5)
    proxy.lost = LOST
    walker.close(LIMIT)
    assert "connection lost" in caplog.text


def test_orders_of_many_threads_all_end(walker, walk):
    commands = [FORWARD, FASTER, STAND, STOP, Step("LLeg", 0.02, 0.1, 0.0), Target(0.1, 0.0, 0.0)]

    def order(n):
        return walker.order(commands[n % len(commands)], f"thread {n}", watched=True)

    with ThreadPoolExecutor(8) as pool:
        orders = list(pool.map(order, range(300)))
    done(walker.order(STOP, "the last one"))
    assert not walk.walking
    for one in orders:
        error = one.answer.exception(LIMIT)
        assert error is None or isinstance(error, NaoError)
