"""Films of the simulation: how long, from where, with which sound, and what is refused."""

from __future__ import annotations

import math

import av
import numpy as np
import pytest

from nao_sim_bridge.film_control import FilmControl
from nao_sim_bridge.record_dir import ClientFiles, OutsideRecordDir
from nao_sim_bridge.sim.errors import BadValue, NotAllowed, UnknownName
from nao_sim_bridge.sim.render.client import RenderError
from nao_sim_bridge.sim.runner import SimulationRunner
from nao_sim_bridge.sim.simulation import Scene, Simulation
from nao_sim_bridge.sim.sound.samples import sine

LIMIT = 60.0
SIDE, RATE = 64, 5.0


@pytest.fixture
def runner():
    simulation = Simulation(Scene(posture="Stand"))
    made = SimulationRunner(simulation, math.inf, paused=True)
    made.start()
    yield made
    made.stop()


@pytest.fixture
def simulation(runner):
    return runner._simulation


@pytest.fixture
def control(simulation, runner, tmp_path):
    made = FilmControl(simulation, runner, ClientFiles(tmp_path), "builtin")
    yield made
    made.close()


@pytest.fixture
def take(control, runner):
    """Films for some seconds; gives the report."""

    def film(seconds, name="film.mp4", view="front"):
        control.start(name, view, SIDE, SIDE, RATE).result(LIMIT)
        runner.advance(seconds).result(LIMIT)
        return control.stop().result(LIMIT)

    return film


def test_a_film_has_its_length_its_frames_and_its_sound(take, simulation, runner):
    runner.call(lambda: simulation.sound.loudspeakers.play(sine(1000.0, 0.5, 0.5), "tone"))
    film = take(1.5)
    assert film.left_out == 0 and film.duration == pytest.approx(1.6, abs=0.02)
    with av.open(str(film.path)) as container:
        pictures = [frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]
    # One at the beginning, then one each fifth of a second.
    assert len(pictures) == film.frames == 8 and pictures[0].shape == (SIDE, SIDE, 3)
    assert pictures[0].std() > 20.0  # there is a robot in it
    with av.open(str(film.path)) as container:
        sound = np.concatenate([frame.to_ndarray() for frame in container.decode(audio=0)], axis=1)
    rate = 48000
    assert sound.shape[1] == pytest.approx(1.5 * rate, abs=0.1 * rate)
    assert np.abs(sound[:, : int(0.4 * rate)]).max() > 0.2 > 20.0 * np.abs(sound[:, int(0.7 * rate) :]).max()


def test_time_runs_on_without_a_film_and_the_next_one_replaces_it(take, runner, simulation):
    first = take(0.3)
    hooks = (len(simulation.after_tick), len(simulation.holds))
    runner.advance(1.0).result(LIMIT)
    assert take(0.2).path == first.path
    assert (len(simulation.after_tick), len(simulation.holds)) == hooks


def test_a_caption_is_written_into_the_picture(take, control, runner):
    control.start("film.mp4", "front", SIDE, SIDE, RATE).result(LIMIT)
    runner.advance(0.5).result(LIMIT)
    control.caption("MMMM")
    runner.advance(0.5).result(LIMIT)
    film = control.stop().result(LIMIT)
    with av.open(str(film.path)) as container:
        pictures = [frame.to_ndarray(format="rgb24").astype(int) for frame in container.decode(video=0)]
    change = np.abs(pictures[-1] - pictures[1]).mean(axis=2)
    assert change[SIDE - 8 :, :].max() > 60 > 6 * change[: SIDE // 4].mean()


@pytest.mark.parametrize(
    "arguments, error",
    [
        (("film.mp4", "sideways", 0, 0, 0.0), UnknownName),
        (("film.avi", "", 0, 0, 0.0), BadValue),
        (("film.mp4", "", 33, 32, 0.0), BadValue),
        (("film.mp4", "", 4000, 32, 0.0), BadValue),
        (("film.mp4", "", 0, 0, 1000.0), BadValue),
        (("film.mp4", "", 0, 0, math.nan), BadValue),
        (("../film.mp4", "", 0, 0, 0.0), OutsideRecordDir),
    ],
)
def test_what_makes_no_film_is_refused(control, arguments, error):
    with pytest.raises(error):
        control.start(*arguments)


def test_there_is_one_film_at_a_time(control, runner):
    with pytest.raises(NotAllowed, match="nothing is being filmed"):
        control.stop().result(LIMIT)
    with pytest.raises(NotAllowed, match="nothing is being filmed"):
        control.caption("x")
    control.start("film.mp4", "", SIDE, SIDE, RATE).result(LIMIT)
    with pytest.raises(NotAllowed, match="film.mp4 is being filmed"):
        control.start("other.mp4", "", SIDE, SIDE, RATE).result(LIMIT)


def test_a_film_process_that_dies_is_told_and_time_goes_on(control, runner):
    control.start("film.mp4", "", SIDE, SIDE, RATE).result(LIMIT)
    control._film._worker.process.kill()
    runner.advance(1.0).result(LIMIT)
    with pytest.raises(RenderError):
        control.stop().result(LIMIT)
    control.start("film.mp4", "", SIDE, SIDE, RATE).result(LIMIT)


def test_the_end_completes_the_film(control, runner, tmp_path):
    control.start("film.mp4", "", SIDE, SIDE, RATE).result(LIMIT)
    runner.advance(0.5).result(LIMIT)
    control.close()
    with av.open(str(tmp_path / "film.mp4")) as container:
        assert sum(1 for _ in container.decode(video=0)) == 3
