"""Keys of the body's devices are those of NAOqi, and echoes are read as they are meant."""

import json
import math
from pathlib import Path

import pytest

from nao_library_modules import body_devices as devices
from nao_library_modules.tactile_names import SENSORS

TABLES = json.loads(
    (Path(__file__).resolve().parents[3] / "nao_sim_bridge" / "config" / "naoqi_memory_keys.json").read_text()
)


@pytest.fixture(scope="module")
def known():
    """All keys of devices that NAOqi has, as texts: of joints each is a pattern."""
    return json.dumps(TABLES)


@pytest.mark.parametrize(
    "key",
    [
        devices.CHARGE,
        devices.CURRENT,
        devices.BATTERY_STATUS,
        *devices.SONARS.values(),
        *devices.weight_keys("left"),
        *devices.weight_keys("right"),
        *(key for sensor in SENSORS for key in sensor.keys),
    ],
)
def test_naoqi_has_the_key(key, known):
    assert key.startswith(TABLES["_meta"]["prefix"])
    assert f'"{key[len(devices.PREFIX) :]}"' in known


@pytest.mark.parametrize(
    "value, distance",
    [(0.8, 0.8), (0.1, 0.1), (2.54, 2.54), (2.55, math.inf), (5.0, math.inf)],
)
def test_what_does_not_echo_is_infinitely_far(value, distance):
    assert devices.echo_of(value) == distance


@pytest.mark.parametrize("value", [0.0, -1.0, math.nan, None, "far", True])
def test_a_sonar_that_failed_tells_no_distance(value):
    assert math.isnan(devices.echo_of(value))
