"""Walking functions on a stand-in for ALMotion: what is called and answered."""

from __future__ import annotations

import json
import math

import pytest
from motion_walk_goals import STOP, f, moved, play


def test_a_walk_to_a_place_answers_how_far_it_got(motion, fake, robot):
    fake.place = [1.0, 2.0, math.pi / 2]
    server = play(motion, f("moveTo", values=[0.3, 0.1, 0.5]))
    assert server.end == "succeeded", server.text
    assert moved(robot) == [("moveTo", 0.3, 0.1, 0.5)]
    assert [float(v) for v in server.result.memList] == pytest.approx([0.3, 0.1, 0.5])
    assert fake.place == pytest.approx([0.9, 2.3, math.pi / 2 + 0.5])


def test_time_and_gait_of_a_walk_go_to_the_robot_in_its_shape(motion, robot):
    play(motion, f("moveTo", values=[0.3, 0, 0], duration=20.0))
    play(motion, f("moveTo", values=[0.3, 0, 0], gait=["MaxStepX", "StepHeight"], gait_values=[0.06, 0.03]))
    play(motion, f("moveTo", values=[0.3, 0, 0], duration=20.0, gait=["MaxStepX"], gait_values=[0.02]))
    assert moved(robot) == [
        ("moveTo", 0.3, 0.0, 0.0, 20.0),
        ("moveTo", 0.3, 0.0, 0.0, [["MaxStepX", 0.06], ["StepHeight", 0.03]]),
        ("moveTo", 0.3, 0.0, 0.0, 20.0, [["MaxStepX", 0.02]]),
    ]


def test_places_on_the_way_are_one_list(motion, robot):
    play(motion, f("moveTo", values=[0.3, 0, 0, 0.5, 0.2, 1.0]))
    assert moved(robot) == [("moveTo", [[0.3, 0.0, 0.0], [0.5, 0.2, 1.0]])]


@pytest.mark.parametrize("name", ["walkTarget", "walk_target"])
def test_a_target_in_the_world_is_walked_to_from_wherever_the_robot_is(motion, fake, name):
    fake.place = [1.0, 1.0, math.pi / 2]
    server = play(motion, f(name, values=[0.0, 2.0, math.pi], frame=1))
    assert server.end == "succeeded", server.text
    assert fake.place == pytest.approx([0.0, 2.0, math.pi])


def test_a_target_in_a_frame_of_tf(motion, fake, edge):
    edge.frames["table"] = (1.0, 0.5, math.pi / 2)
    fake.place = [0.0, 0.0, 0.0]
    play(motion, f("walkTarget", values=[0.2, 0.1, -math.pi / 2], str_param="table"))
    assert fake.place == pytest.approx([0.9, 0.7, 0.0])
    server = play(motion, f("walkTarget", values=[0.2, 0.1, 0.0], str_param="chair"))
    assert server.end == "aborted" and "the frame chair cannot be found" in server.text


def test_a_path_in_the_world_is_walked_through_as_seen_from_the_robot(motion, fake, robot):
    fake.place = [1.0, 0.0, math.pi / 2]
    play(motion, f("walkPath", values=[1.0, 0.5, math.pi / 2, 0.5, 0.5, math.pi], frame=1))
    ((method, points),) = moved(robot)
    assert method == "moveTo"
    assert points[0] == pytest.approx([0.5, 0.0, 0.0])
    assert points[1] == pytest.approx([0.5, 0.5, math.pi / 2])


def test_a_target_that_turns_out_to_be_too_far_is_not_walked_to(motion, fake, robot):
    fake.place = [-90.0, 0.0, 0.0]
    server = play(motion, f("walkTarget", values=[50.0, 0.0, 0.0], frame=1))
    assert server.end == "aborted" and "x cannot be 140" in server.text
    assert not any(call[0] == "moveTo" for call in moved(robot))


def test_a_walk_at_a_speed_goes_on_after_its_goal(motion, fake, robot):
    server = play(motion, f("move", values=[0.1, 0, 0], gait=["LeftStepHeight", "Frequency"], gait_values=[0.03, 0.5]))
    assert server.end == "succeeded"
    assert moved(robot) == [("move", 0.1, 0.0, 0.0, [["LeftStepHeight", 0.03], ["Frequency", 0.5]])]
    assert fake.walking


def test_a_walk_for_a_while_ends_on_two_feet(motion, fake, edge, robot):
    server = play(motion, f("moveToward", values=[1, 0, 0], duration=0.02), f("moveIsActive"))
    assert (server.end, server.result.memList) == ("succeeded", ["False"])
    assert edge.clock.waits == [0.02]
    assert moved(robot) == [("moveToward", 1.0, 0.0, 0.0), *STOP]


def test_a_walk_for_a_while_that_somebody_stops_is_an_error(motion, fake, monkeypatch):
    monkeypatch.setattr(fake, "moveIsActive", lambda: False)
    server = play(motion, f("move", values=[0.1, 0, 0], duration=0.02))
    assert server.end == "aborted"
    assert "the walk was stopped (another client, a protection of the robot or a limit did that)" in server.text
    assert "the robot got to x 0.000 m, y 0.000 m, theta 0.000 rad" in server.text


def test_a_walk_that_a_goal_left_going_ends_with_the_node(motion, fake, edge):
    play(motion, f("move", values=[0.1, 0, 0]))
    play(motion, f("setAngles", names=["HeadYaw"], angles=[0.1]))
    assert fake.walking
    for action in edge.shutdown_actions:
        action()
    assert not fake.walking


def test_a_walk_of_somebody_else_does_not_end_with_the_node(motion, fake, edge):
    play(motion, f("moveTo", values=[0.1, 0, 0]))
    fake.move(0.1, 0.0, 0.0)
    for action in edge.shutdown_actions:
        action()
    assert fake.walking


def test_footsteps_go_to_the_robot_as_rows(motion, robot):
    steps = [0.04, 0.1, 0.0, 0.04, -0.1, 0.2]
    legs = ["LLeg", "RLeg"]
    play(motion, f("setFootSteps", names=legs, values=steps, times=[0.6, 1.2], enable=True))
    play(motion, f("setFootStepsWithSpeed", names=legs, values=steps, speeds=[0.5]))
    play(motion, f("setFootStepsWithSpeed", names=legs, values=steps))
    rows = [steps[:3], steps[3:]]
    assert moved(robot) == [
        ("setFootSteps", legs, rows, [0.6, 1.2], True),
        ("setFootStepsWithSpeed", legs, rows, [0.5, 0.5], False),
        ("setFootStepsWithSpeed", legs, rows, [1.0, 1.0], False),
    ]


def test_questions_about_the_walk(motion, fake):
    fake.place = [1.0, 2.0, 0.5]
    names = ("getRobotPosition", "getNextRobotPosition", "getRobotVelocity", "moveIsActive", "getFootSteps")
    result = play(motion, *map(f, names)).result
    assert result.memList[:10] == ["1.0", "2.0", "0.5"] * 2 + ["0.0"] * 3 + ["False"]
    assert json.loads(result.memList[10]) == [[0.0, 0.05, 0.0], [0.0, -0.05, 0.0]]
    pairs = play(motion, f("getMoveConfig", str_param="Max")).result.memList
    assert json.loads(pairs[0]) == ["MaxStepX", 0.08]


def test_distances_to_obstacles(motion, fake):
    play(motion, f("setOrthogonalSecurityDistance", values=[0.2]), f("setTangentialSecurityDistance", values=[0.05]))
    assert fake.distances == [0.2, 0.05]
    result = play(motion, f("getOrthogonalSecurityDistance"), f("getTangentialSecurityDistance")).result
    assert result.memList == ["0.2", "0.05"]


def test_each_arm_swings_as_it_is_told(motion, fake):
    play(motion, f("setMoveArmsEnabled", names=["RArm"], enable=False))
    assert fake.swing == [True, False]
    assert play(motion, f("getMoveArmsEnabled")).result.memList == ["True", "False"]
    play(motion, f("setMoveArmsEnabled", enable=False))
    assert fake.swing == [False, False]
