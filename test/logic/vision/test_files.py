"""Files of pictures and videos: names, what is never replaced, disks that are full; and pictures of films."""

from __future__ import annotations

import re
from fractions import Fraction

import av
import numpy as np
import pytest
from PIL import Image

from nao_library_modules.contact_sheet import BAND, MOMENTS, Part, contact_sheet, frames_at, save_small
from nao_library_modules.errors import BadGoal
from nao_library_modules.vision_files import FileTrouble, VisionFiles

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
    file, _ = files.create(video)
    refused("a recording is writing", files.require_free, video, True)
    refused("is there already", files.create, video, True)
    file.close()
    files.done(video)
    files.require_free(video, True)
    with pytest.raises(FileTrouble, match="cannot be written: .*[Ee]xists|Not a directory"):
        VisionFiles(str(path)).write(path / "a.png", b"")


# Pictures of films

RATE, SECONDS, SIDE = 10, 6, 64


@pytest.fixture
def film(tmp_path):
    """A film that gets brighter: at time t its grey is 40 t."""
    path = tmp_path / "film.mp4"
    with av.open(str(path), "w") as container:
        stream = container.add_stream("mpeg4", rate=RATE)
        stream.width = stream.height = SIDE
        stream.pix_fmt, stream.bit_rate = "yuv420p", 2_000_000
        for number in range(RATE * SECONDS):
            grey = np.full((SIDE, SIDE, 3), 40.0 * number / RATE, np.uint8)
            frame = av.VideoFrame.from_ndarray(grey, format="rgb24")
            frame.pts, frame.time_base = number, Fraction(1, RATE)
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))
    return path


def grey(picture):
    return float(np.asarray(picture).mean())


def test_a_sheet_has_a_strip_for_each_part_of_a_film(film, tmp_path):
    assert Part("a", 2.0, 5.0).moments(3) == [2.5, 3.5, 4.5]
    found = [grey(picture) for picture in frames_at(film, [3.05, 1.05, 99.0])]
    assert found == pytest.approx([120.0, 40.0, 236.0], abs=6.0), "in any order"
    sheet = contact_sheet(film, [Part("dark", 0.0, 3.0), Part("bright", 3.0, 6.0)], side=32)
    assert sheet.size == (MOMENTS * 32, 2 * (32 + BAND))
    dark = sheet.crop((0, BAND, sheet.width, BAND + 32))
    bright = sheet.crop((0, 2 * BAND + 32, sheet.width, sheet.height))
    assert grey(dark) == pytest.approx(60.0, abs=8.0) and grey(bright) == pytest.approx(180.0, abs=8.0)
    parts = [Part(str(place), place, place + 1.0) for place in range(3)]
    assert contact_sheet(film, parts, side=32, columns=2).size == (2 * MOMENTS * 32 + BAND, 2 * (32 + BAND))
    middle = contact_sheet(film, [Part("all", 0.0, 6.0)], side=32, share=0.5)
    assert middle.size == (MOMENTS * 16, 32 + BAND)
    save_small(middle, tmp_path / "sheet.png")
    assert Image.open(tmp_path / "sheet.png").mode == "P", "a small sheet has few colours"
