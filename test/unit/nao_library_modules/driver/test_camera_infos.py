"""Which calibration holds, and where it is kept: the convention of camera_info_manager."""

from __future__ import annotations

import logging
import math
from dataclasses import replace
from pathlib import Path

import pytest

from nao_library_modules.driver import camera_info_files
from nao_library_modules.driver.camera_calibration import ideal
from nao_library_modules.driver.camera_info_files import camera_name, path_of, read, write
from nao_library_modules.driver.camera_infos import CameraInfos
from naoqi.errors import NaoError

NAME = "nao_camera_top"
FOV = (math.radians(56.3), math.radians(43.7))
OTHER_FOV = (math.radians(60.9), math.radians(47.6))


@pytest.fixture
def home(tmp_path, monkeypatch):
    monkeypatch.setenv("ROS_HOME", str(tmp_path / "home"))
    return tmp_path / "home"


@pytest.fixture
def folders(tmp_path):
    return {"calibrations": str(tmp_path / "package")}


@pytest.fixture
def infos(home, folders):
    return CameraInfos(NAME, folders.__getitem__)


def calibration(width=320, height=240, fov=OTHER_FOV):
    return replace(ideal(width, height, *fov), name=NAME)


def test_without_files_it_is_computed_once_the_robot_has_told_its_field_of_view(infos):
    assert infos.of(320, 240) is None
    infos.set_fov(*FOV)
    assert infos.of(320, 240).k == ideal(320, 240, *FOV).k
    assert "computed" in infos.source(320, 240)
    infos.set_fov(*OTHER_FOV)
    assert infos.of(320, 240).k == ideal(320, 240, *OTHER_FOV).k


def test_what_was_set_holds_in_later_runs(infos, home, folders):
    infos.set_fov(*FOV)
    assert infos.set(calibration()) == home / "camera_info" / f"{NAME}.yaml"
    assert infos.of(320, 240).k == calibration().k
    later = CameraInfos(NAME, folders.__getitem__)
    assert later.of(320, 240).k == calibration().k
    assert later.of(320, 240).name == NAME


def test_one_for_another_size_is_scaled_and_that_is_told(infos, caplog):
    infos.set(calibration())
    with caplog.at_level(logging.WARNING):
        assert infos.of(640, 480).k == pytest.approx(calibration(640, 480).k)
        assert infos.of(640, 480) is infos.of(640, 480)
    assert caplog.text.count("scaled to 640x480") == 1


def test_every_size_may_have_a_calibration_of_its_own(infos, home):
    infos.set(calibration(fov=OTHER_FOV))
    assert infos.set(calibration(640, 480, fov=FOV)).name == f"{NAME}_640x480.yaml"
    assert infos.set(calibration(fov=FOV)).name == f"{NAME}.yaml"
    assert infos.set(calibration(640, 480, fov=OTHER_FOV)).name == f"{NAME}_640x480.yaml"
    assert infos.of(320, 240).k == calibration(fov=FOV).k
    assert infos.of(640, 480).k == calibration(640, 480, fov=OTHER_FOV).k
    assert sorted(path.name for path in (home / "camera_info").iterdir()) == [
        f"{NAME}.yaml",
        f"{NAME}_640x480.yaml",
    ]


def test_a_broken_file_is_told_and_computed_values_take_its_place(infos, home, caplog):
    infos.set(calibration())
    (home / "camera_info" / f"{NAME}.yaml").write_text("nothing", encoding="utf-8")
    infos.set_fov(*FOV)
    assert infos.of(320, 240).k == ideal(320, 240, *FOV).k
    assert "is no calibration" in caplog.text
    infos.set(calibration())
    assert infos.of(320, 240).k == calibration().k


def test_a_url_names_the_file_and_set_camera_info_goes_there(infos, tmp_path, folders):
    path = tmp_path / "package" / "share" / f"{NAME}.yaml"
    write(path, calibration())
    infos.set_url("package://calibrations/share/${NAME}.yaml")
    assert infos.of(320, 240).k == calibration().k
    assert infos.set(calibration(fov=FOV)) == path
    infos.set_url(f"file://{path}")
    assert infos.of(320, 240).k == calibration(fov=FOV).k


def test_a_url_without_a_file_is_refused_and_the_one_before_holds(infos, tmp_path):
    infos.set(calibration())
    with pytest.raises(NaoError, match=r"missing.yaml cannot be read"):
        infos.set_url(f"file://{tmp_path}/missing.yaml")
    assert infos.of(320, 240).k == calibration().k


@pytest.mark.parametrize("url", ["http://host/a.yaml", "/a.yaml", "file://a.yaml", "package://", "package://a"])
def test_other_urls_are_refused(url):
    with pytest.raises(NaoError, match="camera_info_url is"):
        path_of(url, NAME, lambda package: "/")


def test_places_by_the_convention(monkeypatch):
    monkeypatch.delenv("ROS_HOME", raising=False)
    assert path_of("", NAME, str) == Path.home() / ".ros" / "camera_info" / f"{NAME}.yaml"
    monkeypatch.setenv("ROS_HOME", "/var/ros")
    assert path_of("file://${ROS_HOME}/a%20b.yaml", NAME, str) == Path("/var/ros/a b.yaml")
    assert camera_name("/robot 1/nao_camera_top") == "robot_1_nao_camera_top"


def test_another_name_in_the_file_is_told(tmp_path, caplog):
    write(tmp_path / "a.yaml", replace(calibration(), name="webcam"))
    assert read(tmp_path / "a.yaml", NAME).name == "webcam"
    assert "'webcam'" in caplog.text


def test_what_cannot_be_written_leaves_the_former_file_as_it_is(tmp_path, monkeypatch):
    path = tmp_path / "a.yaml"
    write(path, calibration())

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(camera_info_files.os, "replace", full)
    with pytest.raises(NaoError, match="a.yaml cannot be written: .*No space left"):
        write(path, calibration(fov=FOV))
    assert read(path, NAME).k == calibration().k
    assert [each.name for each in tmp_path.iterdir()] == ["a.yaml"]
