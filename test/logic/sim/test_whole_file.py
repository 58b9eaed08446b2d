"""Files that others see only as far as they are whole: drafts, parts, full disks."""

from __future__ import annotations

import os
import re

import pytest
from disks import files, room

from nao_sim_bridge.base.memory_file import memory_file
from nao_sim_bridge.base.whole_file import FileTrouble, WholeFile, tidy, write_whole

FULL = r"{} cannot be written: File too large, \d+\.\d MB free in {}"


def full(path):
    return pytest.raises(FileTrouble, match=FULL.format(re.escape(str(path)), re.escape(str(path.parent))))


def test_a_file_is_whole_or_the_former_one(tmp_path):
    path = tmp_path / "new" / "a.txt"
    write_whole(path, b"old")
    with room(10), full(path):
        write_whole(path, b"new" * 10)
    with pytest.raises(KeyError), WholeFile(path) as file:
        file.write(b"half")
        raise KeyError
    assert files(path.parent) == {"a.txt": b"old"}
    write_whole(path, b"new")
    assert files(path.parent) == {"a.txt": b"new"}


@pytest.mark.parametrize("mask", [0o022, 0o077])
def test_who_may_read_a_file_is_up_to_the_umask(tmp_path, mask):
    former = os.umask(mask)
    try:
        write_whole(tmp_path / "a.txt", b"")
    finally:
        os.umask(former)
    assert (tmp_path / "a.txt").stat().st_mode & 0o777 == 0o666 & ~mask


def test_what_grows_is_seen_with_each_flush_and_not_before(tmp_path):
    file = WholeFile(tmp_path / "a.wav")
    file.write(b"one")
    assert "a.wav" not in files(tmp_path)
    file.flush()
    file.write(b"two")
    assert files(tmp_path) == {"a.wav": b"one"} and file.seek(0, os.SEEK_END) == 6
    file.seek(0)
    file.write(b"O")
    file.close()
    assert files(tmp_path) == {"a.wav": b"Onetwo"}


def test_a_former_file_stays_until_the_new_one_is_closed(tmp_path):
    path = tmp_path / "a.wav"
    path.write_bytes(b"old")
    file, other = WholeFile(path), WholeFile(path)
    for one in (file, other):
        one.write(b"new")
        one.flush()
    assert files(tmp_path) == {"a.wav": b"old", "a.part1.wav": b"new", "a.part2.wav": b"new"}
    other.discard()
    assert file.path == tmp_path / "a.part1.wav"
    file.close()
    assert files(tmp_path) == {"a.wav": b"new"} and file.path == path


def test_a_full_disk_leaves_what_was_whole_and_room_lets_it_go_on(tmp_path):
    file = WholeFile(tmp_path / "a.raw")
    file.write(b"12345")
    file.flush()
    with room(8):
        file.write(b"67890")
        with full(file.path):
            file.flush()
        assert files(tmp_path) == {"a.raw": b"12345"}
    file.write(b"after a hole")
    with full(file.path):
        file.flush()
    file.recover()
    file.write(b"6")
    file.close()
    assert files(tmp_path) == {"a.raw": b"123456"}


def test_a_former_file_is_not_replaced_by_one_that_could_not_be_written(tmp_path):
    path = tmp_path / "a.raw"
    path.write_bytes(b"old")
    file = WholeFile(path)
    file.write(b"new")
    file.flush()
    with room(4):
        file.write(b"er")
        with full(tmp_path / "a.part1.raw"):
            file.close()
    assert files(tmp_path) == {"a.raw": b"old", "a.part1.raw": b"new"}


def test_what_killed_processes_left_is_removed_or_named_and_what_others_write_stays(tmp_path, caplog):
    path = tmp_path / "day" / "a.wav"
    write_whole(path, b"old")
    mine, running = WholeFile(path), WholeFile(path)
    running.write(b"new")
    running.flush()
    (path.parent / f".nao_library-{'5a' * 16}.draft").write_bytes(b"ha")
    (path.parent / "b.part1.wav").write_bytes(b"lost")
    tidy(tmp_path)
    assert f"{path.parent / 'b.part1.wav'} is a recording that was not ended" in caplog.text
    assert "a.part1" not in caplog.text
    mine.close()
    running.close()
    assert files(path.parent) == {"a.wav": b"new", "b.part1.wav": b"lost"}


def test_a_file_for_libraries_is_in_memory():
    with memory_file(b"text") as path:
        assert open(path, "rb").read() == b"text"  # noqa: SIM115
    assert not os.path.exists(path)
