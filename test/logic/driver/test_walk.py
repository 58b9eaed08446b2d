"""Walking: commands, orders, pace, watchdog, inhibition, gaits, footsteps, feet, odometry and messages of the state."""

from __future__ import annotations

import dataclasses
import math
import threading
from concurrent.futures import Future
from types import SimpleNamespace
from unittest.mock import MagicMock, call

import pytest
from geometry_msgs.msg import Quaternion, Transform, Vector3
from hypothesis import given, settings
from hypothesis import strategies as st
from rospy import Time

from almath import Pose2D, areTwoBoxesInCollision, computeBox
from nao_library_modules.core.errors import BadGoal
from nao_library_modules.core.files import Kept
from nao_library_modules.core.geometry import Place, from_roll_pitch_yaw, product, rotate
from nao_library_modules.core.health import Level
from nao_library_modules.core.waiting import WallClock
from nao_library_modules.driver.joints import nao_joint_states as messages
from nao_library_modules.driver.joints.joint_controller import InitialStiffness
from nao_library_modules.driver.joints.joint_sensors import (
    LEG_JOINTS,
    OdometryOffset,
    Reading,
    SlopeEstimator,
    footprint,
    sole,
)
from nao_library_modules.driver.joints.planar_frames import read_transform
from nao_library_modules.driver.walk import walk_commands as commands
from nao_library_modules.driver.walk.nao_footsteps import LEFT_BOX, RIGHT_BOX, check_legs, clip, read_steps, step_target
from nao_library_modules.driver.walk.nao_walker import WalkInhibition, WalkJournal
from nao_library_modules.driver.walk.walk_commands import (
    PACE,
    REFRESH,
    FootStep,
    Mailbox,
    Order,
    Stop,
    Target,
    Velocity,
    WalkEnded,
    WalkPace,
    WalkWatchdog,
    read_gait_config,
    read_step,
)
from nao_library_modules.driver.walk.walker import Walker
from nao_library_msgs.msg import StepTarget
from naoqi.errors import NaoError

NAN, INFINITE = math.nan, math.inf
QUARTER = math.pi / 2
FORWARD, STAND = Velocity(0.5, 0.0, 0.0), Velocity(0.0, 0.0, 0.0)


def refused(words, function, *arguments, error=NaoError):
    with pytest.raises(error, match=words):
        function(*arguments)


def twist(x, y, turn):
    return SimpleNamespace(linear=SimpleNamespace(x=x, y=y, z=9.0), angular=SimpleNamespace(x=9.0, y=9.0, z=turn))


def pose(x, y, theta):
    return SimpleNamespace(x=x, y=y, theta=theta)


def test_the_watchdog_counts_from_the_last_command_also_when_the_clock_is_set_back():
    dog = WalkWatchdog(0.5)
    assert dog.left(10.0) is None
    dog.feed(10.0)
    assert dog.left(10.2) == pytest.approx(0.3) and dog.left(11.0) == pytest.approx(-0.5)
    assert dog.left(3.0) == pytest.approx(0.5) and dog.left(3.4) == pytest.approx(0.1)
    dog.rest()
    assert dog.left(3.6) is None


def test_a_velocity_is_forward_left_and_turning_and_clamped_when_out_of_range():
    assert commands.read_velocity(twist(0.5, -0.25, 1.0)) == (Velocity(0.5, -0.25, 1.0), "")
    velocity, clamped = commands.read_velocity(twist(1.5, 0.2, -3.0))
    assert velocity == Velocity(1.0, 0.2, -1.0)
    assert clamped == "linear.x is 1.5, taken as 1, angular.z is -3, taken as -1"
    assert commands.read_target(pose(1, -0.5, 3.1)) == Target(1.0, -0.5, 3.1)
    step = read_step(SimpleNamespace(leg=1, pose=pose(0.04, 0.1, 0.2)))
    assert step == FootStep("LLeg", 0.04, 0.1, 0.2)
    for read, message, field in (
        (commands.read_velocity, twist(NAN, 0, 0), "linear.x"),
        (commands.read_velocity, twist(0, 0, -INFINITE), "angular.z"),
        (commands.read_target, pose(1.0, 0.0, NAN), "pose.theta"),
        (read_step, SimpleNamespace(leg=2, pose=pose(0.0, 0.1, 0.0)), "leg"),
    ):
        with pytest.raises(BadGoal) as caught:
            read(message)
        assert caught.value.field == field
    assert Velocity(0.0009, -0.0009, 0.0).is_zero and not Velocity(0.0, 0.0, 0.0011).is_zero


def test_a_stop_is_never_left_out_and_leaves_steps_out_which_queue_up():
    box, step = Mailbox(), FootStep("LLeg", 0.02, 0.1, 0.0)
    wanted = (FORWARD, step, step, Stop(), STAND, FORWARD)
    orders = [Order(command, f"source {n}") for n, command in enumerate(wanted)]
    assert [order.halts for order in orders] == [False, False, False, True, True, False]
    for order in orders[:3]:
        box.put(order)
    assert list(iter(box.take, None)) == orders[:3]
    for order in orders:
        box.put(order)
    assert box.halts
    assert list(iter(box.take, None)) == [orders[3], orders[5]] and not box.halts and box.first is None
    assert orders[1].answer.done() and not orders[3].answer.done()
    refused("source 5 came after it", orders[4].answer.result, 0, error=WalkEnded)


def test_steps_that_wait_have_a_bound_and_a_stop_comes_through_all_the_same():
    box, step = Mailbox(), FootStep("LLeg", 0.02, 0.1, 0.0)
    orders = [Order(step, "") for _ in range(1001)]
    for order in orders:
        box.put(order)
    refused("1000 orders wait already, 1000 at most", orders[-1].answer.result, 0, error=WalkEnded)
    assert not orders[-2].answer.done()
    stops = [Order(Stop(), "") for _ in range(1002)]
    for order in stops:
        box.put(order)
    assert list(iter(box.take, None)) == stops[2:] and stops[1].answer.done() and not stops[2].answer.done()


def sent_times(velocity, period, count):
    """At which of many equal commands, one each period, the robot is told."""
    pace, times = WalkPace(), []
    for n in range(count):
        if pace.is_news(velocity, 10.0 + n * period):
            pace.sent(velocity, 10.0 + n * period)
            times.append(n * period)
    return times


def test_commands_keep_a_distance_and_lasting_ones_are_repeated_once_a_second():
    pace = WalkPace()
    assert pace.pause(10.0) <= 0.0
    pace.sent(FORWARD, 10.0)
    assert pace.pause(10.01) == pytest.approx(PACE - 0.01)
    assert pace.pause(10.0 + PACE) <= 1e-9
    assert sent_times(FORWARD, 0.02, 160) == pytest.approx([0.0, REFRESH, 2 * REFRESH, 3 * REFRESH], abs=0.021)
    assert sent_times(STAND, 0.02, 500) == [0.0]  # an idle stick
    assert sent_times(STAND, 1.5, 3) == [0.0, 1.5, 3.0]  # after a break
    pace.sent(FORWARD, 11.0)
    assert pace.is_news(STAND, 11.1) and not pace.is_news(FORWARD, 11.2)
    pace.sent(None, 11.3)
    assert pace.is_news(FORWARD, 11.4)


def test_inhibition_is_counted_and_means_the_others(tmp_path):
    kept = Kept(tmp_path / "nao_walker.json", "run")
    inhibition = WalkInhibition(kept)
    assert [inhibition.inhibit(name) for name in ("/path", "/path", "/me")] == [1, 2, 3]
    assert inhibition.against("/joystick") == ["/path", "/me"] and inhibition.against("/path") == ["/me"]
    assert (inhibition.let_go("/path"), inhibition.let_go("/path")) == (2, 1)
    assert WalkInhibition(kept).owners == ["/me"]  # of a node that was killed and started again
    assert WalkInhibition(kept, own="/me").owners == [], "a part of the same process died with it"
    assert inhibition.let_go("/rosservice_2") == 0  # whoever has no hold takes off the first
    assert inhibition.let_go("/path") == 0 and inhibition.inhibit("/path") == 1  # as clients of nao_robot call it


def test_the_report_tells_who_inhibits_and_of_failures_until_a_command_succeeds():
    journal = WalkJournal()
    journal.failed("cmd_pose", ValueError("fallen"))
    report = journal.report(0.0, "nothing", None, [], 0)
    assert (report.level, report.message) == (Level.WARN, "unknown; cmd_pose: fallen")
    journal.succeeded("moveIsActive")  # an answer to a question of the report
    assert journal.report(0.0, "nothing", False, [], 0).level == Level.WARN
    journal.succeeded("cmd_vel_srv")
    assert journal.report(10.5, "walks at (0.5, 0, 0)", True, [], 2).level == Level.OK
    journal.failed("moveIsActive", ValueError("lost"))
    journal.succeeded("moveIsActive")
    assert journal.report(0.0, "nothing", False, [], 0).level == Level.OK
    assert journal.report(0.0, "nothing", False, ["/path", "/me"], 0).message == "stands, inhibited by /path, /me"


def test_gaits_are_pairs_or_dictionaries_and_the_rest_is_told():
    for value in ([["MaxStepX", 0.03], ["StepHeight", 1]], {"MaxStepX": 0.03, "StepHeight": 1}):
        assert read_gait_config("~gait", value) == [["MaxStepX", 0.03], ["StepHeight", 1.0]]
    assert read_gait_config("~gait", ()) == []
    refused("~gait is 'MaxStepX'", read_gait_config, "~gait", "MaxStepX")
    refused("~gait.*entry 'MaxStepX'", read_gait_config, "~gait", ["MaxStepX", 0.03])
    for value in ("far", True, NAN):
        refused(f"~gait.*MaxStepX is .?{value}", read_gait_config, "~gait", [["MaxStepX", value]])


def test_the_initial_stiffness_is_a_share_and_set_once():
    joints = MagicMock()
    for share in (-0.1, 1.1, NAN, True, "fast"):
        refused("~init_stiffness is .*: 0 to 1", InitialStiffness, joints, lambda *_, share=share: share)
    for share in (0, 0.5, 1.0):
        stiffness = InitialStiffness(joints, lambda *_, share=share: share)
        stiffness.apply()
        stiffness.apply()
    assert joints.set_body_stiffness.call_args_list == [call(0.5), call(1.0)]


SIDES = pytest.mark.parametrize("leg, side", [("LLeg", 1.0), ("RLeg", -1.0)])


def test_a_step_is_the_same_there_and_back_and_the_first_that_will_not_do_is_named():
    step = FootStep("RLeg", 0.04, -0.1, 0.2)
    assert (read_step(step_target(step)), step_target(step).leg) == (step, StepTarget.right)
    good, bad = StepTarget(leg=1), StepTarget(leg=0)
    bad.pose.theta = NAN
    refused(r"footsteps\[1\]\.pose\.theta", read_steps, [good, bad], error=BadGoal)
    words = r"footsteps\[0\]\.leg: 7 is not allowed: 0 \(right\) or 1 \(left\)"
    refused(words, read_steps, [StepTarget(leg=7)], error=BadGoal)
    refused("no leg 'Left'", clip, Place(0.0, 0.1, 0.0), "Left")
    refused(r"pose\.y.*finite", clip, Place(0.0, NAN, 0.0), "LLeg")
    refused(r"footsteps\[2\]\.leg.*RLeg made the step before", check_legs, ["LLeg", "RLeg", "RLeg"])


@SIDES
def test_each_direction_has_its_limit(leg, side):
    for step, clipped in (
        ((0.04, 0.1, 0.1), (0.04, 0.1, 0.1)),
        ((0.3, 0.088, 0.0), (0.08, 0.088, 0.0)),
        ((-0.3, 0.088, 0.0), (-0.04, 0.088, 0.0)),
        ((0.0, 0.5, 0.0), (0.0, 0.16, 0.0)),
        ((0.0, -0.1, 0.0), (0.0, 0.088, 0.0)),  # on the wrong side
        ((0.0, 0.15, 2.0), (0.0, 0.15, 0.5)),
    ):
        expected = Place(clipped[0], side * clipped[1], side * clipped[2])
        assert clip(Place(step[0], side * step[1], side * step[2]), leg) == pytest.approx(expected)


@settings(max_examples=40)
@given(st.floats(-1.0, 1.0), st.floats(-0.2, 1.0), st.floats(-1.0, 1.0))
def test_clipped_steps_tread_on_no_foot_and_are_not_clipped_again(x, y, theta):
    step, moved = clip(Place(x, y, theta), "LLeg"), []
    assert clip(step, "LLeg") == pytest.approx(step, abs=1e-4)
    computeBox(LEFT_BOX, Pose2D(*step), moved)
    assert not areTwoBoxesInCollision(RIGHT_BOX, moved)
    step = clip(Place(0.08, 0.16, 0.0), "LLeg")  # far ahead and far aside at once is too far
    assert (step.x / 0.08) ** 2 + ((step.y - 0.088) / 0.072) ** 2 == pytest.approx(1.0)
    assert step.x / 0.08 == pytest.approx((step.y - 0.088) / 0.072)
    inwards, outwards = clip(Place(0.0, 0.09, -0.5), "LLeg").yaw, clip(Place(0.0, 0.09, 0.3), "LLeg").yaw
    assert -0.5 < inwards <= 0.0 and outwards > inwards + 0.2


STRAIGHT = dict.fromkeys((joint for joints in LEG_JOINTS.values() for joint in joints), 0.0)


def test_soles_of_straight_and_bent_legs_are_where_the_published_lengths_say():
    for side, y in (("L", 0.05), ("R", -0.05)):
        assert sole(side, [0.0] * 6) == pytest.approx((0.0, y, -0.33309))
        place = sole(side, [0.0, 0.0, -0.4, 0.8, -0.4, 0.0])
        assert place[0] == pytest.approx((0.1 - 0.1029) * math.sin(0.4))
        assert place[2] == pytest.approx(-0.085 - (0.1 + 0.1029) * math.cos(0.4) - 0.04519)
    left, right = (sole(side, [-0.3, 0, 0, 0, 0, 0]) for side in "LR")
    assert left == pytest.approx((right[0], -right[1], right[2])) and left[0] > 0.05  # one motor turns both legs alike


def test_the_footprint_is_level_and_lies_under_the_lower_foot():
    place, turn = footprint(STRAIGHT, 0.1, -0.2)
    tilt = from_roll_pitch_yaw(0.1, -0.2, 0.0)
    assert rotate(product(tilt, turn), (0.0, 0.0, 1.0)) == pytest.approx((0.0, 0.0, 1.0), abs=1e-12)
    assert rotate(tilt, place)[2] < -0.3
    place, _ = footprint({**STRAIGHT, **dict(zip(LEG_JOINTS["L"], (0, 0, -0.5, 1.0, -0.5, 0)))}, 0.0, 0.0)
    assert place[2] == pytest.approx(-0.33309)
    with pytest.raises(KeyError):
        footprint({"HeadYaw": 0.0}, 0.0, 0.0)


def test_the_footprint_heads_as_the_torso_however_one_foot_is_turned():
    turned = {**STRAIGHT, "LHipYawPitch": -0.6, "LHipPitch": 0.4}
    for tilt in ((0.0, 0.0), (0.1, -0.2)):
        _, turn = footprint(turned, *tilt)
        x, y, _ = rotate(product(from_roll_pitch_yaw(*tilt, 0.0), turn), (1.0, 0.0, 0.0))
        assert math.atan2(y, x) == pytest.approx(0.0, abs=1e-12)


TORSO = (1.0, 2.0, 0.33, 0.02, -0.03, QUARTER)


def moved(torso, way):
    """The torso of the robot's own odometry after a way in its own frame."""
    place = Place(torso[0], torso[1], torso[5]).then(way)
    return (place.x, place.y, *torso[2:5], place.yaw)


def corrected(offset, torso):
    place, corrected.jumps = offset.correct(torso)
    return place


@pytest.fixture
def offset():
    offset = OdometryOffset()
    assert corrected(offset, TORSO) == pytest.approx(TORSO) and corrected.jumps == 0
    return offset


def test_a_set_pose_holds_at_once_and_ways_go_on_from_there(offset):
    offset.set(Place(5.0, -1.0, 0.0))
    assert corrected(offset, TORSO) == pytest.approx((5.0, -1.0, 0.33, 0.02, -0.03, 0.0))
    after = corrected(offset, moved(TORSO, Place(0.5, 0.1, 0.2)))
    assert after == pytest.approx((5.5, -0.9, 0.33, 0.02, -0.03, 0.2)) and corrected.jumps == 1


def test_an_offset_is_told_in_the_frame_of_the_torso_and_adds_up(offset):
    offset.move_by(Place(0.5, 0.0, QUARTER))  # it looks along Y
    assert corrected(offset, TORSO) == pytest.approx((1.0, 2.5, 0.33, 0.02, -0.03, math.pi))
    offset.move_by(Place(0.5, 0.0, 0.0))
    assert corrected(offset, TORSO)[:2] == pytest.approx((0.5, 2.5))


def test_while_paused_it_stands_still_but_for_height_and_tilt(offset):
    offset.pause()
    carried = list(moved(TORSO, Place(3.0, 1.0, 1.0)))
    carried[2:5] = 0.6, 0.5, 0.4
    assert corrected(offset, carried) == pytest.approx((1.0, 2.0, 0.6, 0.5, 0.4, QUARTER))
    offset.resume()
    assert corrected(offset, carried) == pytest.approx((1.0, 2.0, 0.6, 0.5, 0.4, QUARTER))
    assert corrected(offset, moved(carried, Place(0.1, 0.0, 0.0)))[:2] == pytest.approx((1.0, 2.1))
    assert corrected.jumps == 0


def test_of_a_transform_what_lies_in_the_plane_of_the_floor_counts():
    turn = from_roll_pitch_yaw(0.1, 0.0, 0.8)
    message = Transform(Vector3(1.0, 2.0, 9.0), Quaternion(*turn))
    assert read_transform(message) == pytest.approx((1.0, 2.0, 0.8))
    message.translation.y = INFINITE
    refused(r"offset\.translation\.y", read_transform, message, error=BadGoal)
    refused(r"offset\.rotation", read_transform, Transform(), error=BadGoal)
    for change in (lambda: OdometryOffset().set(Place(0, 0, 0)), OdometryOffset().pause):
        refused("no odometry", change)  # before the first reading


def test_even_motion_has_its_speed_whatever_the_times():
    slopes = SlopeEstimator()
    assert slopes.add(0.0, [0.0, 1.0]) == [0.0, 0.0]  # the first sample tells nothing
    for time in (0.02, 0.037, 0.061, 0.08, 0.1):
        found = slopes.add(time, [0.5 * time, 1.0 - 2.0 * time])
    assert found == pytest.approx([0.5, -2.0])
    for jump in (-10.0, 20.0):  # it starts anew when time jumps
        assert slopes.add(jump, [5.0, 5.0]) == [0.0, 0.0]
    slopes.add(20.1, [7.0, 0.0])
    assert slopes.add(20.1, [6.0, 5.0]) == pytest.approx([10.0, 0.0])  # two samples of one moment are one


STAMP = Time(12, 500)
READING = Reading(
    positions=(0.5, -0.25),
    efforts=(0.1, NAN),
    roll=0.0,
    pitch=0.0,
    angular_velocity=(0.0, 0.0, 0.3),
    acceleration=(0.0, 0.0, 9.81),
    torso=(1.0, 2.0, 0.33, 0.0, 0.0, QUARTER),
)


def test_pose_and_frame_of_odometry_are_the_same_and_its_velocity_is_that_of_the_torso():
    message = messages.odometry(STAMP, "odom", "base_link", READING, (0.0, 0.1, 0.0))
    frame = messages.odometry_transform(STAMP, "odom", "base_link", READING)
    assert (message.header.frame_id, message.child_frame_id) == ("odom", "base_link")
    ahead = message.twist.twist.linear
    assert (ahead.x, ahead.y, ahead.z) == pytest.approx((0.1, 0.0, 0.0))  # it looks along Y, and goes there
    assert message.twist.twist.angular.z == 0.3
    assert frame.child_frame_id == "base_link"
    assert (frame.transform.translation.x, frame.transform.translation.y) == (1.0, 2.0)
    assert frame.transform.rotation == message.pose.pose.orientation
    assert message.pose.pose.orientation.z == pytest.approx(math.sin(QUARTER / 2))


def test_the_heading_of_the_inertial_unit_is_that_of_odometry_or_unknown():
    known = messages.imu(STAMP, "base_link", READING)
    unknown = messages.imu(STAMP, "base_link", dataclasses.replace(READING, torso=None))
    assert known.orientation.z == pytest.approx(math.sin(QUARTER / 2))
    assert unknown.orientation.w == 1.0
    assert unknown.orientation_covariance[8] > 1e3 * known.orientation_covariance[8]
    assert known.linear_acceleration.z == 9.81
    message = messages.joint_state(STAMP, ("HeadYaw", "LHand"), READING, [0.2, 0.0])
    assert (message.header.stamp, message.effort[0]) == (STAMP, 0.1)
    assert (message.name, message.position, message.velocity) == (["HeadYaw", "LHand"], (0.5, -0.25), [0.2, 0.0])


def walker_threads():
    return [thread for thread in threading.enumerate() if thread.name == "walker"]


@pytest.mark.parametrize("ordered", [False, True])
def test_a_walker_whose_node_cannot_be_made_ends_and_stops_only_a_walk_of_its_own(ordered):
    calls, before = [], walker_threads()

    def call_async(method, *arguments):
        calls.append(method)
        future = Future()
        future.set_result([1.0, 1.0] if method == "getStiffnesses" else None)
        return future

    connection = MagicMock()
    robot = SimpleNamespace(connection=connection, proxy=lambda _: SimpleNamespace(call_async=call_async))
    walker = Walker(robot, WallClock(), 0.5)
    if ordered:
        walker.order(FORWARD, "cmd_vel_srv").answer.result(60.0)
    walker.close(5.0, only_own=True)
    assert walker_threads() == before and connection.remove_listener.called
    assert ("stopMove" in calls) == ordered
