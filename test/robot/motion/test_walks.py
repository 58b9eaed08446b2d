"""Goals that walk: where the robot really gets, what it does meanwhile, and that every end is on two feet."""

import json
import math
import threading

import pytest
from goal_functions import motion as f

from nao_library_modules.core.geometry import Place

CLOSE, CLOSE_TURN = 0.03, 0.1
"""m and rad: what odometry of the legs may be off after a short walk."""


def walk(x, y=0.0, theta=0.0, **fields):
    return f("moveTo", values=[x, y, theta], **fields)


LOOK = f("setAngles", names=["HeadYaw"], angles=[1.0])
LEG = f("angleInterpolation", names=["LHipRoll"], angles=[0.05], times=[1.0])


@pytest.fixture
def robot(robot):
    """Stiff, and with the ground under its feet."""
    robot.ALMotion.setStiffnesses("Body", 1.0)
    robot.advance(0.3)
    return robot


@pytest.fixture
def walked(way):
    def check(x, y=0.0, theta=0.0):
        at_x, at_y, at_theta = way()
        assert (at_x, at_y) == pytest.approx((x, y), abs=CLOSE)
        assert abs(math.remainder(at_theta - theta, 2.0 * math.pi)) < CLOSE_TURN

    return check


@pytest.fixture
def on_its_way(robot, way):
    return lambda distance=0.05: robot.advance_until(lambda: math.hypot(*way()[:2]) > distance, 12.0)


@pytest.fixture
def stands(robot, way):
    """On both feet, and at rest."""

    def check():
        assert not robot.ALMotion.moveIsActive()
        robot.advance(0.3)
        before = way()
        loads = [0.0, 0.0]
        for _ in range(5):  # the load of a foot jumps from one moment to the next
            robot.advance(0.05)
            loads = [load + robot.value(f"{side}FootTotalWeight") / 5 for load, side in zip(loads, ("left", "right"))]
        assert min(loads) > 1.8 and robot.now.torso.position[2] > 0.28
        assert math.dist(way()[:2], before[:2]) < 0.004

    return check


def test_a_walk_goes_anywhere_turns_and_answers_how_far_it_got(robot, motion, walked, stands):
    result = motion.succeed(walk(0.15, -0.1, 0.8))
    walked(0.15, -0.1, 0.8)
    assert [float(v) for v in result.memList] == pytest.approx([0.15, -0.1, 0.8], abs=0.02)
    stands()
    result = motion.succeed(f("walkTo", values=[0.0, 0.0, -0.4]))  # seen from where it is now
    walked(0.15, -0.1, 0.4)
    assert float(result.memList[2]) == pytest.approx(-0.4, abs=0.05)


def test_places_on_the_way_a_gait_and_a_time(robot, motion, walked):
    gait = {"gait": ["MaxStepX", "StepHeight"], "gait_values": [0.02, 0.025]}
    slow = motion.succeed(f("moveTo", values=[0.1, 0.0, 0.0, 0.2, 0.05, 0.4], **gait))
    walked(0.2, 0.05, 0.4)
    long = motion.succeed(walk(0.05, duration=6.0, gait=["StepHeight"], gait_values=[0.02]))
    quick = motion.succeed(walk(0.05))
    times = [result.results[0].elapsed.to_sec() for result in (slow, long, quick)]
    assert times[0] > 6.5 and 5.5 < times[1] < 8.0 and times[2] < 5.0


def test_targets_in_the_world_and_in_frames_of_tf(robot, motion, walked):
    start = Place(*(float(value) for value in motion.succeed(f("getRobotPosition")).memList))
    robot.finish("ALMotion", "moveTo", 0.05, 0.0, 0.4, after=6.0)
    motion.succeed(f("walkTarget", values=list(start), frame=1))
    walked(0.0)
    motion.node.frames["table"] = Place(0.1, 0.05, math.pi / 2)
    motion.succeed(f("walk_target", values=[0.05, 0.1, -math.pi / 2], str_param="table"))
    walked(0.0, 0.1)
    points = [start.then(Place(*point)) for point in ((0.05, 0.1, 0.0), (0.05, 0.05, 0.0))]
    motion.succeed(f("walkPath", values=[n for point in points for n in point], frame=1))
    walked(0.05, 0.05)
    assert "the frame chair cannot be found" in motion.refused(f("walkTarget", values=[0, 0, 0], str_param="chair"))
    walked(0.05, 0.05)


def test_footsteps_go_where_they_are_put(robot, motion, walked, stands):
    legs = ["LLeg", "RLeg"] * 2
    steps = [0.04, 0.1, 0.0, 0.04, -0.1, 0.0, 0.04, 0.1, 0.0, 0.0, -0.1, 0.0]
    motion.succeed(f("setFootStepsWithSpeed", names=legs, values=steps, speeds=[0.8]))
    walked(0.12)  # each step goes ahead of the other foot, and the last one beside it
    result = motion.succeed(
        f("setFootSteps", names=legs, values=steps, times=[0.6, 1.2, 1.8, 2.4]), f("moveIsActive"),
        f("waitUntilMoveIsFinished"), f("moveIsActive"),
    )  # fmt: skip
    assert result.memList == ["True", "False"]
    walked(0.24)
    stands()


def test_a_goal_may_leave_it_walking_and_another_one_ends_it(robot, motion, way, stands, on_its_way):
    result = motion.succeed(f("move", values=[0.08, 0.0, 0.0], gait=["LeftStepHeight"], gait_values=[0.03]))
    assert result.results[0].elapsed.to_sec() < 2.0
    on_its_way(0.1)
    assert motion.play(walk(math.nan)).state == "aborted"
    assert "the robot walks, and LHipRoll with it: stopMove" in motion.refused(LEG)
    assert robot.ALMotion.moveIsActive(), "bad goals stop no walk"
    motion.succeed(f("setAngles", names=["HeadYaw"], angles=[0.3]))
    result = motion.succeed(f("getRobotVelocity"), f("moveIsActive"), f("getNextRobotPosition"), f("getRobotPosition"))
    answers = [[float(v) for v in r.values] for r in result.results if r.function != "moveIsActive"]
    assert answers[0] == pytest.approx([0.08, 0.0, 0.0], abs=0.02) and answers[1][0] > answers[2][0]
    motion.succeed(f("stopMove"))
    stands()
    before = way()[2]
    result = motion.succeed(f("move", values=[0.0, 0.0, 0.5], duration=2.5), f("moveIsActive"))
    assert result.memList == ["False"] and way()[2] - before > 0.5
    assert 2.5 <= result.results[0].elapsed.to_sec() < 5.0
    stands()


def test_head_and_arms_move_while_it_walks(motion, way, angle):
    goal = motion.send(
        f("setMoveArmsEnabled", names=["LArm"], enable=False),
        f("moveToward", values=[1.0, 0.0, 0.0]),
        f("angleInterpolation", names=["HeadYaw"], angles=[0.5, 0.3], times=[1.0, 2.0]),
        f("setPose", names=["LArm"], angles=[0.5, 0.3, -1.0, -0.8, 0.0, 0.5], duration=1.5),
        f("getRobotVelocity"), f("stopMove"),
    )  # fmt: skip
    goal.finish()
    assert goal.state == "succeeded" and float(goal.result.results[4].values[0]) > 0.05 and way()[0] > 0.15
    assert angle("HeadYaw") == pytest.approx(0.3, abs=0.05) and angle("LShoulderPitch") == pytest.approx(0.5, abs=0.1)


def test_settings_of_the_walk(robot, motion):
    motion.succeed(f("setOrthogonalSecurityDistance", values=[0.2]), f("setTangentialSecurityDistance", values=[0.05]))
    result = motion.succeed(
        f("getOrthogonalSecurityDistance"), f("getTangentialSecurityDistance"), f("getFootSteps"),
        f("getMoveConfig", str_param="Max"), f("setMoveArmsEnabled", names=["RArm"], enable=False),
        f("getMoveArmsEnabled"), f("setMoveArmsEnabled", enable=False), f("getMoveArmsEnabled"),
    )  # fmt: skip
    values = [r.values for r in result.results]
    assert [float(v) for v in values[0] + values[1]] == pytest.approx([0.2, 0.05])
    left, right = json.loads(values[2][0])
    assert (left[1], right[1]) == (pytest.approx(0.06, abs=0.03), pytest.approx(-0.06, abs=0.03))
    assert json.loads(values[3][0]) == ["MaxStepX", pytest.approx(0.08)]
    assert values[5] == ["True", "False"] and values[7] == ["False", "False"]


@pytest.mark.parametrize(
    "function, moment",
    [
        (walk(2.0), 0.4), (f("walkPath", values=[1, 0, 0, 2, 0, 0]), 1.7),
        (f("moveToward", 60.0, values=[-1, 0.5, 0.2]), 1.9),
        (f("setFootStepsWithSpeed", names=["LLeg", "RLeg"] * 4, values=[0.04, 0.1, 0, 0.04, -0.1, 0] * 4), 1.3),
    ],
)  # fmt: skip
def test_cancelled_at_any_moment_it_stands_on_both_feet(robot, motion, stands, function, moment):
    goal = motion.send(f("getMoveConfig", str_param="Min"), function, LOOK)
    robot.advance(moment)
    began = robot.now.time
    assert goal.cancel().state == "preempted"
    assert robot.now.time - began < 3.0 and goal.text.startswith("preempted in function 2")
    stands()


def test_a_walk_that_goes_on_ends_with_a_goal_that_does_not_succeed(robot, motion, stands):
    later = f("angleInterpolation", names=["LElbowYaw"], angles=[0.5], times=[8.0])
    goal = motion.send(f("move", 0.5, values=[0.05, 0, 0]), later)
    robot.advance(1.5)
    assert goal.cancel().state == "preempted"
    stands()


def test_who_stops_it_on_the_way_is_not_taken_for_an_arrival(robot, motion, angle, stands, on_its_way):
    goal = motion.send(walk(2.0), LOOK)
    on_its_way(0.12)
    robot.post("ALMotion", "stopMove")
    goal.finish()
    assert goal.state == "aborted" and abs(angle("HeadYaw")) < 0.1
    assert "the walk was stopped (another client, a protection of the robot or a limit did that)" in goal.text
    assert "the robot got to x 0.1" in goal.text and "instead of x 2.000 m" in goal.text
    stands()


def test_a_walk_that_a_goal_left_going_ends_with_the_node(robot, motion):
    motion.succeed(f("move", values=[0.05, 0, 0]))
    robot.advance(0.5)
    ends = threading.Thread(target=lambda: [action() for action in motion.node.shutdown_actions], daemon=True)
    ends.start()
    robot.advance_until(lambda: not ends.is_alive(), 5.0)
    assert robot.ALMotion.moveIsActive() is False


REFUSED = [
    (f("moveTo", values=[0.3, 0.0]), "3 numbers are needed: x, y (m), theta (rad); here are 2"),
    (f("moveTo", values=[0.3, 0, 0, 1]), "3 numbers for each place are needed"),
    (walk(0, 0, 90), "theta cannot be 90: -3.1417 to 3.1417 rad; 90 degrees are 1.5708 rad"),
    (f("moveTo", values=[1, 0, 0, 2, 0, 0], duration=5.0), "places on the way"),
    (walk(1, gait=["MaxStepx"], gait_values=[0.04]), "did you mean 'MaxStepX'"),
    (walk(1, gait=["StepHeight"], gait_values=[0.05]), "StepHeight cannot be 0.05: 0.005 to"),
    (f("move", values=[10.0, 0, 0]), "x cannot be 10"),
    (f("moveToward", values=[0, -1.1, 0]), "y cannot be -1.1: -1 to 1"),
    (f("setFootSteps", names=["LLeg"] * 2, values=[0, 0.1, 0] * 2, times=[1.0, 2.0]), "cannot step twice"),
    (f("setMoveArmsEnabled", names=["LLeg"]), "LArm, RArm"),
    (f("setOrthogonalSecurityDistance", values=[-0.1]), "-0.1 is not allowed: 0..2.5 m"),
]  # fmt: skip


def test_what_is_wrong_is_told_and_nothing_moves(robot, motion, walked):
    for function, text in REFUSED:
        refusal = motion.refused(walk(0.1), function)
        assert refusal.startswith("function 2") and text in refusal
    assert not robot.ALMotion.moveIsActive()
    walked(0.0)


def test_joints_of_a_walking_leg_are_not_moved(robot, motion):
    def plan(*between):
        return [f("move", values=[0.1, 0, 0]), *between, LEG, f("getTaskList", dry_run=True)]

    for end in ("stopMove", "waitUntilMoveIsFinished", "killMove", "wakeUp"):
        motion.succeed(*plan(f(end)))
    assert "the robot walks, and LHipRoll with it: stopMove" in motion.refused(*plan())


def test_nobody_walks_on_limp_or_soft_legs_or_from_the_floor(robot, motion):
    robot.ALMotion.setStiffnesses("RHipRoll", 0.5)
    assert "RHipRoll has stiffness 0.50" in motion.refused(walk(0.1))
    robot.ALMotion.setStiffnesses("RHipRoll", 0.0)
    assert "the legs are limp: wakeUp first" in motion.refused(walk(0.1))
    dry = f("getTaskList", dry_run=True)
    motion.succeed(f("wakeUp"), walk(0.1), dry)
    assert "the legs are limp" in motion.refused(f("wakeUp"), f("rest"), walk(0.1))
    robot.ALMotion.setStiffnesses("Body", 1.0)
    assert "(posture Sit)" in motion.refused(f("goToPosture", str_param="Sit"), walk(0.1))
    robot.finish("ALRobotPosture", "goToPosture", "Sit", 1.0, after=8.0)
    assert "(posture Sitting): goToPosture Stand first" in motion.refused(LOOK, walk(0.1))
    motion.succeed(f("goToPosture", str_param="Stand"), walk(0.1), dry)
