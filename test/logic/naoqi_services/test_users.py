"""Users, data about them and the files of both: what several threads do at the same time."""

from __future__ import annotations

import json
import sys
import threading
from datetime import datetime, timezone
from unittest.mock import Mock

import pytest

from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.system.robot_file import RobotFile
from nao_sim_bridge.naoqi.users.book import News
from nao_sim_bridge.naoqi.users.user_session import ALUserSession
from nao_sim_bridge.naoqi.users.users import DATA_FILE, EVENTS, USERS_FILE, Users

PATIENCE = 60.0
GAME = "com.example.game"


@pytest.fixture
def memory():
    return MemoryStore(lambda: 0.0)


@pytest.fixture
def simulation():
    return Mock(snapshot=Mock(time=0.0), after_tick=[])


@pytest.fixture
def users(tmp_path, memory, simulation):
    """A robot that knows the face of Ada, user 1."""
    zone = Mock(now=lambda: datetime(2030, 1, 1, tzinfo=timezone.utc))
    made = Users(simulation, memory, ClientFiles(tmp_path), zone, Mock(names=["Ada"], changed=[]), Mock())
    yield made
    made.close()


def together(*works):
    """Do several things at the same time; returns when all are done."""
    threads = [threading.Thread(target=work) for work in works]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(PATIENCE)
        assert not thread.is_alive()


def test_what_two_programs_keep_at_the_same_time_is_all_kept(users, tmp_path):
    def put(words):
        for word in words:
            users.put(GAME, 1, word, 1)

    names = [str(number) for number in range(40)]
    together(lambda: put(names[::2]), lambda: put(names[1::2]))
    assert sorted(users.values(GAME, 1)) == sorted(names)
    assert json.loads((tmp_path / DATA_FILE).read_text()) == {GAME: {"1": dict.fromkeys(names, 1)}}


def test_who_asks_while_users_come_is_answered(users):
    sessions, done = ALUserSession(users), threading.Event()

    def come():
        for face in range(300):
            users.track(face)
        done.set()

    def ask():
        while not done.is_set():
            assert sessions.getOpenUserSessions() is not None and sessions.getPermanentUserList() == [1]
        answered.append(True)

    answered, interval = [], sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        together(come, ask)
    finally:
        sys.setswitchinterval(interval)
    assert answered and sessions.getNumUsers() == 301


@pytest.mark.parametrize("face", ["x", 7.0, True, -2, 2**31, [7], None])
def test_what_is_no_face_is_not_followed(users, face):
    users.track(face)
    assert users.ask(lambda book: book.numbers) == [1]


@pytest.mark.parametrize("value", ["x", 5, {"a": 1}, [0, 5], [0, [[5], []]], [0, [["a", ["x", 1.0, "Ada"]], []]]])
def test_who_is_followed_is_known_also_when_clients_have_raised_anything_about_faces(users, memory, value):
    memory.raise_event("FaceDetected", value)
    users.track(7)
    assert users.ask(lambda book: (book.open, book.user_of_face(7))) == ([2], 2)


def test_the_simulation_goes_on_while_a_file_is_written(users, simulation, monkeypatch):
    users.close()
    begun, may_go_on, save = threading.Event(), threading.Event(), RobotFile.save

    def slow(file, content):
        begun.set()
        assert may_go_on.wait(PATIENCE)
        save(file, content)

    monkeypatch.setattr(RobotFile, "save", slow)
    putting = threading.Thread(target=lambda: users.put(GAME, 1, "score", 1))
    putting.start()
    assert begun.wait(PATIENCE)
    users.track(7)
    assert users.ask(lambda book: book.open) == [2]
    for tick in simulation.after_tick:
        tick(Mock(time=3.0))
    may_go_on.set()
    putting.join(PATIENCE)
    assert users.values(GAME, 1) == {"score": 1}


def test_events_tell_also_of_users_whose_file_cannot_be_written(users, memory, tmp_path, caplog):
    users.close()
    (tmp_path / USERS_FILE).unlink()
    (tmp_path / USERS_FILE).mkdir()
    users.track(7)
    assert memory.get(EVENTS[News.OPENED]) == [2]
    users.close()
    assert "users.json" in caplog.text
