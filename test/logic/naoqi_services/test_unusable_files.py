"""What modules of the robot remember from one run to the next, where its file is anything: it is put aside and told."""

from __future__ import annotations

import os
from datetime import datetime, timezone
from unittest.mock import Mock

import numpy as np
import pytest

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.system import knowledge, preference_manager
from nao_sim_bridge.naoqi.system.knowledge import ALKnowledge
from nao_sim_bridge.naoqi.system.preference_files import ALPreferences
from nao_sim_bridge.naoqi.system.preference_manager import ALPreferenceManager
from nao_sim_bridge.naoqi.system.robot_file import RobotFile
from nao_sim_bridge.naoqi.users.users import DATA_FILE, USERS_FILE, Users
from nao_sim_bridge.naoqi.vision import face_detection_people, vision_recognition
from nao_sim_bridge.naoqi.vision.face_detection_people import KnownPeople
from nao_sim_bridge.naoqi.vision.vision_recognition import ALVisionRecognition
from nao_sim_bridge.vision.faces_features import DESCRIPTION_LENGTH

PICTURES_FILE = "naoqi/.local/share/naoqi/vision/visionrecognition/current.npz"


def users_of(files):
    zone = Mock(now=lambda: datetime(2030, 1, 1, tzinfo=timezone.utc))
    simulation = Mock(snapshot=Mock(time=0.0), after_tick=[])
    return Users(simulation, MemoryStore(lambda: 0.0), files, zone, Mock(names=["Ada"], changed=[]), Mock())


def use_users(files):
    users = users_of(files)
    users.put("game", 1, "score", 1)
    users.close()
    again = users_of(files)
    assert again.ask(lambda book: book.numbers) == [1] and again.values("game", 1) == {"score": 1}
    again.close()


def use_knowledge(files):
    ALKnowledge(files).add("tutorial", "sky", "hasColor", "blue")
    assert ALKnowledge(files).getObject("tutorial", "sky", "hasColor") == ["blue"]


def preferences_of(files):
    return ALPreferenceManager(files, MemoryStore(lambda: 0.0), Mock())


def use_preferences(files):
    preferences_of(files).setValue("game", "level", "hard")
    assert preferences_of(files).getValue("game", "level") == "hard"


def use_faces(files):
    face = np.ones(DESCRIPTION_LENGTH, np.float32) / np.sqrt(DESCRIPTION_LENGTH)
    KnownPeople(files).learn("Ada", face)
    assert KnownPeople(files).recognise(face)[0] == "Ada"


def use_pictures(files):
    recognition = ALVisionRecognition(Mock(), MemoryStore(lambda: 0.0), Mock(), files)
    assert recognition.getSize() == 0
    recognition.clearCurrentDatabase()
    recognition.close()


STORES = {
    USERS_FILE: use_users,
    DATA_FILE: use_users,
    knowledge.FILE: use_knowledge,
    preference_manager.FILE: use_preferences,
    face_detection_people.FILE: use_faces,
    PICTURES_FILE: use_pictures,
}
JSON = {
    "a number without bounds": b'{"next": 1e999, "users": []}',
    "no number": b'{"a": {"1": {"b": NaN}}}',
    "a number that no call carries": b'{"a": {"1": {"b": 1' + b"0" * 300 + b"}}}",
    "half a character": b'{"a": {"1": {"\\ud800": "b"}}}',
    "another form": b'{"a": ["b", 1]}',
    "a list": b"[]",
    "nested without end": b'{"a": ' + b"[" * 200_000 + b"]" * 200_000 + b"}",
}
ANYTHING = {"nothing": b"", "a text": b"{broken", "no characters": b"\xff\xfe\xfd" * 99, **JSON}


def aside_of(path):
    return path.with_name(path.name + ".broken")


@pytest.mark.parametrize("content", ANYTHING.values(), ids=ANYTHING)
@pytest.mark.parametrize("name", STORES)
def test_a_file_that_cannot_be_used_is_put_aside_and_told_once(name, content, tmp_path, caplog):
    files, path = ClientFiles(tmp_path), tmp_path / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content)
    STORES[name](files)
    assert aside_of(path).read_bytes() == content
    assert caplog.text.count(f"it is kept as {aside_of(path)}") == 1
    assert len(list(path.parent.glob("*.broken*"))) == 1


@pytest.mark.parametrize("name", STORES)
def test_what_is_no_file_is_put_aside_as_well_and_replaces_nothing(name, tmp_path):
    path = tmp_path / name
    (tmp_path / "letter").write_text("mine")
    for number, make in enumerate((path.mkdir, lambda: os.mkfifo(path), lambda: path.write_bytes(b"{")), 1):
        path.parent.mkdir(parents=True, exist_ok=True)
        if os.path.lexists(path):
            path.unlink()
        make()
        STORES[name](ClientFiles(tmp_path))
        assert len(list(path.parent.glob(path.name + ".broken*"))) == number


@pytest.mark.parametrize("name", [name for name in STORES if name.endswith(".json")])
def test_modules_begin_also_where_their_file_leads_out_or_its_folder_is_a_file(name, tmp_path, caplog):
    secret, home = tmp_path / "secret", tmp_path / "home"
    secret.write_text("{}")
    (home / name).parent.mkdir(parents=True)
    (home / name).symlink_to(secret)
    STORES[name](ClientFiles(home))
    assert secret.read_text() == "{}" and aside_of(home / name).is_symlink()
    other = tmp_path / "other"
    other.mkdir()
    (other / ".local").write_text("mine")
    with pytest.raises((NaoqiError, ValueError), match="cannot be"):
        STORES[name](ClientFiles(other))
    assert (other / ".local").read_text() == "mine"


def test_a_file_that_cannot_be_renamed_stays_and_the_module_begins(tmp_path, monkeypatch, caplog):
    path = tmp_path / preference_manager.FILE
    path.parent.mkdir(parents=True)
    path.write_bytes(b"{broken")
    monkeypatch.setattr("pathlib.Path.rename", Mock(side_effect=PermissionError(13, "Permission denied")))
    assert preferences_of(ClientFiles(tmp_path)).getDomainList() == []
    assert f"{path} cannot be used" in caplog.text and "it stays (Permission denied)" in caplog.text


def test_data_go_with_the_users_whom_they_are_about(tmp_path):
    use_users(ClientFiles(tmp_path))
    kept = (tmp_path / DATA_FILE).read_bytes()
    (tmp_path / USERS_FILE).write_text("{broken")
    use_users(ClientFiles(tmp_path))
    assert aside_of(tmp_path / DATA_FILE).read_bytes() == kept


@pytest.mark.parametrize("value", [float("inf"), float("nan"), "\ud800"])
def test_nothing_is_written_that_could_not_be_read(value, tmp_path):
    file = RobotFile(ClientFiles(tmp_path), "a.json")
    file.save({"a": 1})
    with pytest.raises(NaoqiError, match="a.json cannot hold this"):
        file.save({"a": value})
    assert file.load(dict) == {"a": 1}


@pytest.mark.parametrize("text", ["a\0b", "\x01", "\ud800"])
def test_preferences_that_xml_has_no_characters_for_are_refused_and_the_former_stay(text, tmp_path):
    preferences = ALPreferences(ClientFiles(tmp_path), MemoryStore(lambda: 0.0))
    preferences.writePrefFile("Game", ["Game", "", [["level", "", "a\r\n<&>\t\u20ac"], ["share", "", 0.1]]], False)
    with pytest.raises(BadValue, match="what an XML file"):
        preferences.writePrefFile("Game", ["Game", "", [["level", text, 1]]], False)
    assert preferences.readPrefFile("Game", False)[2][0][2] == "a\r\n<&>\t\u20ac"


def test_a_database_of_pictures_that_a_client_names_is_refused_and_stays(tmp_path):
    (tmp_path / "photo.npz").write_bytes(b"a photograph")
    recognition = ALVisionRecognition(Mock(), MemoryStore(lambda: 0.0), Mock(), ClientFiles(tmp_path))
    with pytest.raises(vision_recognition.PictureFileError, match="no file of learnt pictures"):
        recognition.changeDatabase("/home/nao", "photo")
    recognition.close()
    assert [path.name for path in tmp_path.iterdir()] == ["photo.npz"]
