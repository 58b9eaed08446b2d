"""Nothing that is not finite gets to the engine; what it has lost nevertheless begins anew, and is named."""

import math

import pytest

from nao_sim_bridge.base.errors import NotFinite, check_finite
from nao_sim_bridge.base.readings import Pose
from nao_sim_bridge.control.joints.curves import SmoothCurve

BALL = "{name: ball, sphere: 0.04, position: [0.3, 0.02, 0.04], mass: 0.2}"
NAN = math.nan
HUGE = 1.7e308
HERE = (0.0, 0.0, 0.0, 1.0)


def sound(one):
    """Whether the robot stands, and all that is sensed are numbers."""
    now = one.now
    numbers = (*now.positions, *now.torso.position, *now.torso.orientation, *now.imu.angles)
    return all(map(math.isfinite, numbers)) and now.torso.position[2] > 0.3


def culprits(one):
    return [failure.culprit for failure in one.simulation.shared.guard.failures()]


@pytest.mark.parametrize("numbers", [[NAN], [0.0, math.inf], [-math.inf, math.inf], [HUGE, HUGE], [HUGE, -HUGE, NAN]])
def test_a_number_that_is_not_finite_is_told(numbers):
    with pytest.raises(NotFinite, match="targets: numbers must be finite, found "):
        check_finite("targets", numbers)
    check_finite("targets", [1e300, -1e300, 0.0])


def test_a_curve_that_overflows_fails_alone_and_the_head_stays_where_it_is(bench):
    one = bench()
    curve = SmoothCurve((0.0, 1.0, 2.0), (0.0, HUGE, -HUGE))
    failing = one.robot.motion.follow("angleInterpolation", [0], lambda _: {0: curve})
    other = one.robot.motion.follow("angleInterpolation", [1], lambda _: {1: SmoothCurve((0.0, 1.0), (0.0, 0.2))})
    one.run(2.5)
    with pytest.raises(NotFinite, match="angleInterpolation"):
        failing.result(timeout=0)
    assert other.error is None and one.joint("HeadPitch") == pytest.approx(0.2, abs=0.02)
    assert culprits(one) == ["task angleInterpolation"] and sound(one)


@pytest.mark.parametrize("targets, speeds", [({0: NAN}, {0: 1.0}), ({0: 0.1}, {0: math.inf})])
def test_targets_that_are_no_numbers_are_refused(bench, targets, speeds):
    with pytest.raises(NotFinite):
        bench().robot.motion.set_targets(targets, speeds)


@pytest.mark.parametrize("what", ["commands", "stiffnesses"])
def test_what_the_motors_are_told_is_put_right_and_they_go_on(bench, what):
    one = bench()
    one.run(0.1)
    values = list(getattr(one.robot.joints, what))
    values[0] = values[5] = NAN
    setattr(one.robot.joints, what, tuple(values))
    one.robot.joints.set_stiffness({1: 0.9} if what == "stiffnesses" else {1: 0.0})
    one.run(0.5)
    assert sound(one) and culprits(one) == ["motion"]
    one.robot.motion.set_stiffness_now({0: 1.0})
    one.aim(HeadYaw=0.3)
    one.run(1.0)
    assert one.joint("HeadYaw") == pytest.approx(0.3, abs=0.02)


def test_pushes_and_places_that_are_no_numbers_are_refused(bench, world_file):
    one = bench(world=world_file(BALL))
    physics = one.simulation._physics
    for refused in (
        lambda: one.push((NAN, 0.0, 0.0), 0.1),
        lambda: physics.pushing({"torso": (math.inf, 0.0, 0.0)}),
        lambda: physics.place([0.0] * 25 + [NAN]),
        lambda: physics.place([0.0] * 26, xy=(NAN, 0.0)),
        lambda: physics.bodies.put("ball", Pose((NAN, 0.0, 0.0), HERE)),
        lambda: physics.bodies.carry("ball", Pose((0.0, 0.0, 1.0), HERE), Pose((0.0, 0.0, math.inf), HERE), 0.1),
    ):
        with pytest.raises(NotFinite):
            refused()
    one.run(0.1)
    assert one.now.objects["ball"].position[0] == pytest.approx(0.3, abs=0.01)


@pytest.mark.parametrize("body", ["robot", "ball"])
def test_a_world_whose_engine_has_lost_a_body_begins_anew(bench, world_file, body):
    one = bench(world=world_file(BALL))
    one.run(0.2)
    walk = one.robot.motion.follow("glide", [0], lambda _: {0: SmoothCurve((0.0, 5.0), (0.0, 1.0))})
    physics, before = one.simulation._physics, one.simulation.ticks
    number = physics.robot if body == "robot" else physics.bodies.ids["ball"]
    physics.engine.resetBaseVelocity(number, (NAN, 0.0, 0.0), (0.0, 0.0, 0.0))
    one.run(0.1)
    (failure,) = one.simulation.shared.guard.failures()
    assert failure.culprit == "physics, which begins anew," and "numbers must be finite" in failure.error
    assert walk.killed and one.simulation.ticks == before + 12
    one.stiffen(1.0)
    one.run(0.5)
    assert sound(one) and one.now.objects["ball"].position[2] == pytest.approx(0.04, abs=0.01)
