"""Files of clients stay inside the folder for recordings."""

from __future__ import annotations

import pytest

from nao_sim_bridge.record_dir import OutsideRecordDir, inside


@pytest.mark.parametrize("name", ["a.wav", "day/one/a.wav", "day/../a.wav", "..a.wav"])
def test_a_relative_name_is_inside_and_its_folder_is_made(tmp_path, name):
    path = inside(tmp_path, name)
    assert path == (tmp_path / name).resolve()
    assert path.parent.is_dir()


@pytest.mark.parametrize("name", ["", ".", "..", "../a.wav", "day/../../a.wav", "/etc/passwd", "day/.."])
def test_everything_else_is_refused(tmp_path, name):
    with pytest.raises(OutsideRecordDir, match="is not inside .*; give a relative name"):
        inside(tmp_path / "records", name)
    assert not (tmp_path / "a.wav").exists()


def test_an_absolute_name_is_refused_even_inside(tmp_path):
    with pytest.raises(OutsideRecordDir):
        inside(tmp_path, str(tmp_path / "a.wav"))


def test_a_link_does_not_lead_out(tmp_path):
    records = tmp_path / "records"
    records.mkdir()
    (records / "out").symlink_to(tmp_path)
    with pytest.raises(OutsideRecordDir):
        inside(records, "out/a.wav")


def test_a_folder_that_is_a_link_itself_is_fine(tmp_path):
    (tmp_path / "real").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "real")
    assert inside(tmp_path / "link", "a.wav") == tmp_path / "real" / "a.wav"
