"""ALUserSession and ALUserInfo: whom the robot is with, and what programs keep about them."""

import re

import pytest
from simulator import PATIENCE

from nao_sim_bridge.base.errors import UnknownName
from nao_sim_bridge.naoqi.users.users import USERS_FILE
from nao_sim_bridge.vision.faces_features import DESCRIPTION_LENGTH

FACE_EVENT, TRACKED = "FaceDetected", "ALBasicAwareness/HumanTracked"
GAME = "com.example.game"


@pytest.fixture
def sessions(robot):
    return robot.ALUserSession


@pytest.fixture
def info(robot):
    return robot.ALUserInfo


@pytest.fixture
def meet(robot):
    """Basic awareness follows a face of this number and name, of which the cameras have told."""

    def follow(face, name=""):
        robot.server.memory.raise_event(
            FACE_EVENT, [[0, 0], [[[0, 0.0, 0.0, 0.1, 0.1], [face, 1.0, name]], []], [], [], 0]
        )
        robot.server.memory.raise_event(TRACKED, face)

    return follow


@pytest.fixture
def people(robot):
    """Whose faces are learnt."""
    return robot.server.vision.people


def learn(people, *names):
    import numpy as np

    for number, name in enumerate(names):
        description = np.zeros(DESCRIPTION_LENGTH, np.float32)
        description[number] = 1.0
        assert people.learn(name, description)


def test_who_is_followed_has_a_session_that_events_and_signals_tell_of(robot, sessions, meet):
    names = ("SessionsOpened", "SessionsClosed", "FocusedUser", "NoOpenSessions", "ShouldExitInteractiveActivity")
    heard = {name: robot.heard(f"UserSession/{name}") for name in names}
    meet(7)
    assert sessions.getUserList() == sessions.getOpenUserSessions() == [1] and sessions.getFocusedUser() == 1
    assert (sessions.getUsidFromPpid(7), sessions.getPpidFromUsid(1)) == (1, 7)
    assert robot.value("UserSession/OpenSessions") == [1] and sessions.isUserPermanent(1) is False
    robot.advance(3.0)
    assert sessions.getOpenUserSessions() == robot.value("UserSession/OpenSessions") == []
    assert sessions.doesUserExist(1) and sessions.getNumUsers() == 1 and sessions.getFocusedUser() == -1
    values = {
        name: [queue.get(timeout=PATIENCE) for _ in range(count)]
        for (name, queue), count in zip(heard.items(), (1, 1, 2, 2, 1))
    }
    assert values == {
        "SessionsOpened": [[1]],
        "SessionsClosed": [[1]],
        "FocusedUser": [1, -1],
        "NoOpenSessions": [False, True],
        "ShouldExitInteractiveActivity": [True],
    }


def test_learnt_faces_are_permanent_users_with_a_binding(robot, sessions, people, meet, eventually):
    learn(people, "Ada", "Bob")
    assert sessions.getPermanentUserList() == [1, 2] and sessions.areUsersPermanent([1, 2]) is True
    assert sessions.getBindingList() == ["ALFaceDetection"] and sessions.doesBindingExist("ALFaceDetection") is True
    assert sessions.getUserBindings(2) == {"ALFaceDetection": "Bob"}
    assert sessions.getUserBinding(1, "ALFaceDetection") == "Ada"
    assert sessions.findUsersWithBinding("ALFaceDetection", "Bob") == [2]
    meet(5, "Bob")
    assert sessions.getFocusedUser() == 2 and sessions.areUserSessionsOpen([2]) is True
    assert robot.ALFaceDetection.forgetPerson("Ada") is True
    assert sessions.getUserList() == [2]
    eventually((robot.server.files.folder / USERS_FILE).is_file, "the file of users")


def test_dates_of_encounters(robot, sessions, people, meet):
    learn(people, "Ada")
    assert sessions.getFirstEncounterDate(1) == "" and sessions.getSecondsSinceLastEncounter(1) == -1
    meet(5, "Ada")
    date = r"20\d\d-[A-Z][a-z]{2}-\d\d \d\d:\d\d:\d\d"
    for method in ("getUserCreationDate", "getFirstEncounterDate", "getCurrentEncounterDate"):
        assert re.fullmatch(date, sessions.call(method, 1))
    assert sessions.getSecondsSinceLastEncounter(1) == 0 and sessions.getLastEncounterDate(1) == ""
    robot.advance(3.0)
    assert re.fullmatch(date, sessions.getLastEncounterDate(1)) and sessions.getCurrentEncounterDate(1) == ""
    assert 0 <= sessions.getSecondsSinceLastEncounter(1) < 60


def test_programs_keep_data_about_users(info, sessions, people, meet):
    learn(people, "Ada", "Bob")
    assert info.set(GAME, 2, "score", 43) is True and info.get(GAME, 2, "score") == 43
    meet(5, "Ada")
    assert info.set(GAME, "level", "hard") is True and info.set(GAME, "won", True) is True
    assert [info.get(GAME, name) for name in ("level", "won", "score")] == ["hard", True, None]
    assert [info.getType(GAME, name) for name in ("level", "won", "score")] == ["string", "bool", "int"]
    assert info.has(GAME, "level") is True and info.has(GAME, 2, "level") is False
    assert info.get("name") == "Ada" and info.get(2, "name") == "Bob" and info.has("age") is False
    assert sessions.getUserDataSources() == [GAME] and sessions.getUserData(2, "score") == {GAME: 43}
    sessions.setUserData(2, "score", GAME, 44)
    assert sessions.getUserData(2, "score", GAME) == 44
    assert info.remove(GAME, "won") is True and info.remove(GAME, "won") is False
    assert info.removeUser(GAME) is True and info.has(GAME, "level") is False
    assert info.removeUser(GAME, 2) is True and sessions.getUserDataSources() == []


def test_edits_are_told_and_data_go_with_their_user(robot, info, people):
    heard = []
    learn(people, "Ada")
    info.set(GAME, 1, "score", 1)
    edited = info.userInfoEdited.connect(lambda *values: heard.append(values))
    info.set(GAME, 1, "score", 2)
    robot.advance_until(lambda: heard, 5.0, 0.1, "the edit is told")
    assert heard == [(1, "score", 2)]
    info.userInfoEdited.disconnect(edited)
    robot.ALFaceDetection.forgetPerson("Ada")
    learn(people, "Eve")
    assert info.has(GAME, 2, "score") is False
    with pytest.raises(RuntimeError, match="unknown user 1"):
        info.get(GAME, 1, "score")


def test_another_run_of_the_simulator_knows_known_people_and_their_data(robot, info, sessions, people):
    learn(people, "Ada")
    info.set(GAME, 1, "score", 1)
    folder = robot.server.files.folder
    kept = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    robot.server.factory_reset()
    for path, content in kept.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    robot.server.factory_reset()
    assert sessions.getPermanentUserList() == [1] and info.get(GAME, 1, "score") == 1


def test_nothing_is_made_before_somebody_is_there(robot, people):
    assert robot.server.modules()["ALUserSession"].made == ()
    robot.server.memory.raise_event(TRACKED, -1)
    with pytest.raises(UnknownName):
        robot.server.memory.kind("UserSession/CreatedUsers")
    learn(people, "Ada")
    assert robot.value("UserSession/CreatedUsers") == [1]


def test_what_cannot_be_known_of_users_is_refused(people, refuses):
    learn(people, "Ada")
    refuses("ALUserInfo", f"""
        get('name') -> the robot looks at no user: give the userID
        set('{GAME}', 1, 'score', 1.5) -> value is 1.5, allowed is a text, a whole number, true or false
        set('{GAME}', 5, 'score', 1) -> unknown user 5
        set('com.aldebaran.userinfo', 1, 'name', 'Bob') -> the robot's own, of the faces that it has learnt
        getType('{GAME}', 'score') -> unknown data of users
    """)  # fmt: skip
    refuses("ALUserSession", """
        getUserBindings(5) -> unknown user 5
        getUserBinding(1, 'cloud') -> unknown binding 'cloud'
        getUserCreationDate(5) -> unknown user 5
    """)  # fmt: skip
