"""Pictures: what is where, what lights up, and what happens when the picture process fails."""

from __future__ import annotations

import math
import os
import signal
import subprocess
import sys
import textwrap
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from nao_sim_bridge.paths import data_root
from nao_sim_bridge.sim.errors import BadValue, UnknownName
from nao_sim_bridge.sim.leds_layout import load_leds
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.postures import posture
from nao_sim_bridge.sim.render import (
    PRESETS,
    Camera,
    Renderer,
    RenderError,
    RenderState,
    Viewer,
    preset_camera,
    write_png,
)
from nao_sim_bridge.sim.render.backdrop import Backdrop, blur
from nao_sim_bridge.sim.render.view import View
from nao_sim_bridge.sim.snapshot import Pose
from nao_sim_bridge.sim.world import load_world

DARK = (0.0,) * 89
SMALL = {"width": 160, "height": 120, "supersampling": 1}


def standing(leds=DARK, **changes):
    state = RenderState((0.0, 0.0, 0.333), (0.0, 0.0, 0.0, 1.0), posture(load_model(), "Stand"), tuple(leds))
    return replace(state, **changes)


def lit(name, channel, level=1.0):
    leds = load_leds()
    values = list(DARK)
    for index in leds.devices_of(name):
        if leds.channels[index] == channel:
            values[index] = level
    return tuple(values)


def count(picture, channel):
    """Number of pixels that are clearly of one primary colour."""
    values = picture.astype(int)
    others = [values[..., i] for i in range(3) if i != channel]
    return int(np.sum((values[..., channel] > 120) & (values[..., channel] > 1.8 * np.maximum(*others))))


@pytest.fixture(scope="module", params=["opengl", "builtin"])
def renderer(request):
    with Renderer("empty", engine=request.param) as started:
        yield started.start()


def take(renderer, state, view, **size):
    return renderer.render(state, preset_camera(view, load_model(), state, **{**SMALL, **size}))


def test_a_picture_has_the_size_asked_for(renderer):
    picture = take(renderer, standing(), "front", width=200, height=100, supersampling=2)
    assert picture.shape == (100, 200, 3) and picture.dtype == np.uint8


def test_green_eyes_are_green_and_dark_eyes_are_not(renderer):
    dark = take(renderer, standing(), "front", width=640, height=480)
    green = take(renderer, standing(lit("FaceLeds", "green")), "front", width=640, height=480)
    assert count(dark, 1) == 0
    assert count(green, 1) > 150
    rows, columns = np.nonzero(np.any(dark != green, axis=2))
    # The eyes and their glow, nothing else: the head is in the middle of the upper third.
    assert rows.max() < 480 / 3 and columns.min() > 640 * 0.4 and columns.max() < 640 * 0.6


def test_each_eye_lights_up_on_its_own_side(renderer):
    left = take(renderer, standing(lit("LeftFaceLeds", "green")), "front")
    rows, columns = np.nonzero((left[..., 1].astype(int) - left[..., 0]) > 60)
    # Seen from the front, the robot's left is on the right.
    assert len(rows) and columns.min() >= 80


def test_half_intensity_is_between_dark_and_full(renderer):
    levels = [
        take(renderer, standing(lit("FaceLeds", "red", level)), "face")[..., 0].astype(int).sum()
        for level in (0.0, 0.5, 1.0)
    ]
    assert levels[0] < levels[1] < levels[2]


@pytest.mark.parametrize("name, channel, view", [("ChestLeds", "blue", "front"), ("LeftEarLeds", "blue", "side")])
def test_other_lamps_light_up(renderer, name, channel, view):
    before = count(take(renderer, standing(), view, width=320, height=240), 2)
    after = count(take(renderer, standing(lit(name, channel)), view, width=320, height=240), 2)
    assert before == 0 and after > 10


def test_an_arm_that_rises_is_seen_higher(renderer):
    model = load_model()
    state = standing()
    angles = list(state.joint_positions)
    angles[model.joint_index["LShoulderPitch"]] = -1.5
    camera = preset_camera("front", model, state, **SMALL)
    before = renderer.render(state, camera)
    after = renderer.render(replace(state, joint_positions=tuple(angles)), camera)
    changed = np.any(np.abs(before.astype(int) - after) > 40, axis=2)
    assert changed[:30, 80:].sum() > 20  # above the left shoulder, where nothing was
    assert changed[:30, :60].sum() == 0


def test_a_robot_that_moves_away_becomes_smaller(renderer):
    camera = preset_camera("front", load_model(), standing(), **SMALL)
    empty = renderer.render(standing(base_position=(50.0, 0.0, 0.333)), camera).astype(int)

    def size(x):
        picture = renderer.render(standing(base_position=(x, 0.0, 0.333)), camera)
        return np.any(np.abs(picture - empty) > 40, axis=2).sum()

    assert size(0.0) > 2 * size(-1.5) > 0


def test_the_robot_throws_a_shadow_on_the_floor(renderer):
    state = standing()
    camera = preset_camera("front", load_model(), state, **SMALL)
    with_shadow = renderer.render(state, camera).astype(int)
    without = renderer.render(state, replace(camera, shadows=False)).astype(int)
    darker = (without - with_shadow).sum(axis=2) > 60
    assert darker[80:].sum() > 100


def test_views_follow_the_robot_wherever_it_is():
    model = load_model()
    turned = (0.0, 0.0, math.sin(math.pi / 4), math.cos(math.pi / 4))
    state = standing(base_position=(2.0, 3.0, 0.333), base_orientation=turned)
    camera = preset_camera("front", model, state)
    assert camera.eye[:2] == pytest.approx((2.0, 4.05))
    assert camera.target[:2] == pytest.approx((2.0, 3.0))


@pytest.mark.parametrize("view", PRESETS)
def test_every_view_shows_the_robot_also_when_it_lies(renderer, view):
    model = load_model()
    belly = (0.0, math.sin(math.pi / 4), 0.0, math.cos(math.pi / 4))
    state = RenderState((0.3, 0.2, 0.08), belly, posture(model, "LyingBelly"), lit("FaceLeds", "green"))
    assert count_orange(take(renderer, state, view, width=320, height=240)) > 20


def count_orange(picture):
    red, green, blue = (picture[..., i].astype(int) for i in range(3))
    return int(np.sum((red > 100) & (green < 0.75 * red) & (blue < 0.45 * red)))


def test_unknown_view_and_impossible_cameras_are_refused():
    with pytest.raises(UnknownName, match="'frnt'.*did you mean 'front'"):
        preset_camera("frnt", load_model(), standing())
    with pytest.raises(BadValue, match="camera target"):
        Camera(eye=(0.0, 0.0, 0.0), target=(0.0, 0.0, 0.0))
    with pytest.raises(BadValue, match="fov"):
        Camera(eye=(0.0, 0.0, 0.0), target=(1.0, 0.0, 0.0), fov=4.0)
    with pytest.raises(BadValue, match="supersampling"):
        Camera(eye=(0.0, 0.0, 0.0), target=(1.0, 0.0, 0.0), supersampling=9)


def test_objects_of_the_world_are_seen_where_they_are(tmp_path):
    world = tmp_path / "ball.yaml"
    world.write_text(
        "floor: {friction: 1.0}\n"
        "objects:\n- {name: ball, sphere: 0.1, position: [0.3, 0.22, 0.1], mass: 0.1, color: [0, 1, 0]}\n"
    )
    camera = preset_camera("front", load_model(), standing(), **SMALL)
    moved = Pose((0.3, -0.22, 0.1), (0.0, 0.0, 0.0, 1.0))
    with Renderer(str(world)) as own:
        before = own.render(standing(), camera)
        after = own.render(standing(objects={"ball": moved}), camera)
        with pytest.raises(RenderError, match="unknown object 'bal': did you mean 'ball'"):
            own.render(standing(objects={"bal": moved}), camera)
        # A picture it cannot make is no reason to end.
        assert np.array_equal(own.render(standing(objects={"ball": moved}), camera), after)
    # Seen from the front, positive y is on the right.
    assert count(before[:, 80:], 1) > 30 and count(before[:, :80], 1) == 0
    assert count(after[:, :80], 1) > 30 and count(after[:, 80:], 1) == 0


def test_a_process_that_is_killed_before_its_first_picture_is_an_error_once_and_then_started_again():
    camera = preset_camera("front", load_model(), standing(), **SMALL)
    with Renderer() as own:
        own.start()
        first = own.pid
        os.kill(first, signal.SIGKILL)
        with pytest.raises(RenderError, match="ended with status -9"):
            own.render(standing(), camera)
        assert own.render(standing(), camera).shape == (120, 160, 3)
        assert own.pid != first


def test_who_wants_a_picture_does_not_notice_that_the_process_was_killed_after_an_earlier_one(caplog):
    camera = preset_camera("front", load_model(), standing(), **SMALL)
    with Renderer() as own:
        before = own.render(standing(), camera)
        first = own.pid
        os.kill(first, signal.SIGKILL)
        caplog.clear()
        assert np.array_equal(own.render(standing(), camera), before)
        assert own.pid != first
    warnings = [record.getMessage() for record in caplog.records if record.levelname == "WARNING"]
    assert warnings == ["picture: the picture process ended with status -9; it is started again"]


def test_a_process_that_hangs_is_given_up_after_the_timeout():
    camera = preset_camera("front", load_model(), standing(), **SMALL)
    with Renderer() as own:
        own.render(standing(), camera)
        os.kill(own.pid, signal.SIGSTOP)
        with pytest.raises(RenderError, match="no answer .* within 0.2 s"):
            own.render(standing(), camera, timeout=0.2)
        assert own.render(standing(), camera).shape == (120, 160, 3)


def test_an_unknown_world_is_reported_at_the_start():
    with pytest.raises(RenderError, match="no world 'moon'"):
        Renderer("moon").start()


def test_closing_ends_the_process():
    own = Renderer().start()
    process = own.pid
    own.close()
    assert own.pid is None
    with pytest.raises(ProcessLookupError):
        os.kill(process, 0)


def test_the_process_ends_with_its_parent():
    program = """
        import os, signal
        from nao_sim_bridge.sim.render import Renderer
        print(Renderer().start().pid, flush=True)
        os.kill(os.getpid(), signal.SIGKILL)
    """
    environment = {**os.environ, "PYTHONPATH": str(data_root() / "src")}
    parent = subprocess.Popen(
        [sys.executable, "-c", textwrap.dedent(program)],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    assert int(parent.stdout.readline()) != parent.pid
    # The picture process holds the other end of its parent's output: it closes when both have ended.
    parent.communicate(timeout=30.0)
    assert parent.returncode == -signal.SIGKILL


def test_no_display_is_a_clear_error(monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    with pytest.raises(RenderError, match="no display"):
        Viewer().start()


def test_a_display_that_is_not_there_is_an_error_too(monkeypatch):
    monkeypatch.setenv("DISPLAY", ":97")
    with pytest.raises(RenderError, match="window: "):
        Viewer().start()


def test_png_files_hold_the_picture(tmp_path):
    picture = np.random.default_rng(0).integers(0, 255, (12, 16, 3), dtype=np.uint8)
    path = write_png(tmp_path / "new" / "picture.png", picture)
    assert np.array_equal(np.asarray(Image.open(path)), picture)


def test_rays_spread_over_the_field_of_view():
    camera = Camera((0.0, 0.0, 1.0), (1.0, 0.0, 1.0), fov=math.radians(90.0), width=100, height=100)
    rays = View.of_camera(camera).rays()
    assert rays[0, 50][2] == pytest.approx(0.99) and rays[99, 50][2] == pytest.approx(-0.99)
    assert rays[50, 0][1] > 0.9  # the left edge of the picture is on the left


def test_floor_tiles_alternate():
    camera = Camera((0.125, 0.125, 2.0), (0.125, 0.125, 0.0), up=(1.0, 0.0, 0.0), fov=0.25, width=40, height=40)
    picture = Backdrop(load_world("empty")).draw(View.of_camera(camera), None)
    center, left = picture[20, 20], picture[20, 1]
    assert np.abs(center - left).max() > 0.02


def test_blur_keeps_the_sum_and_spreads():
    image = np.zeros((41, 41), dtype=np.float32)
    image[20, 20] = 1.0
    soft = blur(image, 3)
    assert soft.sum() == pytest.approx(1.0, abs=1e-4)
    assert 0.0 < soft[20, 20] < 0.05 and soft[20, 25] > 0.0
