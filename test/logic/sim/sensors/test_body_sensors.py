"""What presses, holds up and turns the body: contacts, foot sensors, touch, the inertial unit."""

from __future__ import annotations

import math

import numpy as np
import pytest

from nao_sim_bridge.base.readings import BodyReadings, Contact, Pose
from nao_sim_bridge.base.rotations import from_roll_pitch_yaw
from nao_sim_bridge.body.sensors.body import FootSensors, Press, TouchSensors, in_link_frames
from nao_sim_bridge.body.sensors.inertial import InertialUnit
from nao_sim_bridge.body.touch_gestures import LONGEST_CLICK, LONGEST_PAUSE, ClickCounter
from nao_sim_bridge.model.model_reader import load_model

MODEL = load_model()
LINKS = {link.name: number for number, link in enumerate(MODEL.links)}
STILL = (0.0, 0.0, 0.0)
UPRIGHT = Pose((1.0, 2.0, 3.0), (0.0, 0.0, 0.0, 1.0))
TURNED = Pose((0.0, 0.0, 1.0), from_roll_pitch_yaw(0.0, 0.0, math.pi / 2))
OVER = Pose(STILL, from_roll_pitch_yaw(math.pi, 0.0, 0.0))


@pytest.mark.parametrize(
    "pose, position, normal, press",
    [
        (UPRIGHT, (1.1, 2.2, 2.9), (0, 0, 1), (0.1, 0.2, -0.1, 1.0)),
        (TURNED, (0.0, 0.3, 1.0), (0, 0, 1), (0.3, 0.0, 0.0, 1.0)),
        (TURNED, (-0.3, 0.0, 1.0), (1, 0, 0), (0.0, 0.3, 0.0, 0.0)),
        (OVER, (0.1, 0.2, 0.3), (0, 0, 1), (0.1, -0.2, -0.3, -1.0)),
    ],
)
def test_contacts_are_moved_and_turned_into_the_frame_of_their_link(pose, position, normal, press):
    contacts = [Contact(link, position, normal, force) for link, force in ((4, 5.0), (-1, 1.0), (4, 2.0))]
    found = in_link_frames(contacts, {4: pose, -1: TURNED})
    assert found[4][0] == pytest.approx((*press, 5.0), abs=1e-12)
    assert [one.force for one in found[4]] == [5.0, 2.0] and [one.force for one in found[-1]] == [1.0]
    assert in_link_frames([], {}) == {}


def foot(side, *presses):
    """Reads a foot under presses of (x, y, force) from straight below."""
    return FootSensors(MODEL, side).read([Press(x, y, -0.045, 1.0, force) for x, y, force in presses])


@pytest.mark.parametrize("side", "LR")
def test_a_force_on_a_sensor_is_felt_by_that_sensor_and_one_amid_them_by_all(side):
    corners = [
        next(p.position for p in MODEL.fsr if p.name == f"{side}Foot/FSR/{corner}")
        for corner in ("FrontLeft", "FrontRight", "RearLeft", "RearRight")
    ]
    for index, (x, y, _) in enumerate(corners):
        assert foot(side, (x, y, 8.0)).forces[index] == pytest.approx(8.0, rel=0.02)
    middle = np.mean(corners, axis=0)[:2]
    assert foot(side, (*middle, 8.0)).forces == pytest.approx((2.0,) * 4, rel=0.1)


@pytest.fixture
def touch():
    return TouchSensors(MODEL, LINKS.__getitem__)


def at(x, y, z, upward=0.0):
    return Press(x, y, z, upward, 1.0)


@pytest.mark.parametrize(
    "y, felt", [(0.03, {"Left"}), (0.0025, {"Left", "Right"}), (-0.03, {"Right"}), (0.048, {"Left"})]
)
def test_a_bumper_is_the_shell_round_its_half_of_the_toes(touch, y, felt):
    """The tip, where a flat wall touches first, belongs to both."""
    assert touch.read({LINKS["LAnkleRoll"]: [at(0.1, y, -0.04)]}) == {f"LFoot/Bumper/{half}" for half in felt}
    mirrored = {f"RFoot/Bumper/{'Right' if half == 'Left' else 'Left'}" for half in felt}
    assert touch.read({LINKS["RAnkleRoll"]: [at(0.1, -y, -0.04)]}) == mirrored
    for nothing in (at(0.0876, 0.019, -0.0353, upward=1.0), at(-0.05, 0.02, -0.035)):  # the floor, the heel
        assert touch.read({LINKS["LAnkleRoll"]: [nothing]}) == frozenset()


DT, TICK = 0.01, 1.0 / 120.0


def body(pose=UPRIGHT, velocity=STILL, turning=STILL):
    return BodyReadings(pose, velocity, turning)


@pytest.fixture
def unit():
    return InertialUnit((0.1, 0.0, 0.0), 9.81)


@pytest.mark.parametrize(
    "angles, felt",
    [
        (STILL, (0.0, 0.0, 9.81)),
        ((math.pi / 2, 0.0, 0.0), (0.0, 9.81, 0.0)),
        ((0.0, math.pi / 2, 0.0), (-9.81, 0.0, 0.0)),
    ],
)
def test_leaning_turns_gravity_into_other_axes(unit, angles, felt):
    for _ in range(2):  # from the first reading on
        reading = unit.read(body(Pose(STILL, from_roll_pitch_yaw(*angles))), DT)
        assert reading.accelerometer == pytest.approx(felt, abs=1e-9)
        assert reading.angles == pytest.approx(angles, abs=1e-9) and reading.gyroscope == STILL


@pytest.mark.parametrize(
    "moved, felt",
    [
        ({"velocity": (0.0, 0.0, -9.81 * DT)}, STILL),
        ({"velocity": (0.02, 0.0, 0.0)}, (2.0, 0.0, 9.81)),
        # 10 cm in front of the centre, a turn to the left that begins moves it to the left.
        ({"turning": (0.0, 0.0, 0.5)}, (0.0, 0.1 * 0.5 / DT, 9.81)),
    ],
)
def test_it_feels_how_its_place_speeds_up(unit, moved, felt):
    unit.read(body(), DT)
    assert unit.read(body(**moved), DT).accelerometer == pytest.approx(felt, abs=1e-9)
    unit.reset()
    assert unit.read(body(), DT).accelerometer == pytest.approx((0.0, 0.0, 9.81)), "the old velocity is forgotten"
    assert unit.read(body(TURNED, turning=(1.0, 0.0, 2.0)), DT).gyroscope == pytest.approx((0.0, -1.0, 2.0))


def clicks_of(*presses):
    """[(time, clicks)] that are told, for presses (from, to) in s."""
    counter = ClickCounter()
    told = [(t, counter.feed(any(a <= t < b for a, b in presses), t)) for t in (k * TICK for k in range(720))]
    return [(time, clicks) for time, clicks in told if clicks]


def test_clicks_that_belong_together_are_counted():
    one, two, three, four = (1.0, 1.1), (1.3, 1.4), (1.6, 1.7), (1.9, 2.0)
    for presses, count in (([one], 1), ([one, two], 2)):
        ((when, clicks),) = clicks_of(*presses)
        assert clicks == count and when == pytest.approx(presses[-1][1] + LONGEST_PAUSE, abs=2 * TICK)
    (when, clicks), *more = clicks_of(one, two, three, four)
    assert (clicks, when) == (3, pytest.approx(1.7, abs=TICK)), "the third is told at once, the fourth begins anew"
    assert [clicks for _, clicks in more] == [1]
    pause = LONGEST_PAUSE + 0.05
    assert [clicks for _, clicks in clicks_of(one, (1.1 + pause, 1.2 + pause))] == [1, 1]
    # The pause counts, not the time from press to press.
    assert [clicks for _, clicks in clicks_of((1.0, 1.6), (2.0, 2.6))] == [2]
    assert clicks_of() == clicks_of((1.0, 1.1 + LONGEST_CLICK)) == clicks_of(one, (1.3, 1.4 + LONGEST_CLICK)) == []
