"""Which files are removed when a folder is tidied: drafts of ours alone, in both packages alike."""

from __future__ import annotations

import os

import pytest

from nao_library_modules.core import files as of_the_library
from nao_sim_bridge.base import whole_file as of_the_simulator

TOKEN = "5a" * 16
FORMS = pytest.mark.parametrize("module", [of_the_library, of_the_simulator], ids=["library", "simulator"])


@FORMS
def test_tidy_removes_no_file_of_others(module, tmp_path):
    names = [
        "thesis.draft",
        ".killed.draft",
        f".{TOKEN}.draft",
        ".nao_library-chapter.draft",
        f"nao_library-{TOKEN}.draft",
    ]
    (tmp_path / "day").mkdir()
    others = [folder / name for folder in (tmp_path, tmp_path / "day") for name in names]
    for path in others:
        path.write_text("mine")
    (tmp_path / "letter").write_text("mine")
    linked, folder = tmp_path / f".nao_library-{'6b' * 16}.draft", tmp_path / f".nao_library-{'7c' * 16}.draft"
    linked.symlink_to(tmp_path / "letter")
    folder.mkdir()
    left = tmp_path / "day" / f".nao_library-{TOKEN}.draft"
    left.write_text("half")
    module.tidy(tmp_path)
    assert not left.exists()
    assert all(path.read_text() == "mine" for path in (*others, linked)) and folder.is_dir()


@FORMS
def test_what_is_being_written_has_the_name_of_a_draft_and_stays(module, tmp_path):
    with module.WholeFile(tmp_path / "a.txt") as file:
        file.write(b"new")
        (draft,) = tmp_path.iterdir()
        assert module.is_draft(draft.name)
        of_the_library.tidy(tmp_path)
        of_the_simulator.tidy(tmp_path)
    assert (tmp_path / "a.txt").read_bytes() == b"new"


@FORMS
def test_a_draft_that_was_removed_before_it_was_locked_is_begun_again(module, tmp_path, monkeypatch):
    lock, taken = module.fcntl.flock, []

    def tidied_before(file, how):
        if not taken:
            taken.extend(tmp_path.iterdir())
            os.unlink(taken[0])
        lock(file, how)

    monkeypatch.setattr(module.fcntl, "flock", tidied_before)
    module.write_whole(tmp_path / "a.txt", b"whole")
    assert taken and [path.name for path in tmp_path.iterdir()] == ["a.txt"]
