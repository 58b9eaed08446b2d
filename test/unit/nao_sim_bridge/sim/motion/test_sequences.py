"""Motions of several steps: waking up, resting, and what becomes of them when they are killed."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.motion import sequences
from nao_sim_bridge.sim.motion.sequences import run_steps


@pytest.fixture
def ended():
    return []


def wake_up(one, ended):
    return sequences.wake_up(one.robot, lambda: one.now, lambda: ended.append("awake"))


def rest(one, ended):
    return sequences.rest(one.robot, lambda: one.now, lambda: ended.append("asleep"))


def test_waking_up_from_a_limp_crouch_stands_stiff(bench, ended):
    one = bench("Crouch", 0.0)
    one.run(0.5)
    task = wake_up(one, ended)
    one.run(2.5)
    assert task.finished and not task.killed
    assert ended == ["awake"]
    assert one.now.stiffnesses == (1.0,) * 26
    assert one.now.torso.position[2] == pytest.approx(0.331, abs=0.005)
    assert sequences.is_on_feet(one.robot, one.now)


def test_waking_up_does_not_make_a_limp_joint_jump(bench, ended):
    one = bench("Crouch", 0.0)
    one.run(0.5)
    before = one.now.positions
    wake_up(one, ended)
    one.run(sequences.STIFFEN_TIME)
    moved = [abs(a - b) for a, b in zip(before, one.now.positions)]
    assert max(moved) < 0.03


def test_resting_crouches_and_lets_go(bench, ended):
    one = bench("Stand")
    one.run(0.2)
    task = rest(one, ended)
    one.run(2.5)
    assert task.finished
    assert ended == ["asleep"]
    assert one.now.stiffnesses == (0.0,) * 26
    assert one.now.torso.position[2] == pytest.approx(0.228, abs=0.01)


def test_resting_a_limp_robot_moves_nothing(bench, ended):
    one = bench("Crouch", 0.0)
    one.run(0.5)
    commands = one.now.commands
    rest(one, ended)
    one.run(0.3)
    assert ended == ["asleep"]
    assert one.now.commands == commands


def test_waking_up_on_the_floor_only_stiffens(bench, ended):
    one = bench("Stand")
    one.push((60.0, 0.0, 0.0), 0.2)
    one.run(2.0)
    assert not sequences.is_on_feet(one.robot, one.now)
    one.stiffen(0.0)
    one.run(0.5)
    task = wake_up(one, ended)
    one.run(2.5)
    assert task.finished and ended == ["awake"]
    assert one.now.stiffnesses == (1.0,) * 26
    assert not sequences.is_on_feet(one.robot, one.now)


@pytest.mark.parametrize("posture", ["SitRelax", "LyingBelly", "LyingBack"])
def test_off_its_feet_it_only_stiffens_and_lets_go(bench, ended, posture):
    one = bench(posture, 0.0)
    one.run(0.5)
    # Where the weight of the body presses limp fingers to is no command they can have.
    before = [one.robot.joints.clamp_alone(i, angle) for i, angle in enumerate(one.now.positions)]
    wake_up(one, ended)
    one.run(2.5)
    assert one.now.commands == pytest.approx(before, abs=0.03)
    assert one.now.stiffnesses == (1.0,) * 26
    commands = one.now.commands
    rest(one, ended)
    one.run(1.0)
    assert one.now.commands == commands
    assert one.now.stiffnesses == (0.0,) * 26
    assert ended == ["awake", "asleep"]


@pytest.mark.parametrize("seconds", [0.1, 1.0])
def test_a_killed_awakening_stops_in_whatever_step_it_is(bench, ended, seconds):
    one = bench("Crouch", 0.0)
    task = wake_up(one, ended)
    one.run(seconds)
    assert task.kill()
    assert one.robot.motion.tasks() == []
    commands = one.now.commands
    one.run(1.0)
    assert task.killed
    assert one.now.commands == commands
    assert ended == []


def test_killing_the_step_ends_the_whole(bench, ended):
    one = bench("Crouch", 0.0)
    task = wake_up(one, ended)
    one.run(1.0)
    one.robot.motion.kill_all()
    assert task.killed and task.finished
    assert ended == []


def test_steps_run_in_order_each_after_the_end_of_the_one_before(bench):
    one = bench()
    order = []

    def step(name, target=None):
        def run():
            order.append((name, one.simulation.ticks))
            return target and sequences.stiffness_task(one.robot, name, [0], target, 0.1)

        return run

    task = run_steps(one.robot, "story", [step("a"), step("b", 0.5), step("c"), step("d", 0.8)])
    assert [name for name, _ in order] == ["a", "b"]
    one.run(0.3)
    assert [name for name, _ in order] == ["a", "b", "c", "d"]
    assert order[2][1] == order[3][1] >= order[1][1] + round(0.1 / one.simulation.settings.tick_s)
    assert task.finished and task.name == "story"
    assert one.now.stiffnesses[0] == 0.8


def test_nothing_to_do_ends_at_once(bench):
    assert run_steps(bench().robot, "nothing", []).finished


def test_a_posture_is_reached_exactly_in_its_time(bench):
    one = bench("Stand")
    task = sequences.posture_task(one.robot, "goToPosture", "Crouch", duration=1.0)
    one.run(1.0 - 2 * one.simulation.settings.tick_s)
    assert not task.finished
    one.run(3 * one.simulation.settings.tick_s)
    assert task.finished
    assert one.joint("LKneePitch", of="commands") == pytest.approx(
        bench("Crouch").joint("LKneePitch", of="commands"), abs=1e-12
    )
