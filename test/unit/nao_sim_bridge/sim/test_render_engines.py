"""Which engine draws, what happens without OpenGL, and what goes over the pipe."""

from __future__ import annotations

import logging
import os
import signal
from dataclasses import replace

import numpy as np
import pytest
from seen import AWAY, GREEN, STATE, UNTURNED, clear, middle, placed, shot

from nao_sim_bridge.sim.cameras.photograph import photograph, read_photograph
from nao_sim_bridge.sim.errors import UnknownName
from nao_sim_bridge.sim.readings import Pose
from nao_sim_bridge.sim.render import Camera, Renderer, RenderError
from nao_sim_bridge.sim.render.engines import open_engine
from nao_sim_bridge.sim.render.view import View
from nao_sim_bridge.sim.render.wire import StateReceiver, StateSender
from nao_sim_bridge.sim.world import load_world

BALL = {"name": "ball", "sphere": 0.05, "position": [1.0, 0.2, 0.5], "color": list(GREEN)}
AHEAD = Camera((0.0, 0.0, 0.5), (1.0, 0.0, 0.5), width=160, height=120)
HELP = "install the packages libegl1, libgl1 and libgl1-mesa-dri"


@pytest.fixture
def no_opengl(monkeypatch):
    """EGL finds no driver in processes that are started from now on."""
    monkeypatch.setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere/at/all.json")
    monkeypatch.setenv("__EGL_VENDOR_LIBRARY_DIRS", "/nowhere/at/all")


def warnings_of(caplog):
    return [record.getMessage() for record in caplog.records if record.levelno >= logging.WARNING]


def test_opengl_draws_where_it_can_be_had(caplog):
    caplog.set_level(logging.INFO)
    with Renderer() as own:
        assert own.engine is None
        assert own.start().engine.startswith("OpenGL: ")
    assert f"pictures are drawn by {own.engine}" in caplog.text
    assert not warnings_of(caplog)


def test_without_opengl_the_built_in_engine_draws_and_one_warning_says_how_to_get_it(no_opengl, caplog):
    with Renderer() as own:
        picture = own.render(AWAY, AHEAD)
        assert own.engine.startswith("the built-in renderer")
        os.kill(own.pid, signal.SIGKILL)
        assert np.array_equal(own.render(AWAY, AHEAD), picture)
    help_once, again = warnings_of(caplog)
    assert HELP in help_once and "is started again" in again


def test_a_driver_that_takes_its_process_with_it_is_done_without(tmp_path, monkeypatch, caplog):
    (tmp_path / "moderngl.py").write_text("import os\nos._exit(7)\n")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    with Renderer() as own:
        assert own.start().engine.startswith("the built-in renderer")
    (warning,) = warnings_of(caplog)
    assert "ended with status 7" in warning
    with pytest.raises(RenderError, match="ended with status 7"):
        Renderer(engine="opengl").start()


def test_who_wants_nothing_but_opengl_gets_an_error_without_it(no_opengl):
    with pytest.raises(RenderError, match=f"OpenGL: .*{HELP}"):
        Renderer(engine="opengl").start()


def test_without_the_python_package_it_is_the_same(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "moderngl", None)
    monkeypatch.delitem(__import__("sys").modules, "nao_sim_bridge.sim.render.opengl", raising=False)
    monkeypatch.delitem(__import__("sys").modules, "nao_sim_bridge.sim.render.opengl.engine", raising=False)
    drawing, complaint = open_engine("auto", load_world("empty"), "V6")
    drawing.close()
    assert drawing.name.startswith("the built-in renderer") and HELP in complaint


def test_an_unknown_engine_is_refused():
    with pytest.raises(UnknownName, match="unknown renderer 'opengles': did you mean 'opengl'"):
        Renderer(engine="opengles")


@pytest.fixture(scope="module")
def renderer():
    with Renderer("empty") as started:
        yield started.start()


def test_a_capture_is_what_the_camera_makes_of_what_is_drawn(renderer):
    state, view = placed(BALL), shot(width=160, height=120)
    drawing, _ = open_engine("auto", load_world("empty"), "V6")
    expected = photograph(drawing.draw(state, View.of_shot(view)), view)
    drawing.close()
    captured = renderer.capture(state, view)
    assert captured == expected
    pixels = np.frombuffer(read_photograph(captured).data, np.uint8).reshape(120, 160, 3)
    assert middle(clear(pixels, 1) > 0.3)[0] < 70


def test_a_capture_that_cannot_be_made_is_an_error_and_the_next_one_is_fine(renderer):
    process = renderer.pid
    with pytest.raises(RenderError, match="unknown object 'bal'"):
        renderer.capture(placed(BALL, objects={"bal": Pose((0.0, 0.0, 0.0), UNTURNED)}), shot())
    with pytest.raises(RenderError, match="colorSpace"):
        renderer.capture(STATE, replace(shot(), color_space=99))
    assert read_photograph(renderer.capture(STATE, shot())).data
    assert renderer.pid == process


def test_what_was_placed_is_there_again_after_the_process_has_died(renderer):
    state = placed(BALL)
    before = renderer.render(state, AHEAD)
    os.kill(renderer.pid, signal.SIGKILL)
    assert np.array_equal(renderer.render(state, AHEAD), before)
    assert not np.array_equal(renderer.render(AWAY, AHEAD), before)


def test_what_was_placed_goes_over_once():
    sender, receiver = StateSender(), StateReceiver()
    state = placed(BALL)
    first, again, moved, without = (
        sender.pack(one)
        for one in (state, state, replace(state, objects={"ball": Pose((0.0, 0.0, 0.0), UNTURNED)}), AWAY)
    )
    assert [packed[1] for packed in (first, again, moved, without)] == [state.placed, None, None, ()]
    assert receiver.unpack(first) == state
    assert receiver.unpack(again).placed is receiver.unpack(moved).placed
    assert receiver.unpack(without) == AWAY


def test_a_failed_request_does_not_lose_what_was_placed(renderer):
    """The state has arrived even if it could not be drawn."""
    state = placed(BALL)
    with pytest.raises(RenderError):
        renderer.render(replace(state, gone=frozenset(["nothing"])), AHEAD)
    assert np.count_nonzero(clear(renderer.render(state, AHEAD), 1)) > 50
