"""People are told apart, strangers stay strangers, and the file survives."""

from __future__ import annotations

import numpy as np
import pytest
from face_pictures import OPTICS, face_picture

from nao_sim_bridge.sim.vision.face_memory import MOST_PICTURES, FaceFileError, FaceMemory
from nao_sim_bridge.sim.vision.faces import FaceDetector, FaceSettings

KNOWN, STRANGERS = ("anna", "ben", "clara", "david", "emma", "farid"), ("grace", "hugo")
THRESHOLD = 0.4


def describe(*arguments, **options):
    faces = FaceDetector().detect(face_picture(*arguments, **options), OPTICS, FaceSettings(0.0))
    return faces[0].description if faces else None


@pytest.fixture(scope="module")
def memory():
    memory = FaceMemory()
    for name in KNOWN:
        memory.learn(name, describe(name, 1.0, seed=1))
    return memory


def direction(number):
    vector = np.zeros(8, np.float32)
    vector[number] = 1.0
    return vector


@pytest.mark.parametrize("distance, yaw, light", [(0.6, 0.0, 1.2), (1.0, 0.2, 1.0), (1.4, -0.1, 0.7), (2.0, 0.0, 1.0)])
def test_known_people_are_told_apart(memory, distance, yaw, light):
    found = {}
    for name in KNOWN:
        guess, score = memory.recognise(describe(name, distance, yaw, light=light, seed=2))
        found[name] = guess if score >= THRESHOLD else ""
    assert all(guess in (name, "") for name, guess in found.items())
    assert sum(guess == name for name, guess in found.items()) >= 5


@pytest.mark.parametrize("name", STRANGERS)
def test_strangers_stay_unknown(memory, name):
    for distance in (0.7, 1.2, 1.8):
        assert memory.recognise(describe(name, distance, seed=3))[1] < THRESHOLD


def test_nobody_is_known_to_an_empty_memory():
    assert FaceMemory().recognise(direction(0)) == ("", 0.0)


def test_a_person_has_ten_pictures_at_most():
    memory = FaceMemory()
    assert [memory.learn("a", direction(0)) for _ in range(MOST_PICTURES + 1)] == [True] * MOST_PICTURES + [False]
    assert memory.pictures_of("a") == MOST_PICTURES and memory.names == ["a"]


def test_more_pictures_make_more_of_a_person_known():
    memory = FaceMemory()
    memory.learn("a", direction(0))
    assert memory.recognise(direction(1)) == ("", 0.0)
    memory.learn("a", direction(1))
    assert memory.recognise(direction(1)) == ("a", 1.0)
    assert memory.forget("a") and not memory.forget("a")
    assert memory.names == []


def test_a_file_gives_back_what_was_saved(tmp_path):
    memory = FaceMemory()
    for number, name in enumerate(["anna", "bjørn", "anna"]):
        memory.learn(name, direction(number))
    memory.save(tmp_path / "faces.npz")
    again = FaceMemory.load(tmp_path / "faces.npz")
    assert (again.names, again.pictures_of("anna")) == (["anna", "bjørn"], 2)
    assert again.recognise(direction(1)) == ("bjørn", 1.0)
    assert [path.name for path in tmp_path.iterdir()] == ["faces.npz"]
    FaceMemory().save(tmp_path / "faces.npz")
    assert FaceMemory.load(tmp_path / "faces.npz").names == []


@pytest.mark.parametrize("content", [b"", b"not an archive", b"PK\x03\x04 broken"])
def test_a_broken_file_is_an_error(tmp_path, content):
    (tmp_path / "faces.npz").write_bytes(content)
    with pytest.raises(FaceFileError, match="faces.npz' is"):
        FaceMemory.load(tmp_path / "faces.npz")


def test_a_file_of_something_else_is_an_error(tmp_path):
    np.savez(tmp_path / "faces.npz", names=np.array(["a", "b"]), person_0=np.ones((1, 4)), person_1=np.ones((1, 5)))
    with pytest.raises(FaceFileError, match="do not fit together"):
        FaceMemory.load(tmp_path / "faces.npz")


def test_a_file_that_cannot_be_written_is_an_error(tmp_path):
    with pytest.raises(FaceFileError, match="cannot be written to .*No such file or directory"):
        FaceMemory().save(tmp_path / "none" / "faces.npz")


@pytest.mark.parametrize("policy, pictures", [("overwrite", (0, 1)), ("merge", (1, 1)), ("keep", (1, 0))])
def test_policies_for_people_whom_both_know(policy, pictures):
    mine, other = FaceMemory(), FaceMemory()
    mine.learn("a", direction(0))
    other.learn("a", direction(1))
    other.learn("b", direction(2))
    mine.take_over(other, policy)
    assert mine.names == ["a", "b"]
    assert tuple(round(mine.recognise(direction(number))[1]) for number in (0, 1)) == pictures
