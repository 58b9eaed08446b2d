"""Archives and files that others bring: what is unpacked is counted, whatever they claim."""

from __future__ import annotations

import json
import struct
import zipfile

import numpy as np
import pytest

from nao_sim_bridge.base.archives import Archive, BadArchive
from nao_sim_bridge.base.config import TooLarge, read_bounded, read_json
from nao_sim_bridge.base.errors import ConfigError
from nao_sim_bridge.base.sizes import ArchiveSizes, load_sizes, size_rows
from nao_sim_bridge.behaviors.packages import read_package
from nao_sim_bridge.vision.face_memory import FaceFileError, FaceMemory

SMALL = ArchiveSizes(file_bytes=10_000, member_bytes=1000, total_bytes=1500, members=3)


@pytest.fixture
def packed(tmp_path):
    def make(members, method=zipfile.ZIP_DEFLATED, name="a.zip"):
        with zipfile.ZipFile(tmp_path / name, "w", method) as archive:
            for member, content in members.items():
                archive.writestr(member, content)
        return tmp_path / name

    return make


def test_members_are_read_stored_and_deflated(packed):
    for method in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        with Archive(packed({"a/b": b"x" * 900}, method), SMALL) as archive:
            assert archive.names == ["a/b"] and archive.read("a/b") == b"x" * 900


def changed(path, offset_in_entry, form, value):
    """Change a field of the first entry in the list of members, and of the member itself, to claim another size."""
    content = bytearray(path.read_bytes())
    for mark, place in ((b"PK\x01\x02", offset_in_entry), (b"PK\x03\x04", offset_in_entry - 2)):
        struct.pack_into(form, content, content.index(mark) + place, value)
    path.write_bytes(bytes(content))
    return path


def test_what_is_claimed_and_what_is_unpacked_are_both_bounded(packed):
    bomb = {"a": b"\0" * 1_000_000}
    with pytest.raises(BadArchive, match="unpacks to 1000000 bytes: at most 1000 bytes a member and 1500 of all"):
        Archive(packed(bomb), SMALL)
    lying = changed(packed(bomb), 24, "<I", 900)
    with Archive(lying, SMALL) as archive, pytest.raises(BadArchive):
        archive.read("a")
    twice = packed({"a": b"x" * 800})
    with Archive(twice, SMALL) as archive:
        assert len(archive.read("a")) == 800
        with pytest.raises(BadArchive, match="'a' is too large: at most"):
            archive.read("a")


@pytest.mark.parametrize("method", [zipfile.ZIP_LZMA, zipfile.ZIP_BZIP2])
def test_other_ways_of_packing_are_refused(packed, method):
    with pytest.raises(BadArchive, match="'a' is packed in a way that is not read: stored and deflated are"):
        Archive(packed({"a": b"x"}, method), SMALL)


@pytest.mark.parametrize("name", ["/etc/passwd", "../a", "a/../../b", "a\\..\\b"])
def test_names_stay_inside(packed, name):
    with pytest.raises(BadArchive, match="is outside of it"):
        Archive(packed({name: b"x"}), SMALL)


def test_members_are_counted_and_large_files_are_not_opened(packed):
    with pytest.raises(BadArchive, match="has 4 members, at most 3 are allowed"):
        Archive(packed({str(i): b"" for i in range(4)}), SMALL)
    path = packed({})
    path.write_bytes(bytes(10_001))
    with pytest.raises(BadArchive, match="has more than 10000 bytes"):
        Archive(path, SMALL)


@pytest.mark.parametrize("method", [8, 12, 14])
def test_a_broken_or_lying_package_is_a_clear_error(packed, method):
    path = packed({"manifest.xml": bytes(range(256))}, name="a.pkg")
    content = bytearray(path.read_bytes())
    content[42:52] = b"\xff" * 10  # behind the head of the member and its name
    path.write_bytes(content)
    changed(path, 10, "<H", method)
    with pytest.raises(ConfigError, match="a.pkg: is no package: 'manifest.xml' is (broken|packed)"):
        read_package(path)


def test_arrays_of_faces_are_no_larger_than_their_bytes(packed):
    def npy(claimed):
        header = f"{{'descr': '<f4', 'fortran_order': False, 'shape': {claimed}, }}".encode().ljust(117) + b"\n"
        return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + bytes(16)

    for claimed in ((10**6, 10**6), (1, 5)):
        path = packed({"names.npy": npy(claimed)}, name="faces.npz")
        with pytest.raises(FaceFileError, match="is no file of known faces: cannot reshape"):
            FaceMemory.load(path)
    np.savez_compressed(path, names=np.zeros(30_000_000, np.uint8))
    with pytest.raises(FaceFileError, match="unpacks to 3000.* bytes: at most 20000000"):
        FaceMemory.load(path)
    np.savez(path, names=np.array([object()], dtype=object))
    with pytest.raises(FaceFileError, match="in this order is not read"):
        FaceMemory.load(path)


def test_files_are_read_up_to_a_size_and_nested_ones_are_clear_errors(tmp_path):
    path = tmp_path / "a.json"
    path.write_bytes(b"x" * 11)
    assert len(read_bounded(path, 11)) == 11
    with pytest.raises(TooLarge, match="has more than 10 bytes"):
        read_bounded(path, 10)
    path.write_text("[" * 100_000)
    with pytest.raises(ConfigError, match="a.json: cannot be read"):
        read_json(path)
    path.write_text(json.dumps({"a": 1}))
    assert read_json(path) == {"a": 1}


def test_every_limit_is_a_row_with_its_unit_and_place():
    rows = {what: (limit, unit, where) for what, limit, unit, where in size_rows()}
    assert rows["archive.members"][:2] == (load_sizes().archive.members, "")
    assert rows["stream.total_s"] == (60.0, "s", "ALAudioPlayer.playWebStream")
    assert rows["sound.highest_rate_hz"][1] == "Hz" and all(where for _, _, where in rows.values())
