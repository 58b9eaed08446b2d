"""The simulator as a library: what a script does with it, and what is the same from run to run."""

from __future__ import annotations

import math
import subprocess
import sys
import time

import numpy as np
import pybullet
import pytest
import qi

from nao_sim_bridge import NaoSim
from nao_sim_bridge.base.errors import BadValue, MoveRefused, NotAllowed, SimulationError, UnknownName

CRATE = {"name": "crate", "box": [0.1, 0.1, 0.1]}


@pytest.fixture
def nao():
    with NaoSim(seed=1) as sim:
        yield sim


def felt(sim):
    now = sim.snapshot
    return now.positions, now.velocities, now.torso, now.imu, now.contacts


def stumble(sim):
    """Something that reaches motors, contacts, noise and balance."""
    sim.walk(0.06, 0.0, 0.2)
    sim.push("Torso", (12.0, 8.0, 0.0), 0.2)
    sim.step(1.5)
    return felt(sim)


def test_it_walks_to_where_it_is_sent(nao):
    assert nao.walk_to(0.3, 0.1, 0.4).result is True
    assert nao.pose_on_ground == pytest.approx((0.3, 0.1, 0.4), abs=0.03)


def test_a_motion_is_no_truth_value_and_has_its_result_when_it_has_ended(nao):
    motion = nao.move_angles("HeadYaw", 0.1, duration=0.1, wait=False)
    assert (motion.done, motion.result) == (False, None)
    with pytest.raises(TypeError, match="`result` tells"):
        bool(motion)


def test_joints_go_to_their_targets(nao):
    nao.set_angles(["HeadYaw", "LArm"], [0.5, 1.0, 0.3, -1.0, -0.5, 0.2, 0.5])
    nao.step(2.0)
    assert nao.angles["HeadYaw"] == pytest.approx(0.5, abs=0.01)
    assert np.asarray(nao.angles)[2:7] == pytest.approx([1.0, 0.3, -1.0, -0.5, 0.2], abs=0.03)


def test_a_motion_ends_in_its_time(nao):
    began = nao.time
    nao.move_angles("HeadPitch", 0.2, duration=0.7)
    assert nao.time - began == pytest.approx(0.7, abs=0.05)
    assert nao.angles["HeadPitch"] == pytest.approx(0.2, abs=0.01)


def test_a_motion_that_is_cancelled_stops_where_it_is(nao):
    motion = nao.move_angles("HeadYaw", 1.0, duration=2.0, wait=False)
    nao.step(1.0)
    motion.cancel()
    nao.step(0.5)
    assert motion.done and nao.angles["HeadYaw"] == pytest.approx(0.5, abs=0.05)


def test_the_feet_bear_the_robot_and_lean_tells_where(nao):
    nao.step(1.0)
    assert nao.feet.left.total + nao.feet.right.total == pytest.approx(nao.robot.model.total_mass * 9.81, rel=0.05)
    assert nao.feet.center_of_pressure == pytest.approx((0.0, 0.0), abs=0.03)
    before = nao.feet.center_of_pressure[1]
    nao.push("Torso", (0.0, 6.0, 0.0), 0.3)
    nao.step(0.25)
    assert nao.feet.center_of_pressure[1] > before + 0.01


def test_pushes_at_the_same_time_add_up(nao):
    def speed(*forces):
        nao.reset(1)
        for force in forces:
            nao.push("Torso", force, 0.1)
        nao.step(0.1)
        return np.array(nao.snapshot.linear_velocity)

    assert speed((8.0, 0.0, 0.0), (8.0, 0.0, 0.0)) == pytest.approx(speed((16.0, 0.0, 0.0)))


def test_a_pushed_robot_without_protection_falls_and_gets_up(nao):
    nao.protect(False)
    nao.push("Torso", (60.0, 0.0, 0.0), 0.2)
    nao.step(3.0)
    assert nao.fallen
    with pytest.raises(MoveRefused):
        nao.walk_to(0.1)
    assert nao.go_to_posture("Stand").wait() is True and not nao.fallen


@pytest.mark.parametrize(
    "posture, lean", [("Stand", 0.0), ("StandInit", 0.0), ("LyingBack", math.pi / 2.0), ("LyingBelly", math.pi / 2.0)]
)
def test_a_robot_leans_by_the_angle_from_upright_and_has_fallen_when_it_lies(posture, lean):
    with NaoSim(posture=posture) as nao:
        nao.step(0.5)
        assert nao.lean == pytest.approx(lean, abs=0.35) and nao.fallen is (lean > 1.0)


@pytest.mark.parametrize("noise, delay", [(0.0, 0.0), (1.0, 0.03)])
def test_equal_seeds_and_calls_are_equal_to_the_last_bit(noise, delay):
    with NaoSim(seed=3, noise=noise, delay=delay) as first, NaoSim(seed=3, noise=noise, delay=delay) as second:
        assert stumble(first) == stumble(second)


@pytest.mark.parametrize("world, robots", [("empty", 1), ("empty", 2), ("obstacles", 1), ("uneven", 1), ("lab", 1)])
def test_a_reset_is_a_fresh_start_to_the_last_bit(world, robots):
    with NaoSim(seed=3, noise=1.0, world=world, robots=robots) as sim:
        once = stumble(sim)
        for _ in range(3):  # the first builds the world once more, the others put it back
            sim.reset(3)
            assert stumble(sim) == once
        sim.reset(4)
        assert stumble(sim) != once


def test_balance_begins_anew_with_a_reset(nao):
    def pushed():
        nao.push("Torso", (30.0, 10.0, 0.0), 0.2)
        nao.step(1.0)
        return felt(nao)

    once = pushed()
    nao.reset(1)
    assert pushed() == once


def test_friction_and_payload_last_until_the_next_reset_and_come_back_with_a_state(nao):
    once = stumble(nao)
    nao.reset(1, payload=1.0)
    nao.robot.scale_friction(0.1)
    state = nao.save_state()
    slipped = stumble(nao)
    for _ in range(2):  # the first one has built the world once more
        nao.reset(1, payload=0.0)
        assert stumble(nao) == once != slipped
    nao.restore_state(state)
    assert stumble(nao) == slipped


def test_a_reset_takes_back_what_was_placed(nao):
    once = stumble(nao)
    nao.place("box", at=(0.6, 0.0, 0.05))
    nao.step(0.5)
    assert "box" in nao.things
    nao.reset(1)
    assert "box" not in nao.things and stumble(nao) == once


def test_what_follows_a_saved_state_is_the_same_each_time():
    with NaoSim(seed=2, noise=1.0) as nao:
        stumble(nao)
        nao.stop()
        nao.step(0.5)
        state = nao.save_state()
        once = stumble(nao)
        assert nao.time > 3.0
        nao.stop()
        for _ in range(2):
            nao.restore_state(state)
            assert stumble(nao) == once


def test_a_state_is_refused_where_it_does_not_fit(nao):
    motion = nao.move_angles("HeadYaw", 0.5, duration=1.0, wait=False)
    with pytest.raises(NotAllowed, match="no motion"):
        nao.save_state()
    motion.wait()
    state = nao.save_state()
    nao.place("box", at=(0.6, 0.0, 0.05))
    with pytest.raises(BadValue, match="nothing has come or gone"):
        nao.restore_state(state)
    nao.reset()
    with pytest.raises(BadValue, match="since its last reset"):
        nao.restore_state(state)


def test_a_state_knows_a_thing_that_has_moved_and_one_that_has_taken_the_name_of_another(nao):
    nao.place("box", at=(0.8, 0.0, 0.05), mass=0.0)
    state = nao.save_state()
    nao.place("box", at=(0.8, 1.0, 0.05))
    nao.restore_state(state)
    nao.step()
    assert nao.snapshot.objects["box"].position == pytest.approx((0.8, 0.0, 0.05)) and nao.things["box"][1] == 0.0
    nao.remove("box")
    nao.place("box", at=(0.8, 0.0, 0.15), box=[0.3, 0.3, 0.3], mass=0.0)
    with pytest.raises(BadValue, match="nothing has come or gone"):
        nao.restore_state(state)


def test_the_engine_keeps_no_state_that_nobody_holds(nao, monkeypatch):
    freed, remove = [], pybullet.removeState
    monkeypatch.setattr(pybullet, "removeState", lambda state, **client: freed.append(state) or remove(state, **client))
    states = [nao.save_state() for _ in range(200)]
    assert freed == []
    del states[1:]
    nao.step()
    assert len(freed) == 199
    for _ in range(200):
        state = nao.save_state()
    nao.step()
    assert len(freed) == 199 + 199
    (kept,) = states
    for _ in range(2):
        kept.drop()
        nao.step()
    assert len(freed) == 199 + 199 + 1
    with pytest.raises(BadValue, match="dropped"):
        nao.restore_state(kept)
    nao.restore_state(state)


def test_things_come_move_and_go(nao):
    assert nao.place("ball", at=(1.0, 0.0, 0.03)) == "ball"
    nao.place("ball", at=(1.0, 0.5, 0.03))
    assert nao.things["ball"][:2] == pytest.approx((1.0, 0.5), abs=0.01)
    nao.remove("ball")
    assert nao.things == {}


def test_a_thing_that_is_placed_again_or_moved_goes_and_turns(nao):
    nao.place(CRATE, at=(1.0, 0.0, 0.05))
    for again in ("crate", CRATE):
        nao.place(again, at=(1.0, 0.3, 0.05), heading=0.4)
        assert nao.things["crate"] == pytest.approx((1.0, 0.3, 0.05, 0.0, 0.0, 0.4))
        nao.place(again, at=(1.0, 0.0, 0.05), rpy=(0.0, 0.0, -0.4))
        assert nao.things["crate"] == pytest.approx((1.0, 0.0, 0.05, 0.0, 0.0, -0.4))
    nao.place("crate", at=(1.0, 0.1, 0.05))
    began = nao.time
    nao.move("crate", (1.2, 0.1, 0.05), duration=0.5)
    assert nao.things["crate"] == pytest.approx((1.2, 0.1, 0.05, 0.0, 0.0, -0.4))
    assert nao.time - began == pytest.approx(0.5)
    turning = nao.move("crate", rpy=(0.0, 0.0, 0.6), duration=1.0, wait=False)
    nao.step(0.5)
    assert nao.things["crate"] == pytest.approx((1.2, 0.1, 0.05, 0.0, 0.0, 0.1)) and not turning.done


@pytest.mark.parametrize(
    "thing, more, told",
    [
        ("box", {"colour": (1, 0, 0)}, "unknown key 'colour': did you mean 'color'"),
        ("bx", {}, "'bx': did you mean 'box'"),
        ("landmark", {}, "landmark=..."),
        ({"box": [1, 1, 1]}, {}, "missing 'name'"),
        ("crate", {"mass": 1.0}, r"unknown key 'mass' \(allowed: rpy, heading\)"),
        (CRATE, {"colour": (1, 0, 0)}, "unknown key 'colour'"),
        (CRATE, {"mass": 1.0}, "'crate' is there already, and not with mass 1.0: .*at, rpy, heading"),
        (CRATE, {"color": (1, 0, 0)}, r"not with box \[.*\], color \(1, 0, 0\)"),
        (CRATE, {"position": (1, 0, 0)}, "`at` says where"),
        (CRATE, {"rpy": (0, 0, 1), "heading": 1.0}, "rpy and heading"),
    ],
)
def test_what_is_said_of_a_thing_and_cannot_be_is_refused(nao, thing, more, told):
    nao.place(CRATE, at=(1.0, 0.0, 0.05))
    with pytest.raises(SimulationError, match=told):
        nao.place(thing, at=(1.0, 1.0, 0.05), **more)
    assert nao.things == {"crate": pytest.approx((1.0, 0.0, 0.05, 0.0, 0.0, 0.0))}


@pytest.fixture
def lifted():
    with NaoSim(seed=1, world="platform") as sim:
        yield sim


def test_a_robot_on_a_plate_that_moves_is_carried_along(lifted):
    lifted.move("plate", (0.1, 0.05, 0.3), rpy=(0.0, 0.0, 0.4), duration=1.0)
    lifted.step(0.5)
    assert lifted.pose_on_ground == pytest.approx((0.1, 0.05, 0.4), abs=0.02)
    assert np.linalg.norm(lifted.snapshot.linear_velocity) < 0.03
    lifted.move("plate", rpy=(0.0, 0.06, 0.4), duration=0.8)
    lifted.step(0.4)
    assert lifted.imu.angles[1] == pytest.approx(0.06, abs=0.02) and not lifted.fallen


def test_a_robot_on_a_plate_that_tilts_too_far_falls(lifted):
    lifted.move("plate", rpy=(0.0, 0.4, 0.0), duration=0.5)
    lifted.step(2.0)
    assert lifted.fallen


def swing(seconds):
    return (0.03 * math.sin(3.0 * seconds), 0.0, 0.3, 0.04 * math.sin(2.0 * seconds), 0.0, 0.0)


def test_a_plate_goes_along_its_path_until_it_is_told_otherwise(lifted):
    swinging = lifted.move_along("plate", swing)
    lifted.step(1.3)
    assert lifted.things["plate"] == pytest.approx(swing(1.3), abs=1e-6) and not lifted.fallen
    swinging.cancel()
    lifted.step(0.5)
    assert lifted.things["plate"] == pytest.approx(swing(1.3), abs=1e-6)
    timed = lifted.move_along("plate", lambda seconds: swing(1.3 - seconds), duration=0.7)
    timed.wait()
    assert lifted.things["plate"] == pytest.approx(swing(0.6), abs=1e-6)
    broken = lifted.move_along("plate", lambda seconds: swing(0.6)[: 6 if seconds < 0.1 else 5])
    with pytest.raises(BadValue, match="roll, pitch, yaw"):
        broken.wait()
    lifted.step(0.1)
    assert lifted.things["plate"] == pytest.approx(swing(0.6), abs=1e-6)
    lifted.move_along("plate", lambda seconds: swing(0.6 + seconds))
    lifted.step(0.1)
    lifted.reset()
    lifted.step(0.2)
    assert lifted.things["plate"] == (0.0, 0.0, 0.3, 0.0, 0.0, 0.0)


def test_what_follows_a_state_is_the_same_where_a_plate_was_on_its_way_or_has_begun_to_move_since(lifted):
    def followed():
        lifted.step(0.7)
        return felt(lifted), lifted.things

    at_rest = lifted.save_state()
    still = followed()
    lifted.restore_state(at_rest)
    swinging = lifted.move_along("plate", swing, duration=1.5)
    lifted.step(0.5)
    under_way = lifted.save_state()
    once = followed()
    lifted.step(0.5)
    assert swinging.done
    lifted.restore_state(under_way)
    assert followed() == once
    lifted.restore_state(at_rest)
    assert followed() == still


@pytest.mark.parametrize("mode, values", [("position", None), ("velocity", 0.0), ("torque", 0.0)])
def test_joints_that_are_driven_directly_do_what_the_mode_says(nao, mode, values):
    stand = np.asarray(nao.angles)
    wanted = stand.copy()
    wanted[0] = 0.4
    nao.drive(wanted if values is None else np.zeros(26), mode, ticks=60)
    height = nao.pose_torso_in_world.position[2]
    if mode == "torque":
        assert height < 0.25  # nothing holds it
        return
    assert height > 0.3
    assert nao.angles["HeadYaw"] == pytest.approx(0.4 if mode == "position" else 0.0, abs=0.02)


def test_no_target_moves_a_joint_that_is_driven(nao):
    stand = np.asarray(nao.commands)
    nao.set_angles("HeadYaw", 1.0)
    nao.drive(stand, ticks=120)
    assert nao.angles["HeadYaw"] == pytest.approx(0.0, abs=0.02)


def test_a_torque_turns_its_joint(nao):
    torques = np.zeros(26)
    torques[0] = 0.3
    nao.drive(torques, "torque", ticks=6)
    assert nao.velocities["HeadYaw"] > 1.0


def test_a_robot_that_was_driven_walks_afterwards(nao):
    nao.drive(np.asarray(nao.commands), ticks=30)
    assert nao.walk_to(0.1).wait() is True


def test_a_reset_after_a_fall_is_a_fresh_start():
    def struggles(sim, seed):
        sim.reset(3)
        chance = np.random.default_rng(seed)
        for step in range(30):
            if step == 5:
                sim.push("Torso", (80.0, 30.0, 0.0), 0.1)
            sim.drive(np.asarray(sim.angles) + chance.uniform(-0.5, 0.5, 26), ticks=3)
            yield sim.pose_torso_in_world, tuple(sim.angles.values())

    with NaoSim(seed=3) as sim, NaoSim(seed=3) as other:
        for seed in range(4):
            again = list(struggles(other, seed))
            assert other.fallen
        assert again == list(struggles(sim, seed))


def test_a_reset_after_driving_is_a_fresh_start(nao):
    nao.reset(1)
    once = felt(nao)
    nao.drive(np.asarray(nao.commands) + 0.2, ticks=3)
    nao.reset(1)
    assert felt(nao) == once


def test_the_camera_sees_what_is_in_front_of_it(nao):
    empty = nao.camera("bottom").picture(160, 120).astype(int)
    nao.place("ball", at=(0.6, 0.0, 0.03))
    seen = nao.camera("bottom").picture(160, 120).astype(int)
    assert seen.shape == (120, 160, 3)
    redder = (seen - empty)[..., 0] - (seen - empty)[..., 2]
    assert (redder > 60).sum() > 30


def test_a_picture_of_a_size_that_the_camera_has_not_names_those_it_has(nao):
    with pytest.raises(BadValue, match="320x240"):
        nao.camera().picture(100, 100)


def test_a_thing_is_in_the_picture_where_it_is_projected(nao):
    camera, at = nao.camera("bottom"), (0.45, 0.05, 0.03)
    empty = camera.picture(320, 240).astype(int)
    nao.place("ball", at=at)
    changed = np.abs(camera.picture(320, 240).astype(int) - empty).sum(axis=2) > 60
    rows, columns = np.nonzero(changed)
    ((column, row),) = camera.project([at])
    assert (columns.mean() + 0.5, rows.mean() + 0.5) == pytest.approx((column, row), abs=8.0)
    assert np.isnan(camera.project([(-1.0, 0.0, 0.5)])).all()


@pytest.mark.parametrize("points", [(1.0, 0.0, 0.5), [(1.0, 0.0)], [(1.0, 0.0, math.nan)], "ball"])
def test_points_that_cannot_be_projected_are_refused(nao, points):
    with pytest.raises(BadValue, match=r"points.*an array \(n, 3\) of finite numbers"):
        nao.camera().project(points)


@pytest.mark.parametrize("served", [False, True])
def test_pictures_from_outside_show_the_joints_as_they_are_not_as_they_are_measured(monkeypatch, served):
    drawn = []
    with NaoSim(noise=1.0, delay=0.2) as nao:
        address = nao.serve(port=0) if served else ""
        nao.set_angles("HeadYaw", 1.0)
        nao.step(0.15)
        render = nao._simulation.renderer.render
        monkeypatch.setattr(
            nao._simulation.renderer, "render", lambda state, *more: drawn.append(state) or render(state, *more)
        )
        if served:
            session = qi.Session()
            session.connect(address)
            session.service("NaoSimulation").picture("front", 64, 80)
            session.close()
        else:
            assert nao.picture("front", 64, 80).shape == (80, 64, 3)
        true = nao.robot._physics.read_joints().positions
        assert drawn[0].joint_positions == true and abs(nao.angles["HeadYaw"] - true[0]) > 0.2


@pytest.mark.parametrize("size", [(0, 64), (64, 5000), (64.0, 64)])
def test_a_picture_from_outside_of_no_such_size_is_refused(nao, size):
    with pytest.raises(BadValue, match="4096"):
        nao.picture("front", *size)


def test_robots_of_one_world_move_by_themselves():
    with NaoSim(robots=2, places=[(0.0, 0.0, 0.0), (0.0, 1.0, math.pi / 2.0)]) as sim:
        sim.robots[1].walk_to(0.2)
        assert sim.pose_on_ground == pytest.approx((0.0, 0.0, 0.0), abs=0.02)
        assert sim.robots[1].pose_on_ground == pytest.approx((0.0, 1.2, math.pi / 2.0), abs=0.05)


def test_a_program_for_naoqi_and_a_script_share_the_robot(nao):
    session = qi.Session()
    session.connect(nao.serve(port=0))
    walk = session.service("ALMotion").moveTo(0.15, 0.0, 0.0, _async=True)
    while not walk.isFinished():
        nao.step(0.1)
    assert walk.value() is True and nao.pose_on_ground.x == pytest.approx(0.15, abs=0.03)
    nao.set_angles("HeadYaw", 0.4)
    nao.step(1.0)
    assert session.service("ALMotion").getAngles("HeadYaw", True)[0] == pytest.approx(0.4, abs=0.02)
    with pytest.raises(NotAllowed, match="served already"):
        nao.serve(port=0)
    session.close()


@pytest.fixture
def served(nao):
    """A client of a robot that is served, in whose world there is a ball."""
    nao.place("ball", at=(1.0, 0.0, 0.03))
    session = qi.Session()
    session.connect(nao.serve(port=0))
    nao.step(2.0)
    yield session
    session.close()


def test_a_served_simulation_follows_a_factory_reset(nao, served):
    nao.set_angles("HeadYaw", 0.5)
    walk = nao.walk_to(1.0, wait=False)
    nao.step(1.0)
    before = nao.robot
    served.service("NaoSimulation").factoryReset()
    assert walk.done and nao.robot is not before
    assert nao.time < 0.1 and nao.angles["HeadYaw"] == pytest.approx(0.0, abs=0.01) and nao.things == {}
    nao.place("box", at=(0.6, 0.0, 0.05))
    nao.set_stiffness("Head", 1.0)
    nao.set_angles("HeadYaw", -0.4)
    nao.step(1.0)
    assert nao.time == pytest.approx(1.0, abs=0.1) and "box" in nao.things
    assert served.service("ALMotion").getAngles("HeadYaw", True)[0] == pytest.approx(-0.4, abs=0.02)
    nao.reset(2)
    assert nao.things == {} and nao._simulation.scene.seed == 2


def test_a_reset_by_a_client_ends_no_step(nao, served):
    called = []

    def reset_once(snapshot):
        if not called:
            called.append(served.service("NaoSimulation").reset(_async=True))

    nao._simulation.after_tick.append(reset_once)
    began = nao.time
    nao.step(3.0)
    assert called[0].value() is None and nao.time - began == pytest.approx(3.0, abs=0.02)


def test_a_robot_whose_address_is_taken_goes_on_without_being_served(nao, served):
    port = int(served.url().rpartition(":")[2])
    with NaoSim() as other:
        for _ in range(2):
            with pytest.raises(RuntimeError):
                other.serve(port=port)
        assert other.walk_to(0.1).wait() is True
        other.serve(port=0)


class Window:
    """Takes note of the angle of HeadYaw that it is shown."""

    shown: list[float] = []
    closed = 0

    def __init__(self, *_):
        self.shown.clear()

    def start(self):
        return self

    def show(self, state):
        self.shown.append(state.joint_positions[0])

    def close(self):
        type(self).closed += 1


def test_the_window_shows_a_robot_that_is_told_targets_or_driven_and_time_passes_as_on_the_wall(monkeypatch):
    monkeypatch.setattr("nao_sim_bridge.render.client.Viewer", Window)
    with NaoSim(gui=True) as nao:
        nao.set_angles("HeadYaw", 0.3)
        began = time.monotonic()
        nao.step(0.3)
        assert time.monotonic() - began > 0.29
        assert len(Window.shown) == 36 and Window.shown[-1] == pytest.approx(0.3, abs=0.02)
        Window.shown.clear()
        wanted = np.asarray(nao.commands)
        wanted[0] = 0.6
        began = time.monotonic()
        for _ in range(20):
            nao.drive(wanted, ticks=3)
        assert time.monotonic() - began > 0.49
        assert len(Window.shown) == 20 and Window.shown[-1] == pytest.approx(0.6, abs=0.02)
    assert Window.closed == 1


def test_nobody_who_does_not_look_or_listen_pays_for_it(nao):
    nao.walk_to(0.1)
    simulation = nao._simulation
    assert simulation._sound is None and simulation._cameras is None and simulation.renderer.pid is None


def test_the_first_simulation_loads_nothing_that_nobody_has_asked_for():
    rooms = "cameras control.whole_body render sound walk world.objects world.visible".split()
    unasked = {"PIL", "multiprocessing", "yaml", *(f"nao_sim_bridge.{room}" for room in rooms)}
    program = f"import sys; from nao_sim_bridge import NaoSim; NaoSim(); print({unasked!r} & {{*sys.modules}})"
    told = subprocess.run([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True, check=True).stdout
    assert told == "set()\n"


@pytest.mark.parametrize(
    "call, told",
    [
        (lambda nao: nao.set_angles("Tail", 0.1), "Tail"),
        (lambda nao: nao.set_angles("HeadYaw", math.nan), "angles"),
        (lambda nao: nao.set_angles("Head", [0.1, 0.2, 0.3]), "angles"),
        (lambda nao: nao.set_angles("HeadYaw", 0.1, speed=0.0), "speed"),
        (lambda nao: nao.move_angles("HeadYaw", 0.1, duration=0.0), "duration"),
        (lambda nao: nao.push("Tail", (1, 0, 0)), "Tail"),
        (lambda nao: nao.push("Torso", (1, 0)), "force"),
        (lambda nao: nao.walk_to(math.inf), "pose"),
        (lambda nao: nao.step(-1.0), "seconds"),
        (lambda nao: nao.step(math.inf), "seconds"),
        (lambda nao: nao.step(0.004), "seconds"),
        (lambda nao: nao.go_to_posture("Stand", speed=0.0), "speed"),
        (lambda nao: nao.set_angles("HeadYaw", "left"), "angles"),
        (lambda nao: nao.set_stiffness("Head", [0.5, 1.5]), "stiffness"),
        (lambda nao: nao.protect("no"), "on is 'no'"),
        (lambda nao: nao.reset(0.5), "seed"),
        (lambda nao: nao.save_picture("nao.jpg"), "PNG"),
        (lambda nao: nao.move("ball", (0, 0, 0)), "ball"),
        (lambda nao: NaoSim(seed=None), "seed"),
        (lambda nao: NaoSim(posture=""), "posture"),
        (lambda nao: NaoSim(places=[(0, 0)]), "place"),
        (lambda nao: NaoSim(places=[(0, 0, 0), (1, 0, 0)]), "places"),
        (lambda nao: nao.drive([0.0] * 25), "26"),
        (lambda nao: nao.drive([0.0] * 26, "muscle"), "muscle"),
        (lambda nao: nao.camera("left"), "left"),
        (lambda nao: nao.go_to_posture("Handstand"), "Handstand"),
        (lambda nao: nao.reset(payload=-1.0), "payload"),
    ],
)
def test_what_cannot_be_is_refused_by_name(nao, call, told):
    with pytest.raises((UnknownName, BadValue), match=told):
        call(nao)
    nao.step(0.1)
