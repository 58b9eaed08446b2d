"""What the robot notices of itself and its surroundings: walls, boxes, fingers, hands, heat, noise, broken devices."""

import math
from pathlib import Path

import numpy as np
import pytest

from nao_sim_bridge.base.errors import NotAllowed
from nao_sim_bridge.base.rotations import roll_pitch_yaw
from nao_sim_bridge.body.hand import AWAY
from nao_sim_bridge.body.sensors.sonar import NO_ECHO
from nao_sim_bridge.control.balance.posture_recognition import STANDING, PostureWatch, recognise
from nao_sim_bridge.core.hands import COME_TIME, LEAVE_TIME
from nao_sim_bridge.model.kinematics import link_transforms, quaternion_matrix, rpy_matrix, transform
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.touch_names import CHEST_BUTTON, HEAD, SENSORS
from nao_sim_bridge.world.objects import read_object

MODEL = load_model()
YAW = MODEL.joint_index["HeadYaw"]
ALL = (*SENSORS, CHEST_BUTTON)


BUMPERS = {f"{side}Foot/Bumper/{half}" for side in "LR" for half in ("Left", "Right")}
RAMP = "{name: ramp, box: [0.3, 1.0, 0.02], position: [0.27, 0, 0.018], rpy: [0, -0.2, 0], friction: 0}"


@pytest.mark.parametrize(
    "y, width, pressed",
    [
        (0.0, 0.4, BUMPERS),
        (0.09, 0.02, {"LFoot/Bumper/Left", "LFoot/Bumper/Right"}),
        (-0.05, 0.02, {"RFoot/Bumper/Left"}),
        (0.3, 0.05, set()),
    ],
)
def test_bumpers_feel_a_cart_that_slides_down_against_the_toes(bench, world_file, y, width, pressed):
    place = f"box: [0.05, {width}, 0.05], position: [0.2, {y}, 0.06]"
    cart = f"{{name: cart, {place}, rpy: [0, -0.2, 0], mass: 0.6, friction: 0}}"
    one = bench(world=world_file(RAMP, cart))
    assert not one.run(0.05).touched and one.run(1.0).touched == pressed
    one.simulation.reset()
    assert one.now.touched == frozenset()


def place(one, **entry):
    """A thing in the world in place of the one before."""
    if "it" in one.simulation.things.things:
        one.simulation.things.remove("it")
    one.simulation.things.place(read_object({"name": "it", **entry}, "it", Path))
    return one.run(0.2)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_slanting_wall_is_heard_by_the_sonar_that_it_faces(bench, side):
    """Turned by 30 degrees, `distance` from the origin; the other sonar gets nothing back from this mirror."""
    one, turn = bench(), side * math.pi / 6.0
    for distance in (0.3, 0.5, 1.0, 1.5, 2.0, 2.5):
        x, y = ((distance + 0.05) * f(turn) for f in (math.cos, math.sin))
        now = place(one, box=[0.1, 8, 2], position=[x, y, 1], rpy=[0, 0, turn])
        at = one.model.sonars[0 if side > 0.0 else 1].position + now.torso.position
        near, far = now.sonars[:: int(side)]
        assert near == pytest.approx(distance - (at[0] * math.cos(turn) + at[1] * math.sin(turn)), abs=0.003)
        assert far == NO_ECHO


def test_a_robot_with_noise_feels_errors_of_its_seed_but_the_truth_stays_true(bench):
    noisy, same, other = (bench("Crouch", sensor_noise=1.0, seed=seed).run(0.4) for seed in (1, 1, 2))
    true = bench("Crouch").run(0.4)
    assert noisy == same and noisy.imu != other.imu
    assert noisy.positions != true.positions and noisy.positions == pytest.approx(true.positions, abs=0.01)
    assert noisy.imu.angles != true.imu.angles and noisy.odometry != true.odometry
    assert roll_pitch_yaw(noisy.torso.orientation) == pytest.approx(true.imu.angles, abs=2e-3)
    assert max(map(abs, noisy.angular_velocity)) < 0.01 < max(map(abs, noisy.imu.gyroscope))


def test_a_picture_shows_the_joints_as_they_are_not_as_noisy_sensors_say(bench):
    one = bench("Crouch", sensor_noise=1.0)
    one.run(0.1)
    shown = one.simulation.render_state()
    assert shown.joint_positions == one.robot.true_positions != one.now.positions


def test_a_broken_motor_gives_no_torque_until_it_is_repaired_and_only_stiff_ones_are_found(bench):
    one = bench()
    faults = one.robot.faults
    faults.break_device("HeadYaw")
    one.aim(3.0, HeadYaw=0.8)
    one.run(1.0)
    assert one.joint("HeadYaw") == pytest.approx(0.0, abs=0.02) and one.robot.joints.efforts[YAW] == 0.0
    for how, found in ((0.0, frozenset()), (1.0, {YAW})):
        faults.try_motors([how] * 26)
        assert faults.found == found
    faults.repair("HeadYaw")
    one.run(1.0)
    assert one.joint("HeadYaw") == pytest.approx(0.8, abs=0.02) and faults.found == frozenset()


def test_broken_sensors_read_an_error_beside_others_that_work(bench):
    one = bench()
    whole = one.run(0.5).right_foot
    one.robot.faults.break_device("Head/Touch/Rear")
    seen = one.watch(0.3)
    assert len({id(now.sonars) for now in seen}) == len({id(now.echoes) for now in seen}) in (3, 4)
    for device in ("US/Right", "RFoot/FSR/RearLeft", "InertialSensor", "LKneePitch"):
        one.robot.faults.break_device(device)
    one.run(0.2)
    assert one.now.sonars[1] == 0.0 and one.now.currents and one.now.right_foot.forces[2] == 0.0
    assert one.now.right_foot.total == pytest.approx(whole.total - whole.forces[2], rel=0.05)
    assert one.now.left_foot.total > 5.0
    one.simulation.reset()
    assert (one.robot.faults.sensors, one.robot.faults.motors) == (frozenset(), frozenset()), "a new robot is whole"


def test_a_posture_is_recognised_anew_when_the_feet_tell_nothing_any_more(bench):
    one, watch = bench(), PostureWatch(MODEL)
    one.run(0.5)
    before = watch.recognise(one.now)
    assert before.family == STANDING
    for side in "LR":
        for corner in ("FrontLeft", "FrontRight", "RearLeft", "RearRight"):
            one.robot.faults.break_device(f"{side}Foot/FSR/{corner}")
    one.run(0.1)
    assert watch.recognise(one.now) == recognise(MODEL, one.now) != before


def ray_at(one, name):
    """From a place outside the robot that looks at a sensor, nearly straight."""
    at = next(place for place in one.model.touch if place.name == name)
    torso = transform(quaternion_matrix(one.now.torso.orientation), one.now.torso.position)
    link = torso @ link_transforms(one.model, one.now.positions)[at.parent_link]
    eye = (link @ [*(at.position + rpy_matrix(at.rpy) @ (0.7, 0.1, 0.2)), 1.0])[:3]
    direction = (link @ [*at.position, 1.0])[:3] - eye
    return tuple(eye), tuple(direction / np.linalg.norm(direction))


def test_pointing_at_a_sensor_touches_it_until_the_button_is_released(bench, world_file):
    one = bench("StandInit")
    for name in ALL:
        if name in ("LHand/Touch/Left", "RHand/Touch/Right"):
            continue  # legs hide the inner sides of the hands
        for aside in (None, ((1.2, -0.7, 0.6), (0.0, 1.0, 0.0))):
            one.robot.point_at(ray_at(one, name))
            assert one.simulation.tick().touched == {name}
            one.robot.point_at(aside)
            assert one.simulation.tick().touched == frozenset()
    one = bench(world=world_file("{name: wall, box: [0.02, 2, 2], position: [0.4, 0, 1]}"))
    one.robot.point_at(ray_at(one, CHEST_BUTTON))
    assert one.simulation.tick().touched == frozenset(), "what hides a sensor is pointed at instead"


def touch(one, sensors, duration, limit=3.0):
    """Touch, and the snapshots until the hand has gone."""
    task, seen = one.simulation.hands.touch(sensors, duration), []
    while not task.finished and len(seen) < limit * 120:
        seen.append(one.simulation.tick())
    felt = [snapshot.time for snapshot in seen if sensors[0] in snapshot.touched]
    assert task.result(0) == felt[0] and not task.killed
    return seen


@pytest.mark.parametrize("posture, stiffness", [("Stand", 0.0), ("Crouch", 1.0)])
def test_each_sensor_feels_a_hand_and_the_robot_keeps_still(bench, posture, stiffness):
    one = bench(posture, stiffness)
    start = one.run(0.3)
    for name in ALL:
        seen = touch(one, [name], 0.3)
        felt = [snapshot.time for snapshot in seen if name in snapshot.touched]
        assert (felt[0] - seen[0].time, felt[-1] - felt[0]) == pytest.approx((COME_TIME, 0.3), abs=0.05), name
        # A finger between two sensors of one part may touch both.
        parts = {other.rsplit("/", 1)[0] for snapshot in seen for other in snapshot.touched}
        assert parts == {name.rsplit("/", 1)[0]}, name
        links = [(one.robot.link_name(c.link), c.force) for snapshot in seen for c in snapshot.contacts]
        assert max((force for link, force in links if "ankle" not in link), default=0.0) < 8.0, name
    for snapshot in (start, one.now):
        assert math.hypot(*snapshot.imu.angles[:2]) == pytest.approx(math.hypot(*start.imu.angles[:2]), abs=0.02)
    assert math.dist(start.torso.position, one.now.torso.position) < 0.005
    assert "hand" not in one.now.objects and one.now.placed == ()


def test_hands_stay_until_they_are_released_are_seen_and_go_with_a_robot_that_moves(bench):
    one = bench()
    task = one.simulation.hands.touch(["MiddleTactilTouched"], 0.0)
    one.simulation.tick()
    (hand,) = one.now.placed
    assert hand.name == "hand" and "hand" in one.simulation.render_state(one.now).objects
    far = one.now.objects["hand"].position[2]
    near = one.run(0.5).objects["hand"].position[2]
    assert far - near == pytest.approx(AWAY, abs=0.03) and task.finished
    one.aim(0.8, HeadYaw=0.7, HeadPitch=0.2)
    felt = [HEAD[1] in snapshot.touched for snapshot in one.watch(1.5)]
    assert sum(felt) > 0.98 * len(felt)
    with pytest.raises(NotAllowed, match="a hand touches Head/Touch/Middle already: release it first"):
        one.simulation.hands.touch(HEAD, 1.0)
    one.simulation.hands.touch([CHEST_BUTTON], 0.0)
    assert one.run(0.6).touched == {HEAD[1], CHEST_BUTTON} and set(one.now.objects) == {"hand", "hand_2"}
    one.simulation.hands.release([HEAD[1]])
    assert one.run(LEAVE_TIME + 0.02).touched == {CHEST_BUTTON}
    one.simulation.hands.release()
    assert one.run(0.3).touched == frozenset() and one.now.placed == ()


@pytest.mark.parametrize("end", ["kill", "reset"])
def test_a_touch_that_is_killed_or_reset_is_over_and_another_may_come(bench, end):
    one = bench()
    task = one.simulation.hands.touch([HEAD[0]], 5.0)
    assert HEAD[0] in one.run(0.5).touched
    {"kill": task.kill, "reset": one.simulation.reset}[end]()
    assert not one.run(0.3).touched and one.now.placed == () and task.killed
    one.simulation.hands.release()
    assert touch(one, [HEAD[0]], 0.1)
