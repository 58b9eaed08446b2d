"""Known people survive the robot, and what cannot be kept is not known."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.record_dir import ClientFiles
from nao_sim_bridge.services.vision.face_detection_people import KnownPeople
from nao_sim_bridge.sim.vision.face_memory import FaceFileError, FaceMemory

FACE = np.array([1.0, 0.0, 0.0], np.float32)


@pytest.fixture
def people(tmp_path):
    return KnownPeople(ClientFiles(tmp_path))


def test_people_are_known_to_the_next_robot(tmp_path, people):
    assert people.learn("anna", FACE) and people.learn("ben", -FACE)
    assert people.forget("ben") and not people.forget("nobody")
    again = KnownPeople(ClientFiles(tmp_path))
    assert again.names == ["anna"]
    assert again.recognise(FACE) == ("anna", 1.0)
    again.clear()
    assert KnownPeople(ClientFiles(tmp_path)).names == []


def test_who_cannot_be_kept_is_not_known(people, monkeypatch):
    def full(memory, path):
        raise FaceFileError("No space left on device")

    people.learn("anna", FACE)
    monkeypatch.setattr(FaceMemory, "save", full)
    with pytest.raises(FaceFileError, match="No space left"):
        people.learn("ben", -FACE)
    assert people.names == ["anna"]


def test_a_broken_file_is_put_aside(tmp_path, people):
    (tmp_path / "faces.npz").write_bytes(b"broken")
    assert people.names == []
    assert people.learn("anna", FACE)
    assert (tmp_path / "faces.npz.broken").read_bytes() == b"broken"
    assert KnownPeople(ClientFiles(tmp_path)).names == ["anna"]


def test_without_a_file_of_another_robot_nothing_is_imported(people):
    assert people.take_over("merge") is False
