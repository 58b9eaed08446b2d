"""What a node keeps for the one that takes its place when it dies."""

from __future__ import annotations

from nao_library_modules.base.kept import Kept


def test_what_is_kept_is_there_again_in_the_same_run_only(tmp_path):
    path = tmp_path / "folder" / "node.json"
    assert Kept(path, "run 1").load() is None
    Kept(path, "run 1").save(["a", {"b": 2.0}])
    assert Kept(path, "run 1").load() == ["a", {"b": 2.0}]
    assert Kept(path, "run 2").load() is None


def test_an_end_in_order_forgets(tmp_path):
    Kept(tmp_path / "node.json", "run").forget()
    kept = Kept(tmp_path / "node.json", "run")
    kept.save([1])
    kept.forget()
    kept.save([2])  # by a later step of the end
    assert kept.load() is None


def test_a_file_of_others_is_as_none_and_told_of(tmp_path, caplog):
    path = tmp_path / "node.json"
    path.write_text("[1, 2")
    assert Kept(path, "run").load() is None
    assert str(path) in caplog.text


def test_what_cannot_be_written_is_told_and_no_error(tmp_path, caplog):
    (tmp_path / "file").write_text("")
    Kept(tmp_path / "file" / "node.json", "run").save([1])
    assert "cannot be written" in caplog.text
