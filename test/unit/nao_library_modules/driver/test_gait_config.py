"""Gait parameters as people write them."""

from __future__ import annotations

import pytest

from nao_library_modules.driver.gait_config import read_gait_config, read_share
from naoqi.errors import NaoError

NAME = "~foot_gait_config"


@pytest.mark.parametrize(
    "value", [[["MaxStepX", 0.03], ["StepHeight", 1]], {"MaxStepX": 0.03, "StepHeight": 1}, (("MaxStepX", 0.03),)]
)
def test_pairs_and_dictionaries(value):
    config = read_gait_config(NAME, value)
    assert config[0] == ["MaxStepX", 0.03]
    assert config[1:] in ([["StepHeight", 1.0]], [])


def test_nothing_is_the_gait_of_the_robot():
    assert read_gait_config(NAME, []) == []


@pytest.mark.parametrize(
    "value, words",
    [
        ("MaxStepX", "is 'MaxStepX'"),
        (0.03, "is 0.03"),
        (["MaxStepX", 0.03], "entry 'MaxStepX'"),
        ([["MaxStepX"]], "entry"),
        ([[1, 0.03]], "entry"),
        ([["MaxStepX", "far"]], "MaxStepX is 'far': a number"),
        ([["MaxStepX", True]], "MaxStepX is True"),
        ([["MaxStepX", float("nan")]], "MaxStepX is nan"),
    ],
)
def test_everything_else_is_told(value, words):
    with pytest.raises(NaoError, match=words) as caught:
        read_gait_config(NAME, value)
    assert NAME in str(caught.value)


@pytest.mark.parametrize("value", [0, 0.5, 1.0])
def test_a_share_is_a_number_from_0_to_1(value):
    assert read_share("~step_frequency", value) == value


@pytest.mark.parametrize("value", [-0.1, 1.1, float("nan"), True, "fast"])
def test_a_share_is_nothing_else(value):
    with pytest.raises(NaoError, match="~step_frequency is .*: 0 to 1"):
        read_share("~step_frequency", value)
