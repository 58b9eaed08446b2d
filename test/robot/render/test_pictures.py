"""The picture process: what is where and what lights up, which engine draws, and what happens when it fails."""

import logging
import math
import os
import signal
from dataclasses import replace

import numpy as np
import pytest
from seen import AWAY, MODEL, STATE
from waits import hold

from nao_sim_bridge.base.errors import UnknownName
from nao_sim_bridge.model.leds_layout import load_leds
from nao_sim_bridge.model.postures import posture
from nao_sim_bridge.render.client import Renderer, RenderError, Viewer
from nao_sim_bridge.world.render_state import PRESETS, Camera, RenderState, preset_camera

SMALL = {"width": 160, "height": 120, "supersampling": 1}
FRONT = preset_camera("front", MODEL, STATE, **SMALL)
AHEAD = Camera((0.0, 0.0, 0.5), (1.0, 0.0, 0.5), width=160, height=120)
HELP = "install the packages libegl1, libgl1 and libgl1-mesa-dri"


def lit(name, channel, level=1.0):
    leds = load_leds()
    lamps = {index for index in leds.devices_of(name) if leds.channels[index] == channel}
    return tuple(level if index in lamps else 0.0 for index in range(89))


def shining(leds):
    return replace(STATE, led_values=leds)


def count(picture, channel):
    """Number of pixels that are clearly of one primary colour."""
    values = picture.astype(int)
    others = [values[..., i] for i in range(3) if i != channel]
    return int(np.sum((values[..., channel] > 120) & (values[..., channel] > 1.8 * np.maximum(*others))))


def warnings_of(caplog):
    return [record.getMessage() for record in caplog.records if record.levelno >= logging.WARNING]


@pytest.fixture(scope="module", params=["opengl", "builtin"])
def renderer(request):
    with Renderer("empty", engine=request.param) as started:
        yield started.start()


def take(renderer, state, view, **size):
    return renderer.render(state, preset_camera(view, MODEL, state, **{**SMALL, **size}))


def test_green_eyes_are_green_each_on_its_own_side_and_dark_eyes_are_not(renderer):
    size = {"width": 640, "height": 480, "supersampling": 2}
    dark, green = (take(renderer, state, "front", **size) for state in (STATE, shining(lit("FaceLeds", "green"))))
    assert dark.shape == (480, 640, 3) and dark.dtype == np.uint8
    assert count(dark, 1) == 0 and count(green, 1) > 150
    rows, columns = np.nonzero(np.any(dark != green, axis=2))
    # The eyes and their glow, nothing else: the head is in the middle of the upper third.
    assert rows.max() < 480 / 3 and columns.min() > 640 * 0.4 and columns.max() < 640 * 0.6
    left = take(renderer, shining(lit("LeftFaceLeds", "green")), "front")
    rows, columns = np.nonzero((left[..., 1].astype(int) - left[..., 0]) > 60)
    assert len(rows) and columns.min() >= 80, "seen from the front, the robot's left is on the right"


def test_an_arm_that_rises_is_seen_higher_and_the_robot_throws_a_shadow(renderer):
    angles = list(STATE.joint_positions)
    angles[MODEL.joint_index["LShoulderPitch"]] = -1.5
    raised = replace(STATE, joint_positions=tuple(angles))
    before, after = (renderer.render(state, FRONT).astype(int) for state in (STATE, raised))
    changed = np.any(np.abs(before - after) > 40, axis=2)
    assert changed[:30, 80:].sum() > 20, "above the left shoulder, where nothing was"
    assert changed[:30, :60].sum() == 0
    darker = (renderer.render(STATE, replace(FRONT, shadows=False)).astype(int) - before).sum(axis=2) > 60
    assert darker[80:].sum() > 100, "the robot throws a shadow on the floor"


@pytest.mark.parametrize("view", PRESETS)
def test_every_view_shows_the_robot_also_when_it_lies(renderer, view):
    belly = (0.0, math.sin(math.pi / 4), 0.0, math.cos(math.pi / 4))
    state = RenderState((0.3, 0.2, 0.08), belly, posture(MODEL, "LyingBelly"), lit("FaceLeds", "green"))
    picture = take(renderer, state, view, width=320, height=240)
    red, green, blue = (picture[..., i].astype(int) for i in range(3))
    assert int(np.sum((red > 100) & (green < 0.75 * red) & (blue < 0.45 * red))) > 20, "orange"


def test_a_process_that_is_killed_or_hangs_is_started_again(caplog):
    with Renderer() as own:
        first = own.start().pid
        os.kill(first, signal.SIGKILL)
        with pytest.raises(RenderError, match="ended with status -9"):
            own.render(STATE, FRONT)
        before = own.render(STATE, FRONT)
        second = own.pid
        os.kill(second, signal.SIGKILL)
        caplog.clear()
        assert np.array_equal(own.render(STATE, FRONT), before), "after a first picture nobody notices"
        assert warnings_of(caplog) == ["picture: the picture process ended with status -9; it is started again"]
        assert len({first, second, own.pid}) == 3
        hold(own.pid)
        with pytest.raises(RenderError, match="no answer .* within 0.2 s"):
            own.render(STATE, FRONT, timeout=0.2)
        assert own.render(STATE, FRONT).shape == (120, 160, 3)
    assert own.pid is None


def test_what_cannot_start_says_why(monkeypatch):
    with pytest.raises(UnknownName, match="unknown renderer 'opengles': did you mean 'opengl'"):
        Renderer(engine="opengles")
    monkeypatch.delenv("DISPLAY", raising=False)
    with pytest.raises(RenderError, match="no display"):
        Viewer().start()


def test_without_opengl_the_built_in_engine_draws_and_one_warning_says_how_to_get_it(monkeypatch, caplog):
    for name in ("FILENAMES", "DIRS"):  # EGL finds no driver in processes that are started from now on
        monkeypatch.setenv(f"__EGL_VENDOR_LIBRARY_{name}", "/nowhere/at/all.json")
    with Renderer() as own:
        picture = own.render(AWAY, AHEAD)
        assert own.engine.startswith("the built-in renderer")
        os.kill(own.pid, signal.SIGKILL)
        assert np.array_equal(own.render(AWAY, AHEAD), picture)
    help_once, again = warnings_of(caplog)
    assert HELP in help_once and "is started again" in again
    with pytest.raises(RenderError, match=f"OpenGL: .*{HELP}"):
        Renderer(engine="opengl").start()
