"""Head angles for looking at points: the point lies on the axis of the camera."""

from __future__ import annotations

import math

import pytest

from nao_library_modules.gaze import load_head, look_at

HEAD = load_head()


def off_axis(camera, yaw, pitch, point):
    """Distance of a point from the line of sight of a camera, m."""
    x, y, z = point
    # Into the frame of the head: turn back yaw, then pitch (positive is down).
    ahead, aside = x * math.cos(yaw) + y * math.sin(yaw), y * math.cos(yaw) - x * math.sin(yaw)
    up = z - HEAD.height
    hx = ahead * math.cos(pitch) - up * math.sin(pitch)
    hz = ahead * math.sin(pitch) + up * math.cos(pitch)
    dx, dz = hx - camera.ahead, hz - camera.above
    along = dx * math.cos(camera.down) - dz * math.sin(camera.down)
    assert along > 0.0, "behind the camera"
    return math.hypot(aside, dx * math.sin(camera.down) + dz * math.cos(camera.down))


@pytest.mark.parametrize("name", HEAD.cameras)
@pytest.mark.parametrize("point", [(1.0, 0.0, 0.2), (0.5, 0.5, 0.0), (2.0, -1.0, 1.0), (0.3, 0.1, -0.3)])
def test_the_point_is_in_the_middle_of_the_picture(name, point):
    camera = HEAD.cameras[name]
    yaw, pitch = look_at(HEAD, camera, point)
    assert off_axis(camera, yaw, pitch, point) == pytest.approx(0.0, abs=1e-9)


def test_a_point_far_ahead_at_eye_height_needs_next_to_no_turn():
    yaw, pitch = look_at(HEAD, HEAD.cameras["CameraTop"], (1000.0, 0.0, HEAD.height))
    assert yaw == 0.0
    assert pitch == pytest.approx(-HEAD.cameras["CameraTop"].down, abs=1e-3)


def test_left_is_positive_yaw_and_down_is_positive_pitch():
    camera = HEAD.cameras["CameraTop"]
    assert look_at(HEAD, camera, (1.0, 1.0, 0.0))[0] == pytest.approx(math.pi / 4)
    assert look_at(HEAD, camera, (1.0, 0.0, -0.5))[1] > look_at(HEAD, camera, (1.0, 0.0, 0.5))[1]


def test_a_point_in_the_head_is_refused():
    with pytest.raises(ValueError, match="inside the head"):
        look_at(HEAD, HEAD.cameras["CameraTop"], (0.01, 0.0, HEAD.height))
