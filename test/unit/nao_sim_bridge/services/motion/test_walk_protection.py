"""What keeps a walk from beginning or ends it, over the network, and the event about it."""

from __future__ import annotations

import pytest

from nao_sim_bridge.server import ServerOptions, SimulatorServer
from nao_sim_bridge.sim.simulation import Scene


@pytest.fixture
def motion(walker):
    return walker.motion


@pytest.mark.parametrize(
    "method, arguments",
    [("moveTo", (0.1, 0.0, 0.0)), ("move", (0.05, 0.0, 0.0)), ("moveToward", (1.0, 0.0, 0.0)), ("moveInit", ())],
)
def test_limp_legs_do_not_walk(walker, motion, method, arguments):
    motion.setStiffnesses("Body", 0.0)
    before = walker.failures
    with pytest.raises(RuntimeError, match=f"ALMotion::{method} stiffness of LHipYawPitch.* wakeUp first"):
        motion.call(method, *arguments)
    assert motion.moveIsActive() is False
    assert walker.failures == before + 1
    cause, status, obstacle = walker.last_failure
    assert "stiffness of LHipYawPitch" in cause
    assert (status, obstacle) == (0, None)


def test_legs_that_get_soft_end_a_walk(walker, motion):
    before = walker.failures
    move = walker.begin("moveTo", 1.0, 0.0, 0.0)
    motion.setStiffnesses("LAnklePitch", 0.5)
    walker.advance(0.1)
    assert walker.answer(move) is False
    assert not motion.moveIsActive()
    assert walker.failures == before + 1
    cause, status, _ = walker.last_failure
    assert "LAnklePitch" in cause
    assert status == 1


def test_without_protection_soft_legs_walk_too(walker, motion):
    motion.setMotionConfig([["ENABLE_STIFFNESS_PROTECTION", False]])
    motion.setStiffnesses("LShoulderPitch", 0.0)
    motion.setStiffnesses("LAnklePitch", 0.6)
    motion.move(0.03, 0.0, 0.0)
    walker.advance(1.0)
    assert motion.moveIsActive()


def test_a_lifted_robot_ends_its_walk_and_begins_none(walker, motion):
    before = walker.failures
    move = walker.begin("moveTo", 1.0, 0.0, 0.0, after=1.0)
    walker.NaoSimulation.push([0.0, 0.0, 57.0], 2.0, "torso")
    walker.advance(0.8)
    assert walker.answer(move) is False
    assert walker.failures == before + 1
    assert "ground" in walker.last_failure[0]
    with pytest.raises(RuntimeError, match="ALMotion::move the feet feel no ground"):
        motion.move(0.05, 0.0, 0.0)
    assert walker.failures == before + 2


def test_a_fallen_robot_does_not_walk(walker, motion):
    move = walker.begin("moveTo", 1.0, 0.0, 0.0, after=1.0)
    walker.NaoSimulation.push([60.0, 0.0, 0.0], 0.2, "torso")
    walker.advance(4.0)
    assert walker.answer(move) is False
    motion.setStiffnesses("Body", 1.0)
    with pytest.raises(RuntimeError, match="ALMotion::moveTo .*"):
        motion.moveTo(0.1, 0.0, 0.0)


def test_a_reset_ends_a_walk(walker, motion):
    move = walker.begin("moveTo", 1.0, 0.0, 0.0)
    wait = walker.begin("waitUntilMoveIsFinished", after=0.1)
    walker.NaoSimulation.reset()
    assert walker.answer(move) is False
    assert walker.answer(wait) is None
    assert motion.moveIsActive() is False


# --- obstacles --------------------------------------------------------------------------------------------------------


@pytest.fixture
def before_a_wall(client_of, walker_of, world_file):
    """A robot that stands a metre before a wall."""
    world = world_file("{name: wall, box: [0.1, 2.0, 1.0], position: [1.0, 0.0, 0.5]}")
    server = SimulatorServer(ServerOptions(Scene(world=world, posture="Stand"), port=0, paused=True))
    server.start()
    client = client_of(server)
    yield walker_of(client)
    client.close()
    server.stop()


def test_an_obstacle_ends_a_walk_before_it_and_is_told(before_a_wall):
    assert before_a_wall.walk("moveTo", 1.5, 0.0, 0.0) is False
    cause, status, obstacle = before_a_wall.last_failure
    assert "obstacle" in cause and status == 1
    assert obstacle[0] == pytest.approx(0.95, abs=0.1)
    gap = 0.95 - before_a_wall.truth[0]
    assert 0.2 < gap <= before_a_wall.motion.getOrthogonalSecurityDistance() + 0.1
    assert before_a_wall.stands


def test_without_protection_a_robot_walks_on_to_the_obstacle(before_a_wall):
    before_a_wall.motion.setExternalCollisionProtectionEnabled("Move", False)
    assert before_a_wall.walk("moveTo", 0.7, 0.0, 0.0) is True
    assert before_a_wall.truth[0] == pytest.approx(0.7, abs=0.05)
