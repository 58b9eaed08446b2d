"""Names of what can be touched."""

from __future__ import annotations

import pytest

from nao_library_modules.errors import BadGoal
from nao_library_modules.tactile_names import GROUPS, SENSORS, names_of, sensors_of


@pytest.mark.parametrize(
    "words, names",
    [
        (["front head"], ["front head"]),
        (["FrontTactilTouched"], ["front head"]),
        (["Head/Touch/Front"], ["front head"]),
        (["front_head", " Front  Head "], ["front head"]),
        (["head"], ["front head", "middle head", "rear head"]),
        (["bumpers"], ["left bumper", "right bumper"]),
        (["chest", "left hand"], ["left hand back", "left hand left", "left hand right", "chest"]),
        (["LFoot/Bumper/Right"], ["left bumper"]),
    ],
)
def test_sensors_are_known_by_short_names_events_devices_and_groups(words, names):
    assert names_of(sensors_of(words)) == names


def test_no_name_and_any_stand_for_all():
    assert sensors_of([]) == SENSORS == sensors_of(["any"])
    assert len(SENSORS) == 12


def test_every_group_has_members_and_no_sensor_has_the_name_of_a_group():
    for group in GROUPS:
        assert sensors_of([group])
    assert not set(GROUPS) & set(names_of(SENSORS))


def test_an_unknown_name_is_told_with_those_that_come_close():
    with pytest.raises(BadGoal, match="'frot head' is nothing that can be touched: did you mean 'front head'"):
        sensors_of(["head", "frot head"])
