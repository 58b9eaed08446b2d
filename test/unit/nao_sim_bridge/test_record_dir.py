"""Files of clients stay inside the folder for recordings."""

from __future__ import annotations

import os

import pytest

from nao_sim_bridge.record_dir import ClientFiles, NoSuchFile, OutsideRecordDir, UnusableName, inside, unused


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


# --- names as clients give them ---------------------------------------------------------------------------------------


@pytest.fixture
def files(tmp_path):
    """Recordings with one file, and a folder that is shipped with another."""
    for name in ("records/day/one.wav", "shipped/chime.wav", "records/both.wav", "shipped/both.wav"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(name)
    return ClientFiles(tmp_path / "records", [tmp_path / "shipped"])


@pytest.mark.parametrize(
    "name, found",
    [
        ("day/one.wav", "records/day/one.wav"),
        ("chime.wav", "shipped/chime.wav"),
        ("both.wav", "records/both.wav"),
        ("/home/nao/day/one.wav", "records/day/one.wav"),
        ("/home//nao/day/../both.wav", "records/both.wav"),
    ],
)
def test_files_are_read_from_the_recordings_or_from_what_is_shipped(files, name, found):
    assert files.to_read(name).read_text() == found


@pytest.mark.parametrize("name", ["", "../x.wav", "/etc/passwd", "/home/nao/../x", "/home/naomi/x", "a\0b"])
def test_nothing_is_read_or_written_outside(files, name):
    for way in (files.to_read, files.to_write):
        with pytest.raises(OutsideRecordDir, match="is not inside .*records; give a relative name"):
            way(name)


def test_a_file_that_is_not_there_is_named(files):
    with pytest.raises(NoSuchFile, match="no file 'two.wav' in .*records"):
        files.to_read("two.wav")
    with pytest.raises(NoSuchFile, match="'day' is a folder, not a file"):
        files.to_read("day")


@pytest.mark.parametrize("name", ["n" * 300 + ".wav", "day/" + "é" * 200 + "/a.wav", "abc/" * 2000 + "a.wav"])
def test_a_name_that_no_file_can_have_is_refused_shortly(files, name):
    for way in (files.to_read, files.to_write):
        with pytest.raises(UnusableName, match="too long a name") as refused:
            way(name)
        assert len(str(refused.value)) < 200


def test_only_files_are_written_to(files, tmp_path):
    with pytest.raises(UnusableName, match="'day' cannot be written: Is a directory"):
        files.to_write("day")
    with pytest.raises(UnusableName, match="folder of 'both.wav/a.wav' cannot be made"):
        files.to_write("both.wav/a.wav")
    os.mkfifo(tmp_path / "records/pipe.wav")  # opened for writing it would block
    with pytest.raises(UnusableName, match="'pipe.wav' cannot be written: it is no file"):
        files.to_write("pipe.wav")


def test_files_are_written_to_the_recordings_only(files, tmp_path):
    assert files.to_write("chime.wav") == tmp_path / "records/chime.wav"
    assert files.to_write("/home/nao/new/a.wav") == tmp_path / "records/new/a.wav"
    assert (tmp_path / "records/new").is_dir()


def test_reading_makes_no_folders(files, tmp_path):
    with pytest.raises(NoSuchFile):
        files.to_read("new/a.wav")
    assert not (tmp_path / "records/new").exists()


def test_the_home_of_the_user_may_be_named(monkeypatch, tmp_path):
    monkeypatch.setenv("HOME", str(tmp_path))
    assert ClientFiles("~/records").folder == tmp_path / "records"


def test_a_file_that_is_there_keeps_its_name(tmp_path):
    assert unused(tmp_path / "a.wav") == tmp_path / "a.wav"
    (tmp_path / "a.wav").touch()
    assert unused(tmp_path / "a.wav") == tmp_path / "a-2.wav"
    (tmp_path / "a-2.wav").touch()
    assert unused(tmp_path / "a.wav") == tmp_path / "a-3.wav"
