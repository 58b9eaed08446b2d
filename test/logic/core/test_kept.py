"""What a node keeps for the one that takes its place when it dies."""

from __future__ import annotations

import pytest

from nao_library_modules.core.files import Kept
from nao_library_modules.driver.walk.nao_walker import WalkInhibition


def test_what_is_kept_is_there_again_in_the_same_run_only(tmp_path):
    path = tmp_path / "folder" / "node.json"
    assert Kept(path, "run 1").load(list) is None
    Kept(path, "run 1").save(["a", {"b": 2.0}])
    assert Kept(path, "run 1").load(list) == ["a", {"b": 2.0}]
    assert Kept(path, "run 2").load(list) is None


def test_an_end_in_order_forgets(tmp_path):
    Kept(tmp_path / "node.json", "run").forget()
    kept = Kept(tmp_path / "node.json", "run")
    kept.save([1])
    kept.forget()
    kept.save([2])  # by a later step of the end
    assert kept.load(list) is None


@pytest.mark.parametrize(
    "content",
    [
        b"[1, 2", b"[1, 2]", b"\xff\xfe", b'{"run": "run", "kept": [1e999]}', b'{"run": "run", "kept": [NaN]}',
        b'{"run": "run", "kept": ["\\ud800"]}', b'{"run": "run", "kept": 5}', b"[" * 200_000, None,
    ],
)  # fmt: skip
def test_a_file_that_cannot_be_used_is_put_aside_and_told(content, tmp_path, caplog):
    path = tmp_path / "node.json"
    path.mkdir() if content is None else path.write_bytes(content)
    kept = Kept(path, "run")
    assert kept.load(list) is None
    assert f"{path} cannot be used: " in caplog.text and f"kept as {tmp_path / 'node.json.broken'}" in caplog.text
    kept.save([1])
    assert kept.load(list) == [1]


def test_a_node_begins_without_what_is_no_value_of_its_own(tmp_path, caplog):
    Kept(tmp_path / "walk.json", "run").save({"teleop": "often"})
    assert WalkInhibition(Kept(tmp_path / "walk.json", "run")).owners == []
    assert "does not count holds on walking" in caplog.text


def test_no_number_is_written_that_could_not_be_read(tmp_path, caplog):
    kept = Kept(tmp_path / "node.json", "run")
    kept.save([1])
    kept.save([float("inf")])
    assert kept.load(list) == [1] and "if this node dies" in caplog.text


def test_what_cannot_be_written_is_told_and_no_error(tmp_path, caplog):
    (tmp_path / "file").write_text("")
    Kept(tmp_path / "file" / "node.json", "run").save([1])
    assert "cannot be written" in caplog.text
