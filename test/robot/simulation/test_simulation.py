"""A simulation as a whole: its clock, its reset, equal runs, plain snapshots; and the thread that runs it."""

import math
import threading
import time
from types import SimpleNamespace

import pytest

from nao_sim_bridge.base.closing import FAILED, wait_for_end
from nao_sim_bridge.base.errors import BadValue, SimulationStopped, TaskKilled
from nao_sim_bridge.body import led_animations
from nao_sim_bridge.control.joints.curves import Ramp
from nao_sim_bridge.core import sequences
from nao_sim_bridge.core.runner import FASTEST, SimulationRunner
from nao_sim_bridge.core.simulation import Scene, Simulation

PATIENCE = 60.0
BALL = "{name: ball, sphere: 0.04, position: [0.3, 0.02, 0.3], mass: 0.2}"


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
    assert motion.killed and fade.killed and one.now.objects["ball"] == ball
    assert one.now.stiffnesses == (0.0,) * 26 and one.now.touched == frozenset() and one.robot.leds.values[0] == 1.0
    # The push is over, too: limp in Stand, it would fall at once under it.
    assert one.run(0.5).torso.position[2] > 0.3


@pytest.fixture
def start():
    """Starts a runner of a simulation of its own; both."""
    runners = []

    def make(speed=1.0, paused=True, **options):
        simulation = Simulation(Scene())
        runners.append(SimulationRunner(simulation, speed, paused, **options))
        runners[-1].start()
        return runners[-1], simulation

    yield make
    for runner in runners:
        runner.stop()


def follow(runner, simulation):
    """A motion of ten seconds."""
    return runner.call(lambda: simulation.robot.motion.follow("glide", [0], lambda _: {0: Ramp(0.0, 1.0, 0.1)}))


def test_commands_run_in_order_in_the_simulation_thread_and_what_they_raise_comes_back(start):
    (runner, _), order = start(), []
    task = runner.execute(lambda: 1 / 0, "divide")
    with pytest.raises(ZeroDivisionError):
        task.result(PATIENCE)
    assert task.name == "divide" and runner.call(lambda: threading.current_thread().name) == "simulation"
    for number in range(50):
        runner.execute(lambda number=number: order.append(number))
    long = runner.advance(1000.0)
    assert runner.call(lambda: list(order), PATIENCE) == list(range(50)) and not long.finished


@pytest.mark.parametrize("paused", [True, False])
def test_advances_follow_each_other_and_end_after_exactly_their_time(start, paused):
    runner, simulation = start(speed=0.001, paused=paused)
    before, tick_s = runner.snapshot.tick, simulation.settings.tick_s
    ends = [task.result(PATIENCE) for task in [runner.advance(seconds) for seconds in (0.1, 0.0, 0.4)]]
    assert [end.tick - before for end in ends] == [round(seconds / tick_s) for seconds in (0.1, 0.1, 0.5)]
    assert ends[-1].time == pytest.approx(0.5, abs=tick_s)


@pytest.mark.parametrize("speed", [1e-12, 1e-320, 1e7, 1.7e308, -1.0, math.nan])
def test_a_speed_at_which_the_thread_would_wait_for_ever_is_refused(start, speed):
    runner, _ = start(paused=False)
    with pytest.raises(BadValue, match="speed is .* allowed is 0.001 to 1e.06, above 0; infinity"):
        runner.set_speed(speed)
    assert runner.wait_for_tick(runner.ticks, PATIENCE) is not None


@pytest.mark.parametrize("seconds", [1e9, 1.7e308, math.inf, math.nan, -1.0])
def test_no_more_than_a_day_is_asked_for_at_once(start, seconds):
    with pytest.raises(BadValue, match="seconds is .* 0 or more, finite, 86400 s at most"):
        start()[0].advance(seconds)


@pytest.mark.parametrize("by", ["a pause", "a reset"])
def test_an_advance_ends_with_a_pause_or_a_reset_and_the_next_one_is_heard(start, by):
    runner, simulation = start()
    long, waits = runner.advance(86400.0), runner.advance(5.0)
    runner.wait_for_tick(runner.ticks + 2, PATIENCE)
    runner.pause() if by == "a pause" else runner.end_advances(by)
    after = runner.advance(0.1)
    for task, seconds in ((long, 86400), (waits, 5)):
        with pytest.raises(TaskKilled, match=rf"was ended by {by} after [\d.]+ of {seconds} s"):
            task.result(PATIENCE)
    end = after.result(PATIENCE).tick
    assert runner.call(lambda: runner.snapshot.tick) == end


def test_an_advance_that_is_cancelled_ends_and_the_next_one_has_its_turn(start):
    runner, simulation = start()
    first, second = runner.advance(86400.0), runner.advance(86400.0)
    last = runner.advance(0.1)
    for task in (second, first):
        task.then(lambda snapshot: snapshot and snapshot.time).request_kill()
        assert task.result(PATIENCE) is None and task.killed
    assert last.result(PATIENCE).time > 0.0


def test_a_listener_that_raises_is_named_and_the_tick_goes_on(start, monkeypatch):
    runner, simulation = start()
    heard = []
    simulation.after_tick[:0] = [lambda _: 1 / 0]
    simulation.after_tick.append(lambda snapshot: heard.append(snapshot.tick))
    monkeypatch.setattr(simulation.cameras, "tick", lambda _: {}["camera"])
    assert runner.advance(0.1).result(PATIENCE).tick == heard[-1] == 12 == len(heard)
    counts = {failure.error: failure.count for failure in simulation.shared.guard.failures()}
    assert counts == {"ZeroDivisionError: division by zero": 12, "KeyError: 'camera'": 12}


def test_time_stands_still_while_paused_and_passes_no_faster_than_asked(start):
    runner, simulation = start(speed=4.0)
    runner.call(lambda: None)
    assert runner.paused and runner.snapshot.tick == 0 and runner.wait_for_tick(after=0, timeout=0.05) is None
    begin = time.monotonic()
    runner.resume()
    snapshot = runner.wait_for_tick(after=60, timeout=PATIENCE)
    took = time.monotonic() - begin
    assert took >= (snapshot.time - simulation.settings.tick_s) / 4.0
    runner.pause()
    tick = runner.call(lambda: runner.snapshot.tick)
    assert runner.call(lambda: runner.snapshot.tick) == tick
    runner.set_speed(FASTEST)
    assert runner.speed == math.inf
    runner.resume()
    assert runner.wait_for_tick(after=tick + 240, timeout=PATIENCE).tick > tick + 240
    runner.advance(8.0).result(PATIENCE)
    runner.set_speed(0.05)  # 8 s too many would be made up for in 160 s
    late = runner.call(lambda: runner.snapshot.tick)
    assert runner.wait_for_tick(after=late + 2, timeout=60.0), "the pace counts from where it was set"


def test_a_speed_that_the_computer_cannot_keep_leaves_it_some_of_its_time(start):
    runner, simulation = start(speed=1e6, paused=False)
    now = lambda: (time.thread_time(), time.monotonic())  # noqa: E731
    used, wall = runner.call(now)
    assert runner.wait_for_tick(after=runner.ticks + 300, timeout=60.0)
    used_then, wall_then = runner.call(now)
    assert (used_then - used) / (wall_then - wall) < 0.9
    assert simulation.shared.late


def test_stop_ends_everybody_who_waits_with_an_error(start):
    ended, seen = threading.Event(), []
    runner, simulation = start(on_end=ended.set)
    task, advance = follow(runner, simulation), runner.advance(1000.0)
    waiting = threading.Thread(target=lambda: seen.append(runner.wait_for_tick(after=10**9, timeout=PATIENCE)))
    waiting.start()
    runner.stop()
    waiting.join(PATIENCE)
    assert seen == [None] and not runner.running and task.finished
    for late in (lambda: advance.result(0), lambda: runner.execute(lambda: None), lambda: runner.advance(1.0)):
        with pytest.raises(SimulationStopped, match="has stopped"):
            late()
    assert wait_for_end(SimpleNamespace(ended=ended, runner=runner)) == 0


def test_what_holds_time_and_fails_does_not_hold_it(start):
    runner, simulation = start()

    def waits():
        raise ValueError("no thread")

    runner.call(lambda: simulation.holds.insert(0, waits))
    assert runner.advance(0.1).result(PATIENCE).time == pytest.approx(0.1, abs=simulation.settings.tick_s)
    assert [one.error for one in simulation.shared.guard.failures()] == ["ValueError: no thread"]


def test_a_failing_simulation_tells_everybody_why_and_so_does_the_exit_status(start, monkeypatch):
    ended = threading.Event()
    runner, simulation = start(on_end=ended.set)

    def fail():
        raise ValueError("the floor is gone")

    monkeypatch.setattr(simulation, "tick", fail)
    with pytest.raises(SimulationStopped, match="the simulation failed: the floor is gone"):
        runner.advance(1.0).result(PATIENCE)
    assert ended.wait(PATIENCE)
    runner.stop(PATIENCE)
    assert not runner.running and wait_for_end(SimpleNamespace(ended=ended, runner=runner)) == FAILED
