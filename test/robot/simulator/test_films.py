"""Films of the simulation, and what its loudspeakers play as a file and on the sound card."""

import sys
import threading

import av
import numpy as np
import pytest
from simulator import PATIENCE, Simulator
from sounds import sound_of

from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.base.samples import RATE, sine
from nao_sim_bridge.server.film import Film
from nao_sim_bridge.server.sound_outlets import CARD_DELAY, SoundCard, SoundFile
from nao_sim_bridge.sound.files import WavFile
from nao_sim_bridge.world.render_state import StateSender

SIDE, FRAME_RATE = 64, 5.0


@pytest.fixture
def film(robot):
    """Begins a film that is called film.mp4."""
    return lambda view="front": robot.NaoSimulation.startFilm("film.mp4", view, SIDE, SIDE, FRAME_RATE)


@pytest.fixture
def pictures(robot):
    """The pictures of film.mp4."""

    def decoded():
        with av.open(str(robot.server.files.folder / "film.mp4")) as container:
            return [frame.to_ndarray(format="rgb24").astype(int) for frame in container.decode(video=0)]

    return decoded


def play(robot, sound):
    robot.server.runner.call(lambda: robot.server.simulation.sound.loudspeakers.play(sound, "tone"))


def test_a_film_has_its_length_its_frames_its_sound_and_its_caption(robot, film, pictures):
    simulation = robot.server.simulation
    hooks = (len(simulation.after_tick), len(simulation.holds))
    path = film()
    play(robot, sine(1000.0, 0.5, 0.5))
    robot.advance(0.9)
    robot.NaoSimulation.captionFilm("MMMM")
    robot.advance(0.6)
    report = robot.NaoSimulation.stopFilm()
    assert report["path"] == path == str(robot.server.files.folder / "film.mp4")
    assert report["left_out"] == 0 and report["duration"] == pytest.approx(1.6, abs=0.02)
    seen = pictures()  # one at the beginning, then one each fifth of a second
    assert len(seen) == report["frames"] == 8 and seen[0].shape == (SIDE, SIDE, 3)
    assert seen[0].std() > 20.0  # there is a robot in it
    change = np.abs(seen[-1] - seen[1]).mean(axis=2)
    assert change[SIDE - 8 :, :].max() > 60 > 6 * change[: SIDE // 4].mean()
    with av.open(path) as container:
        sound = np.abs(np.concatenate([frame.to_ndarray() for frame in container.decode(audio=0)], axis=1))
    assert sound.shape[1] == pytest.approx(1.5 * RATE, abs=0.1 * RATE)
    assert sound[:, : int(0.4 * RATE)].max() > 0.2 > 20.0 * sound[:, int(0.7 * RATE) :].max()
    assert (len(simulation.after_tick), len(simulation.holds)) == hooks


def test_there_is_one_film_at_a_time_and_it_is_complete_when_the_program_ends(robot, film, pictures):
    simulation = robot.NaoSimulation
    with pytest.raises(RuntimeError, match="nothing is being filmed"):
        simulation.stopFilm()
    with pytest.raises(RuntimeError, match="NaoSimulation::startFilm frame_rate is 1000.0, allowed is 1 to 60"):
        simulation.startFilm("film.mp4", "", 0, 0, 1000.0)
    film("")
    with pytest.raises(RuntimeError, match="film.mp4 is being filmed"):
        simulation.startFilm("other.mp4", "", SIDE, SIDE, FRAME_RATE)
    robot.advance(0.5)
    robot.server.film.close()  # as at the end of the program: it is complete
    assert len(pictures()) == 3
    path = simulation.startFilm("", "", SIDE, SIDE, FRAME_RATE)
    robot.server.film.close()
    assert path == str(robot.server.files.folder / "film-2.mp4"), "one without a name replaces none"


def test_a_film_that_cannot_be_drawn_tells_so_and_holds_no_time_up(robot, film, monkeypatch):
    monkeypatch.setattr(StateSender, "pack", lambda *_: 1 / 0)
    film()
    robot.advance(1.0)
    with pytest.raises(RuntimeError, match="ZeroDivisionError"):
        robot.NaoSimulation.stopFilm()


def test_a_film_is_drawn_after_a_simulation_that_needs_the_processor(simulation, tmp_path, monkeypatch):
    film = Film(simulation, tmp_path / "film.mp4", "front", (SIDE, SIDE), FRAME_RATE, "auto")
    sent_at, send = [], film._worker.send
    monkeypatch.setattr(film._worker, "send", lambda *message: (sent_at.append(simulation.ticks), send(*message)))
    simulation.shared.late = True
    film.begin()
    simulation.run(1.0)
    film.pause()
    assert film.end().frames == 6
    assert sent_at and set(sent_at) == {simulation.ticks}


class Card:
    """A stand-in for the library of the sound card."""

    def __init__(self):
        self.written, self.closed = [], False

    def OutputStream(self, rate, channels, dtype):
        assert (rate, channels, dtype) == (RATE, 2, "int16")
        return self

    def start(self):
        pass

    def write(self, samples):
        self.written.append(samples)

    def abort(self):
        self.closed = True

    def close(self):
        assert self.closed


@pytest.fixture
def card(monkeypatch):
    made = Card()
    monkeypatch.setitem(sys.modules, "sounddevice", made)
    return made


@pytest.fixture
def simulation(bench):
    return bench().simulation


def test_the_file_has_silence_and_sound_at_their_times_and_is_whole_while_it_grows(simulation, tmp_path, monkeypatch):
    written, write = threading.Event(), WavFile.write
    monkeypatch.setattr(WavFile, "write", lambda file, *block: (write(file, *block), written.set()))
    file = SoundFile(simulation, tmp_path / "all.wav")
    assert file.behind in simulation.holds and not file.behind()
    simulation.run(0.5)
    simulation.sound.loudspeakers.play(sine(1000.0, 0.5, 0.5), "say")
    assert written.wait(PATIENCE) and sound_of(tmp_path / "all.wav").duration >= 0.5
    simulation.run(1.5)
    file.close()
    kept = sound_of(tmp_path / "all.wav")
    assert (kept.duration, kept.channels, kept.rate) == (2.0, 2, RATE)
    loud = np.flatnonzero(np.abs(kept.samples[:, 0]) > 1e-3)
    assert loud[0] == pytest.approx(0.5 * RATE, abs=2) and loud[-1] == pytest.approx(RATE, abs=2)
    assert np.array_equal(kept.samples[RATE // 2 : RATE], (sine(1000.0, 0.5, 0.5).pcm16() / 32768.0).repeat(2, axis=1))
    with pytest.raises(SimulationError, match="cannot be written"):
        SoundFile(simulation, tmp_path / "all.wav" / "all.wav")


def test_the_card_gets_what_is_played_after_a_short_silence(simulation, card, bench):
    outlet, tone, start = SoundCard(simulation), sine(1000.0, 0.2, 0.5), round(CARD_DELAY * RATE)
    simulation.sound.loudspeakers.play(tone, "say")
    simulation.run(0.3)
    outlet.follow(bench().simulation)  # what was played before is out by then
    sent = np.concatenate(card.written)
    assert not sent[:start].any() and np.array_equal(sent[start : start + tone.frames, 1], tone.pcm16()[:, 0])
    assert not card.closed
    outlet.close()
    assert card.closed


def test_the_sound_file_goes_on_after_a_factory_reset_and_modules_that_were_taken_off_are_back(tmp_path):
    robot = Simulator(tmp_path, speed=float("inf"), sound_file="today/all.wav")
    try:
        robot.advance(0.5)
        robot.post("ALSonar", "exit").wait(int(1000 * PATIENCE))  # there is nobody left to answer
        robot.server.factory_reset()
        assert robot.session.service("ALSonar").ping()
        play(robot, sine(800.0, 0.2, 0.5))
        robot.advance(0.5)
    finally:
        robot.close()
    sound = sound_of(tmp_path / "today" / "all.wav").samples
    assert len(sound) == pytest.approx(RATE, abs=RATE // 50)
    assert not sound[: RATE // 2].any() and sound[RATE // 2 :].any()
