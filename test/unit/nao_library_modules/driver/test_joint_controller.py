"""What ALMotion is asked to do for messages and goals of nao_robot."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from nao_library_modules.driver.joint_controller import JointController, Reached
from nao_library_modules.errors import BadGoal
from nao_library_modules.interrupt import Interrupt


@pytest.fixture
def joints(robot):
    return JointController(robot)


@pytest.fixture
def asked(proxy):
    """The calls without those for names."""
    return lambda: [call for call in proxy.calls if call[0] != "getBodyNames"]


def trajectory(names, *points):
    return SimpleNamespace(
        joint_names=names,
        points=[SimpleNamespace(time_from_start=t, positions=p, velocities=v) for t, p, v in points],
    )


def test_angles_are_set_or_changed(joints, motion):
    joints.set_angles(["Head"], [0.5, -0.5], 0.2, relative=False)
    joints.set_angles(["HeadYaw"], [0.1], 0.2, relative=True)
    assert (motion.angles["HeadYaw"], motion.angles["HeadPitch"]) == (0.6, -0.5)


@pytest.mark.parametrize(
    "names, angles, speed, field",
    [
        (["Tail"], [0.0], 0.2, "joint_names"),
        (["Head"], [0.0, 0.0, 0.0], 0.2, "joint_angles"),
        (["Head"], [0.0], 0.0, "speed"),
        (["Head"], [0.0], 1.1, "speed"),
    ],
)
def test_wrong_angles_move_nothing(joints, asked, names, angles, speed, field):
    with pytest.raises(BadGoal) as caught:
        joints.set_angles(names, angles, speed, relative=False)
    assert caught.value.field == field
    assert asked() == []


def test_stiffnesses_have_a_range(joints, motion):
    joints.set_stiffnesses(["Body"], [0.75])
    assert set(motion.stiffnesses.values()) == {0.75}
    with pytest.raises(BadGoal, match="HeadPitch is to be 1.5: 0 to 1"):
        joints.set_stiffnesses(["Head"], [1.0, 1.5])


def test_a_trajectory_is_one_interpolation_and_tells_where_it_came(joints, motion, asked):
    frames = joints.trajectory(trajectory(["Head"], (1, [0.5, 0.1], ()), (2, [0.0, 0.2], ())), relative=True)
    motion.pending = _EndsAtOnce()
    reached = joints.follow(frames, Interrupt())
    assert asked()[0] == (
        "angleInterpolation",
        ["HeadYaw", "HeadPitch"],
        [[0.5, 0.0], [0.1, 0.2]],
        [[1.0, 2.0], [1.0, 2.0]],
        False,
    )
    assert reached == Reached([0.25, 0.25], preempted=False)


def test_velocities_make_it_a_bezier_curve_from_the_commanded_angles(joints, motion, asked):
    frames = joints.trajectory(trajectory(["HeadYaw"], (1.5, [0.5], (0.3,))), relative=True)
    motion.pending = _EndsAtOnce()
    joints.follow(frames, Interrupt())
    (_, names, use_sensors), (method, *_, points) = asked()[:2]
    assert (names, use_sensors, method) == (["HeadYaw"], False, "angleInterpolationBezier")
    assert points[0][0][0] == 0.75


def test_relative_angles_count_from_the_measured_ones(joints, motion, asked):
    motion.pending = _EndsAtOnce()
    joints.move(["Head"], [0.1, 0.2], 0.5, True, Interrupt())
    assert asked()[1] == ("angleInterpolationWithSpeed", ["HeadYaw", "HeadPitch"], [0.35, 0.45], 0.5)


def test_an_interrupt_ends_the_motion_and_tells_where_the_joints_are(joints, motion, in_thread, eventually):
    interrupt = Interrupt()
    thread, outcome = in_thread(joints.move, ["HeadYaw"], [1.0], 0.1, False, interrupt)
    eventually(lambda: motion.pending)
    motion.angles["HeadYaw"] = 0.4
    interrupt.trigger()
    thread.join(5.0)
    assert motion.pending[0].canceled
    assert outcome == [Reached([0.4], preempted=True)]


def test_a_stiffness_trajectory_must_stay_in_range(joints, motion, asked):
    with pytest.raises(BadGoal, match="HeadYaw is to be -0.1"):
        joints.stiffness_trajectory(trajectory(["HeadYaw"], (1, [-0.1], ())))
    motion.pending = _EndsAtOnce()
    frames = joints.stiffness_trajectory(trajectory(["Body"], (0.5, [1.0], ())))
    reached = joints.stiffen(frames, Interrupt())
    assert asked()[0] == (
        "stiffnessInterpolation",
        ["HeadYaw", "HeadPitch", "LHand"],
        [[1.0], [1.0], [1.0]],
        [[0.5], [0.5], [0.5]],
    )
    assert reached == Reached([0.5, 0.5, 0.5], preempted=False)


def test_a_stiffening_that_cannot_be_cancelled_stays_where_it_is(joints, motion, in_thread, eventually, asked):
    frames = joints.stiffness_trajectory(trajectory(["HeadYaw"], (9, [1.0], ())))
    interrupt = Interrupt()
    thread, outcome = in_thread(joints.stiffen, frames, interrupt)
    eventually(lambda: motion.pending)
    call = motion.pending[0]
    call.cancel = lambda: None
    interrupt.trigger()
    eventually(lambda: ("setStiffnesses", ["HeadYaw"], [0.5]) in asked())
    call.end()
    thread.join(5.0)
    assert outcome == [Reached([0.5], preempted=True)]


def test_names_are_asked_for_once_a_connection(joints, robot, proxy):
    def count():
        return sum(call == ("getBodyNames", "Body") for call in proxy.calls)

    assert set(joints.names.chains) == {"Body", "Head"}
    assert joints.names.body == ("HeadYaw", "HeadPitch", "LHand")
    assert count() == 1
    robot.connection.generation = 2
    assert joints.joints_of(["Head"]) == ("HeadYaw", "HeadPitch")
    assert count() == 2


class _EndsAtOnce(list):
    """Ends every call that is added."""

    def append(self, call):
        super().append(call)
        call.end()
