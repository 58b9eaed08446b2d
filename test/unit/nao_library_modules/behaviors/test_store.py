"""Behaviours as files."""

from __future__ import annotations

import pytest

from nao_library_modules.behaviors import BehaviorError, BehaviorStore, NoSuchBehavior
from nao_library_modules.errors import BadGoal

TEXT = "help: Waits.\ndo: [{wait: 1}]\n"
OTHER = "help: Waits longer.\ndo: [{wait: 2}]\n"


@pytest.fixture
def store(tmp_path):
    shipped = tmp_path / "shipped"
    shipped.mkdir()
    (shipped / "hello.yaml").write_text(TEXT)
    return BehaviorStore(tmp_path / "own", shipped)


def test_what_is_saved_is_there(store):
    store.save("a", TEXT)
    assert store.names() == ["a", "hello"]
    assert (store.text("a"), store.load("a").help) == (TEXT, "Waits.")
    assert [path.name for path in store.folder.iterdir()] == ["a.yaml"]


def test_one_of_that_name_is_replaced_only_when_that_is_said(store):
    store.save("a", TEXT)
    with pytest.raises(BadGoal, match="there is a behavior 'a' already"):
        store.save("a", OTHER)
    assert store.text("a") == TEXT
    store.save("a", OTHER, overwrite=True)
    assert store.text("a") == OTHER


def test_those_of_the_library_stay_and_can_be_put_behind(store):
    for change in (lambda: store.delete("hello"), lambda: store.rename("hello", "b")):
        with pytest.raises(BadGoal, match="comes with the library"):
            change()
    store.save("hello", OTHER)
    assert (store.text("hello"), store.shipped_text("hello"), store.names()) == (OTHER, TEXT, ["hello"])
    store.delete("hello")
    assert store.text("hello") == TEXT


def test_names_change(store):
    store.save("a", TEXT)
    store.rename("a", "b")
    assert store.names() == ["b", "hello"]
    store.save("c", OTHER)
    with pytest.raises(BadGoal, match="field new_name"):
        store.rename("b", "c")
    store.rename("b", "c", overwrite=True)
    assert store.text("c") == TEXT


def test_what_is_not_there_is_told_with_what_is(store):
    store.save("wave", TEXT)
    for ask in (store.text, store.load, store.delete, lambda name: store.rename(name, "x")):
        with pytest.raises(NoSuchBehavior, match="did you mean 'wave'"):
            ask("wavee")


@pytest.mark.parametrize("name", ["../a", "a/b", "", ".a", "a\0"])
def test_nothing_outside_of_the_folder_is_reached(store, name):
    store.save("a", TEXT)
    for ask in (store.text, store.delete, store.of_user, lambda n: store.save(n, TEXT), lambda n: store.rename("a", n)):
        with pytest.raises(BadGoal, match="no name for a behavior"):
            ask(name)


def test_broken_files_are_told_and_do_not_hide_the_others(store):
    store.save("a", TEXT)
    store.folder.joinpath("bad.yaml").write_bytes(b"\xff\xfe")
    with pytest.raises(BehaviorError, match="cannot be read"):
        store.load("bad")
    assert store.names() == ["a", "bad", "hello"]


def test_a_folder_that_cannot_be_written_is_told(store, tmp_path):
    (tmp_path / "own").write_text("a file")
    with pytest.raises(BadGoal, match="cannot be written"):
        store.save("a", TEXT)


def test_who_uses_a_box_is_known(store):
    store.save("a", "help: x\ndo: [{parallel: [{wait: 1}, [{behavior: hello}]]}]")
    store.save("b", "help: broken")
    assert store.users_of("hello") == ["a"]
