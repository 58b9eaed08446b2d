"""The thread of the simulation: commands, time by request, pace, and its end."""

from __future__ import annotations

import math
import threading
import time

import pytest

from nao_sim_bridge.sim import runner as module
from nao_sim_bridge.sim.errors import BadValue, SimulationStopped
from nao_sim_bridge.sim.motion.curves import Ramp
from nao_sim_bridge.sim.runner import FASTEST, SimulationRunner
from nao_sim_bridge.sim.simulation import Scene, Simulation


@pytest.fixture
def start():
    """Starts a runner of a simulation of its own."""
    runners = []

    def make(speed=1.0, paused=True, **options):
        simulation = Simulation(Scene())
        runner = SimulationRunner(simulation, speed, paused, **options)
        runners.append(runner)
        runner.start()
        return runner, simulation

    yield make
    for runner in runners:
        runner.stop()


def test_a_command_runs_in_the_simulation_thread_and_returns_its_value(start):
    runner, _ = start()
    assert runner.call(lambda: threading.current_thread().name) == "simulation"


def test_what_a_command_raises_comes_back_and_the_thread_lives_on(start, patience):
    runner, _ = start()
    task = runner.execute(lambda: 1 / 0, "divide")
    with pytest.raises(ZeroDivisionError):
        task.result(patience)
    assert task.name == "divide"
    assert runner.call(lambda: 5) == 5


def test_commands_run_in_the_order_they_came(start):
    runner, _ = start()
    order = []
    for number in range(50):
        runner.execute(lambda number=number: order.append(number))
    assert runner.call(lambda: list(order)) == list(range(50))


def test_time_stands_still_while_paused(start):
    runner, _ = start(paused=True)
    for _ in range(5):
        runner.call(lambda: None)
    assert runner.paused
    assert runner.snapshot.tick == 0
    assert runner.wait_for_tick(after=0, timeout=0.05) is None


@pytest.mark.parametrize("paused", [True, False])
def test_advance_ends_with_the_snapshot_after_exactly_that_time(start, patience, paused):
    runner, simulation = start(speed=0.001, paused=paused)
    before = runner.snapshot.tick
    snapshot = runner.advance(0.5).result(patience)
    assert snapshot.tick - before == round(0.5 / simulation.settings.tick_s)
    assert snapshot.time == pytest.approx(0.5, abs=simulation.settings.tick_s)


def test_advances_follow_each_other(start, patience):
    runner, simulation = start()
    tasks = [runner.advance(seconds) for seconds in (0.1, 0.0, 0.2)]
    ticks = [task.result(patience).tick for task in tasks]
    assert ticks == [round(0.1 / simulation.settings.tick_s)] * 2 + [round(0.3 / simulation.settings.tick_s)]


def test_a_command_waits_for_no_advance(start, patience):
    runner, _ = start()
    long = runner.advance(1000.0)
    assert runner.call(lambda: "now", patience) == "now"
    assert not long.finished


@pytest.mark.parametrize("seconds", [-0.1, math.inf, math.nan])
def test_an_impossible_advance_is_refused(start, seconds):
    runner, _ = start()
    with pytest.raises(BadValue, match="seconds is .*, allowed is 0 or more, finite"):
        runner.advance(seconds)


@pytest.mark.parametrize("speed", [0.0, -1.0, math.nan])
def test_an_impossible_speed_is_refused(start, speed):
    runner, _ = start()
    with pytest.raises(BadValue, match="speed is .*, allowed is above 0"):
        runner.set_speed(speed)
    assert runner.speed == 1.0


def test_time_passes_at_the_speed_asked_for_and_no_faster(start, patience):
    runner, simulation = start(speed=4.0)
    begin = time.monotonic()
    runner.resume()
    snapshot = runner.wait_for_tick(after=60, timeout=patience)
    passed = time.monotonic() - begin
    assert snapshot.time <= 4.0 * passed + simulation.settings.tick_s


def test_as_fast_as_possible_is_faster_than_the_clock(start, patience):
    runner, _ = start()
    begin = time.monotonic()
    runner.set_speed(FASTEST)
    runner.resume()
    snapshot = runner.wait_for_tick(after=240, timeout=patience)
    assert runner.speed == math.inf
    assert snapshot.time > time.monotonic() - begin


def test_time_that_a_busy_machine_lost_is_not_made_up_for(start, monkeypatch):
    class Clock:
        now = 100.0
        sleep = staticmethod(time.sleep)

        def monotonic(self):
            return self.now

    clock = Clock()
    monkeypatch.setattr(module, "time", clock)
    runner, simulation = start(paused=False)
    runner.call(lambda: setattr(clock, "now", 110.0))
    allowed = round(module.MAX_LAG / simulation.settings.tick_s) + 2
    assert runner.wait_for_tick(after=allowed, timeout=0.2) is None


def test_a_pause_can_end_and_come_back(start, patience):
    runner, _ = start()
    runner.resume()
    assert runner.wait_for_tick(after=2, timeout=patience).tick >= 3
    runner.pause()
    tick = runner.call(lambda: runner.snapshot.tick)
    assert runner.call(lambda: runner.snapshot.tick) == tick


def test_another_thread_may_ask_for_the_end_of_a_motion(start, patience):
    runner, simulation = start()
    follow = lambda: simulation.robot.motion.follow("glide", [0], lambda _: {0: Ramp(0.0, 1.0, 0.1)})  # noqa: E731
    task = runner.call(follow)
    runner.advance(0.1).result(patience)
    task.request_kill()
    task.result(patience)
    assert task.killed


def test_stop_ends_everybody_who_waits_with_an_error_and_frees_the_engine(start):
    runner, simulation = start()
    task = simulation.robot.motion.follow("glide", [0], lambda _: {0: Ramp(0.0, 1.0, 0.1)})
    waiting = runner.advance(1000.0)
    runner.stop()
    assert not runner.running
    with pytest.raises(SimulationStopped, match="has stopped"):
        waiting.result(timeout=0)
    assert task.finished
    for late in (lambda: runner.execute(lambda: None), lambda: runner.advance(1.0)):
        with pytest.raises(SimulationStopped):
            late()


def test_stop_wakes_who_waits_for_a_tick(start, patience):
    runner, _ = start()
    seen = []
    waiting = threading.Thread(target=lambda: seen.append(runner.wait_for_tick(after=0, timeout=patience)))
    waiting.start()
    runner.stop()
    waiting.join(patience)
    assert seen == [None]


def test_a_failing_simulation_tells_everybody_why(start, patience, monkeypatch):
    runner, simulation = start()

    def fail():
        raise ValueError("the floor is gone")

    monkeypatch.setattr(simulation, "tick", fail)
    with pytest.raises(SimulationStopped, match="the simulation failed: the floor is gone"):
        runner.advance(1.0).result(patience)
    runner.stop(patience)
    assert not runner.running


def test_whoever_asked_is_told_that_a_failing_simulation_has_ended(start, patience, monkeypatch):
    ended = threading.Event()
    runner, simulation = start(on_end=ended.set)
    monkeypatch.setattr(simulation, "tick", lambda: 1 / 0)
    runner.advance(1.0)
    assert ended.wait(patience)
