"""Motions in a folder: names, files, errors."""

from __future__ import annotations

import errno
from pathlib import Path

import pytest

from nao_library_modules.errors import BadGoal
from nao_library_modules.motion_store import MotionStore
from nao_library_modules.recorded_motion import RecordedMotion

MOTION = RecordedMotion(("HeadYaw",), (0.0, 1.0), ((0.5,), (0.25,)))


@pytest.fixture
def store(tmp_path):
    return MotionStore(tmp_path / "motions")


def test_a_folder_that_is_not_there_holds_nothing(store):
    assert store.names() == []


def test_a_saved_motion_is_loaded_and_listed(store):
    store.save("wave", MOTION)
    store.save("Bow 2", MOTION)
    assert store.load("wave") == MOTION
    assert store.names() == ["Bow 2", "wave"]


def test_saving_again_replaces_and_leaves_no_draft(store):
    store.save("wave", MOTION)
    store.save("wave", MOTION.faster(2.0))
    assert store.load("wave").times == (0.0, 0.5)
    assert [path.name for path in store.folder.iterdir()] == ["wave.yaml"]


def test_renaming_and_deleting(store):
    store.save("wave", MOTION)
    store.rename("wave", "greet")
    assert store.names() == ["greet"]
    store.save("wave", MOTION)
    with pytest.raises(BadGoal, match="there is a motion 'greet' already"):
        store.rename("wave", "greet")
    store.delete("greet")
    assert store.names() == ["wave"]


@pytest.mark.parametrize("name", ["", "../wave", "a/b", ".hidden", "/tmp/wave", "a\\b", "wave\n"])
def test_no_name_leads_out_of_the_folder(store, name):
    for action in (store.load, store.delete, lambda n: store.save(n, MOTION), lambda n: store.rename(n, "x")):
        with pytest.raises(BadGoal, match="is no name for a motion"):
            action(name)


def test_a_motion_that_is_not_there_is_told_with_those_that_are(store):
    with pytest.raises(BadGoal, match="none is recorded"):
        store.load("wave")
    store.save("wave", MOTION)
    with pytest.raises(BadGoal, match="no motion 'wafe': did you mean 'wave'"):
        store.load("wafe")


@pytest.mark.parametrize("text", ["{", "5", "joints: [a]\n", "\x00"])
def test_a_file_that_is_no_motion_is_told(store, text):
    store.save("wave", MOTION)
    store.path("wave").write_text(text)
    with pytest.raises(BadGoal, match="motion 'wave'"):
        store.load("wave")


def test_a_folder_that_cannot_be_made_is_told(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(BadGoal, match="cannot be written"):
        MotionStore(tmp_path / "file" / "motions").save("wave", MOTION)


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (lambda store: store.rename("wave", "greet"), "wave.yaml cannot be renamed to greet.yaml: No space left"),
        (lambda store: store.delete("wave"), "wave.yaml cannot be deleted: No space left"),
    ],
)
def test_a_file_that_cannot_be_changed_is_told_with_path_and_reason(store, monkeypatch, call, told):
    def refuse(*_, **__):
        raise OSError(errno.ENOSPC, "No space left")

    store.save("wave", MOTION)
    monkeypatch.setattr(Path, "rename", refuse)
    monkeypatch.setattr(Path, "unlink", refuse)
    with pytest.raises(BadGoal) as caught:
        call(store)
    assert f"{store.folder}/{told}" in str(caught.value)
