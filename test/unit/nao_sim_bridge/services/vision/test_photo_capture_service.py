"""ALPhotoCapture over the network: what is in the files, and when it is there."""

from __future__ import annotations

import cv2
import pytest

from nao_sim_bridge.services.vision.photo_capture_files import FORMATS

MAGIC = {
    "bmp": b"BM",
    "dib": b"BM",
    "jpeg": b"\xff\xd8\xff",
    "jpg": b"\xff\xd8\xff",
    "jpe": b"\xff\xd8\xff",
    "png": b"\x89PNG",
    "pbm": b"P4",
    "pgm": b"P5",
    "ppm": b"P6",
    "sr": b"\x59\xa6\x6a\x95",
    "ras": b"\x59\xa6\x6a\x95",
    "tiff": b"II*\0",
    "tif": b"II*\0",
}


@pytest.fixture
def photos(robot):
    photos = robot.ALPhotoCapture
    photos.setResolution(0)  # quick to draw
    yield photos
    photos.setHalfPressEnabled(False)
    if photos.isHalfPressed():
        photos.halfPress()
    for method, value in [("setColorSpace", 13), ("setPictureFormat", "jpg"), ("setCaptureInterval", 200)]:
        photos.call(method, value)


@pytest.fixture
def folder(robot):
    return robot.server.files.folder


def test_defaults_are_those_of_the_robot(shared_robot):
    photos = shared_robot.ALPhotoCapture
    found = [photos.getCameraID(), photos.getResolution(), photos.getColorSpace(), photos.getPictureFormat()]
    assert found == [0, 2, 13, "jpg"]
    assert (photos.getCaptureInterval(), photos.isHalfPressed(), photos.isHalfPressEnabled()) == (200, False, False)


def test_a_picture_has_the_size_that_was_set_and_shows_what_the_camera_sees(robot, photos, folder):
    photos.setPictureFormat("png")
    photos.setResolution(1)
    (path,) = robot.finish("ALPhotoCapture", "takePicture", "/home/nao/photos", "one", after=0.2)
    assert path == str(folder / "photos" / "one.png")
    picture = cv2.imread(path)
    assert picture.shape == (240, 320, 3)
    blue, _, red = picture.astype(float).mean(axis=1).T
    assert blue[0] > red[0] + 10.0 and red[-1] > blue[-1] + 5.0  # sky above, floor below


@pytest.mark.parametrize("kind", FORMATS)
def test_every_format_is_what_its_name_says(robot, photos, kind):
    photos.setPictureFormat(kind)
    (path,) = robot.finish("ALPhotoCapture", "takePicture", "formats", "picture", after=0.2)
    with open(path, "rb") as file:
        assert file.read(4).startswith(MAGIC[kind])
    assert cv2.imread(path).shape == (120, 160, 3)


def test_grey_pictures_are_grey(robot, photos):
    photos.setColorSpace(0)
    photos.setPictureFormat("png")
    (path,) = robot.finish("ALPhotoCapture", "takePicture", "grey", "picture", after=0.2)
    assert cv2.imread(path, cv2.IMREAD_UNCHANGED).shape == (120, 160)


def test_a_series_takes_its_time_and_is_numbered(robot, photos, folder):
    photos.setCaptureInterval(300)
    future = robot.post("ALPhotoCapture", "takePictures", 3, "series", "day")
    robot.handed_over("ALPhotoCapture")
    robot.advance(0.59)
    assert future.isRunning()
    robot.advance(0.05)
    assert robot.answer(future) == [[str(folder / "series" / f"day_{number}.jpg") for number in range(3)]]
    assert sorted(path.name for path in (folder / "series").iterdir()) == ["day_0.jpg", "day_1.jpg", "day_2.jpg"]


def test_a_series_of_one_has_the_name_as_given(robot, photos, folder):
    answer = robot.finish("ALPhotoCapture", "takePictures", 1, "", "alone.jpg", after=0.1)
    assert answer == [[str(folder / "alone.jpg")]]


def test_what_is_there_already_is_kept_when_it_must_not_be_overwritten(robot, photos, folder):
    (folder / "kept_1.jpg").write_bytes(b"old")
    with pytest.raises(RuntimeError, match="kept_1.jpg' exists already, and is not to be overwritten"):
        photos.takePictures(2, "", "kept", False)
    assert not (folder / "kept_0.jpg").exists()
    robot.finish("ALPhotoCapture", "takePictures", 2, "", "kept", True, after=0.5)
    assert cv2.imread(str(folder / "kept_1.jpg")) is not None


def test_a_camera_that_is_held_ready_gives_its_picture_while_time_stands_still(robot, photos):
    assert photos.halfPress() and photos.isHalfPressed()
    robot.advance(0.2)
    assert photos.takePicture("held", "one")[0].endswith("one.jpg")
    photos.setResolution(1)  # counts from the next half press on
    robot.advance(0.1)
    (path,) = photos.takePicture("held", "two")
    assert cv2.imread(path).shape == (120, 160, 3)
    photos.halfPress()
    assert not photos.isHalfPressed()
    (path,) = robot.finish("ALPhotoCapture", "takePicture", "held", "three", after=0.2)
    assert cv2.imread(path).shape == (240, 320, 3)


def test_a_held_camera_begins_a_series_at_once(robot, photos):
    photos.halfPress()
    robot.advance(0.2)
    future = robot.post("ALPhotoCapture", "takePictures", 3, "held", "series")
    robot.handed_over("ALPhotoCapture")
    robot.advance(0.45)
    assert len(robot.answer(future)[0]) == 3


def test_the_camera_stays_held_after_a_picture_when_that_is_enabled(robot, photos):
    photos.setHalfPressEnabled(True)
    assert not photos.isHalfPressed()
    robot.finish("ALPhotoCapture", "takePicture", "held", "four", after=0.2)
    assert photos.isHalfPressed() and photos.isHalfPressEnabled()
    photos.setHalfPressEnabled(False)
    assert not photos.isHalfPressed()


def test_a_cancelled_series_ends_at_once_and_keeps_what_it_has(robot, photos, folder):
    future = robot.post("ALPhotoCapture", "takePictures", 100, "cancelled", "many")
    robot.handed_over("ALPhotoCapture")
    robot.advance(0.5)
    future.cancel()
    future.wait(int(1000 * robot.patience))
    assert future.isFinished() or future.isCanceled()
    robot.advance(1.0)
    assert 1 <= len(list((folder / "cancelled").iterdir())) <= 4


@pytest.mark.parametrize(
    "method, arguments, message",
    [
        ("setCameraID", (2,), "camera is 2, allowed is one of 0 .top., 1 .bottom."),
        ("setResolution", (9,), "resolution is 9, allowed is one of"),
        ("setColorSpace", (11,), "colorSpace is 11, allowed is 0 .grey. or 13 .BGR."),
        ("setCaptureInterval", (0,), "captureInterval is 0, allowed is 1 to"),
        ("setPictureFormat", ("gif",), "pictureFormat is 'gif', allowed is one of bmp"),
        ("takePictures", (0, "", "a"), "numberOfPictures is 0, allowed is a whole number, 1 to"),
        ("takePictures", ("a", "", "a"), "numberOfPictures is 'a', allowed is a whole number"),
        ("takePicture", ("a", 5), "fileName is 5, allowed is a text"),
        ("takePicture", ([1], "a"), r"folderPath is .1.?., allowed is a text"),
        ("takePicture", ("a", "x" * 1000000), "fileName is 'x{40}...', allowed is 4000 characters at most"),
        ("setColorSpace", ([13],), "colorSpace is"),
        ("takePicture", ("a", ""), "fileName is '', allowed is the name of a file"),
        ("takePicture", ("../..", "a"), "is not inside"),
        ("takePicture", ("/tmp", "a"), "is not inside"),
    ],
)
def test_what_is_refused_names_what_is_allowed(photos, method, arguments, message):
    with pytest.raises(RuntimeError, match=f"ALPhotoCapture::{method} .*{message}"):
        photos.call(method, *arguments)


def test_a_folder_that_is_a_file_is_refused(photos, folder):
    (folder / "no_folder").write_text("file")
    with pytest.raises(RuntimeError, match="no_folder"):
        photos.takePicture("no_folder", "a")


def test_pictures_of_the_bottom_camera_show_the_floor(robot, photos):
    photos.setCameraID(1)
    (bottom,) = robot.finish("ALPhotoCapture", "takePicture", "cameras", "bottom", after=0.2)
    photos.setCameraID(0)
    (top,) = robot.finish("ALPhotoCapture", "takePicture", "cameras", "top", after=0.2)
    (blue_below, _, red_below), (blue_ahead, _, red_ahead) = (
        cv2.imread(path).astype(float)[0].mean(axis=0) for path in (bottom, top)
    )
    assert blue_below - red_below < blue_ahead - red_ahead - 10.0  # no sky
