"""QR codes and barcodes in drawn pictures: what they say and where they are."""

from __future__ import annotations

import math

import numpy as np
import pytest
from seen_cards import OPTICS, card

from nao_sim_bridge.sim.vision.barcodes import BarcodeDetector
from nao_sim_bridge.sim.world_pictures import WorldPicture

QR = WorldPicture("qr", "hello world")
VGA = (640, 480)


@pytest.fixture(scope="module")
def detector():
    return BarcodeDetector()


def middle(code):
    return np.mean(code.corners, axis=0)


@pytest.mark.parametrize("size, distance", [((320, 240), 0.6), (VGA, 0.5), (VGA, 1.4)])
def test_a_qr_code_is_read_and_found_where_it_is(detector, size, distance):
    (code,) = detector.detect(card(QR, 0.2, distance, alpha=0.1, beta=-0.05, size=size), OPTICS)
    assert (code.text, code.kind) == ("hello world", "QRCode")
    assert middle(code) == pytest.approx(np.array(OPTICS.place(0.1, -0.05)) * size, abs=3.0)


def test_corners_go_clockwise_from_the_upper_left_one(detector):
    (code,) = detector.detect(card(QR, 0.2, 0.5), OPTICS)
    corners = np.array(code.corners) - middle(code)
    assert np.all(np.sign(corners) == [(-1, -1), (1, -1), (1, 1), (-1, 1)])
    # The code itself, without its white margin of four modules on each side of 21.
    edge = OPTICS.intrinsics(320, 240).fx * 0.2 / 0.5 * 21 / 29
    assert np.ptp(corners, axis=0) == pytest.approx((edge, edge), abs=4.0)


def test_corners_turn_with_the_code(detector):
    (code,) = detector.detect(card(QR, 0.2, 0.5, roll=np.pi / 2.0), OPTICS)
    first = np.array(code.corners[0]) - middle(code)
    assert first[0] < 0.0 < first[1]  # its upper left corner is the lower left one of the picture


@pytest.mark.parametrize(
    "content, text, kind", [("4006381333931", "4006381333931", "EAN13"), ("code128:ABC-1", "ABC-1", "Code128")]
)
def test_barcodes_are_read(detector, content, text, kind):
    picture = card(WorldPicture("barcode", content), 0.2, 0.45, size=VGA)
    (code,) = detector.detect(picture, OPTICS)
    assert (code.text, code.kind) == (text, kind)
    assert middle(code) == pytest.approx((320.0, 240.0), abs=40.0)


@pytest.mark.parametrize("number", ["4006381333931", "5901234123457", "9780201379624"])
def test_an_article_number_is_rather_not_read_than_wrongly(detector, number):
    read = []
    for turn in range(16):
        distance, yaw = 0.3 + 0.02 * turn, 0.4 * math.sin(turn)
        picture = card(WorldPicture("barcode", number), 0.2, distance, alpha=0.01 * turn, yaw=yaw, seed=turn)
        read += [code.text for code in detector.detect(picture, OPTICS)]
    assert set(read) == {number}


def test_two_codes_come_from_left_to_right(detector):
    picture = card(WorldPicture("qr", "right"), 0.2, 0.7, alpha=-0.25, size=VGA)
    picture = card(WorldPicture("qr", "left"), 0.2, 0.7, alpha=0.25, size=VGA, onto=picture)
    assert [code.text for code in detector.detect(picture, OPTICS)] == ["left", "right"]


def test_letters_of_all_languages_are_read(detector):
    (code,) = detector.detect(card(WorldPicture("qr", "Grüße, 北京"), 0.2, 0.5, size=VGA), OPTICS)
    assert code.text == "Grüße, 北京"


def test_stripes_and_noise_are_no_codes(detector):
    stripes = np.full((240, 320, 3), 230, np.uint8)
    stripes[:, ::7] = stripes[:, 1::7] = 20
    assert detector.detect(stripes, OPTICS) == []
    noise = np.random.default_rng(3).integers(0, 256, (240, 320, 3)).astype(np.uint8)
    assert detector.detect(noise, OPTICS) == []
