"""Constants of `motion` and `vision_definitions`: published values, and one value for what is said twice."""

import json
import math
from pathlib import Path

import pytest

import almath
import motion
import vision_definitions

REPOSITORY = Path(__file__).parents[3]
CAMERAS = json.loads((REPOSITORY / "nao_sim_bridge" / "config" / "nao_h25.json").read_text())["cameras"]


def constants_of(module):
    return {name: value for name, value in vars(module).items() if isinstance(value, (int, float)) and name[0] != "_"}


def test_frames_have_the_numbers_of_almotion_under_old_and_new_names():
    assert (motion.FRAME_TORSO, motion.FRAME_WORLD, motion.FRAME_ROBOT) == (0, 1, 2)
    assert (motion.SPACE_TORSO, motion.SPACE_WORLD, motion.SPACE_NAO) == (0, 1, 2)


def test_axis_masks_are_those_of_almath():
    masks = {name: value for name, value in constants_of(motion).items() if name.startswith("AXIS_MASK_")}
    assert len(masks) == 12
    for name, value in masks.items():
        assert value == getattr(almath, name)


def test_axis_masks_add_up():
    single = [motion.AXIS_MASK_X, motion.AXIS_MASK_Y, motion.AXIS_MASK_Z]
    turning = [motion.AXIS_MASK_WX, motion.AXIS_MASK_WY, motion.AXIS_MASK_WZ]
    assert single + turning == [1, 2, 4, 8, 16, 32]
    assert (sum(single), sum(turning), sum(single + turning)) == (
        motion.AXIS_MASK_VEL,
        motion.AXIS_MASK_ROT,
        motion.AXIS_MASK_ALL,
    )


def test_degrees_and_radians():
    assert 180.0 * motion.TO_RAD == pytest.approx(math.pi)
    assert motion.TO_RAD * motion.TO_DEG == pytest.approx(1.0)


@pytest.mark.parametrize("name, value", CAMERAS["color_spaces"].items())
def test_colour_spaces_agree_with_the_robot_data(name, value):
    assert getattr(vision_definitions, name) == value


@pytest.mark.parametrize("name, entry", CAMERAS["resolutions"].items())
def test_resolutions_agree_with_the_robot_data(name, entry):
    assert getattr(vision_definitions, name) == entry[0]


@pytest.mark.parametrize("entry", CAMERAS["parameters_V6"], ids=lambda entry: entry[0])
def test_camera_parameters_agree_with_the_robot_data(entry):
    assert getattr(vision_definitions, entry[0]) == entry[1]


def test_cameras_agree_with_the_robot_data():
    indices = {frame["name"]: frame["index"] for frame in CAMERAS["frames"]}
    assert indices == {
        "CameraTop": vision_definitions.kTopCamera,
        "CameraBottom": vision_definitions.kBottomCamera,
    }
    assert vision_definitions.kOV5640 == CAMERAS["V6"]["camera_model_id"]
    assert vision_definitions.kMT9M114 == CAMERAS["V5_V4"]["camera_model_id"]
    assert vision_definitions.kOV7670 == CAMERAS["V3"]["camera_model_id"]


def test_parameters_are_numbered_without_gap_up_to_the_focus():
    numbers = {value for name, value in constants_of(vision_definitions).items() if name.startswith("kCamera")}
    assert numbers == set(range(41)) | {43}


def test_both_spellings_of_a_colour_space_mean_the_same():
    for old, new in (("kHsv", "kHsy"), ("khSv", "khSy"), ("khsV", "khsY"), ("kHSV", "kHSY")):
        first, second = (getattr(vision_definitions, f"{stem}ColorSpace") for stem in (old, new))
        assert first == second
    assert vision_definitions.kYUV422InterlacedColorSpace == vision_definitions.kYUV422ColorSpace == 9
    assert vision_definitions.k960p == vision_definitions.k4VGA
