"""Sounds that clients of the simulator place in the world, and persons that speak there."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.sim.sound.files import write_sound
from nao_sim_bridge.sim.sound.samples import RATE, sine

HERE, THERE = [1.0, 0.0, 0.5], [0.0, 2.0, 0.5]


@pytest.fixture
def simulation(robot):
    return robot.NaoSimulation


def level(robot, seconds=0.2):
    """Level at the microphones in the last `seconds`, dB SPL."""
    end = robot.now.time - 0.01
    heard = robot.server.simulation.sound.microphones.heard(end - seconds, end)
    return 20.0 * np.log10(np.sqrt(2.0 * np.mean(heard.astype(float) ** 2))) + 104.0


def test_a_noise_is_placed_moved_and_removed(robot, simulation):
    simulation.addSound("n", "noise:pink", HERE, 70.0, False)
    assert simulation.sounds() == {"n": pytest.approx(HERE)}
    simulation.advance(0.5)
    assert level(robot) == pytest.approx(70.0, abs=1.5)
    simulation.moveSound("n", THERE)
    assert simulation.sounds() == {"n": pytest.approx(THERE)}
    simulation.advance(0.5)
    assert level(robot) == pytest.approx(64.0, abs=1.5)
    simulation.removeSound("n")
    assert simulation.sounds() == {}
    simulation.advance(0.5)
    assert level(robot) == pytest.approx(30.0, abs=1.5)


def test_a_tone_has_its_frequency(robot, simulation):
    simulation.addSound("t", "tone:440", HERE, 65.0, False)
    simulation.advance(1.0)
    end = robot.now.time - 0.01
    heard = robot.server.simulation.sound.microphones.heard(end - 0.5, end)[:, 0]
    peak = np.argmax(np.abs(np.fft.rfft(heard))) * RATE / len(heard)
    assert peak == pytest.approx(440.0, abs=2.0)


def test_a_file_sounds_once_or_again_and_again(robot, simulation):
    folder = robot.server.files.folder
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "sounds_of_the_world_test.wav"
    write_sound(path, sine(500.0, 0.3, 0.5))
    try:
        simulation.addSound("once", path.name, HERE, 60.0, False)
        simulation.addSound("again", path.name, THERE, 60.0, True)
    finally:
        path.unlink()
    assert set(simulation.sounds()) == {"once", "again"}
    simulation.advance(0.5)
    assert set(simulation.sounds()) == {"again"}


def test_a_person_speaks_and_the_call_ends_when_it_is_said(robot, simulation):
    future = robot.post("NaoSimulation", "personSays", "Good morning.", HERE, "slt", 0.0)
    begun = robot.now.time
    simulation.advance(0.4)
    assert future.isRunning()
    assert len(simulation.sounds()) == 1
    loudest = -100.0
    while future.isRunning() and robot.now.time < begun + 5.0:
        simulation.advance(0.1)
        loudest = max(loudest, level(robot, 0.1))
    robot.answer(future)
    assert 0.6 < robot.now.time - begun < 2.0
    assert loudest == pytest.approx(65.0, abs=5.0)
    assert simulation.sounds() == {}


def test_a_person_can_be_silenced(robot, simulation):
    future = robot.post("NaoSimulation", "personSays", "I could go on like this for ever and ever.", HERE, "", 60.0)
    simulation.advance(0.5)
    assert len(simulation.sounds()) == 1
    future.cancel()
    robot.settled()
    simulation.advance(0.1)
    assert simulation.sounds() == {}


def test_two_persons_may_speak_at_once(robot, simulation):
    futures = [robot.post("NaoSimulation", "personSays", "Hello you.", place, "", 0.0) for place in (HERE, THERE)]
    simulation.advance(0.2)
    assert sorted(simulation.sounds().values()) == [pytest.approx(THERE), pytest.approx(HERE)]
    simulation.advance(3.0)
    for future in futures:
        robot.answer(future)


def test_a_reset_silences_all(robot, simulation):
    simulation.addSound("n", "noise:white", HERE, 60.0, True)
    simulation.reset()
    assert simulation.sounds() == {}


@pytest.mark.parametrize(
    "name, sound, position, level_db, message",
    [
        ("n", "noise:blue", HERE, 60.0, "sound is 'noise:blue', allowed is noise:white or noise:pink"),
        ("n", "tone:a", HERE, 60.0, 'allowed is "tone:" and a frequency in Hz'),
        ("n", "tone:-1", HERE, 60.0, "frequency is -1.0, allowed is 1 to 20000"),
        ("n", "none.wav", HERE, 60.0, "no file 'none.wav'"),
        ("n", "../none.wav", HERE, 60.0, "is not inside"),
        ("n", "noise:white", [1.0, 2.0], 60.0, "allowed is .x, y, z. in m, in world"),
        ("n", "noise:white", [1.0, 2.0, float("nan")], 60.0, "a finite number"),
        ("n", "noise:white", HERE, 600.0, "level_db is 600.0, allowed is -20 to 140"),
        ("", "noise:white", HERE, 60.0, "name is ''"),
    ],
)
def test_wrong_sounds_are_refused(simulation, name, sound, position, level_db, message):
    with pytest.raises(RuntimeError, match=f"NaoSimulation::addSound .*{message}"):
        simulation.addSound(name, sound, position, level_db, False)
    assert simulation.sounds() == {}


def test_names_are_unique_and_known(simulation):
    simulation.addSound("n", "noise:white", HERE, 60.0, True)
    with pytest.raises(RuntimeError, match="addSound name is 'n'"):
        simulation.addSound("n", "noise:white", HERE, 60.0, True)
    with pytest.raises(RuntimeError, match="moveSound unknown sound source 'm'"):
        simulation.moveSound("m", HERE)
    with pytest.raises(RuntimeError, match="removeSound unknown sound source 'm'"):
        simulation.removeSound("m")


@pytest.mark.parametrize(
    "text, voice, message",
    [
        ("  ", "", "text is '  '"),
        ("x" * 10001, "", "1 to 10000 characters"),
        ("Hi", "bob", "voice is 'bob', allowed is"),
    ],
)
def test_what_cannot_be_said_is_refused(robot, text, voice, message):
    with pytest.raises(RuntimeError, match=f"NaoSimulation::personSays .*{message}"):
        robot.NaoSimulation.personSays(text, HERE, voice, 0.0)
