"""Files of pictures and videos: names, what is never replaced, and disks that are full."""

from __future__ import annotations

import errno
import re

import pytest

from nao_library_modules.errors import BadGoal
from nao_library_modules.vision_files import FileTrouble, VisionFiles

KINDS = ("png", "jpg", "tiff")


@pytest.fixture
def files(tmp_path):
    return VisionFiles(str(tmp_path / "files"))


@pytest.mark.parametrize(
    "name, field, kind",
    [
        ("", "", "png"), ("a.jpg", "", "jpg"), ("a.JPEG", "", "jpg"), ("a", ".tif", "tiff"), ("a.jpg", "JPG", "jpg"),
    ],
)  # fmt: skip
def test_kind_of_a_file(files, name, field, kind):
    assert files.file_type(name, field, KINDS) == kind


@pytest.mark.parametrize(
    "name, field, problem",
    [
        ("a.gif", "", "field str_param: 'gif' is no type of file for this: one of png, jpg, tiff"),
        ("", "pgn", "field file_type: 'pgn' is no type of file for this: did you mean 'png'"),
        ("a.jpg", "png", "field file_type: 'a.jpg' is no png: jpg, as the file's name ends"),
    ],
)
def test_kinds_that_cannot_be(files, name, field, problem):
    with pytest.raises(BadGoal) as caught:
        files.file_type(name, field, KINDS)
    assert problem in str(caught.value)


def test_names_are_inside_the_folder(files):
    inside = files.folder
    assert files.path("a", "png") == inside / "a.png"
    assert files.path("walk/a.png", "png") == inside / "walk" / "a.png"
    assert files.path(str(inside / "a.png"), "png") == inside / "a.png"


@pytest.mark.parametrize("name", ["../a.png", "/etc/a.png", "x/../../a.png", "~/a.png", "a\n.png", "folder/"])
def test_names_that_lead_elsewhere_are_refused(files, name):
    with pytest.raises(BadGoal, match="str_param"):
        files.path(name, "png")


def test_a_link_does_not_lead_out(files, tmp_path):
    files.folder.mkdir()
    (files.folder / "out").symlink_to(tmp_path)
    with pytest.raises(BadGoal, match="leads out of the folder for recordings"):
        files.path("out/a.png", "png")


def test_a_folder_is_no_file_and_names_have_an_end(files):
    (files.folder / "walk.png").mkdir(parents=True)
    with pytest.raises(BadGoal, match="is a folder"):
        files.path("walk.png", "png")
    with pytest.raises(BadGoal, match="too long"):
        files.path("x" * 260, "png")


def test_what_is_there_stays_unless_it_may_be_replaced(files):
    path = files.path("a", "png")
    assert files.write(path, b"one") == path
    with pytest.raises(BadGoal, match="a.png is there already"):
        files.require_free(path, False)
    with pytest.raises(BadGoal, match="a.png is there already: another name, or overwrite"):
        files.write(path, b"two")
    assert path.read_bytes() == b"one"
    files.write(path, b"three", overwrite=True)
    assert path.read_bytes() == b"three"
    assert [files.write(path, b"", numbered=True).name for _ in range(2)] == ["a-2.png", "a-3.png"]


def test_what_a_recording_writes_is_not_replaced(files):
    path = files.path("a", "mp4")
    file, _ = files.create(path)
    with pytest.raises(BadGoal, match="a recording is writing"):
        files.require_free(path, True)
    with pytest.raises(BadGoal, match="is there already"):
        files.create(path, overwrite=True)
    file.close()
    files.done(path)
    files.require_free(path, True)


def test_names_by_time(files):
    path = files.named_by_time("top", "png")
    assert path.parent == files.folder
    assert re.fullmatch(r"top_\d{4}-\d\d-\d\d_\d\d-\d\d-\d\d\.\d{3}\.png", path.name)


class FullFile:
    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def write(self, data):
        raise OSError(errno.ENOSPC, "No space left on device")


def test_a_full_disk_is_told_and_leaves_no_half_a_file(files, monkeypatch):
    path = files.path("a", "png")

    def create(path, *_):
        path.parent.mkdir()
        path.touch()
        return FullFile(), path

    monkeypatch.setattr(files, "create", create)
    with pytest.raises(FileTrouble, match=r"a\.png cannot be written: the disk is full"):
        files.write(path, b"data")
    assert not path.exists()


def test_a_folder_that_cannot_be_made_is_told(tmp_path):
    (tmp_path / "files").write_text("not a folder")
    files = VisionFiles(str(tmp_path / "files"))
    with pytest.raises(FileTrouble, match="cannot be written: .*[Ee]xists|Not a directory"):
        files.write(files.folder / "a.png", b"")
