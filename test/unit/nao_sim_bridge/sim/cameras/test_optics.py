"""Places in the picture and angles."""

from __future__ import annotations

import math

import numpy as np
import pytest

from nao_sim_bridge.sim.cameras.optics import CameraOptics, Optics


@pytest.mark.parametrize("version, h_deg, v_deg", [("V6", 56.3, 43.7), ("V5", 60.9, 47.6)])
def test_each_version_has_its_field_of_view(version, h_deg, v_deg):
    for index in (0, 1):
        assert CameraOptics(version, index).fov == pytest.approx((math.radians(h_deg), math.radians(v_deg)))


def test_intrinsics_are_those_of_a_pinhole():
    pinhole = CameraOptics("V6", 0).intrinsics(640, 480)
    assert (pinhole.fx, pinhole.fy) == pytest.approx((598.05, 598.53), abs=0.05)
    assert (pinhole.cx, pinhole.cy) == (320.0, 240.0)
    half = CameraOptics("V6", 0).intrinsics(320, 240)
    assert (half.fx, half.fy) == pytest.approx((pinhole.fx / 2, pinhole.fy / 2))


def test_signs_are_those_of_naoqi():
    optics = Optics(1.0, 0.8)
    assert optics.angles(0.5, 0.5) == (0.0, 0.0)
    assert optics.angles(0.0, 0.0) == pytest.approx((0.5, -0.4))  # upper left corner
    assert optics.angles(1.0, 1.0) == pytest.approx((-0.5, 0.4))


@pytest.mark.parametrize("x, y", [(0.1, 0.9), (0.5, 0.25), (0.98, 0.02)])
def test_angles_lead_back_to_the_place(x, y):
    optics = CameraOptics("V6", 1)
    assert optics.place(*optics.angles(x, y)) == pytest.approx((x, y))
    assert optics.image_size(*optics.angular_size(x, y)) == pytest.approx((x, y))


def test_a_ray_goes_where_the_angles_say():
    optics = CameraOptics("V6", 0)
    ray = optics.ray(0.2, 0.7)
    assert np.linalg.norm(ray) == pytest.approx(1.0)
    alpha, beta = optics.angles(0.2, 0.7)
    assert math.atan2(ray[1], ray[0]) == pytest.approx(alpha)
    assert math.atan2(-ray[2], ray[0]) == pytest.approx(beta)
    assert optics.project(3.0 * ray) == pytest.approx((0.2, 0.7))


def test_what_is_behind_is_in_no_picture():
    assert CameraOptics().project(np.array((-1.0, 0.0, 0.0))) is None


def test_the_whole_width_fills_the_field_of_view():
    optics = CameraOptics()
    assert optics.angular_size(1.0, 1.0) == pytest.approx(optics.fov)
