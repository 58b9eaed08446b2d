"""Gait parameters, as ROS parameters give them and as ALMotion takes them. No ROS."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, List, Union

from naoqi.errors import NaoError

from ...base.field_checks import number_parameter
from ...base.limits import limit

GaitConfig = List[List[Union[str, float]]]
"""What ALMotion takes: [["MaxStepX", 0.04], ...]."""
FORM = "a list like [[MaxStepX, 0.03], [StepHeight, 0.02]], or a dictionary"


def read_gait_config(name: str, value: Any) -> GaitConfig:
    """Gait parameters from pairs of name and value, or a dictionary. Names and ranges are the robot's to judge.

    Raises:
        NaoError: If it is something else; `name` is the parameter's, for its text.
    """
    pairs = list(value.items()) if isinstance(value, Mapping) else value
    if not isinstance(pairs, (list, tuple)):
        raise NaoError(f"{name} is {value!r}: {FORM}")
    config: GaitConfig = []
    for pair in pairs:
        if not isinstance(pair, (list, tuple)) or len(pair) != 2 or not isinstance(pair[0], str):
            raise NaoError(f"{name} has the entry {pair!r}: {FORM}")
        key, number = pair
        config.append([key, number_parameter(f"{name}: {key}", number, limit("setting"))])
    return config
