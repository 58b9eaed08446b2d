"""A simulation as a whole: its clock, its phases, its reset, and the same run for the same commands."""

from __future__ import annotations

from dataclasses import fields

import pytest

from nao_sim_bridge.sim import led_animations
from nao_sim_bridge.sim.errors import UnknownName
from nao_sim_bridge.sim.motion import sequences

DERIVED = ("left_foot", "right_foot", "touched", "currents")
BALL = "{name: ball, sphere: 0.04, position: [0.3, 0.02, 0.3], mass: 0.2}"


def state(snapshot, *without):
    """All values of a snapshot, of fields and of what follows from them, by name."""
    names = [field.name for field in fields(snapshot) if field.compare]
    return {name: getattr(snapshot, name) for name in [*names, *DERIVED] if name not in without}


def story(bench):
    """Wakes up, sways, is pushed, twinkles; the states of every tick."""
    robot = bench.robot
    sequences.wake_up(robot, lambda: bench.now, lambda: None)
    seen = bench.watch(0.6)
    bench.aim(0.5, HeadYaw=0.8, LShoulderPitch=0.2)
    bench.push((12.0, 4.0, 0.0), 0.2)
    layout = bench.simulation.led_layout
    robot.leds.animate("eyes", led_animations.random_eyes(layout, 1.0, robot.random), robot.time, step=True)
    seen += bench.watch(0.3)
    robot.press(["Head/Touch/Front"])
    seen += bench.watch(0.3)
    return seen, robot.leds.values


def test_equal_commands_at_equal_ticks_give_equal_snapshots(bench, world_file):
    path = world_file(BALL)
    (first, lights), (second, same_lights) = (story(bench("Crouch", 0.0, world=path, seed=5)) for _ in range(2))
    assert first == second
    assert [state(snapshot) for snapshot in first] == [state(snapshot) for snapshot in second]
    assert lights == same_lights


def test_a_reset_starts_the_same_story_again_but_for_the_clock(bench, world_file):
    one = bench("Crouch", 0.0, world=world_file(BALL), seed=5)
    start = one.now
    first, lights = story(one)
    one.simulation.reset()
    assert state(one.now, "tick", "time") == state(start, "tick", "time")
    second, same_lights = story(one)
    assert second[0].tick == first[-1].tick + 1
    for before, after in zip(first, second):
        assert state(after, "tick", "time") == state(before, "tick", "time")
    assert lights == same_lights


def test_another_seed_is_another_chance(bench):
    first, second = (bench(seed=seed).robot.random.random() for seed in (1, 2))
    assert first != second


def test_the_clock_counts_ticks_and_never_goes_back(bench):
    one = bench()
    seen = [one.now, *one.watch(0.1)]
    one.simulation.reset()
    seen += [one.now, *one.watch(0.1)]
    ticks = [snapshot.tick for snapshot in seen]
    assert ticks == sorted(ticks)
    tick_s = one.simulation.settings.tick_s
    assert all(snapshot.time == pytest.approx(snapshot.tick * tick_s) for snapshot in seen)


def test_run_passes_the_time_asked_for(bench):
    assert bench().run(0.25).time == pytest.approx(0.25)


def test_it_starts_limp_in_the_posture_asked_for(bench):
    one = bench("StandInit", 0.0)
    assert one.now.tick == 0
    assert one.now.stiffnesses == (0.0,) * 26
    assert one.joint("LKneePitch") == pytest.approx(one.joint("LKneePitch", of="commands"))
    assert one.robot.leds.values[one.simulation.led_layout.devices_of("FaceLeds")[0]] == 1.0


def test_a_reset_brings_robot_objects_and_lights_back_and_kills_tasks(bench, world_file):
    one = bench(world=world_file(BALL))
    ball = one.now.objects["ball"]
    motion = sequences.posture_task(one.robot, "rest", "Crouch")
    fade = one.robot.leds.animate("off", [led_animations.LedKeyframe(3.0, {0: 0.0})], one.robot.time)
    one.push((60.0, 0.0, 0.0), 5.0)
    one.robot.press(["Head/Touch/Rear"])
    one.run(1.0)
    assert one.now.objects["ball"] != ball
    one.simulation.reset()
    assert motion.killed and fade.killed
    assert one.now.objects["ball"] == ball
    assert one.now.stiffnesses == (0.0,) * 26
    assert one.now.touched == frozenset()
    assert one.robot.leds.values[0] == 1.0
    # The push is over, too: limp in Stand, it would fall at once under it.
    assert one.run(0.5).torso.position[2] > 0.3


def test_two_simulations_do_not_disturb_each_other(bench):
    alone = bench().watch(0.3)
    beside, other = bench(), bench()
    seen = []
    for _ in alone:
        other.push((60.0, 0.0, 0.0), 0.1)
        other.simulation.tick()
        seen.append(beside.simulation.tick())
    assert seen == alone


@pytest.mark.parametrize("version, mass", [("V6", 5.35975), ("V5", 5.30535)])
def test_the_version_decides_on_the_robot(bench, version, mass):
    one = bench(version=version)
    assert one.model.total_mass == pytest.approx(mass)
    assert one.simulation.led_layout.version == version


def test_an_unknown_posture_is_refused_with_the_closest(bench):
    with pytest.raises(UnknownName, match="unknown posture 'Standing'.*'Stand'"):
        bench("Standing")


def test_an_unknown_link_to_push_is_refused_with_the_closest(bench):
    with pytest.raises(UnknownName, match="unknown link 'l_ancle'.*'l_ankle'"):
        bench().push((1.0, 0.0, 0.0), 0.1, "l_ancle")


def test_an_unknown_touch_sensor_is_refused_and_presses_nothing(bench):
    one = bench()
    with pytest.raises(UnknownName, match="unknown touch sensor 'Head/Touch/Frnt'.*'Head/Touch/Front'"):
        one.robot.press(["Head/Touch/Middle", "Head/Touch/Frnt"])
    assert one.simulation.tick().touched == frozenset()
