"""Angles, trajectories, poses and stiffness: where the joints go, what is refused, how motions end."""

import pytest
from genpy import Duration
from goal_functions import motion as f
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

NEAR = 0.03
"""What a joint under load may be off its target, rad."""
YAW = {"names": ["HeadYaw"], "stiffness": 1.0}


def lasted(seconds):
    """A time that something took, with what the way of a call takes on a busy computer, s."""
    return pytest.approx(seconds + 0.35, abs=0.45)


def trajectory(*points, joints=("HeadYaw",)):
    points = [
        JointTrajectoryPoint(positions=p, velocities=v, accelerations=sum(a, []), time_from_start=Duration.from_sec(t))
        for t, p, v, *a in points
    ]
    return JointTrajectory(joint_names=list(joints), points=points)


@pytest.fixture
def at(angle):
    """Joints of a result are named, and are where they should be, as told and as measured."""

    def check(result, **angles):
        told = dict(zip(result.name, result.position))
        for joint, wanted in angles.items():
            assert told[joint] == pytest.approx(wanted, abs=NEAR), joint
            assert angle(joint) == pytest.approx(wanted, abs=NEAR), joint

    return check


def test_angles_go_out_change_and_come_back(stiff_robot, motion, at, angle):
    result = motion.succeed(f("setAngles", 1.0, names=["Head"], angles=[0.5, 0.2]), f("getAngles", names=["HeadPitch"]))
    at(result, HeadYaw=0.5, HeadPitch=0.2)
    at(motion.succeed(f("changeAngles", 1.0, names=["HeadYaw"], angles=[-0.2])), HeadYaw=0.3)
    at(motion.succeed(f("setAngles", 1.0, names=["Head"], angles=[0.1], relative=True)), HeadYaw=0.4, HeadPitch=0.3)
    at(motion.succeed(f("setAngles", 1.0, names=["HeadPitch", "HeadYaw"], angles=[0.0])), HeadYaw=0.0, HeadPitch=0.0)
    motion.succeed(f("setAngles", names=["HeadYaw"], angles=[1.0], speed=0.05))
    told = motion.succeed(f("getAngles", 1.0, names=["HeadYaw"], commanded=True), f("getAngles", names=["HeadPitch"]))
    assert told.position == pytest.approx([float(result.values[0]) for result in told.results])
    assert 0.0 <= told.position[0] < angle("HeadYaw") - 0.2, "as it was told when it was asked, a second ago"
    after = motion.succeed(f("getAngles", names=["HeadYaw"]), f("setAngles", 1.0, names=["HeadYaw"], angles=[0.0]))
    at(after, HeadYaw=0.0)


def test_joints_turn_at_shares_of_their_top_speeds(stiff_robot, motion, angle):
    motion.succeed(f("setAngles", names=["Head"], angles=[1.5, 0.5], speeds=[0.02, 0.05]))
    stiff_robot.advance(0.3)
    before = angle("HeadYaw"), angle("HeadPitch")
    stiff_robot.advance(0.5)
    for joint, start, share in zip(("HeadYaw", "HeadPitch"), before, (0.02, 0.05)):
        top = stiff_robot.ALMotion.getLimits(joint)[0][2]
        assert angle(joint) - start == pytest.approx(0.5 * share * top, rel=0.15), joint


def test_interpolations_go_through_their_keys_joint_by_joint_in_their_time(robot, motion, angle, at):
    goal = motion.send(
        f("angleInterpolation", names=["Head"], angles=[0.6, 0.0, 0.2, 0.1], times=[1, 2], stiffness=1.0)
    )
    robot.advance_until(lambda: angle("HeadYaw") > 0.55, 2.0)
    assert angle("HeadPitch") == pytest.approx(0.2, abs=0.05)
    goal.finish()
    assert goal.result.results[0].elapsed.to_sec() == lasted(2.0)
    at(goal.result, HeadYaw=0.0, HeadPitch=0.1)
    at(motion.succeed(f("angleInterpolation", names=["HeadYaw"], angles=[0.3], times=[1.0])), HeadYaw=0.3)
    at(
        motion.succeed(f("angleInterpolation", names=["HeadYaw"], angles=[0.2], times=[1.0], relative=True)),
        HeadYaw=0.5,
    )
    result = motion.succeed(f("angleInterpolationWithSpeed", names=["HeadYaw"], angles=[-0.6], speed=0.1))
    at(result, HeadYaw=-0.6)
    assert result.results[0].elapsed.to_sec() == pytest.approx(1.1 / (0.1 * 8.27), abs=0.4)


def test_trajectories_with_and_without_velocities(robot, motion, angle, at):
    goal = motion.send(
        f("setTrajectory", trajectory=trajectory((1.0, [0.3], [0.4]), (2.0, [0.5], [0.0])), stiffness=1.0)
    )
    robot.advance_until(lambda: angle("HeadYaw") > 0.29, 3.0)
    before = angle("HeadYaw")
    robot.advance(0.1)
    assert angle("HeadYaw") - before == pytest.approx(0.04, abs=0.008), "it passes its point at the speed asked for"
    at(goal.finish().result, HeadYaw=0.5)
    curve = trajectory((1.0, [0.2], [0.0]), joints=())
    at(motion.succeed(f("angleInterpolationBezier", names=["HeadYaw"], trajectory=curve)), HeadYaw=0.2)
    line = trajectory((0.6, [0.0, 0.1], ()), (1.2, [-0.4, 0.2], ()), joints=["Head"])
    at(motion.succeed(f("setTrajectory", trajectory=line, stiffness=1.0)), HeadYaw=-0.4, HeadPitch=0.2)
    further = trajectory((0.6, [0.1], ()))
    at(motion.succeed(f("setTrajectory", trajectory=further, relative=True)), HeadYaw=-0.3)


def test_accelerations_of_points_bend_the_way_between_them(robot, motion, angle, at):
    there_and_back = trajectory((0.0, [0.0], [0.0], [0.0]), (2.0, [0.0], [0.0], [2.0]))
    goal = motion.send(f("setTrajectory", trajectory=there_and_back, stiffness=1.0))
    robot.advance_until(lambda: angle("HeadYaw") > 0.12, 2.0)  # without them the head would stay where it is
    at(goal.finish().result, HeadYaw=0.0)


def test_poses_of_chains_as_points_and_by_name(stiff_robot, motion, at):
    left, right = [1.0, 0.3, -1.0, -0.5, 0.2, 0.5], [1.2, -0.4, 1.1, 0.6, -0.2, 0.3]
    result = motion.succeed(f("setPose", names=["LArm", "RArm"], angles=left + right, duration=1.5))
    at(result, LShoulderPitch=1.0, LShoulderRoll=0.3, LElbowRoll=-0.5, RShoulderRoll=-0.4, RElbowRoll=0.6)
    assert result.results[0].elapsed.to_sec() == lasted(1.5)
    points = trajectory((1.0, [0.5, 0.25], ()), joints=())
    at(motion.succeed(f("setPose", names=["Head"], trajectory=points)), HeadYaw=0.5)
    result = motion.succeed(f("setPose", str_param="ArmsForward", names=["LArm"], duration=1.5))
    at(result, LShoulderPitch=0.2, LElbowYaw=-1.2)
    assert all(name.startswith("L") for name in result.name)


def test_hands_open_and_close(robot, motion, angle):
    motion.succeed(f("openHand", names=["LHand", "RHand"]))
    assert min(angle("LHand"), angle("RHand")) > 0.9
    assert motion.succeed(f("closeHand", names=["LHand"])).name == ["LHand"]
    assert angle("LHand") < 0.1 < 0.9 < angle("RHand")


REFUSED = [
    (f("setAngles", names=["HeadYow"], angles=[0.5]), "did you mean 'HeadYaw'"),
    (f("setAngles", names=["HeadYaw"], angles=[3.0]), "HeadYaw cannot go to 3.0000 rad: -2.0857 to 2.0857 rad"),
    (f("setAngles", names=["Head"], angles=[0.1, 0.2, 0.3]), "3 values for 2 joints"),
    (f("setAngles", names=["RArm"], angles=[0.1]), "no stiffness in RShoulderPitch"),
    (f("changeAngles", names=["HeadYaw"], angles=[2.0]), "HeadYaw cannot go to 2.5000"),
    (f("angleInterpolation", names=["HeadYaw"], angles=[-2.0], times=[0.1]), "at least 0.3"),
    (f("setPose", names=["HeadYaw"], angles=[0.0], str_param="Wave"), "there is more than one pose"),
    (f("setStiffnesses", names=["Body"], angles=[1.5]), "1.5 is no stiffness"),
    (f("goToPosture", str_param="Standd"), "did you mean 'Stand'"),
    (f("setMaxTryNumber", values=[21]), "one whole number from 1 to 20"),
    (f("setPosition", names=["Tail"], values=[0.0] * 6), "'Tail' is no effector"),
    (f("setPosition", names=["LArm"], values=[0.0] * 5, stiffness=1.0), "6 numbers are needed"),
    (f("lookAt", values=[1.0, 0.0]), "x, y, z"),
    (f("wbGoToBalance", str_param="LLeg"), "field duration"),
    (f("killTask", values=[0.5]), "a whole number 0.."),
]


def test_what_is_wrong_is_told_and_nothing_moves(robot, motion, angle):
    chain = f("setStiffnesses", names=["Head"], angles=[1.0]), f("setAngles", names=["HeadYaw"], angles=[0.5])
    for function, text in REFUSED:
        goal = motion.play(*chain, function)
        assert (goal.state, goal.result.results) == ("aborted", []), function
        assert goal.text.startswith(f"function 3 ({function.function}): ") and text in goal.text
    robot.advance(0.5)
    assert angle("HeadYaw") == pytest.approx(0.0, abs=NEAR)
    assert robot.ALMotion.getStiffnesses("Body") == [0.0] * 26


def test_a_dry_run_moves_nothing_and_tells_times_and_the_pose_at_the_end(stiff_robot, motion, angle):
    result = motion.succeed(
        f("angleInterpolation", 0.5, names=["HeadYaw"], angles=[0.5, 1.0], times=[1.0, 2.0]),
        f("angleInterpolationWithSpeed", names=["HeadYaw"], angles=[-1.0], speed=0.5, dry_run=True),
    )
    assert [entry.values for entry in result.results] == [["2.500"], ["0.484"]]
    assert (result.name, list(result.position)) == (["HeadYaw"], [-1.0])
    assert angle("HeadYaw") == pytest.approx(0.0, abs=NEAR)


def test_stiffness_changes_at_once_and_along_a_time(robot, motion):
    result = motion.succeed(
        f("setStiffnesses", names=["Head"], angles=[0.2, 0.6]),
        f("getStiffnesses", names=["Head"]),
        f("stiffnessInterpolation", names=["Head"], angles=[0.5, 0.0], times=[0.2, 0.4]),
        f("getStiffnesses", names=["Head"]),
    )
    assert list(map(float, result.memList)) == pytest.approx([0.2, 0.6, 0.0, 0.0], abs=1e-6)
    assert result.results[2].elapsed.to_sec() == lasted(0.4)


KINDS = [
    f("angleInterpolation", angles=[2.0], times=[8.0], **YAW),
    f("angleInterpolationWithSpeed", angles=[2.0], speed=0.03, **YAW),
    f("setTrajectory", trajectory=trajectory((8.0, [2.0], [0.0])), stiffness=1.0),
    f("setPose", angles=[2.0], duration=8.0, **YAW),
    f("setAngles", 30.0, angles=[2.0], speed=0.03, **YAW),
    f("lookAt", values=[0.0, 1.0, 0.1], duration=8.0, stiffness=1.0),
]


@pytest.mark.parametrize("function", KINDS, ids=lambda function: function.function)
def test_every_kind_of_motion_ends_where_it_is_when_it_is_cancelled(robot, motion, angle, function):
    first = f("getAngles", names=["HeadPitch"])
    goal = motion.send(first, function, f("rest"))
    robot.advance_until(lambda: angle("HeadYaw") > 0.1, 4.0)
    assert goal.cancel().state == "preempted"
    assert goal.text == f"preempted in function 2 ({function.function})"
    done = [entry.function for entry in goal.result.results]
    assert done == ["getAngles", "setAngles"][: 1 + (function.function == "setAngles")]
    assert "HeadYaw" in goal.result.name and robot.ALMotion.getTaskList() == []
    robot.advance(0.2)
    stopped = angle("HeadYaw")
    robot.advance(0.8)
    assert angle("HeadYaw") == pytest.approx(stopped, abs=0.02) and stopped < 1.0
    at = motion.succeed(f("angleInterpolation", names=["HeadYaw"], angles=[stopped - 0.2], times=[0.5])).position[0]
    assert at == pytest.approx(stopped - 0.2, abs=NEAR), "the next goal takes over where it was"


def test_a_motion_that_somebody_stops_is_an_error_with_where_the_joints_are(robot, motion, angle):
    goal = motion.send(KINDS[0], f("setAngles", names=["HeadPitch"], angles=[0.3], stiffness=1.0))
    robot.advance_until(lambda: angle("HeadYaw") > 0.2, 6.0)
    robot.ALMotion.killTasksUsingResources(["HeadYaw"])
    goal.finish()
    assert goal.state == "aborted"
    assert "the motion was stopped: HeadYaw got to 0." in goal.text and "instead of 2.000" in goal.text
    assert angle("HeadPitch") < 0.0, "the chain went on"
