"""Goals of the module for vision: streams, recordings and pictures, in chains, checked before they begin."""

from __future__ import annotations

import re
import threading
from pathlib import Path

import cv2
import pytest
from fake_vision import BOTTOM, TOP, f, image, number_of, numbered_image, wait_for

from nao_library_actions.msg import NaoVisionGoal


@pytest.fixture
def camera(topics, edge):
    """Sends a numbered frame at once to whoever subscribes, again and again, as a camera does."""
    ended = threading.Event()
    numbers = iter(range(1, 10**6))

    def run():
        while not ended.wait(0.005):
            number = next(numbers)
            for topic in (TOP, BOTTOM):
                topics.send(topic, numbered_image(number % 256, edge.clock.now()))

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    yield
    ended.set()
    thread.join(10.0)


def states(result):
    return {thread.id: thread.state for thread in result.threads}


# Streams and recordings


def test_streams_and_recordings_outlive_their_goals(vision, succeed, topics, edge):
    result = succeed(f("subscribe", id="small", width=32), f("startRecording", id="walk", camera="bottom"))
    topic = "/NaoVision/small/image_raw"
    assert [r.values[0] for r in result.results] == [topic, vision.threads.get("walk").report().path]
    assert states(succeed(f("listThreads"))) == {"small": "waiting", "walk": "waiting"}
    for number in range(5):
        topics.send(TOP, numbered_image(number, edge.clock.now()))
        topics.send(BOTTOM, numbered_image(100 + number, edge.clock.now()))
    wait_for(lambda: vision.threads.get("small").report().frames == 5)
    result = succeed(f("listThreads"))
    small, walk = result.threads
    assert (small.kind, small.topic, small.topic_out, small.state) == ("stream", TOP, topic, "running")
    assert (walk.kind, walk.topic, walk.state) == ("recording", BOTTOM, "running")
    assert walk.path.startswith(str(vision.files.folder / "walk_20"))
    assert result.results[0].values == ["small", "walk"] and result.memList == []

    result = succeed(f("stopRecording", id="walk"), f("unsubscribe", id="small"), f("listThreads"))
    (video,) = result.recordings
    assert (video.frames, video.id, video.error) == (5, "walk", "")
    assert states(result) == {"small": "stopped", "walk": "stopped"}
    assert len(topics.publishers[topic].messages) == 5
    result = succeed(f("startThread", id="small"), f("deleteThread", id="walk"), f("listThreads"))
    assert states(result) == {"small": "waiting"}
    result = succeed(f("deleteThread", id="small"), f("listThreads"))
    assert states(result) == {} and topics.count(TOP) == topics.count(BOTTOM) == 0
    assert Path(video.path).is_file()


def test_what_is_made_ready_runs_when_it_is_started(succeed, topics):
    result = succeed(
        f("createStream", id="s", topic="/webcam", topic_out="/relay"),
        f("createRecording", id="r", topic="/webcam", str_param="web.avi"),
        f("listThreads"),
    )
    assert states(result) == {"s": "ready", "r": "ready"} and topics.count("/webcam") == 0
    assert states(succeed(f("startThread", id="s"), f("listThreads"))) == {"s": "waiting", "r": "ready"}
    assert topics.count("/webcam") == 1
    result = succeed(f("startThread", id="r"), f("stopThread", id="r"))
    assert [(v.id, v.frames, v.file_type, v.codec) for v in result.recordings] == [("r", 0, "avi", "mjpeg")]


def test_a_preempted_goal_leaves_streams_and_recordings(vision, topics, edge):
    edge.clock.waiting.clear()
    wait = f("startRecording", id="walk")
    wait.time.secs = 1000
    thread = vision.server.play_in_background(NaoVisionGoal([f("subscribe", id="s"), wait]))
    assert edge.clock.waiting.wait(10.0)
    vision.server.preempt()
    thread.join(10.0)
    assert vision.server.end == "preempted"
    topics.send(TOP, image(edge.clock.now()))
    wait_for(lambda: [t.report().frames for t in vision.threads.known.values()] == [1, 1])


def test_the_end_of_the_server_completes_the_files(vision, succeed, topics, edge):
    succeed(*(f("startRecording", id=f"r{k}", str_param=f"walk{k}") for k in range(3)), f("subscribe", id="s"))
    for number in range(10):
        topics.send(TOP, numbered_image(number, 10.0 + number / 10.0))
    vision.shut_down()
    for k in range(3):
        capture = cv2.VideoCapture(str(vision.files.folder / f"walk{k}.mp4"))
        assert capture.get(cv2.CAP_PROP_FRAME_COUNT) == 10
    assert topics.count(TOP) == 0


def test_the_active_camera_is_the_one_of_the_moment(succeed, topics):
    succeed(f("setActiveCamera", camera="1"), f("subscribe", id="a"))
    assert (topics.count(TOP), topics.count(BOTTOM)) == (0, 1)
    succeed(f("setActiveCamera", camera="TOP"), f("subscribe", id="b"))
    assert (topics.count(TOP), topics.count(BOTTOM)) == (1, 1)


REFUSED = [
    (f("subscribe"), "field id: it is empty"),
    (f("subscribe", id="a/b"), "field id: 'a/b' is not allowed: a name of up to 64 characters, without slashes"),
    (f("subscribe", id="x" * 65), "field id"),
    (f("subscribe", id="a", camera="left"), "field camera: 'left' is no camera"),
    (f("subscribe", id="a", camera="botom"), "'botom' is no camera: did you mean 'bottom'"),
    (f("subscribe", id="a", topic="no topic"), "field topic: 'no topic' is not allowed: letters, digits"),
    (f("subscribe", id="a", topic_out="2/out"), "field topic_out: '2/out' is not allowed"),
    (f("subscribe", id="a", topic_out=TOP), "field topic_out: frames come from there: another topic"),
    (f("subscribe", id="a", rate=-1.0), "field rate: -1.0 is not allowed: frames a second, or 0: all"),
    (f("subscribe", id="a", rate=float("nan")), "field rate: nan"),
    (f("subscribe", id="a", width=-2), "field width: -2 is not allowed: 1..8192 pixels, or 0"),
    (f("startRecording", id="a", str_param="../a.mp4"), "leads out of the folder for recordings"),
    (f("startRecording", id="a", str_param="a.mkv"), "'mkv' is no type of file for this"),
    (
        f("startRecording", id="a", file_type="avi", codec="h264"),
        "avi files cannot have h264 here: one of mpeg4, mjpeg",
    ),
    (f("startRecording", id="a", codec="h265"), "'h265' is no codec: did you mean 'h264'"),
    (f("stopRecording", id="a"), "there is no stream or recording 'a': one of first"),
    (f("deleteThread"), "field id: it is empty"),
    (f("listThreads", id="z"), "there is no stream or recording 'z'"),
    (f("takePicture", str_param="a.mp4"), "'mp4' is no type of file for this: did you mean"),
    (f("takePicture", quality=101), "field quality: 101 is not allowed: 1..100"),
    (f("takePicture", timeout=-1.0), "field timeout"),
    (f("takePictures", count=-1), "field count: -1 is not allowed: 1..10000"),
    (f("takePictures", count=2, interval=-1.0), "field interval"),
]


@pytest.mark.parametrize("function, problem", REFUSED, ids=lambda value: getattr(value, "function", None))
def test_a_mistake_is_told_before_anything_begins(refused, vision, topics, function, problem):
    text = refused(f("subscribe", id="first"), function)
    assert text.startswith(f"function 2 ({function.function}): ") and problem in text
    assert vision.threads.known == {} and topics.subscribers == {}


@pytest.mark.parametrize(
    "functions, problem",
    [
        ([f("subscribe", id="a"), f("subscribe", id="a")], "'a' runs already"),
        ([f("subscribe", id="a"), f("stopRecording", id="a")], "'a' is a stream: there is no recording"),
        ([f("startRecording", id="a"), f("unsubscribe", id="a")], "'a' is a recording: there is no stream"),
        ([f("subscribe", id="a"), f("startThread", id="a")], "'a' runs already"),
        ([f("subscribe", id="a"), f("deleteThread", id="a"), f("stopThread", id="a")], "no stream or recording 'a'"),
        (
            [f("startRecording", id="a", str_param="x"), f("startRecording", id="b", str_param="x.mp4")],
            "an earlier function writes",
        ),
        (
            [f("takePictures", str_param="x", count=3), f("takePicture", str_param="x-002.png")],
            "an earlier function writes",
        ),
    ],
)
def test_a_chain_is_checked_as_a_whole(refused, vision, functions, problem):
    text = refused(*functions)
    assert text.startswith(f"function {len(functions)} (") and problem in text
    assert vision.threads.known == {}


def test_two_streams_need_two_topics(refused, succeed):
    succeed(f("subscribe", id="my camera"))
    assert "'my camera' publishes /NaoVision/my_camera/image_raw" in refused(f("subscribe", id="my_camera"))
    succeed(f("subscribe", id="my_camera", topic_out="other"))


def test_pictures_of_any_camera_are_taken_without_a_robot(camera, vision, robot, play):
    robot.connection.generation = 0
    run = play(f("takePicture", str_param="a.png"), f("listThreads"))
    assert (run.end, [feedback.waiting for feedback in run.feedback]) == ("succeeded", ["", ""])


def test_files_that_are_there_are_replaced_only_on_demand(vision, refused, succeed, camera):
    succeed(f("takePicture", str_param="a.png"))
    before = (vision.files.folder / "a.png").read_bytes()
    assert "a.png is there already: another name, or overwrite" in refused(f("takePicture", str_param="a"))
    assert (vision.files.folder / "a.png").read_bytes() == before
    succeed(f("takePicture", str_param="a", overwrite=True))
    assert (vision.files.folder / "a.png").read_bytes() != before


# Pictures


def test_a_picture_is_the_cameras(vision, succeed, topics, edge):
    asked = edge.clock.now()
    topics.on_subscribe = lambda topic: topics.send(topic, numbered_image(200, edge.clock.now()))
    result = succeed(f("takePicture", camera="bottom", str_param="looks/one.png"))
    (picture,) = result.pictures
    path = vision.files.folder / "looks" / "one.png"
    assert (picture.path, picture.topic, picture.file_type, picture.encoding) == (str(path), BOTTOM, "png", "bgr8")
    assert (picture.width, picture.height, picture.header.frame_id) == (64, 48, "CameraTop_optical_frame")
    assert asked <= picture.header.stamp.to_sec() <= edge.clock.now()
    assert number_of(cv2.imread(str(path))) == 200
    assert result.results[0].values == [str(path)] and result.memList == []
    assert topics.count(BOTTOM) == 0


def test_frames_from_before_are_not_taken(vision, succeed, topics, edge):
    def late(topic):
        for number in (1, 2, 3):
            topics.send(topic, numbered_image(number, edge.clock.now() - 0.5))
            threading.Event().wait(0.02)
        topics.send(topic, numbered_image(4, edge.clock.now() + 0.1))

    topics.on_subscribe = lambda topic: threading.Thread(target=late, args=(topic,), daemon=True).start()
    (picture,) = succeed(f("takePicture")).pictures
    assert number_of(cv2.imread(picture.path)) == 4


def test_a_camera_with_another_clock_is_taken_at_its_word(vision, succeed, topics):
    ended = threading.Event()

    def run(topic):
        number = 0
        while not ended.wait(0.01):
            number += 1
            topics.send(topic, numbered_image(number % 256, 5.0 + number))

    topics.on_subscribe = lambda topic: threading.Thread(target=run, args=(topic,), daemon=True).start()
    (picture,) = succeed(f("takePicture", topic="/webcam")).pictures
    ended.set()
    assert picture.header.stamp.to_sec() < 1000.0
    assert Path(picture.path).name.startswith("picture_20")


@pytest.mark.parametrize("kind", ["jpg", "webp", "bmp", "tiff"])
def test_kinds_and_sizes_of_pictures(succeed, camera, kind):
    (picture,) = succeed(f("takePicture", file_type=kind, width=32)).pictures
    assert picture.path.endswith(f".{kind}") and Path(picture.path).name.startswith("top_20")
    assert cv2.imread(picture.path).shape == (24, 32, 3)
    assert (picture.width, picture.height) == (32, 24)


def test_several_pictures_at_an_interval(vision, succeed, camera, edge):
    asked = edge.clock.now()
    result = succeed(f("takePictures", count=4, interval=0.05, str_param="walk.jpg"))
    assert [Path(p.path).name for p in result.pictures] == [f"walk-00{k}.jpg" for k in (1, 2, 3, 4)]
    stamps = [p.header.stamp.to_sec() for p in result.pictures]
    assert all(asked + 0.05 * k <= stamp < asked + 0.05 * k + 3.0 for k, stamp in enumerate(stamps))
    assert stamps == sorted(set(stamps))
    done = [feedback.done for feedback in vision.server.feedback if feedback.status == "taking pictures"]
    assert done == [1, 2, 3, 4]


def test_pictures_without_a_name_have_names_of_their_own(succeed, camera):
    pictures = succeed(f("takePictures", count=5)).pictures
    assert len({picture.path for picture in pictures}) == 5


def test_preemption_ends_the_pictures_and_keeps_those_that_are_there(vision, topics, camera):
    thread = vision.server.play_in_background(NaoVisionGoal([f("takePictures", count=5000, interval=0.01)]))
    wait_for(lambda: any(feedback.done >= 3 for feedback in vision.server.feedback))
    vision.server.preempt()
    thread.join(10.0)
    assert (vision.server.end, vision.server.text) == ("preempted", "preempted in function 1 (takePictures)")
    assert 3 <= len(vision.server.result.pictures) < 5000
    assert all(Path(picture.path).is_file() for picture in vision.server.result.pictures)
    assert topics.count(TOP) == 0


def test_a_camera_that_sends_nothing_is_told(refused, topics):
    text = refused(f("takePicture", timeout=0.05))
    assert f"no picture came from {TOP} within 0.05 s: is its camera running?" in text
    assert topics.count(TOP) == 0


def test_a_picture_of_an_unknown_kind_is_told(vision, refused, topics, edge):
    topics.on_subscribe = lambda topic: topics.send(topic, image(edge.clock.now(), encoding="32FC1"))
    assert "a picture of encoding '32FC1' cannot be read: known are bgr8" in refused(f("takePicture"))
    assert not vision.files.folder.exists()


# The robot is not needed


def test_nothing_of_this_asks_the_robot(vision, robot, succeed, camera, device):
    succeed(f("takePicture"), f("subscribe", id="a"), f("startRecording", id="b"), f("stopRecording", id="b"))
    assert robot.proxy("ALVideoDevice").calls == []
    robot.connection.become("lost", "it is gone")
    succeed(f("takePicture"), f("listThreads"))
    assert vision.threads.get("a").runs


def test_the_action_is_that_of_the_contract(vision):
    assert NaoVisionGoal.__slots__[0] == "functions"
    assert vision.server.started
    assert re.fullmatch(r"NaoVision_\w+", vision.subscriber)
