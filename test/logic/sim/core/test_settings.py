"""Errors say what was wrong and what is allowed; settings are read strictly."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.base import errors, settings, sizes
from nao_sim_bridge.base.errors import BadValue, ConfigError, UnknownName
from nao_sim_bridge.body.sensors import imperfection
from nao_sim_bridge.control.balance import balance, fall_manager
from nao_sim_bridge.core.scene import Scene
from nao_sim_bridge.hearing import settings as hearing
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.world.places import NEAREST, ORIGIN, RobotPlace, checked_places, on_circle, parse_places

MODEL = load_model()
BALANCE, FALLS, NOISE, PHYSICS = balance.FILE, fall_manager.FILE, imperfection.FILE, settings.FILE
HEARING, SIZES = hearing.FILE, sizes.FILE
LOADERS = {
    BALANCE: (balance, lambda: balance.load_balance(MODEL)),
    FALLS: (fall_manager, lambda: fall_manager.load_fall_settings(MODEL)),
    NOISE: (imperfection, imperfection.load_noise),
    PHYSICS: (settings, settings.load_settings),
    HEARING: (hearing, hearing.load_recognition.__wrapped__),
    SIZES: (sizes, sizes.load_sizes.__wrapped__),
}


def test_errors_keep_their_facts_and_say_them():
    family = [errors.TaskKilled, errors.SimulationStopped, ConfigError, UnknownName, BadValue]
    assert all(issubclass(kind, errors.SimulationError) for kind in family)
    assert issubclass(errors.SimulationError, RuntimeError)
    error = UnknownName("joint", "HeadYow", ["RHipRoll", "HeadPitch", "HeadYaw"])
    assert (error.kind, error.name, error.close) == ("joint", "HeadYow", ["HeadYaw", "HeadPitch"])
    assert str(error) == "unknown joint 'HeadYow': did you mean 'HeadYaw' or 'HeadPitch'?"
    assert str(UnknownName("joint", "zzz", ["HeadYaw"])) == "unknown joint 'zzz'"
    assert all(repr(name) in str(UnknownName("joint", name, ["HeadYaw"])) for name in (3, None, ["HeadYaw"]))
    assert str(BadValue("speed", -1.0, "above 0")) == "speed is -1.0, allowed is above 0"
    assert str(ConfigError("physics.json: motor", "missing 'gain'")) == "physics.json: motor: missing 'gain'"


def test_a_tick_is_a_whole_number_of_steps_and_an_encoder_has_4096_a_turn():
    physics = settings.load_settings()
    # ALMotion's own cycle is 10 to 20 ms: a command must not wait longer here.
    assert 0.002 <= physics.tick_s == physics.time_step_s * physics.steps_per_tick <= 0.02
    assert imperfection.load_noise().joints.angle_step == pytest.approx(2 * math.pi / 4096)


def test_every_size_tells_where_it_counts():
    rows = sizes.size_rows()
    assert all(where and limit > 0 for _, limit, _, where in rows)
    assert ("clients.call_s", 300.0, "s") in [row[:3] for row in rows]


@pytest.mark.parametrize(
    "file, change, message",
    [
        (PHYSICS, lambda c: c.update(gravity=9.81), "unknown key 'gravity': did you mean 'gravity_m_s2'"),
        (PHYSICS, lambda c: c["motor"].popitem(), f"{PHYSICS}: motor: missing"),
        (PHYSICS, lambda c: c["motor"].update(_meta={}), f"{PHYSICS}: motor: unknown key '_meta'"),
        (PHYSICS, lambda c: c.update(gravity_m_s2="9.81"), "gravity_m_s2: is '9.81', not a number"),
        (PHYSICS, lambda c: c["battery"].update(cell_rest_voltages=3.3), "cell_rest_voltages: is 3.3, not a list"),
        (HEARING, lambda c: c["gain"].update(_notes=""), "gain: unknown key '_notes': did you mean '_note'"),
        (SIZES, lambda c: c["call"].update(items=0), f"{SIZES}: call: items: is 0, not a number above 0"),
        (NOISE, lambda c: c["feet"].pop("force"), f"{NOISE}: feet: missing 'force'"),
        (NOISE, lambda c: c["joints"].update(angle=-1), r"joints\.angle: is -1, allowed is 0 or more"),
        (NOISE, lambda c: c["inertial"].update(angle_wander_time_s=0), "angle_wander_time_s: is 0, allowed is above 0"),
        (BALANCE, lambda c: c["pitch"].update(AnkleRoll=[1.0, 1.0]), f"{BALANCE}: pitch: unknown key 'AnkleRoll'"),
        (FALLS, lambda c: c["protect"]["front"].update(LElbow=0.0), f"{FALLS}: protect.front: no joint 'LElbow'"),
    ],
)
def test_wrong_entries_are_refused_with_their_place(change_file, file, change, message):
    module, load = LOADERS[file]
    change_file(module, change)
    with pytest.raises(ConfigError, match=message):
        load()


@pytest.mark.parametrize("name", ["friction", "payload", "sensor_noise", "sensor_delay"])
def test_amounts_below_zero_or_without_end_are_refused(name):
    for value in (-0.1, math.inf, math.nan):
        with pytest.raises(BadValue, match=f"{name} is {value}, allowed is 0 "):
            Scene(**{name: value})
    with pytest.raises(BadValue, match="sensor_delay is 1.5, allowed is 0 to 1 s"):
        Scene(sensor_delay=1.5)


def test_places_are_read_from_a_line():
    expected = RobotPlace(0.0, 0.0, 0.0), RobotPlace(1.5, -2.0, math.pi / 2), RobotPlace(3.0, 4.0, 0.0)
    assert parse_places("0,0,0; 1.5,-2,90;3,4") == expected
    for text in ("", "1", "1,2,3,4", "1,2,north", "0,0;", "1e9,0,0", "nan,0,0", "0,0,inf"):
        with pytest.raises(BadValue, match="place"):
            parse_places(text)


def test_too_few_and_too_near_places_are_refused():
    near, two = (ORIGIN, RobotPlace(0.2, 0.1)), on_circle(2)
    wrong = [(two, 3, "one for each of the 3 robots"), (near, 2, f"{NEAREST:g} m or more"), (two, 9, "1 to 8")]
    for places, count, text in wrong:
        with pytest.raises(BadValue, match=text):
            checked_places(places, count)
    assert checked_places(on_circle(3), 2) == on_circle(3)[:2]
