"""Files are written as a whole, or stay as they were."""

import pytest

from nao_library_modules.whole_file import write_whole


def test_a_file_and_its_folder_are_made_and_can_be_read_by_all(tmp_path):
    file = tmp_path / "new" / "notes.yaml"
    write_whole(file, "größer: 1\n")
    assert file.read_text(encoding="utf-8") == "größer: 1\n"
    assert file.stat().st_mode & 0o777 == 0o644


def test_a_file_is_replaced(tmp_path):
    file = tmp_path / "notes.yaml"
    write_whole(file, "a much longer text than the next\n")
    write_whole(file, "short\n")
    assert file.read_text() == "short\n"
    assert list(tmp_path.iterdir()) == [file]


def test_what_cannot_be_written_leaves_the_former_file_and_no_draft(tmp_path):
    file = tmp_path / "notes.yaml"
    write_whole(file, "former\n")
    with pytest.raises(UnicodeEncodeError):
        write_whole(file, "half a character: \ud800")
    assert file.read_text() == "former\n"
    assert list(tmp_path.iterdir()) == [file]


def test_a_folder_in_the_way_is_told(tmp_path):
    with pytest.raises(OSError, match=r"notes\.yaml"):
        (tmp_path / "notes.yaml").mkdir()
        write_whole(tmp_path / "notes.yaml", "text")
    assert not list(tmp_path.glob(".*"))
