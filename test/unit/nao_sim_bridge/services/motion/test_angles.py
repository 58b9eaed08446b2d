"""ALMotion moves joints over the network: targets, interpolations, hands."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.model import load_model

MODEL = load_model()
HEAD = ["HeadYaw", "HeadPitch"]


@pytest.fixture
def motion(stiff_robot):
    return stiff_robot.ALMotion


def commands(robot, names="Head"):
    return robot.ALMotion.getAngles(names, False)


def sensed(robot, names="Head"):
    return robot.ALMotion.getAngles(names, True)


# --- reading ----------------------------------------------------------------------------------------------------------


def test_angles_come_in_the_order_asked_for(stiff_robot):
    stiff_robot.finish("ALMotion", "angleInterpolation", HEAD, [0.5, -0.2], 0.5, True, after=1.0)
    assert commands(stiff_robot, ["HeadPitch", "LHand", "HeadYaw"]) == pytest.approx([-0.2, 0.3, 0.5])
    assert len(sensed(stiff_robot, "Body")) == 26


def test_sensors_tell_what_is_and_commands_what_should_be(robot):
    """A limp joint takes a command, but does not follow it."""
    robot.ALMotion.setAngles("HeadYaw", 0.5, 1.0)
    robot.advance(1.0)
    assert commands(robot, "HeadYaw") == pytest.approx([0.5])
    assert sensed(robot, "HeadYaw") == pytest.approx([0.0], abs=0.01)


# --- targets ----------------------------------------------------------------------------------------------------------


def test_a_target_is_approached_at_its_share_of_the_top_speed(stiff_robot):
    stiff_robot.ALMotion.setAngles("HeadYaw", 2.0, 0.1)
    stiff_robot.advance(1.0)
    assert commands(stiff_robot, "HeadYaw") == pytest.approx([0.1 * MODEL.joint("HeadYaw").max_velocity])
    assert sensed(stiff_robot, "HeadYaw") == pytest.approx(commands(stiff_robot, "HeadYaw"), abs=0.01)


@pytest.mark.parametrize(
    "names, angles, fraction, reached",
    [
        ("Head", [0.5, -0.2], 0.5, [0.5, -0.2]),
        ("Head", 0.25, 0.5, [0.25, 0.25]),
        (HEAD, [0.25], 0.5, [0.25, 0.25]),
        (HEAD, [0.5, -0.2], [0.5, 0.2], [0.5, -0.2]),
        ("HeadPitch", 9.0, 1.0, [0.0, MODEL.joint("HeadPitch").upper]),
    ],
)
def test_targets_in_all_shapes(stiff_robot, names, angles, fraction, reached):
    stiff_robot.ALMotion.setAngles(names, angles, fraction)
    stiff_robot.advance(1.0)
    assert commands(stiff_robot) == pytest.approx(reached)


def test_a_newer_target_replaces_the_older_one(stiff_robot):
    stiff_robot.ALMotion.setAngles("HeadYaw", 2.0, 0.1)
    stiff_robot.advance(0.5)
    stiff_robot.ALMotion.setAngles("HeadYaw", 0.0, 1.0)
    stiff_robot.advance(0.5)
    assert commands(stiff_robot, "HeadYaw") == pytest.approx([0.0], abs=1e-9)


def test_changes_add_up(stiff_robot):
    yaw, pitch = commands(stiff_robot)
    for _ in range(2):
        stiff_robot.ALMotion.changeAngles(HEAD, [0.25, -0.1], 0.5)
    stiff_robot.advance(1.0)
    assert commands(stiff_robot) == pytest.approx([yaw + 0.5, pitch - 0.2])


# --- interpolations ---------------------------------------------------------------------------------------------------


def test_an_interpolation_answers_when_it_has_arrived(stiff_robot):
    future = stiff_robot.post("ALMotion", "angleInterpolation", HEAD, [[0.5, 0.1], [-0.2]], [[1.0, 2.0], [1.0]], True)
    stiff_robot.handed_over("ALMotion")
    stiff_robot.advance(1.0)
    assert commands(stiff_robot) == pytest.approx([0.5, -0.2])
    assert future.isRunning()
    stiff_robot.advance(1.01)
    assert stiff_robot.answer(future) is None
    assert commands(stiff_robot) == pytest.approx([0.1, -0.2])
    assert sensed(stiff_robot) == pytest.approx([0.1, -0.2], abs=0.01)


def test_relative_angles_count_from_the_start_of_the_motion(stiff_robot):
    stiff_robot.finish("ALMotion", "angleInterpolation", "HeadYaw", 0.5, 0.5, True, after=0.6)
    stiff_robot.finish("ALMotion", "angleInterpolation", "HeadYaw", [0.1, -0.2], [0.5, 1.0], False, after=1.1)
    assert commands(stiff_robot, "HeadYaw") == pytest.approx([0.3])


def test_with_speed_it_takes_the_time_the_speed_needs(stiff_robot):
    fraction = 1.0 / MODEL.joint("HeadYaw").max_velocity
    future = stiff_robot.post("ALMotion", "angleInterpolationWithSpeed", "HeadYaw", 1.5, fraction)
    stiff_robot.handed_over("ALMotion")
    stiff_robot.advance(1.4)
    assert commands(stiff_robot, "HeadYaw") == pytest.approx([1.4], abs=0.01)
    assert stiff_robot.ALMotion.getTaskList() != []
    stiff_robot.advance(0.11)
    stiff_robot.answer(future)
    assert commands(stiff_robot, "HeadYaw") == pytest.approx([1.5])


def test_recorded_angles_of_the_whole_body_can_be_played_back(stiff_robot):
    """The two hips share a motor, but their sensors differ in the last digits."""
    recorded = sensed(stiff_robot, "Body")
    recorded[MODEL.joint_index["RHipYawPitch"]] += 0.002
    assert stiff_robot.finish("ALMotion", "angleInterpolation", "Body", recorded, 0.5, True, after=0.6) is None


def test_motions_of_one_joint_queue_up_and_others_run_beside(stiff_robot):
    calls = [("HeadYaw", 0.5), ("HeadYaw", 0.0), ("HeadPitch", 0.3)]
    futures = [stiff_robot.post("ALMotion", "angleInterpolation", name, to, 1.0, True) for name, to in calls]
    stiff_robot.handed_over("ALMotion")
    stiff_robot.advance(1.01)
    stiff_robot.answer(futures[0])
    stiff_robot.answer(futures[2])
    assert futures[1].isRunning()
    assert commands(stiff_robot) == pytest.approx([0.5, 0.3], abs=0.01)
    stiff_robot.advance(1.01)
    stiff_robot.answer(futures[1])
    assert commands(stiff_robot) == pytest.approx([0.0, 0.3])


@pytest.mark.parametrize("early", [True, False])
def test_a_cancelled_interpolation_stays_where_it_is(stiff_robot, early):
    with stiff_robot.busy_simulation():
        future = stiff_robot.post("ALMotion", "angleInterpolation", "HeadYaw", 1.0, 1.0, True)
        stiff_robot.ALMotion.ping()
        if early:
            future.cancel()
            stiff_robot.ALMotion.ping()
    stiff_robot.handed_over("ALMotion")
    stiff_robot.advance(0.5)
    if not early:
        future.cancel()
        stiff_robot.handed_over("ALMotion")
    stiff_robot.advance(1.0)
    future.wait(int(1000 * stiff_robot.patience))
    assert future.isCanceled()
    assert commands(stiff_robot, "HeadYaw") == pytest.approx([0.0 if early else 0.5], abs=0.02)


# --- hands ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("hand", ["LHand", "RHand"])
def test_a_hand_opens_and_closes(stiff_robot, hand):
    stiff_robot.finish("ALMotion", "openHand", hand, after=1.0)
    assert sensed(stiff_robot, hand) == pytest.approx([1.0], abs=0.03)
    stiff_robot.finish("ALMotion", "closeHand", hand, after=1.0)
    assert sensed(stiff_robot, hand) == pytest.approx([0.0], abs=0.03)


# --- refused ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "method, arguments, message",
    [
        (
            "getAngles",
            ("HeadYow", True),
            "ALMotion::getAngles unknown joint or chain 'HeadYow': did you mean 'HeadYaw'",
        ),
        ("setAngles", (["HeadYaw", "HeadYaw"], 0.1, 0.5), "named twice: HeadYaw"),
        ("setAngles", ("Head", [0.1, 0.2, 0.3], 0.5), "angles is .*, allowed is one number or 2, one for each joint"),
        ("setAngles", ("HeadYaw", "much", 0.5), "angles is 'much', allowed is a finite number"),
        ("setAngles", ("HeadYaw", 0.5, 1.5), "fractionMaxSpeed is 1.5, allowed is 0 to 1"),
        ("setAngles", ("HeadYaw", 0.5, 0.0), "fractionMaxSpeed is 0, allowed is above 0 to 1"),
        ("changeAngles", ([], 0.5, 0.5), "names is .*, allowed is a joint, a chain, or a list of them"),
        ("angleInterpolation", ("Head", [0.1], 1.0, True), "angleLists is .*, allowed is 2 entries"),
        ("angleInterpolation", ("HeadYaw", 0.1, 0.0, True), "allowed is times that rise, the first above 0 s"),
        ("angleInterpolationWithSpeed", ("HeadYaw", 0.1, -0.5), "fractionMaxSpeed is -0.5, allowed is 0 to 1"),
        ("openHand", ("LArm",), "unknown hand 'LArm'"),
    ],
)
def test_wrong_arguments_name_what_is_allowed_and_move_nothing(shared_robot, method, arguments, message):
    shared_robot.ALMotion.killAll()
    before = commands(shared_robot, "Body")
    with pytest.raises(RuntimeError, match=message):
        getattr(shared_robot.ALMotion, method)(*arguments)
    shared_robot.advance(0.05)
    assert commands(shared_robot, "Body") == before
    assert shared_robot.ALMotion.getTaskList() == []


# --- hands ------------------------------------------------------------------------------------------------------------


def test_a_hand_is_stiff_while_it_moves_and_limp_afterwards(robot):
    """Also one that was limp before; what it has reached, its gears hold."""
    motion = robot.ALMotion
    for method, reached in (("openHand", 1.0), ("closeHand", 0.0)):
        future = robot.post("ALMotion", method, "LHand")
        robot.handed_over("ALMotion")
        robot.advance(0.1)
        assert motion.getStiffnesses("LHand") == [1.0]
        robot.advance(3.0)
        assert robot.answer(future) is None
        assert motion.getStiffnesses(["LHand", "RHand"]) == [0.0, 0.0]
        assert sensed(robot, "LHand") == pytest.approx([reached], abs=0.05)


def test_a_hand_that_is_stopped_is_limp_too(stiff_robot):
    future = stiff_robot.post("ALMotion", "openHand", "RHand")
    stiff_robot.handed_over("ALMotion")
    stiff_robot.advance(0.1)
    stiff_robot.ALMotion.killAll()
    stiff_robot.answer(future)
    assert stiff_robot.ALMotion.getStiffnesses("RHand") == [0.0]


# --- limits -----------------------------------------------------------------------------------------------------------


def test_a_head_that_looks_aside_nods_less(stiff_robot):
    stiff_robot.finish("ALMotion", "angleInterpolationWithSpeed", HEAD, [1.5, 0.5], 0.5, after=2.0)
    upper = MODEL.coupled_limits["HeadPitch"].limits_at(1.5)[1]
    assert commands(stiff_robot) == pytest.approx([1.5, upper])
    assert sensed(stiff_robot) == pytest.approx([1.5, upper], abs=0.01)


def test_key_frames_faster_than_a_joint_end_when_it_has_arrived(stiff_robot):
    begun = stiff_robot.now.time
    future = stiff_robot.post("ALMotion", "angleInterpolation", "HeadYaw", 2.0, 0.05, True)
    stiff_robot.handed_over("ALMotion")
    while future.isRunning() and stiff_robot.now.time < begun + 1.0:
        stiff_robot.advance(1 / 120)
    needed = 2.0 / MODEL.joint("HeadYaw").max_velocity
    assert stiff_robot.now.time - begun == pytest.approx(needed, abs=2.1 / 60)
    assert commands(stiff_robot, "HeadYaw") == [2.0]
