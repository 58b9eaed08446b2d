"""What moves is found where it is; noise, light and a moving head are no movement."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from nao_sim_bridge.sim.cameras.optics import Optics
from nao_sim_bridge.sim.vision.movement import MovementDetector, MovementSettings

OPTICS = Optics(0.9826, 0.7627)
POSE = (0.05, 0.0, 0.5, 0.0, 0.1, 0.0)
PERIOD = 0.1


@pytest.fixture
def room():
    random = np.random.default_rng(1)
    coarse = random.integers(30, 220, (15, 20, 3), dtype=np.uint8)
    background = cv2.resize(coarse, (320, 240), interpolation=cv2.INTER_NEAREST)

    def picture(ball=None, shift=0.0, gain=1.0, noise=4.0):
        shown = cv2.warpAffine(background, np.float32([[1, 0, shift], [0, 1, 0]]), (320, 240), borderMode=1)
        if ball is not None:
            cv2.circle(shown, tuple(round(8 * x) for x in ball), 8 * 12, (20, 20, 220), -1, cv2.LINE_AA, 3)
        return np.clip(gain * shown + random.normal(0.0, noise, shown.shape), 0, 255).astype(np.uint8)

    return picture


def watch(pictures, sensitivity=0.8, poses=None, period=PERIOD):
    """What the detector says to each picture."""
    detector = MovementDetector()
    poses = poses or [POSE] * len(pictures)
    return [
        detector.detect(picture, OPTICS, MovementSettings(sensitivity, period * number, 0, pose))
        for number, (picture, pose) in enumerate(zip(pictures, poses))
    ]


def test_nothing_moves_in_a_room_with_noise_and_sway(room):
    found = watch([room(shift=0.4 * np.sin(k)) for k in range(30)], sensitivity=1.0)
    assert found == [None, None] + [[]] * 28


def test_the_camera_that_adjusts_its_exposure_is_no_movement(room):
    found = watch([room(gain=0.75 + 0.25 * np.cos(k / 4)) for k in range(30)])
    assert found[2:] == [[]] * 28


def test_a_light_that_goes_on_is_no_movement(room):
    lit = [cv2.convertScaleAbs(room(), alpha=0.2, beta=5) for _ in range(5)] + [room() for _ in range(5)]
    assert not any(watch(lit))


@pytest.mark.parametrize("pixels", [2, 6, 15])
def test_a_ball_that_rolls_by_is_found_where_it_is(room, pixels):
    found = watch([room(ball=(80 + pixels * k, 120)) for k in range(8)])
    for number, clusters in enumerate(found[2:], 2):
        cluster = clusters[0]
        # Between where it is and where it was two pictures ago.
        middle = 80 + pixels * (number - 1)
        assert cluster.alpha == pytest.approx(OPTICS.angles(middle / 320, 0.5)[0], abs=0.04)
        assert cluster.beta == pytest.approx(0.0, abs=0.03)
        left, top = OPTICS.place(*cluster.corner)
        width, height = OPTICS.image_size(*cluster.size)
        assert 0.0 < left < middle / 320 < left + width < 1.0
        assert top < 0.5 < top + height
        assert width * 320 <= 24 + 2 * pixels + 8 and height * 240 <= 32
        assert 0.0 < cluster.share_of_picture < 0.03 < cluster.share_of_rectangle <= 1.0


def test_two_things_that_move_are_two_the_larger_first(room):
    def both(step):
        picture = room(ball=(60 + 4 * step, 60))
        cv2.rectangle(picture, (220, 120 + 8 * step), (270, 145 + 8 * step), (250, 250, 250), -1)
        return picture

    first, second = watch([both(step) for step in range(4)])[-1]
    assert first.alpha < 0.0 < second.alpha
    assert first.share_of_picture > second.share_of_picture


def test_the_lower_the_sensitivity_the_more_it_takes(room):
    def faint(step):
        picture = room(noise=2.0).astype(np.int16)
        picture[100:140, 100 + 8 * step : 150 + 8 * step] += 30
        return np.clip(picture, 0, 255).astype(np.uint8)

    pictures = [faint(step) for step in range(6)]
    assert all(watch(pictures, sensitivity=0.9)[2:])
    assert not any(watch(pictures, sensitivity=0.3))


def test_a_moving_head_is_no_movement_and_afterwards_it_goes_on(room):
    poses = [POSE] * 4 + [(*POSE[:5], 0.02 * k) for k in range(1, 6)] + [(*POSE[:5], 0.1)] * 5
    shifts = [0] * 4 + [6 * k for k in range(1, 6)] + [30] * 5
    found = watch([room(shift=shift) for shift in shifts], poses=poses)
    assert found[2:4] == [[], []]
    assert found[4:9] == [None] * 5
    assert found[-2:] == [[], []]


def test_another_camera_or_size_begins_anew(room):
    detector = MovementDetector()
    for time in (0.0, 0.3):
        detector.detect(room(), OPTICS, MovementSettings(0.8, time, 0, POSE))
    assert detector.detect(room(ball=(100, 100)), OPTICS, MovementSettings(0.8, 0.6, 1, POSE)) is None
    assert detector.detect(room()[:120, :160], OPTICS, MovementSettings(0.8, 0.9, 1, POSE)) is None


def test_reset_forgets_the_pictures_before(room):
    detector = MovementDetector()
    detector.detect(room(), OPTICS, MovementSettings(0.8, 0.0, 0, POSE))
    detector.reset()
    assert detector.detect(room(ball=(100, 100)), OPTICS, MovementSettings(0.8, 0.5, 0, POSE)) is None


def test_slow_pictures_are_compared_with_the_one_before(room):
    found = watch([room(ball=(80 + 10 * k, 120)) for k in range(4)], period=1.0)
    assert found[0] is None and all(found[1:])
