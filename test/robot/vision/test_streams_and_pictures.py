"""Goals of NaoVision that stream, record and take pictures of any camera, and settings of the cameras."""

from __future__ import annotations

from pathlib import Path

import cv2
import pytest
from camera_topics import BOTTOM, TOP, number_of, numbered_image, read_video, wait_for
from goal_functions import vision as f

from nao_library_actions.msg import NaoVisionGoal
from nao_library_modules.core.files import Kept
from nao_library_modules.vision import NaoVision


@pytest.fixture
def files(vision):
    return vision.module.files.folder


def states(result):
    return {thread.id: thread.state for thread in result.threads}


def test_streams_and_recordings_outlive_their_goals(robot, vision, topics, files):
    result = vision.succeed(f("subscribe", id="small", width=32), f("startRecording", id="walk", camera="bottom"))
    topic = "/NaoVision/small/image_raw"
    path = result.results[1].values[0]
    assert result.results[0].values == [topic] and path.startswith(str(files / "walk_20"))
    assert states(vision.succeed(f("listThreads"))) == {"small": "waiting", "walk": "waiting"}
    for number in range(5):
        topics.send(TOP, numbered_image(number, robot.now.time + number / 10))
        topics.send(BOTTOM, numbered_image(100 + number, robot.now.time + number / 10))
    wait_for(lambda: [t.frames for t in vision.succeed(f("listThreads")).threads] == [5, 5])
    result = vision.succeed(f("listThreads"))
    small, walk = result.threads
    assert (small.kind, small.topic, small.topic_out, small.state) == ("stream", TOP, topic, "running")
    assert (walk.kind, walk.topic, walk.state, walk.path) == ("recording", BOTTOM, "running", path)
    assert result.results[0].values == ["small", "walk"] and result.memList == []
    result = vision.succeed(f("stopRecording", id="walk"), f("unsubscribe", id="small"), f("listThreads"))
    (video,) = result.recordings
    assert (video.frames, video.id, video.error) == (5, "walk", "")
    assert states(result) == {"small": "stopped", "walk": "stopped"}
    assert len(topics.publishers[topic].messages) == 5
    result = vision.succeed(f("startThread", id="small"), f("deleteThread", id="walk"), f("listThreads"))
    assert states(result) == {"small": "waiting"}
    result = vision.succeed(f("deleteThread", id="small"), f("listThreads"))
    assert states(result) == {} and topics.count(TOP) == topics.count(BOTTOM) == 0
    assert read_video(video.path) == [100, 101, 102, 103, 104]


def test_the_end_of_the_server_completes_the_files(vision, topics, files):
    recordings = [f("startRecording", id=f"r{k}", str_param=f"walk{k}") for k in range(3)]
    made = f("createStream", id="made", topic_out="/made"), f("createRecording", id="ready", str_param="web.avi")
    result = vision.succeed(*made, *recordings, f("subscribe", id="s"), f("listThreads"))
    assert (states(result)["made"], states(result)["ready"], states(result)["s"]) == ("ready", "ready", "waiting")
    for number in range(10):
        topics.send(TOP, numbered_image(number, 10.0 + number / 10.0))
    vision.module.shut_down()
    assert [read_video(files / f"walk{k}.mp4") for k in range(3)] == [list(range(10))] * 3
    assert topics.count(TOP) == 0


def test_streams_and_recordings_of_a_server_that_died_go_on_in_the_next(goals_to, topics, tmp_path):
    def server():
        kept = Kept(tmp_path / "kept.json", "run")
        return goals_to(NaoVision, NaoVisionGoal, topics=topics, record_dir=str(tmp_path / "files"), kept=kept)

    died = server()
    died.succeed(f("subscribe", id="s", width=32), f("createStream", id="made", topic_out="/made"))
    died.succeed(f("startRecording", id="walk", str_param="walk.mp4", width=16), f("subscribe", id="gone"))
    died.succeed(f("deleteThread", id="gone"))
    (tmp_path / "files/walk.mp4").write_bytes(b"what there was until then")
    vision = server()
    topics.send(TOP, numbered_image(7, 1.0))
    wait_for(lambda: [t.frames for t in vision.succeed(f("listThreads")).threads] == [0, 1, 1])
    result = vision.succeed(f("stopRecording", id="walk"), f("listThreads"))
    assert states(result) == {"made": "ready", "s": "running", "walk": "stopped"}
    (video,) = result.recordings
    assert (video.path, video.frames, video.width) == (str(tmp_path / "files/walk-2.mp4"), 1, 16)


def test_the_active_camera_is_the_one_of_the_moment(vision, topics):
    vision.succeed(f("setActiveCamera", camera="1"), f("subscribe", id="a"))
    assert (topics.count(TOP), topics.count(BOTTOM)) == (0, 1)
    vision.succeed(f("setActiveCamera", camera="TOP"), f("subscribe", id="b"))
    assert (topics.count(TOP), topics.count(BOTTOM)) == (1, 1)
    vision.succeed(f("subscribe", id="my camera"))
    assert "'my camera' publishes /NaoVision/my_camera/image_raw" in vision.refused(f("subscribe", id="my_camera"))
    vision.succeed(f("subscribe", id="my_camera", topic_out="other"))


A = {"id": "a"}
REFUSED = [
    (f("subscribe"), "field id: it is empty"),
    (f("subscribe", id="a/b"), "field id: 'a/b' is not allowed: a name of up to 64 characters, without slashes"),
    (f("subscribe", camera="botom", **A), "'botom' is no camera: did you mean 'bottom'"),
    (f("subscribe", topic="no topic", **A), "field topic: 'no topic' is not allowed: letters, digits"),
    (f("subscribe", topic_out=TOP, **A), "field topic_out: frames come from there: another topic"),
    (f("subscribe", rate=-1.0, **A), "field rate: -1.0 is not allowed: 0.001..1000 Hz, or 0: all"),
    (f("subscribe", width=-2, **A), "field width: -2 is not allowed: 1..8192 pixels, or 0"),
    (f("startRecording", str_param="a.mkv", **A), "'mkv' is no type of file for this"),
    (f("startRecording", file_type="avi", codec="h264", **A), "avi files cannot have h264 here: one of mpeg4, mjpeg"),
    (f("stopRecording", **A), "there is no stream or recording 'a': one of first"),
    (f("takePicture", quality=101), "field quality: 101 is not allowed: 1..100"),
    (f("takePictures", count=-1), "field count: -1 is not allowed: 1..10000"),
    (f("takePictures", count=2, interval=-1.0), "field interval"),
]
CHAINS = [
    ([f("subscribe", **A), f("subscribe", **A)], "'a' runs already"),
    ([f("subscribe", **A), f("stopRecording", **A)], "'a' is a stream: there is no recording"),
    ([f("subscribe", **A), f("deleteThread", **A), f("stopThread", **A)], "no stream or recording 'a'"),
    ([f("takePictures", str_param="x", count=3), f("takePicture", str_param="x-002.png")], "an earlier function"),
]


def test_a_mistake_is_told_before_anything_begins(vision, topics):
    chains = [([f("subscribe", id="first"), function], text) for function, text in REFUSED]
    for functions, problem in chains + CHAINS:
        text = vision.refused(*functions)
        assert text.startswith(f"function {len(functions)} (") and problem in text
    assert vision.module.jobs.known == {} and topics.subscribers == {}


def test_a_picture_is_the_cameras_and_newer_than_the_goal(robot, vision, topics, camera, files):
    topics.send(BOTTOM, numbered_image(200, robot.now.time))
    asked = robot.now.time
    result = vision.succeed(f("takePicture", camera="bottom", str_param="looks/one.png"))
    (picture,) = result.pictures
    path = files / "looks" / "one.png"
    assert (picture.path, picture.topic, picture.file_type, picture.encoding) == (str(path), BOTTOM, "png", "bgr8")
    assert (picture.width, picture.height, picture.header.frame_id) == (64, 48, "CameraTop_optical_frame")
    stamp = picture.header.stamp.to_sec()
    assert asked <= stamp and number_of(cv2.imread(str(path))) == camera.numbers[round(stamp, 6)] % 256
    assert result.results[0].values == [str(path)] and result.memList == []
    assert topics.count(BOTTOM) == 0
    before = path.read_bytes()
    text = vision.refused(f("takePicture", str_param="looks/one"))
    assert "one.png is there already: another name, or overwrite" in text and path.read_bytes() == before
    vision.succeed(f("takePicture", str_param="looks/one", overwrite=True))
    assert path.read_bytes() != before


def test_several_pictures_at_an_interval_and_a_cancel_keeps_those_that_are_there(robot, vision, camera, topics):
    asked = robot.now.time
    goal = vision.play(f("takePictures", count=4, interval=0.5, str_param="walk.jpg"))
    assert [Path(p.path).name for p in goal.result.pictures] == [f"walk-00{k}.jpg" for k in (1, 2, 3, 4)]
    stamps = [p.header.stamp.to_sec() for p in goal.result.pictures]
    assert all(asked + 0.5 * k <= stamp < asked + 0.5 * k + 0.5 for k, stamp in enumerate(stamps))
    assert [feedback.done for feedback in goal.feedback if feedback.status == "taking pictures"] == [1, 2, 3, 4]
    assert len({p.path for p in vision.succeed(f("takePictures", count=5)).pictures}) == 5
    goal = vision.send(f("takePictures", count=5000, interval=0.1))
    robot.advance_until(lambda: any(feedback.done >= 3 for feedback in goal.feedback), 5.0)
    goal.cancel()
    assert (goal.state, goal.text) == ("preempted", "preempted in function 1 (takePictures)")
    assert 3 <= len(goal.result.pictures) < 100 and topics.count(TOP) == 0
    assert all(Path(picture.path).is_file() for picture in goal.result.pictures)


def test_the_active_camera_is_the_robots_as_well(robot, vision):
    result = vision.succeed(f("setActiveCamera", camera="bottom"), f("getActiveCamera"))
    assert (result.memList, robot.ALVideoDevice.getActiveCamera()) == (["bottom"], 1)
    vision.succeed(f("setActiveCamera", camera="top"), f("setActiveCamera", camera="bottom", revert=True))
    assert (vision.module.cameras.active, robot.ALVideoDevice.getActiveCamera()) == ("top", 0)
    assert vision.succeed(f("getCameras")).memList == [
        f'["top", "{TOP}", "CameraTop_optical_frame"]', f'["bottom", "{BOTTOM}", "CameraBottom_optical_frame"]',
    ]  # fmt: skip


def test_parameters_are_set_at_the_robot_and_go_back(robot, vision):
    def value(camera, number):
        return robot.ALVideoDevice.getParameter(camera, number)

    usual = value(0, 1)
    result = vision.succeed(
        f("setParameter", str_param="brightness", values=[100]),
        f("setParameter", str_param="kCameraContrastID", values=[50], camera="bottom"),
        f("getParameter", str_param="0"),
        f("getParameter", str_param="contrast", camera="1"),
        f("getParameterRange", str_param="contrast"),
    )
    assert result.memList == ["100", "50", *map(str, robot.ALVideoDevice.getParameterRange(0, 1))]
    assert (value(0, 0), value(0, 1), value(1, 1)) == (100, usual, 50) and usual != 50
    goal = vision.send(
        f("setParameter", str_param="brightness", values=[20], revert=True),
        f("setAutoExposure", enable=False, camera="bottom", revert=True),
        f("setAutoWhiteBalance", 1.0, enable=False, revert=True),
    )
    robot.advance(0.5)
    assert (value(0, 0), value(1, 11), value(0, 12)) == (100, 1, 0)
    assert goal.finish().state == "succeeded" and value(0, 12) == 1
    vision.succeed(f("setAllParametersToDefault"))
    assert value(0, 0) != 100 and value(1, 1) == 50


@pytest.fixture
def node(topics):
    topics.servers["nao_camera/top"] = {"resolution": 1, "frame_rate": 15.0, "brightness": 0}
    return topics.servers["nao_camera/top"]


def test_resolution_and_rate_are_set_at_the_node_and_go_back(vision, node, topics, monkeypatch):
    result = vision.succeed(
        f("setResolution", resolution="VGA"), f("setFrameRate", rate=5), f("getResolution"), f("getFrameRate")
    )
    assert result.memList == ["VGA", "5.0"] and node == {"resolution": 2, "frame_rate": 5.0, "brightness": 0}
    revert = f("setResolution", resolution="QQVGA", revert=True), f("setFrameRate", rate=30, revert=True)
    assert vision.succeed(*revert, f("getFrameRate")).memList == ["5.0"]
    assert (node["resolution"], node["frame_rate"]) == (2, 5.0)
    monkeypatch.setattr(topics, "set", lambda server, values: {"frame_rate": 10.0})
    text = vision.refused(f("setFrameRate", rate=30))
    assert "nao_camera/top keeps frame_rate at 10.0 instead of 30.0" in text
    del node["resolution"]
    assert "has no parameter resolution; it has brightness, frame_rate" in vision.refused(f("getResolution"))


def test_what_cannot_be_set_is_told(vision):
    for function, problem in (
        (f("setParameter", str_param="brightness", values=[0.5]), "one whole number"),
        (f("setParameter", str_param="brightness", values=[300]), "allowed is -255 to 255"),
        (f("setResolution"), "field resolution: '' is no resolution"),
        (f("setFrameRate", rate=0.0), "field rate: 0.0 is not allowed: 1..30 frames a second"),
    ):
        assert problem in vision.refused(function)
