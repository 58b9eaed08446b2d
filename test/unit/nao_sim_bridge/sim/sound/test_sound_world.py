from __future__ import annotations

import gc
import tracemalloc

import numpy as np
import pytest

from nao_sim_bridge.sim.runner import FASTEST, SimulationRunner
from nao_sim_bridge.sim.simulation import Scene, Simulation
from nao_sim_bridge.sim.sound.samples import sine
from nao_sim_bridge.sim.sound.sources import SoundSource


@pytest.fixture
def simulation():
    made = Simulation(Scene(posture="Crouch"))
    yield made
    made.close()


@pytest.fixture
def runner(simulation):
    made = SimulationRunner(simulation, paused=True)
    made.start()
    yield made
    made.stop()


def test_a_reset_ends_what_plays_and_time_goes_on(simulation):
    sound = simulation.sound
    playing = sound.loudspeakers.play(sine(500.0, 5.0), "say")
    source = sound.sources.add(SoundSource("radio", (1.0, 0.0, 0.5), sine(500.0, 5.0)))
    calls = []
    simulation.after_reset.append(lambda: calls.append(sound.sources.names()))
    simulation.run(0.5)
    simulation.reset()
    assert playing.task.killed and source.task.killed and calls == [[]]
    simulation.run(0.5)
    assert sound.time == pytest.approx(1.0)
    assert sound.loudspeakers.played(0.2, 0.4).samples.any() and not sound.loudspeakers.played(0.6, 1.0).samples.any()
    assert sound.microphones.heard(0.0, 1.0).shape == (48000, 4)


def test_tasks_end_when_the_simulation_does(simulation):
    playing = simulation.sound.loudspeakers.play(sine(500.0, 5.0), "say")
    simulation.close()
    assert playing.task.finished


def test_a_kill_from_another_thread_silences(simulation, runner, patience):
    task = runner.execute(lambda: simulation.sound.loudspeakers.play(sine(500.0, 5.0), "say").task).result(patience)
    runner.advance(0.5).result(patience)
    task.request_kill()
    runner.advance(0.5).result(patience)
    assert task.killed and not simulation.sound.loudspeakers.played(0.6, 1.0).samples.any()


def test_fast_time_waits_for_whoever_holds_it(simulation, runner, patience):
    held = True
    simulation.holds.append(lambda: held)
    advance = runner.advance(0.5)
    with pytest.raises(TimeoutError):
        advance.result(0.1)
    assert simulation.ticks == 0
    assert runner.execute(lambda: "commands are still taken").result(patience)
    held = False
    simulation.wake()
    assert advance.result(patience).tick == 60


def test_real_time_waits_for_nobody(simulation, patience):
    simulation.holds.append(lambda: True)
    runner = SimulationRunner(simulation, speed=1.0)
    runner.start()
    try:
        assert runner.wait_for_tick(5, patience).tick > 5
        runner.set_speed(FASTEST)
        now = runner.call(lambda: simulation.ticks)
        assert runner.wait_for_tick(now + 1, 0.1) is None
    finally:
        runner.stop()


def test_ears_hear_everything_of_a_fast_run(simulation, runner, patience):
    blocks = []
    runner.call(lambda: simulation.sound.loudspeakers.play(sine(500.0, 4.0, 0.5), "say"))
    simulation.sound.ears.listen("test", blocks.append)
    runner.advance(2.0).result(patience)
    simulation.sound.ears.catch_up(patience)
    assert [block.time for block in blocks] == pytest.approx([0.17 * k for k in range(11)])


def test_memory_stays_flat(room):
    """Long runs with sounds that come and go, one that is moved at every tick, and a listener."""
    one = room(keep_s=1.0)
    one.ears.listen("test", lambda block: None, "16k1")
    one.sources.add(SoundSource("fly", (1.0, 0.0, 0.5), sine(500.0, 1.0), loop=True))
    one.moves = lambda time: one.sources.move("fly", (1.0 + 0.2 * np.sin(time), 0.0, 0.5))
    beep = sine(700.0, 0.05)

    def live(seconds):
        for _ in range(round(seconds / 0.2)):
            one.loudspeakers.play(beep, "play")
            one.loudspeakers.volume = 50.0 + one.loudspeakers.volume % 50.0 / 2.0
            one.run(0.2)
            one.ears.catch_up()

    tracemalloc.start()
    try:
        live(3.0)
        gc.collect()
        before = tracemalloc.take_snapshot()
        live(5.0)
        gc.collect()
        grown = sum(line.size_diff for line in tracemalloc.take_snapshot().compare_to(before, "filename"))
    finally:
        tracemalloc.stop()
    assert grown < 100_000
    assert len(one.loudspeakers._players) < 25
