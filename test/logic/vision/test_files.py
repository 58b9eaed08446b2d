"""Files of pictures and videos: names, and what is never replaced."""

from __future__ import annotations

import re

import pytest

from nao_library_modules.core.errors import BadGoal
from nao_library_modules.core.files import FileTrouble
from nao_library_modules.vision.video import VisionFiles

KINDS = ("png", "jpg", "tiff")


@pytest.fixture
def files(tmp_path):
    return VisionFiles(str(tmp_path / "files"))


def refused(text, function, *arguments):
    with pytest.raises(BadGoal, match=text):
        function(*arguments)


def test_the_kind_of_a_file_is_that_of_its_name_or_of_the_field(files):
    for name, field, kind in (
        ("", "", "png"), ("a.jpg", "", "jpg"), ("a.JPEG", "", "jpg"), ("a", ".tif", "tiff"), ("a.jpg", "JPG", "jpg"),
    ):  # fmt: skip
        assert files.file_type(name, field, KINDS) == kind
    for name, field, problem in (
        ("a.gif", "", "field str_param: 'gif' is no type of file for this: one of png, jpg, tiff"),
        ("", "pgn", "field file_type: 'pgn' is no type of file for this: did you mean 'png'"),
        ("a.jpg", "png", "field file_type: 'a.jpg' is no png: jpg, as the file's name ends"),
    ):
        refused(problem, files.file_type, name, field, KINDS)


def test_names_are_inside_the_folder(files, tmp_path):
    inside = files.folder
    assert files.path("a", "png") == files.path(str(inside / "a.png"), "png") == inside / "a.png"
    assert files.path("walk/a.png", "png") == inside / "walk" / "a.png"
    for name in ("../a.png", "/etc/a.png", "~/a.png", "a\n.png", "folder/"):
        refused("str_param", files.path, name, "png")
    (inside / "walk.png").mkdir(parents=True)
    (inside / "out").symlink_to(tmp_path)
    refused("leads out of the folder for recordings", files.path, "out/a.png", "png")
    refused("is a folder", files.path, "walk.png", "png")
    refused("too long", files.path, "x" * 260, "png")
    path = files.named_by_time("top", "png")
    assert path.parent == inside and re.fullmatch(r"top_\d{4}-\d\d-\d\d_\d\d-\d\d-\d\d\.\d{3}\.png", path.name)


def test_what_is_there_stays_unless_it_may_be_replaced(files):
    path = files.path("a", "png")
    assert files.write(path, b"one") == path
    refused("a.png is there already", files.require_free, path, False)
    refused("a.png is there already: another name, or overwrite", files.write, path, b"two")
    assert path.read_bytes() == b"one"
    files.write(path, b"three", overwrite=True)
    assert path.read_bytes() == b"three"
    assert [files.write(path, b"", numbered=True).name for _ in range(2)] == ["a-2.png", "a-3.png"]
    video = files.path("a", "mp4")
    file = files.create(video)
    refused("a recording is writing", files.require_free, video, True)
    refused("is there already", files.create, video, True)
    assert files.create(video, numbered=True).path.name == "a-2.mp4"
    file.close()
    files.done(video)
    files.require_free(video, True)
    with pytest.raises(FileTrouble, match="cannot be written: .*[Ee]xists|Not a directory"):
        VisionFiles(str(path)).write(path / "a.png", b"")
