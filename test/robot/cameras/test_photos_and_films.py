"""ALPhotoCapture and ALVideoRecorder over the network: what is in the files, and when it is there."""

import av
import cv2
import pytest

from nao_sim_bridge.naoqi.cameras.photographer import FORMATS

MAGIC = {"bmp": b"BM", "jpg": b"\xff\xd8\xff", "png": b"\x89PNG", "pbm": b"P4", "pgm": b"P5", "ppm": b"P6"}
MAGIC.update(sr=b"\x59\xa6\x6a\x95", tif=b"II*\0", dib=MAGIC["bmp"], jpeg=MAGIC["jpg"], jpe=MAGIC["jpg"])
MAGIC.update(ras=MAGIC["sr"], tiff=MAGIC["tif"])


@pytest.fixture
def folder(robot):
    return robot.server.files.folder


def refuses(module, table):
    for method, arguments, text in table:
        with pytest.raises(RuntimeError, match=f"::{method} .*{text}"):
            module.call(method, *arguments)


@pytest.fixture
def photos(robot):
    photos = robot.ALPhotoCapture
    found = [photos.getCameraID(), photos.getResolution(), photos.getColorSpace(), photos.getPictureFormat()]
    assert found == [0, 2, 13, "jpg"]
    assert (photos.getCaptureInterval(), photos.isHalfPressed(), photos.isHalfPressEnabled()) == (200, False, False)
    photos.setResolution(0)  # quick to draw
    return photos


@pytest.fixture
def here(robot):
    """Path on this computer of a file whose path on the robot was answered, as text."""
    return lambda answered: str(robot.server.files.to_read(answered))


@pytest.fixture
def take(robot, photos, here):
    """Takes a picture of a name; its path here."""
    return lambda name, after=0.2: here(robot.finish("ALPhotoCapture", "takePicture", "photos", name, after=after)[0])


def test_pictures_have_the_size_that_was_set_and_show_what_the_cameras_see(photos, take, folder):
    photos.setPictureFormat("png")
    photos.setResolution(1)
    path = take("one")
    assert path == str(folder / "photos" / "one.png")
    picture = cv2.imread(path)
    assert picture.shape == (240, 320, 3)
    blue, _, red = picture.astype(float).mean(axis=1).T
    assert blue[0] > red[0] + 10.0 and red[-1] > blue[-1] + 5.0  # sky above, floor below
    photos.setCameraID(1)
    below, _, red_below = cv2.imread(take("below")).astype(float)[0].mean(axis=0)
    assert below - red_below < blue[0] - red[0] - 10.0  # no sky
    photos.setColorSpace(0)
    assert cv2.imread(take("grey"), cv2.IMREAD_UNCHANGED).shape == (240, 320)


def test_every_format_is_what_its_name_says(photos, take):
    assert set(FORMATS) == set(MAGIC)
    for kind in FORMATS:
        photos.setPictureFormat(kind)
        path = take("picture", after=0.05)
        with open(path, "rb") as file:
            assert file.read(4).startswith(MAGIC[kind]), kind
        assert cv2.imread(path).shape == (120, 160, 3)


def test_a_series_takes_its_time_and_is_numbered(robot, photos, folder):
    photos.setCaptureInterval(300)
    future = robot.post("ALPhotoCapture", "takePictures", 3, "series", "day")
    robot.handed_over("ALPhotoCapture")
    robot.advance(0.59)
    assert future.isRunning()
    robot.advance(0.05)
    assert robot.answer(future) == [[f"/home/nao/series/day_{number}.jpg" for number in range(3)]]
    assert sorted(path.name for path in (folder / "series").iterdir()) == ["day_0.jpg", "day_1.jpg", "day_2.jpg"]
    alone = robot.finish("ALPhotoCapture", "takePictures", 1, "", "alone.jpg", after=0.1)
    assert alone == [["/home/nao/alone.jpg"]]


def test_what_is_there_already_is_kept_when_it_must_not_be_overwritten(robot, photos, folder):
    (folder / "kept_1.jpg").write_bytes(b"old")
    with pytest.raises(RuntimeError, match="kept_1.jpg' exists already, and is not to be overwritten"):
        photos.takePictures(2, "", "kept", False)
    assert not (folder / "kept_0.jpg").exists()
    robot.finish("ALPhotoCapture", "takePictures", 2, "", "kept", True, after=0.5)
    assert cv2.imread(str(folder / "kept_1.jpg")) is not None


def test_a_camera_that_is_held_ready_gives_its_picture_while_time_stands_still(robot, photos, take):
    assert photos.halfPress() and photos.isHalfPressed()
    robot.advance(0.2)
    assert take("one", after=0.0).endswith("one.jpg")
    photos.setResolution(1)  # counts from the next half press on
    robot.advance(0.1)
    assert cv2.imread(take("two", after=0.0)).shape == (120, 160, 3)
    photos.halfPress()
    assert not photos.isHalfPressed()
    assert cv2.imread(take("three")).shape == (240, 320, 3)
    photos.setHalfPressEnabled(True)
    take("four")
    assert photos.isHalfPressed() and photos.isHalfPressEnabled()


def test_what_photos_cannot_be_is_refused_with_what_they_can(photos):
    refuses(
        photos,
        [
            ("setCameraID", (2,), "camera is 2, allowed is one of 0 .top., 1 .bottom."),
            ("setResolution", (9,), "resolution is 9, allowed is one of"),
            ("setColorSpace", (11,), "colorSpace is 11, allowed is 0 .grey. or 13 .BGR."),
            ("setPictureFormat", ("gif",), "pictureFormat is 'gif', allowed is one of bmp"),
            ("takePictures", (0, "", "a"), "numberOfPictures is 0, allowed is a whole number, 1 to"),
            ("takePicture", ("a", 5), "fileName is 5, allowed is a text"),
            ("takePicture", ("../..", "a"), "is not inside"),
        ],
    )


@pytest.fixture
def films(robot):
    films = robot.ALVideoRecorder
    found = [films.getCameraID(), films.getResolution(), films.getColorSpace(), films.getFrameRate()]
    assert found == [0, 1, 13, 15] and films.getVideoFormat() == "MJPG" and not films.isRecording()
    films.setResolution(0)
    return films


def read(path):
    """Codec, size, rate and number of the frames of a film."""
    with av.open(str(path)) as film:
        stream = film.streams.video[0]
        count = sum(1 for _ in film.decode(stream))
        return stream.codec_context.name, (stream.width, stream.height), float(stream.average_rate), count


@pytest.mark.parametrize(
    "kind, resolution, rate, space, recorded",
    [("MJPG", 1, 30, 0, ("mjpeg", (320, 240), 30, 30)), ("IYUV", 0, 10, 13, ("rawvideo", (160, 120), 10, 10))]
    + [("MJPG", 0, 4.5, 13, ("mjpeg", (160, 120), 4.5, 5)), ("MJPG", 2, 30, 13, ("mjpeg", (640, 480), 15, 15))],
)
def test_a_film_has_a_frame_for_each_period_that_it_lasted(robot, films, kind, resolution, rate, space, recorded, here):
    films.setVideoFormat(kind)
    films.setResolution(resolution)
    films.setColorSpace(space)
    films.setFrameRate(rate)
    films.startRecording("films", "one")
    films.setResolution(1)  # what changes meanwhile counts for the next film
    assert films.isRecording()
    robot.advance(1.0)
    frames, path = films.stopRecording()
    assert not films.isRecording()
    assert path == "/home/nao/films/one.avi"
    assert read(here(path)) == recorded and frames == recorded[3]


def test_a_recording_goes_through_a_reset_and_there_is_one_at_a_time(robot, films, folder, here):
    films.startRecording("films", "first")
    with pytest.raises(RuntimeError, match="first.avi' is under way; stop it first"):
        films.startRecording("films", "second")
    assert not (folder / "films" / "second.avi").exists()
    robot.advance(0.2)
    robot.NaoSimulation.reset()
    robot.advance(0.2)
    frames, path = films.stopRecording()
    assert (frames, read(here(path))[3]) == (6, 6)
    assert films.stopRecording() == [0, ""]


def test_a_film_that_is_there_is_kept_when_it_must_not_be_overwritten(robot, films, folder, here):
    path = folder / "kept.avi"
    path.write_bytes(b"old")
    with pytest.raises(RuntimeError, match="kept.avi' exists already, and is not to be overwritten"):
        films.startRecording("", "kept", False)
    assert path.read_bytes() == b"old"
    films.startRecording("", "kept", True)
    robot.advance(0.2)
    assert read(here(films.stopRecording()[1]))[3] == 3


def test_what_films_cannot_be_is_refused_with_what_they_can(films):
    refuses(
        films,
        [
            ("setResolution", (3,), "resolution is 3, allowed is 0 .160x120., 1 .320x240. or 2 .640x480."),
            ("setColorSpace", (11,), "colorSpace is 11, allowed is 0 .grey. or 13 .BGR."),
            ("setFrameRate", (31.0,), "frameRate is 31.0, allowed is 1 to 30"),
            ("setVideoFormat", ("H264",), "videoFormat is 'H264', allowed is MJPG or IYUV"),
            ("startRecording", ("..", "a"), "is not inside"),
        ],
    )
    assert not films.isRecording()
