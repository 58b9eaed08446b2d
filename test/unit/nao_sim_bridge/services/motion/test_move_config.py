"""Gait configurations as moves take them, and the lists of what may be in them."""

from __future__ import annotations

import struct

import pytest

from nao_sim_bridge.services.motion.move_config import gait_list, gait_of, gait_of_feet
from nao_sim_bridge.sim.errors import BadValue, UnknownName
from nao_sim_bridge.sim.walk.gait import FeetGait

NAMES = ["MaxStepX", "MaxStepY", "MaxStepTheta", "MaxStepFrequency", "StepHeight", "TorsoWx", "TorsoWy"]


def as_single(value):
    return struct.unpack("f", struct.pack("f", value))[0]


@pytest.mark.parametrize(
    "which, values",
    [
        ("Default", [0.04, 0.14, 0.349, 1.0, 0.02, 0.0, 0.0]),
        ("Min", [0.001, 0.101, 0.001, 0.0, 0.005, -0.122, -0.122]),
        ("Max", [0.08, 0.16, 0.524, 1.0, 0.035, 0.122, 0.122]),
    ],
)
def test_the_lists_name_all_that_can_be_set_in_naoqis_order(which, values):
    assert gait_list(which) == [[name, value] for name, value in zip(NAMES, values)]


def test_there_are_three_lists():
    with pytest.raises(BadValue, match="config is 'default', allowed is Default, Min, Max"):
        gait_list("default")


@pytest.mark.parametrize("which", ["Default", "Min", "Max"])
def test_what_a_list_says_can_be_asked_for_also_in_single_precision(which):
    exact = gait_of(gait_list(which))
    assert gait_of([[name, as_single(value)] for name, value in gait_list(which)]) == exact


def test_no_configuration_is_the_default_gait():
    assert gait_of() == gait_of([]) == gait_of(gait_list("Default")) == FeetGait()


def test_names_without_a_side_are_for_both_feet():
    gait = gait_of([["MaxStepX", 0.06], ["RightStepHeight", 0.03], ("LeftMaxStepFrequency", 0), ["Frequency", 0.5]])
    assert gait.left.max_step_x == gait.right.max_step_x == 0.06
    assert (gait.left.step_height, gait.right.step_height) == (0.02, 0.03)
    assert (gait.left.max_step_frequency, gait.right.max_step_frequency) == (0.0, 1.0)
    assert gait.frequency == 0.5


def test_a_frequency_may_be_an_argument_of_its_own():
    assert gait_of([["MaxStepX", 0.06]], frequency=0.25).frequency == 0.25


def test_each_foot_may_have_a_configuration_of_its_own():
    gait = gait_of_feet([["MaxStepX", 0.06]], [["StepHeight", 0.03]], 0.5)
    assert (gait.left.max_step_x, gait.right.max_step_x) == (0.06, 0.04)
    assert (gait.left.step_height, gait.right.step_height) == (0.02, 0.03)
    assert gait.frequency == 0.5


def test_the_configuration_of_a_foot_names_no_foot():
    with pytest.raises(UnknownName, match="unknown gait parameter of a foot 'LeftMaxStepX': did you mean 'MaxStepX'"):
        gait_of_feet([["LeftMaxStepX", 0.06]], [], 1.0)


@pytest.mark.parametrize("config", [None, "MaxStepX", ["MaxStepX", 0.04], [["MaxStepX"]], [[0.04, "MaxStepX"]], 0.5])
def test_other_shapes_are_refused(config):
    with pytest.raises(BadValue, match=r"moveConfig is .*, allowed is pairs such as \[\[\"MaxStepX\", 0.03\]"):
        gait_of(config)


@pytest.mark.parametrize(
    "pair, message",
    [
        (["MaxStepX", 0.081], "MaxStepX is 0.081, allowed is 0.001 to 0.08"),
        (["LeftStepHeight", 0.04], "LeftStepHeight is 0.04, allowed is 0.005 to 0.035"),
        (["TorsoWx", -0.2], "TorsoWx is -0.2, allowed is -0.122 to 0.122"),
        (["MaxStepY", "wide"], "MaxStepY is 'wide', allowed is 0.101 to 0.16"),
        (["StepHeight", True], "StepHeight is True"),
        (["MaxStepX", float("nan")], "MaxStepX is nan"),
        (["FootSeparation", 0.1], "FootSeparation is 0.1, allowed is nothing: it is fixed at 0.1"),
        (["StepHigh", 0.02], "unknown gait parameter 'StepHigh': did you mean 'StepHeight'"),
    ],
)
def test_what_a_gait_cannot_be_is_refused(pair, message):
    with pytest.raises((BadValue, UnknownName), match=message):
        gait_of([pair])
