"""ALMotion moves joints: targets, interpolations, curves, hands, stiffness; and lists and kills what runs."""

import pytest

from nao_sim_bridge.model.model_reader import load_model

MODEL = load_model()
HEAD = ["HeadYaw", "HeadPitch"]
INTERPOLATION = "angleInterpolation"


@pytest.fixture(autouse=True)
def stiff(stiff_robot):
    return stiff_robot


@pytest.fixture
def commands(motion):
    return lambda names="Head": motion.getAngles(names, False)


@pytest.fixture
def sensed(motion):
    return lambda names="Head": motion.getAngles(names, True)


@pytest.fixture
def play(robot):
    """A motion of ALMotion that is over after so many seconds; its answer."""
    return lambda method, *arguments, after: robot.finish("ALMotion", method, *arguments, after=after)


def near(*values, within=1e-6):
    return pytest.approx(list(values), abs=within)


def test_a_target_is_approached_at_its_share_of_the_top_speed_and_replaced(robot, motion, commands, sensed):
    motion.setAngles("HeadYaw", 2.0, 0.1)
    robot.advance(1.0)
    assert motion.getTaskList() == []
    assert commands("HeadYaw") == near(0.1 * MODEL.joint("HeadYaw").max_velocity)
    assert sensed("HeadYaw") == pytest.approx(commands("HeadYaw"), abs=0.01)
    motion.setAngles("HeadYaw", 0.0, 1.0)
    robot.advance(0.5)
    assert commands("HeadYaw") == near(0.0)
    pitch = commands()[1]
    for _ in range(2):  # changes add up
        motion.changeAngles(HEAD, [0.25, -0.1], 0.5)
    robot.advance(1.0)
    assert commands() == near(0.5, pitch - 0.2)
    assert commands(["HeadPitch", "LHand", "HeadYaw"]) == near(pitch - 0.2, 0.3, 0.5) and len(sensed("Body")) == 26


def test_targets_come_in_all_shapes_and_stay_within_limits(robot, motion, commands):
    for names, angles, fraction, reached in (
        ("Head", [0.5, -0.2], 0.5, [0.5, -0.2]),
        ("Head", 0.25, 0.5, [0.25, 0.25]),
        (HEAD, [0.1], 0.5, [0.1, 0.1]),
        (HEAD, [0.5, -0.2], [0.5, 0.2], [0.5, -0.2]),
        ("HeadPitch", 9.0, 1.0, [0.5, MODEL.coupled_limits["HeadPitch"].limits_at(0.5)[1]]),
    ):
        motion.setAngles(names, angles, fraction)
        robot.advance(1.0)
        assert commands() == pytest.approx(reached)


def test_a_head_that_looks_aside_nods_less(play, commands):
    play("angleInterpolationWithSpeed", HEAD, [1.5, 0.5], 0.5, after=2.0)
    assert commands() == near(1.5, MODEL.coupled_limits["HeadPitch"].limits_at(1.5)[1])


def test_an_interpolation_answers_when_it_has_arrived(robot, begin, play, commands, sensed):
    future = begin("ALMotion", INTERPOLATION, HEAD, [[0.5, 0.1], [-0.2]], [[1.0, 2.0], [1.0]], True, after=1.0)
    assert commands() == near(0.5, -0.2) and future.isRunning()
    robot.advance(1.01)
    assert robot.answer(future) is None
    assert commands() == near(0.1, -0.2) and sensed() == near(0.1, -0.2, within=0.01)
    play(INTERPOLATION, "HeadYaw", [0.1, -0.2], [0.5, 1.0], False, after=1.1)  # from the start of the motion
    assert commands("HeadYaw") == near(-0.1)


def test_with_speed_and_for_key_frames_too_fast_it_takes_the_time_that_is_needed(robot, motion, begin, commands):
    top = MODEL.joint("HeadYaw").max_velocity
    future = begin("ALMotion", "angleInterpolationWithSpeed", "HeadYaw", 1.5, 1.0 / top, after=1.4)
    assert commands("HeadYaw") == near(1.4, within=0.01) and motion.getTaskList() != []
    robot.advance(0.11)
    robot.answer(future)
    assert commands("HeadYaw") == near(1.5)
    begun, future = robot.now.time, begin("ALMotion", INTERPOLATION, "HeadYaw", -0.5, 0.05, True)
    robot.advance_until(lambda: not future.isRunning(), 1.0, 1 / 120)
    assert robot.now.time - begun == pytest.approx(2.0 / top, abs=2.1 / 60) and commands("HeadYaw") == [-0.5]


def test_motions_of_one_joint_queue_up_and_others_run_beside(robot, begin, commands):
    one, two, three = (
        begin("ALMotion", INTERPOLATION, name, to, 1.0, True)
        for name, to in (("HeadYaw", 0.5), ("HeadYaw", 0.0), ("HeadPitch", 0.3))
    )
    robot.advance(1.01)
    robot.answer(one), robot.answer(three)
    assert two.isRunning() and commands() == near(0.5, 0.3, within=0.01)
    robot.advance(1.01)
    robot.answer(two)
    assert commands() == near(0.0, 0.3)


def test_a_cancelled_interpolation_stays_where_it_is(robot, begin, commands):
    future = begin("ALMotion", INTERPOLATION, "HeadYaw", 1.0, 1.0, True, after=0.5)
    future.cancel()
    robot.handed_over("ALMotion")
    robot.advance(1.0)
    future.wait(int(1000 * robot.patience))
    assert future.isCanceled() and commands("HeadYaw") == near(0.5, within=0.02)


def test_a_hand_opens_and_closes_is_stiff_while_it_moves_and_limp_afterwards(robot, motion, begin, sensed):
    motion.setStiffnesses("RHand", 0.0)
    for hand in ("LHand", "RHand"):
        for method, reached in (("openHand", 1.0), ("closeHand", 0.0)):
            future = begin("ALMotion", method, hand, after=0.1)
            assert motion.getStiffnesses(hand) == [1.0]
            robot.advance(2.0)
            assert robot.answer(future) is None
            assert motion.getStiffnesses(hand) == [0.0] and sensed(hand) == near(reached, within=0.05)


def test_stiffness_is_set_at_once_or_in_time(robot, motion, begin):
    motion.setStiffnesses("Body", 0.0)
    for names, stiffnesses, expected in (
        ("Head", 0.5, [0.5, 0.5]),
        (HEAD, [0.25, 1.0], [0.25, 1.0]),
        ("HeadYaw", [0.5], [0.5, 1.0]),
    ):
        motion.setStiffnesses(names, stiffnesses)
        assert motion.getStiffnesses("Head") == expected
    motion.setStiffnesses("RHipYawPitch", 0.5)  # either hip stiffens both
    assert motion.getStiffnesses(["LHipYawPitch", "RHipYawPitch"]) == [0.5, 0.5]
    motion.setStiffnesses("Head", 0.0)
    future = begin("ALMotion", "stiffnessInterpolation", HEAD, [[1.0, 0.0], [0.5]], [[1.0, 2.0], [1.0]], after=0.5)
    assert motion.getStiffnesses("Head") == near(0.5, 0.25, within=0.01)
    robot.advance(1.51)
    assert robot.answer(future) is None and motion.getStiffnesses("Head") == [0.0, 0.5]
    future = begin("ALMotion", "stiffnessInterpolation", "Body", 1.0, 5.0, after=0.5)
    motion.setStiffnesses("Body", 0.25)
    robot.answer(future)
    assert motion.getStiffnesses("Body") == [0.25] * 26


def test_a_limp_joint_takes_commands_but_follows_none_and_does_not_jump(robot, motion, commands, sensed, caplog):
    motion.setStiffnesses("HeadYaw", 0.0)
    for _ in range(2):
        motion.setAngles("HeadYaw", 0.5, 1.0)
        robot.advance(1.0)
    told = [record.getMessage() for record in caplog.records if record.name == "nao_sim.motion"]
    assert told == ["setAngles: no stiffness in HeadYaw: wakeUp or setStiffnesses comes first"]
    assert commands("HeadYaw") == near(0.5) and sensed("HeadYaw") == near(0.0, within=0.01)
    motion.setStiffnesses("HeadYaw", 1.0)
    robot.advance(0.5)
    assert sensed("HeadYaw") == near(0.0, within=0.01)


def test_wrong_arguments_name_what_is_allowed_and_move_nothing(refuses):
    refuses("ALMotion", r"""
        getAngles('HeadYow', True) -> unknown joint or chain 'HeadYow': did you mean 'HeadYaw'
        setAngles('Head', [0.1, 0.2, 0.3], 0.5) -> angles is .*, allowed is one number or 2, one for each joint
        setAngles('HeadYaw', 0.5, 1.5) -> fractionMaxSpeed is 1.5, allowed is 0 to 1
        angleInterpolation('HeadYaw', 0.1, 0.0, True) -> allowed is times that rise, the first above 0 s
        openHand('LArm') -> unknown hand 'LArm'
        setStiffnesses('Head', 1.5) -> stiffnesses is 1.5, allowed is 0 to 1
        angleInterpolationBezier(['HeadYaw', 'HeadPitch'], [[0.5], [0.5]], [[0.1, 0.2], [0.1]]) -> as many points as t
        angleInterpolationBezier(['HeadYaw'], [[0.5]], [[[0.1, [7, 0.0, 0.0]]]]) -> type of a handle is 7
        angleInterpolationBezier(['HeadYaw'], [[0.5]], [[[0.1, [3, 0.2, 0.0], [3, 0.2, 0.0]]]]) -> dTime of 0 or less
        animation(['HeadYaw'], [[0.3]], [[0.2]], True, [[0.1, 'LLeg']]) -> supportSequence
    """)  # fmt: skip
