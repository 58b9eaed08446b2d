"""Sound in a simulation with physics: resets, and time that waits."""

from __future__ import annotations

import pytest

from nao_sim_bridge.base.samples import sine
from nao_sim_bridge.core.runner import FASTEST, SimulationRunner
from nao_sim_bridge.sound.sources import SoundSource

PATIENCE = 60.0


@pytest.fixture
def simulation(bench):
    return bench(posture="Crouch", stiffness=0.0).simulation


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


def test_fast_time_waits_for_whoever_holds_it_and_real_time_for_nobody(simulation, runner):
    held = True
    simulation.holds.append(lambda: held)
    advance = runner.advance(0.5)
    with pytest.raises(TimeoutError):
        advance.result(0.1)
    assert simulation.ticks == 0
    assert runner.execute(lambda: "commands are still taken").result(PATIENCE)
    held = False
    simulation.wake()
    assert advance.result(PATIENCE).tick == 60
    held = True
    runner.set_speed(1.0)
    runner.resume()
    assert runner.wait_for_tick(65, PATIENCE).tick >= 65
    runner.set_speed(FASTEST)
    now = runner.call(lambda: simulation.ticks)
    assert runner.wait_for_tick(now + 1, 0.1) is None
    held = False
    simulation.wake()
