"""The motion module on a stand-in for ALMotion: what is called, what is refused, what the result tells."""

from __future__ import annotations

import math

import pytest
from fake_motion import CHAINS
from genpy import Duration
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from nao_library_actions.msg import NaoMotionGoal
from nao_library_msgs.msg import MotionFunction

LIMIT = 5.0


def f(function, **fields):
    return MotionFunction(function=function, **fields)


def play(motion, *functions):
    return motion.server.play(NaoMotionGoal(list(functions)))


def moved(robot):
    """Calls that change something, in order."""
    asking = ("get", "robotIs")
    return [call for call in robot.proxy("ALMotion").calls if not call[0].startswith(asking)]


def point(positions, time, velocities=()):
    return JointTrajectoryPoint(positions=positions, velocities=velocities, time_from_start=Duration.from_sec(time))


# Joints


def test_get_angles_gives_names_and_positions_in_the_same_order(motion, fake):
    fake.angles.update(RShoulderPitch=0.25, RShoulderRoll=-0.5, RHand=1.0)
    result = play(motion, f("getAngles", names=["RArm"])).result
    assert (result.name, list(result.position)) == (CHAINS["RArm"], [0.25, -0.5, 1.0])
    assert result.memList == [], "the answers have fields of their own"
    assert result.results[0].values == ["0.25", "-0.5", "1.0"]


def test_the_result_tells_every_joint_that_was_moved(motion):
    server = play(motion, f("setAngles", names=["HeadYaw"], angles=[0.5]), f("getAngles", names=["Head"]))
    assert server.end == "succeeded"
    assert dict(zip(server.result.name, server.result.position)) == {"HeadYaw": 0.5, "HeadPitch": 0.0}


def test_set_angles_takes_one_speed_or_one_each(motion, robot):
    play(motion, f("setAngles", names=["Head"], angles=[0.5, 0.1], speed=0.2))
    play(motion, f("setAngles", names=["Head"], angles=[0.0], speeds=[0.1, 0.4]))
    assert moved(robot) == [
        ("setAngles", CHAINS["Head"], [0.5, 0.1], 0.2),
        ("setAngles", CHAINS["Head"], [0.0, 0.0], [0.1, 0.4]),
    ]


def test_relative_set_angles_adds_to_where_the_joint_is_told_to_be(motion, fake):
    fake.angles["HeadYaw"] = 0.5
    play(motion, f("setAngles", names=["HeadYaw"], angles=[0.25], relative=True))
    assert fake.angles["HeadYaw"] == 0.75


def test_key_angles_come_joint_by_joint(motion, robot):
    play(motion, f("angleInterpolation", names=["Head"], angles=[0.1, 0.2, 0.3, 0.4], times=[1.0, 2.0]))
    assert moved(robot) == [
        ("angleInterpolation", CHAINS["Head"], [[0.1, 0.2], [0.3, 0.4]], [[1.0, 2.0], [1.0, 2.0]], True)
    ]


def test_a_trajectory_without_velocities_is_interpolated(motion, robot):
    trajectory = JointTrajectory(joint_names=["HeadYaw"], points=[point([0.5], 1.0), point([0.0], 2.0)])
    play(motion, f("setTrajectory", trajectory=trajectory))
    assert moved(robot) == [("angleInterpolation", ["HeadYaw"], [[0.5, 0.0]], [[1.0, 2.0]], True)]


def test_a_trajectory_with_velocities_becomes_curves_with_these_slopes(motion, robot):
    trajectory = JointTrajectory(points=[point([0.5], 1.5, [0.2]), point([0.0], 3.0, [0.0])])
    play(motion, f("setTrajectory", names=["HeadYaw"], trajectory=trajectory))
    ((method, names, times, ((first, _),)),) = moved(robot)
    assert (method, names, times) == ("angleInterpolationBezier", ["HeadYaw"], [[1.5, 3.0]])
    angle, (_, before, down), (_, after, up) = first
    assert (angle, before, after) == (0.5, -0.5, 0.5)
    assert (down, up) == (pytest.approx(-0.1), pytest.approx(0.1))


def test_a_pose_of_several_chains_in_a_time(motion, fake):
    pose = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]
    play(motion, f("setPose", names=["LArm", "RArm"], angles=pose, duration=2.0))
    assert [fake.angles[joint] for joint in CHAINS["LArm"] + CHAINS["RArm"]] == pose


def test_a_pose_is_also_a_point_of_a_trajectory(motion, robot):
    trajectory = JointTrajectory(points=[point([0.5, 0.25], 1.0)])
    play(motion, f("setPose", names=["Head"], trajectory=trajectory))
    assert moved(robot) == [("angleInterpolation", CHAINS["Head"], [[0.5], [0.25]], [[1.0], [1.0]], True)]


@pytest.mark.parametrize("fields", [{}, {"angles": [0.0], "str_param": "Wave"}])
def test_a_pose_is_given_in_one_way(motion, robot, fields):
    server = play(motion, f("setPose", names=["HeadYaw"], **fields))
    assert server.end == "aborted" and "pose" in server.text
    assert moved(robot) == []


def test_a_pose_of_a_library_in_the_folder(motion, fake, tmp_path):
    (tmp_path / "mine.xap").write_text(
        "<poses><position><name>Look</name><version>2</version><Motors>"
        "<Motor><name>HeadYaw</name><value>0.7</value></Motor>"
        "<Motor><name>Tail</name><value>0.1</value></Motor></Motors></position></poses>"
    )
    assert play(motion, f("setPose", str_param="mine.xap:Look")).end == "succeeded"
    assert fake.angles["HeadYaw"] == 0.7
    server = play(motion, f("setPose", str_param="mine.xap:Luck"))
    assert server.end == "aborted" and "Look" in server.text


def test_hands_open_and_close_together(motion, fake):
    play(motion, f("openHand", names=["LHand", "RHand"]))
    assert (fake.angles["LHand"], fake.angles["RHand"]) == (1.0, 1.0)
    server = play(motion, f("closeHand", names=["HeadYaw"]))
    assert server.end == "aborted" and "'HeadYaw' is no hand" in server.text


# Checks before anything moves


@pytest.mark.parametrize(
    "function, text",
    [
        (f("setAngles", names=["HeadYow"], angles=[0.5]), "did you mean 'HeadYaw'"),
        (f("setAngles", names=["HeadYaw"], angles=[2.5]), "HeadYaw cannot go to 2.5000: -2.0000 to 2.0000"),
        (f("setAngles", names=["HeadYaw"], angles=[math.nan]), "HeadYaw cannot go to nan"),
        (f("setAngles", names=["Head"], angles=[0.1, 0.2, 0.3]), "3 values for 2 joints"),
        (f("setAngles", angles=[0.1]), "no joint is named"),
        (f("setAngles", names=["HeadYaw"], angles=[0.1], speed=2.0), "field speed"),
        (f("angleInterpolation", names=["HeadYaw"], angles=[1.5], times=[0.1]), "at least 0.188 s"),
        (f("angleInterpolation", names=["HeadYaw"], angles=[1.5], times=[]), "field times"),
        (f("angleInterpolation", names=["Head"], angles=[0.1, 0.2, 0.3], times=[1.0, 2.0]), "3 values for 2 joints"),
        (f("setTrajectory", names=["HeadYaw"]), "there is no point"),
        (f("setStiffnesses", names=["Body"], angles=[1.5]), "1.5 is no stiffness"),
        (f("goToPosture", str_param="Standd"), "did you mean 'Stand'"),
        (f("setPosition", names=["Tail"], values=[0.0] * 6), "'Tail' is no effector"),
        (f("setPosition", names=["RArm"], values=[0.0] * 5), "6 finite numbers"),
        (f("positionInterpolation", names=["RArm"], values=[0.0] * 6, times=[1.0], frame=3), "field frame"),
        (f("lookAt", values=[1.0, 0.0]), "x, y, z"),
        (f("lookAt", values=[1.0, 0.0, 0.0], str_param="Camera"), "CameraTop"),
        (f("setBreathEnabled", names=["Leg"]), "'Leg' is not known"),
        (f("killTask", values=[0.5]), "the number of one task"),
    ],
)
def test_what_is_wrong_is_told_and_nothing_moves(motion, robot, function, text):
    server = play(motion, f("setAngles", names=["HeadPitch"], angles=[0.1]), function)
    assert server.end == "aborted"
    assert server.text.startswith("function 2") and text in server.text
    assert moved(robot) == []


def test_limp_joints_are_refused_or_stiffened(motion, fake, robot):
    fake.stiffnesses["HeadYaw"] = 0.0
    server = play(motion, f("setAngles", names=["Head"], angles=[0.5]))
    assert server.end == "aborted" and "no stiffness in HeadYaw" in server.text
    assert play(motion, f("setAngles", names=["Head"], angles=[0.5], stiffness=0.8)).end == "succeeded"
    assert (fake.stiffnesses["HeadYaw"], fake.stiffnesses["HeadPitch"]) == (0.8, 1.0)


def test_a_chain_may_wake_the_robot_first_and_not_rest_it_before(motion, fake):
    fake.rest()
    move = f("setAngles", names=["HeadYaw"], angles=[0.5])
    assert play(motion, f("wakeUp"), move).end == "succeeded"
    server = play(motion, f("rest"), move)
    assert server.end == "aborted" and server.text.startswith("function 2")


def test_a_dry_run_moves_nothing_and_tells_times_and_the_pose_at_the_end(motion, robot):
    server = play(
        motion,
        f("angleInterpolation", names=["HeadYaw"], angles=[0.5, 1.0], times=[1.0, 2.0], time=Duration.from_sec(0.5)),
        f("angleInterpolationWithSpeed", names=["HeadYaw"], angles=[-1.0], speed=0.5, dry_run=True),
    )
    assert server.end == "succeeded"
    assert moved(robot) == []
    assert [entry.values for entry in server.result.results] == [["2.500"], ["0.500"]]
    assert (server.result.name, list(server.result.position)) == (["HeadYaw"], [-1.0])


# Preemption


@pytest.mark.parametrize(
    "function",
    [
        f("angleInterpolation", names=["HeadYaw"], angles=[1.0], times=[5.0]),
        f("angleInterpolationWithSpeed", names=["HeadYaw"], angles=[1.0]),
        f("wakeUp"),
    ],
)
def test_preemption_cancels_the_motion_and_holds_the_joints(motion, fake, robot, function):
    fake.slow.add(function.function)
    thread = motion.server.play_in_background(NaoMotionGoal([function]))
    assert fake.started.wait(LIMIT)
    motion.server.preempt()
    thread.join(LIMIT)
    assert motion.server.end == "preempted"
    assert fake.pending[0].canceled
    assert moved(robot)[-1] == ("killTasksUsingResources", motion.server.result.name)


def test_a_target_is_held_when_the_wait_after_it_is_preempted(motion, edge, robot):
    goal = NaoMotionGoal([f("setAngles", names=["HeadYaw"], angles=[1.0], time=Duration.from_sec(60.0))])
    thread = motion.server.play_in_background(goal)
    assert edge.clock.waiting.wait(LIMIT)
    motion.server.preempt()
    thread.join(LIMIT)
    assert motion.server.end == "preempted"
    assert moved(robot)[-1] == ("setAngles", ["HeadYaw"], [1.0], 1.0)


# Postures, gaze, effectors


def test_a_posture_that_is_not_reached_is_an_error_with_where_the_robot_is(motion, robot):
    assert play(motion, f("goToPosture", str_param="Stand")).end == "succeeded"
    robot.proxy("ALRobotPosture")._service.fails = True
    server = play(motion, f("goToPosture", str_param="Sit"))
    assert server.end == "aborted"
    assert "did not reach Sit: it is in posture Stand of the family Standing" in server.text


def test_looking_goes_as_far_as_the_neck_and_tells_what_is_missing(motion, fake):
    result = play(motion, f("lookAt", values=[1.0, 0.0, 0.1])).result
    assert float(result.results[0].values[2]) == pytest.approx(0.0)
    assert fake.angles["HeadYaw"] == pytest.approx(0.0)


def test_a_point_in_another_frame_is_brought_into_that_of_the_torso(motion, fake):
    # The torso looks along Y of the frame, so a point on Y is ahead of it.
    play(motion, f("lookAt", values=[0.0, 2.0, 0.4], frame=1))
    assert fake.angles["HeadYaw"] == pytest.approx(0.0)
    play(motion, f("lookAt", values=[-1.0, 1.0, 0.4], frame=1))
    assert fake.angles["HeadYaw"] == pytest.approx(math.pi / 4)


def test_paths_of_effectors_go_to_the_robot_in_its_shape(motion, robot):
    poses = [float(i) for i in range(24)]
    play(motion, f("positionInterpolation", names=["LArm", "RArm"], values=poses, times=[1.0, 2.0], relative=True))
    rows = [poses[i : i + 6] for i in range(0, 24, 6)]
    assert moved(robot) == [
        ("positionInterpolations", ["LArm", "RArm"], 0, [rows[:2], rows[2:]], [7, 7], [[1.0, 2.0], [1.0, 2.0]], False)
    ]


def test_switches_are_set_for_each_chain(motion):
    play(motion, f("setBreathEnabled", names=["LArm", "RArm"], enable=True))
    result = play(motion, f("getBreathEnabled", names=["LArm", "Head"])).result
    assert result.memList == ["True", "False"]


def test_facts_are_asked_again_after_a_reconnection(motion, robot):
    play(motion, f("getAngles", names=["Head"]))
    asked = [call for call in robot.proxy("ALMotion").calls if call[0] == "getLimits"]
    play(motion, f("setAngles", names=["Head"], angles=[0.0]))
    robot.connection.become("connected")
    play(motion, f("setAngles", names=["Head"], angles=[0.0]))
    asked_now = [call for call in robot.proxy("ALMotion").calls if call[0] == "getLimits"]
    assert (len(asked), len(asked_now)) == (1, 2)


# What stops a motion


@pytest.mark.parametrize(
    "function",
    [
        f("angleInterpolation", names=["HeadYaw"], angles=[1.0], times=[5.0]),
        f("angleInterpolation", names=["HeadYaw"], angles=[1.0], times=[5.0], relative=True),
        f("angleInterpolationWithSpeed", names=["HeadYaw"], angles=[1.0]),
        f("setPose", names=["HeadYaw"], angles=[1.0], duration=5.0),
    ],
)
def test_a_motion_that_somebody_stops_is_an_error_with_where_the_joints_are(motion, fake, monkeypatch, function):
    for method in ("angleInterpolation", "angleInterpolationWithSpeed"):
        monkeypatch.setattr(fake, method, lambda *_: fake.angles.update(HeadYaw=0.4))
    server = play(motion, function)
    assert server.end == "aborted"
    assert "the motion was stopped: HeadYaw got to 0.400 instead of 1.000" in server.text


# Falls


def test_a_fall_aborts_the_chain_and_says_how_to_get_up(motion, fake, robot):
    fake.slow.add("angleInterpolation")
    chain = [
        f("angleInterpolation", names=["HeadYaw"], angles=[1.0], times=[5.0]),
        f("setAngles", names=["HeadPitch"], angles=[0.1]),
    ]
    thread = motion.server.play_in_background(NaoMotionGoal(chain))
    assert fake.started.wait(LIMIT)
    robot.memory.signals["ALMotion/RobotIsFalling"](True)
    thread.join(LIMIT)
    assert motion.server.end == "aborted"
    assert motion.server.text == (
        "function 1 (angleInterpolation): the robot fell and its motors are off: goToPosture gets it up again"
    )
    assert fake.angles["HeadPitch"] == 0.0, "the chain went on"


def test_a_fall_between_goals_aborts_nothing(motion, robot):
    play(motion, f("getAngles", names=["Head"]))
    robot.memory.signals["ALMotion/RobotIsFalling"](True)
    assert play(motion, f("getAngles", names=["Head"])).end == "succeeded"


def test_a_chain_that_only_asks_goes_on_while_the_robot_falls(motion, edge, robot):
    goal = NaoMotionGoal([f("getAngles", names=["Head"], time=Duration.from_sec(60.0))])
    thread = motion.server.play_in_background(goal)
    assert edge.clock.waiting.wait(LIMIT)
    robot.memory.signals["ALMotion/RobotIsFalling"](True)
    assert not motion.interrupt.is_set()
    motion.server.preempt()
    thread.join(LIMIT)
    assert motion.server.end == "preempted"


def test_falls_are_watched_again_after_a_reconnection(motion, robot):
    play(motion, f("getAngles", names=["Head"]))
    robot.memory.signals.clear()
    robot.connection.become("connected")
    assert robot.memory.signals["ALMotion/RobotIsFalling"].links
