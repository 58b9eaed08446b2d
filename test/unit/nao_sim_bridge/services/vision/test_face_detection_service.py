"""ALFaceDetection over the network, with cards of faces in front of the robot."""

from __future__ import annotations

import queue

import pytest

CARD = "{{name: {name}, face: {face}, position: [{x}, {y}, 0.55], heading: 3.1416}}"
EVENT = "FaceDetected"
SOON = 0.7
"""Long enough for several pictures, s."""


@pytest.fixture
def faces(stiff_robot):
    faces = stiff_robot.ALFaceDetection
    faces.clearDatabase()
    faces.subscribe("test")
    yield faces
    faces.unsubscribe("test")
    faces.setRecognitionConfidenceThreshold(0.4)
    faces.setRecognitionEnabled(True)


@pytest.fixture
def show(stiff_robot):
    """Puts up the card of somebody, to the left by `y` m."""

    def show(face, x=1.0, y=0.0, name="card"):
        stiff_robot.NaoSimulation.placeObject(CARD.format(name=name, face=face, x=x, y=y))
        stiff_robot.advance(SOON)

    return show


@pytest.fixture
def seen(stiff_robot):
    return lambda: stiff_robot.ALMemory.getData(EVENT)


@pytest.fixture
def learn(stiff_robot, faces):
    return lambda name, method="learnFace": stiff_robot.finish("ALFaceDetection", method, name, after=1.0)


def labels(value):
    return [face[1][2] for face in value[1][:-1]] if value else []


def test_the_event_says_where_a_face_is_as_naoqi_does(stiff_robot, faces, show, seen):
    show("anna", x=1.0, y=0.2)
    (seconds, micros), (face, news), in_torso, in_robot, camera = seen()
    assert stiff_robot.now.time - 0.25 < seconds + 1e-6 * micros <= stiff_robot.now.time
    (zero, alpha, beta, width, height), extra = face
    assert zero == 0 and alpha == pytest.approx(0.2, abs=0.03) and 0.0 < beta < 0.3
    assert width == pytest.approx(0.17, abs=0.05) and height == pytest.approx(width, rel=0.1)
    number, score, label, left, right, brow, other_brow, nose, mouth = extra
    assert isinstance(number, int) and (score, label, news) == (0.0, "", [])
    assert [len(points) for points in (left, right, brow, other_brow, nose, mouth)] == [14, 14, 6, 6, 6, 16]
    assert left[0] < alpha < right[0] and left[6:] == [0.0] * 8  # the person's own left
    assert left[1] < nose[1] < mouth[1]
    assert in_torso == pytest.approx(stiff_robot.ALMotion.getPosition("CameraTop", 0, True), abs=0.01)
    assert in_robot == pytest.approx(stiff_robot.ALMotion.getPosition("CameraTop", 2, True), abs=0.01)
    assert camera == 0


def test_an_empty_list_tells_once_that_nobody_is_there_any_more(stiff_robot, faces, show, seen, listener):
    show("ben")
    stiff_robot.ALMemory.subscribeToEvent(EVENT, "Listener", "onEvent")
    stiff_robot.NaoSimulation.removeObject("card")
    stiff_robot.advance(1.0)
    assert seen() == []
    heard = [listener.heard.get(timeout=stiff_robot.patience)[1]]
    while heard[-1]:
        heard.append(listener.heard.get(timeout=stiff_robot.patience)[1])
    with pytest.raises(queue.Empty):
        listener.heard.get_nowait()
    stiff_robot.ALMemory.unsubscribeToEvent(EVENT, "Listener")


def test_who_was_learnt_is_called_by_name_once_and_labelled_always(stiff_robot, faces, show, seen, learn):
    show("anna")
    assert labels(seen()) == [""]
    assert learn("Anna") is True
    assert faces.getLearnedFacesList() == ["Anna"]
    history = [value for value, *_ in stiff_robot.ALMemory.getEventHistory(EVENT) if "Anna" in labels(value)]
    assert labels(seen()) == ["Anna"] and seen()[1][0][1][1] > 0.4
    news = [value[1][-1] for value in history]
    assert news.count([2, ["Anna"]]) == 1 and news[-1] == []


def test_somebody_else_stays_unknown(stiff_robot, faces, show, seen, learn):
    show("anna")
    assert learn("Anna")
    stiff_robot.NaoSimulation.removeObject("card")
    show("david")
    assert labels(seen()) == [""]
    faces.setRecognitionConfidenceThreshold(0.0)
    stiff_robot.advance(SOON)
    assert labels(seen()) == ["Anna"] or seen()[1][0][1][1] == 0.0  # nobody is too unlike to be somebody
    faces.setRecognitionConfidenceThreshold(0.4)


def test_without_recognition_nobody_has_a_name(stiff_robot, faces, show, seen, learn):
    show("hugo")
    assert learn("Hugo") and labels(seen()) == ["Hugo"]
    faces.setRecognitionEnabled(False)
    stiff_robot.advance(SOON)
    assert labels(seen()) == [""] and not faces.isRecognitionEnabled()


def test_learning_needs_exactly_one_face(faces, show, learn, stiff_robot):
    assert learn("Nobody") is False
    show("anna", y=0.2)
    show("ben", y=-0.2, name="other")
    assert learn("Somebody") is False
    assert faces.getLearnedFacesList() == []
    stiff_robot.NaoSimulation.removeObject("other")
    assert learn("Anna") is True


def test_relearning_needs_somebody_known_and_ends_at_ten_pictures(faces, show, learn):
    show("emma")
    assert learn("Emma", "reLearnFace") is False
    assert learn("Emma")
    assert [learn("Emma", "reLearnFace") for _ in range(10)] == [True] * 9 + [False]
    assert faces.getLearnedFacesList() == ["Emma"]
    assert faces.forgetPerson("Emma") and not faces.forgetPerson("Emma")
    assert faces.getLearnedFacesList() == []


def test_learning_does_not_need_a_subscriber(stiff_robot, faces, show, learn):
    faces.unsubscribe("test")
    show("clara")
    assert learn("Clara") is True
    faces.subscribe("test")


def test_people_of_another_robot_are_imported(stiff_robot, faces, show, learn):
    show("clara")
    assert learn("Clara")
    folder = stiff_robot.server.files.folder
    (folder / "faces_old.npz").write_bytes((folder / "faces.npz").read_bytes())
    faces.clearDatabase()
    assert faces.getLearnedFacesList() == []
    assert faces.importOldDatabase("merge") is True
    assert faces.getLearnedFacesList() == ["Clara"]
    (folder / "faces_old.npz").write_bytes(b"broken")
    with pytest.raises(RuntimeError, match="faces_old.npz' is no file of known faces"):
        faces.importOldDatabase("keep")
    (folder / "faces_old.npz").unlink()
    assert faces.importOldDatabase("keep") is False


def test_a_paused_module_sees_nobody(stiff_robot, faces, show, seen):
    show("hugo")
    assert len(labels(seen())) == 1
    faces.pause(True)
    assert seen() == []
    stiff_robot.advance(SOON)
    assert seen() == []
    faces.pause(False)
    stiff_robot.advance(SOON)
    assert len(labels(seen())) == 1


@pytest.mark.parametrize(
    "method, arguments, message",
    [
        ("learnFace", ("  ",), "name is '  ', allowed is the name of somebody"),
        ("learnFace", (5,), "pId is 5, allowed is a text"),
        ("learnFace", ("x" * 201,), "allowed is 200 characters at most"),
        ("setRecognitionConfidenceThreshold", (1.5,), "threshold is 1.5, allowed is 0 to 1"),
        ("importOldDatabase", ("drop",), "policy is 'drop', allowed is overwrite or merge or keep"),
        ("setActiveCamera", (2,), "camera is 2, allowed is"),
    ],
)
def test_what_is_refused_names_what_is_allowed(stiff_robot, faces, method, arguments, message):
    future = stiff_robot.post("ALFaceDetection", method, *arguments)
    stiff_robot.handed_over("ALFaceDetection")
    stiff_robot.advance(1.0)
    with pytest.raises(RuntimeError, match=f"ALFaceDetection::{method} .*{message}"):
        stiff_robot.answer(future)
