"""Orders to walk on the robot: the newest wins, a stop always gets through, commands that cease stop it."""

from __future__ import annotations

import pytest

from nao_library_modules.core.errors import BadGoal
from nao_library_modules.core.geometry import Place
from nao_library_modules.core.health import Level
from nao_library_modules.core.waiting import CancellationToken
from nao_library_modules.driver.joints.joint_controller import JointController
from nao_library_modules.driver.walk.nao_footsteps import FootstepWalk
from nao_library_modules.driver.walk.nao_walker import AFTERWARDS, DOWN, SWEEP_SPEED, UP, HeadScan
from nao_library_modules.driver.walk.naoqi_moveto import MoveToWalk, WalkGoal
from nao_library_modules.driver.walk.walk_commands import FootStep, Stop, Superseded, Target, Velocity, WalkEnded
from nao_library_modules.driver.walk.walker import Walker
from naoqi.errors import NaoError

LIMIT = 60.0
FORWARD, FASTER, STAND = Velocity(0.5, 0.0, 0.0), Velocity(1.0, 0.0, 0.0), Velocity(0.0, 0.0, 0.0)


@pytest.fixture
def standing(stiff_robot):
    """The robot, stiff, after a moment in which its feet felt the ground."""
    stiff_robot.advance(0.3)
    return stiff_robot


@pytest.fixture
def walker(standing, driver_robot, clock, closing):
    return closing(Walker(driver_robot, clock, cmd_vel_timeout=0.5), 0.5)


def done(order):
    """Wait until the order was carried out."""
    return order.answer.result(LIMIT)


def steer(walker, velocity):
    return walker.order(velocity, "cmd_vel from /stick", watched=True)


def walking(robot):
    return robot.ALMotion.moveIsActive()


def place(robot):
    return Place(*robot.ALMotion.getRobotPosition(True))


def test_velocities_go_to_the_robot_with_frequency_and_gait(walker, robot):
    ways = []
    for frequency, gait in ((1.0, []), (0.0, [["MaxStepX", 0.02]])):
        walker.frequency, walker.gait = frequency, gait
        start = place(robot)
        done(walker.order(Velocity(1.0, -0.5, 0.25), "cmd_vel_srv from /me"))
        assert str(walker.doing) == "walking at (1.00, -0.50, 0.25) of the top speed"
        robot.advance(4.0)
        ways.append(place(robot).seen_from(start))
        stop = walker.order(STAND, "cmd_vel_srv from /me")
        done(stop)
        robot.advance(2.0)
    assert ways[0].x > 0.1 and ways[0].y < -0.02 and ways[0].yaw > 0.05
    assert ways[1].x < 0.4 * ways[0].x
    assert walker.watchdog_stops == 0  # velocities of services last


def test_a_walk_whose_commands_cease_is_stopped(walker, robot, until, eventually, caplog):
    for _ in range(3):
        done(steer(walker, FORWARD))  # the same again keeps the walk alive
        robot.advance(0.4)
    assert walking(robot) and str(walker.doing) == "walking at (0.50, 0.00, 0.00) of the top speed"
    assert walker.watchdog_stops == 0
    robot.advance(0.15)
    eventually(lambda: walker.watchdog_stops == 1)
    assert "no command on cmd_vel for 0.5 s" in caplog.text
    until(lambda: not walking(robot), limit=4.0)
    done(steer(walker, FORWARD))  # and walks again when told to
    robot.advance(0.4)
    walker.gait = [["NoSuchParameter", 1.0]]
    order = walker.order(FASTER, "another")
    until(order.answer.done, limit=1.0)
    with pytest.raises(NaoError):
        done(order)
    until(lambda: not walking(robot), limit=4.0)  # what was refused leaves no older walk unwatched


def test_a_target_ends_when_the_robot_is_there(walker, robot, until):
    start = place(robot)
    order = walker.order(Target(0.1, 0.05, 0.1), "cmd_pose_srv from /me")
    until(lambda: walking(robot), limit=2.0)
    assert str(walker.doing) == "walking to (0.10 m, 0.05 m, 0.10 rad)" and not order.answer.done()
    until(order.answer.done)
    done(order)
    assert walker.doing is None
    way = place(robot).seen_from(start)
    assert (way.x, way.y, way.yaw) == pytest.approx((0.1, 0.05, 0.1), abs=0.04)


def test_a_stop_or_a_newer_command_overtakes_a_target(walker, robot, until):
    target = walker.order(Target(3.0, 0.0, 0.0), "cmd_pose_srv from /me")
    until(lambda: walking(robot), limit=2.0)
    robot.advance(1.5)
    stop = walker.order(Stop(), "stop_walk_srv from /you")
    until(lambda: walker.doing is None)
    done(steer(walker, STAND))  # which takes nothing from the stop
    until(target.answer.done)
    assert not walking(robot)
    done(stop)
    with pytest.raises(WalkEnded, match=r"walking to \(3.00 m.*stop_walk_srv from /you stopped it"):
        done(target)
    target = walker.order(Target(3.0, 0.0, 0.0), "cmd_pose from /me")
    until(lambda: walking(robot), limit=2.0)
    walker.order(FORWARD, "cmd_vel from /you")
    with pytest.raises(Superseded, match="cmd_vel from /you came after it"):
        done(target)
    robot.advance(0.3)
    assert walking(robot)


def test_a_robot_that_others_stop_on_the_way_is_told_and_left_alone(walker, robot, until):
    done(steer(walker, FORWARD))
    target = walker.order(Target(3.0, 0.0, 0.0), "cmd_pose from /me")
    until(lambda: str(walker.doing).startswith("walking to"))
    robot.advance(1.0)
    robot.post("ALMotion", "moveTo", 1.0, 0.0, 0.0)  # by another client
    robot.handed_over("ALMotion")
    with pytest.raises(WalkEnded, match="another client or a protection") as caught:
        done(target)
    assert not isinstance(caught.value, Superseded)
    robot.advance(1.0)
    assert walking(robot) and walker.watchdog_stops == 0


def test_steps_queue_up_and_can_be_waited_for_or_stopped(walker, robot, until):
    start = place(robot)
    done(walker.order(FootStep("LLeg", 0.04, 0.1, 0.0), "cmd_step from /me"))
    last = walker.order(FootStep("RLeg", 0.04, -0.1, 0.0), "cmd_step_srv from /me", to_the_end=True)
    robot.settled()
    assert not last.answer.done()
    until(last.answer.done)
    done(last)
    assert not walking(robot) and place(robot).seen_from(start).x > 0.02
    stopped = walker.order(FootStep("LLeg", 0.02, 0.1, 0.0), "cmd_step_srv from /me", to_the_end=True)
    until(lambda: walking(robot), limit=2.0)
    stop = walker.order(Stop(), "stop_walk_srv from /you")
    until(stop.answer.done)
    with pytest.raises(WalkEnded, match="stop_walk_srv from /you stopped it"):
        done(stopped)


def test_what_the_robot_refuses_is_told_and_not_repeated_with_every_message(walker, robot):
    done(walker.order(FORWARD, "cmd_vel_srv from /me"))
    robot.ALMotion.killMove()  # not by this walker, for which it walks
    robot.ALMotion.setStiffnesses("Body", 0.0)
    for order in (Target(1.0, 0.0, 0.0), FORWARD, FORWARD):
        with pytest.raises(NaoError, match="the legs are limp: wakeUp first"):
            done(walker.order(order, "a service of /me"))  # a velocity of a service is always sent
    for _ in range(3):
        done(steer(walker, FORWARD))  # of a stream it was
    assert not walking(robot)
    robot.ALMotion.setStiffnesses("Body", 1.0)
    done(walker.order(FORWARD, "cmd_vel_srv from /me"))
    assert walking(robot)


def test_the_pose_for_walking_comes_first_and_once_and_a_stop_interrupts_it(walker, robot, until):
    walker.needs_walk_pose = True
    order = steer(walker, FORWARD)
    robot.advance(0.1)
    stop = walker.order(Stop(), "stop")
    until(stop.answer.done, limit=2.0)
    with pytest.raises(WalkEnded, match="order to stand"):
        done(order)
    assert walker.needs_walk_pose and not walking(robot)
    order = steer(walker, FORWARD)
    until(order.answer.done, limit=4.0)
    done(order)
    assert walking(robot) and not walker.needs_walk_pose


def test_without_a_limit_a_velocity_lasts_until_the_end_which_takes_no_orders(standing, driver_robot, clock, until):
    walker = Walker(driver_robot, clock, cmd_vel_timeout=0.0)
    done(steer(walker, FORWARD))
    standing.advance(2.0)
    assert walking(standing)
    walker.close(0.1)
    until(lambda: not walking(standing), limit=4.0)
    with pytest.raises(WalkEnded, match="the node ends"):
        done(steer(walker, FORWARD))


STEPS = [FootStep(leg, 0.04, side * 0.1, 0.0) for leg, side in (("LLeg", 1), ("RLeg", -1), ("LLeg", 1), ("RLeg", -1))]


@pytest.fixture
def footsteps(standing, driver_robot, clock):
    return FootstepWalk(driver_robot, clock)


def test_footsteps_that_end_too_early_are_told_and_single_ones_are_added_to_those_before(
    footsteps, robot, driver_robot, until, begin
):
    walk = begin(footsteps.walk, STEPS * 2, 0.25, CancellationToken(), lambda made: None)
    until(lambda: walking(robot), limit=2.0)
    stop = robot.post("ALMotion", "stopMove")
    until(walk.done)
    robot.answer(stop)
    with pytest.raises(NaoError, match="ended after . of 8 steps"):
        walk.result()
    footsteps.add(STEPS[0])
    made = begin(footsteps.make, STEPS[1])
    robot.advance(0.3)
    assert not made.done()
    until(made.done)
    made.result()
    assert not walking(robot)


def test_sequences_are_of_left_and_right_in_turn_and_refusals_are_told(footsteps, robot):
    with pytest.raises(BadGoal, match="one step at least"):
        footsteps.prepared([])
    with pytest.raises(BadGoal, match=r"footsteps\[1\]\.leg"):
        footsteps.prepared([STEPS[0], STEPS[0]])
    robot.ALMotion.setStiffnesses("Body", 0.0)
    with pytest.raises(NaoError, match="the legs are limp: wakeUp first"):
        footsteps.walk(STEPS, 0.25, CancellationToken(), lambda made: None)


@pytest.fixture
def moving(standing, driver_robot, closing):
    return closing(MoveToWalk(driver_robot))


def goal(name, *way):
    return WalkGoal(name, lambda: Place(*way))


def test_a_goal_is_walked_to_and_a_new_one_takes_over_without_a_stop(moving, robot, until, eventually):
    assert moving.report().message == "no goal yet"
    moving.go(goal("door", 1.0, 0.5, 0.25))
    eventually(lambda: "walks to door: 1.00 m ahead, 0.50 m left" in moving.report().message)
    robot.advance(1.0)
    start = place(robot)
    moving.go(goal("window", 0.05, 0.0, 0.0))
    eventually(lambda: "walks to window" in moving.report().message)
    assert walking(robot)
    until(lambda: "window is reached" in moving.report().message)
    assert moving.report().level == Level.OK
    assert place(robot).seen_from(start).x == pytest.approx(0.05, abs=0.05)


def test_a_walk_that_is_cancelled_or_stopped_by_others_is_told(moving, robot, until, eventually):
    for stop, words, level in (
        (moving.cancel, "was stopped", Level.OK),
        (lambda: robot.post("ALMotion", "stopMove"), "door was not reached", Level.WARN),
    ):
        moving.go(goal("door", 1.0, 0.0, 0.0))
        eventually(lambda: "walks to door" in moving.report().message)
        robot.advance(0.5)
        stop()
        until(lambda words=words: words in moving.report().message)
        assert moving.report().level == level
        until(lambda: not walking(robot))
    robot.ALMotion.setStiffnesses("Body", 0.0)
    moving.go(goal("window", 1.0, 0.0, 0.0))
    eventually(lambda: "window: " in moving.report().message and "limp" in moving.report().message)
    assert moving.report().level == Level.ERROR


@pytest.fixture
def scan(standing, driver_robot, closing):
    return closing(HeadScan(JointController(driver_robot), 0.2))


def test_a_head_scan_sweeps_evenly_from_the_ground_to_the_sky(scan, robot, begin, until):
    pitch = lambda: robot.ALMotion.getAngles("HeadPitch", True)[0]  # noqa: E731
    running = begin(scan.run)
    until(lambda: pitch() > DOWN - 0.01)
    started, samples = robot.now.time, []
    until(lambda: samples.append((robot.now.time - started, pitch())) or samples[-1][1] < UP + 0.01, 25.0)
    (began, down), (ended, up) = samples[0], samples[-1]
    assert (down - up) / (ended - began) == pytest.approx(SWEEP_SPEED, rel=0.08)
    half = next(angle for time, angle in samples if time > (began + ended) / 2.0)
    assert half == pytest.approx((down + up) / 2.0, abs=0.05)
    with pytest.raises(NaoError, match="a head scan is under way"):
        scan.run()
    until(running.done)
    assert running.result() is None and not scan.active and pitch() == pytest.approx(AFTERWARDS, abs=0.02)


def test_a_head_scan_ends_with_the_node(scan, robot, begin, until):
    running = begin(scan.run)
    until(lambda: robot.ALMotion.getAngles("HeadPitch", True)[0] > 0.2)
    scan.close()
    until(running.done)
    with pytest.raises(NaoError, match="the head scan was stopped: the node ends"):
        running.result()
    assert not scan.active
