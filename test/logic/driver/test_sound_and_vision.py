"""Sound, speech and vision: requests, blocks of sound, settings of speech, and the values of the robot's events."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from std_msgs.msg import Header

from nao_library_modules.core.errors import BadGoal
from nao_library_modules.driver.audio import nao_microphone as blocks
from nao_library_modules.driver.audio.nao_audio import file_on_robot, read_direction, read_recording, read_volume
from nao_library_modules.driver.audio.nao_microphone import BlockClock, channel_map, read_samples
from nao_library_modules.driver.audio.robot_speech import (
    from_config,
    given_parameters,
    join_vocabulary,
    percent,
    split_vocabulary,
)
from nao_library_modules.driver.audio.speech_recognition import read_heard
from nao_library_modules.driver.sensors import nao_vision as vision
from nao_library_modules.driver.sensors.nao_vision import Face, MovementReader, to_face, to_landmarks, to_movement
from nao_library_modules.vision.detections import FACE, LANDMARK, Detection, DetectionArray
from nao_library_msgs.msg import FaceDetected
from naoqi.errors import NaoError


def refused(words, function, *arguments, error=NaoError, **more):
    with pytest.raises(error, match=words):
        function(*arguments, **more)


def test_a_recording_in_the_words_of_naoqi_and_files_are_in_the_home_of_the_robot():
    for name in ("music/rock.ogg", "/music/rock.ogg", "/home/nao/music/rock.ogg", "music/../music/rock.ogg"):
        assert file_on_robot(name) == "/home/nao/music/rock.ogg"
    for name in ("/usr/share/naoqi/wav/random.wav", "/tmp/a.wav"):
        assert file_on_robot(name) == name
    for name in ("", "../etc/passwd", "/home/nao/../root/a/../../..", "a/", "a\0b"):
        refused("file_path", file_on_robot, name, error=BadGoal)
    request = read_recording("day/one", 5, 1, (False, False, True, False), 16000)
    assert (request.file, request.kind) == ("/home/nao/day/one.ogg", "ogg")
    assert (request.seconds, request.rate, request.channels) == (5, 16000, (0, 0, 1, 0))
    assert read_recording("one.wav", 5, 0, (True,) * 4, 48000).file == "/home/nao/one.wav"
    assert (read_volume(0), read_volume(100)) == (0, 100)
    good = {"seconds": 1, "kind": 0, "channels": (True,) * 4, "rate": 48000}
    for field, change in (
        ("secs", {"seconds": 0}),
        ("audio_type", {"kind": 2}),
        ("samplerate", {"rate": 44100}),
        ("channels", {"channels": (False,) * 4}),
    ):
        refused(field, read_recording, "a.wav", error=BadGoal, **{**good, **change})
    refused("secs", read_recording, "a.wav", error=BadGoal, **{**good, "seconds": 3601})
    assert read_recording("/usr/share/naoqi/a.wav", **good).file == "/home/nao/usr/share/naoqi/a.wav"
    refused("master_volume", read_volume, 101, error=BadGoal)


BLOCK = 0.17


def test_microphones_are_in_the_corners_of_the_head_or_on_the_sides_of_older_heads():
    assert list(read_samples(b"\x01\x00\xff\xff\x00\x80\xff\x7f", 2, 2)) == [1, -1, -32768, 32767]
    refused("4 channels and 2 frames has 15 bytes", read_samples, bytes(15), 4, 2)
    for version in ("6.0.0", "V6.0", "", "unknown"):
        corners = (blocks.REAR_LEFT, blocks.REAR_RIGHT, blocks.FRONT_LEFT, blocks.FRONT_RIGHT)
        assert channel_map(4, version) == corners and channel_map(1, version) == (blocks.FRONT_LEFT,)
    for version in ("5.0.0", "V4.0", "4"):
        sides = (blocks.FRONT_LEFT, blocks.FRONT_RIGHT, blocks.FRONT_CENTER, blocks.REAR_CENTER)
        assert channel_map(4, version) == sides and channel_map(1, version) == (blocks.FRONT_CENTER,)


def stamp(seconds):
    return [int(seconds), round(1e6 * (seconds - int(seconds)))]


def test_times_of_the_first_sample_follow_the_quickest_blocks():
    clock, ahead = BlockClock(), 1000.0
    off = []
    for n, delay in enumerate([0.05, 0.03, 0.2, 0.01, 0.3, 0.02]):
        heard = 5.0 + n * BLOCK
        time = clock.take(stamp(heard), BLOCK, heard + BLOCK + ahead + delay)
        assert time.robot == pytest.approx(heard)
        off.append(time.ros - ahead - heard)
    assert off == pytest.approx([0.05, 0.03, 0.03, 0.01, 0.01, 0.01], abs=1e-3)
    assert clock.lost == 0
    clock.take(stamp(5.0 + 9 * BLOCK), BLOCK, 2000.0)
    assert clock.lost == 3  # of the blocks between
    assert clock.take(stamp(0.0), BLOCK, 2000.0).ros == pytest.approx(2000.0 - BLOCK)  # the robot has started again
    assert clock.lost == 3


def test_volume_is_percent_or_a_share_with_a_point():
    results = [(0, 0), (1, 1), (100, 100), (-1, -1), (0.0, 0), (1.0, 100), (0.55, 55)]
    assert [percent(volume) for volume, _ in results] == [result for _, result in results]
    for volume in (101, -2, 1.5, True, "50", float("nan")):
        refused("~volume", percent, volume)
    config = {"voice": " naoenu ", "language": "", "vocabulary": "", "audio_expression": True}
    config.update(visual_expression=False, word_spotting=False)
    found = from_config({**config, "volume": -1})
    assert (found.voice, found.language, found.volume, found.vocabulary) == ("naoenu", "", None, ())
    assert found.audio_expression and not found.visual_expression
    assert from_config({**config, "volume": 80}).volume == pytest.approx(0.8)


def test_parameters_of_former_versions_are_understood():
    given = {"pip": "10.0.0.7", "volume": 0.4, "vocabulary": ["yes", " good morning "], "enable_word_spotting": True}
    given.update(enable_audio_expression=False, audio_expression=True)
    expected = {"volume": 40, "vocabulary": "yes / good morning", "word_spotting": True, "audio_expression": False}
    assert given_parameters(given) == expected
    for name, value in (("voice", 3), ("vocabulary", [1]), ("word_spotting", 1), ("volume", "loud")):
        refused(f"~{name}", given_parameters, {name: value})


def test_vocabulary_as_one_text_and_back():
    words = split_vocabulary(" yes / good morning //no/")
    assert words == ("yes", "good morning", "no") == split_vocabulary(join_vocabulary(words))
    refused("separates words", join_vocabulary, ["and/or"])
    refused("is empty", join_vocabulary, ["yes", " "])


def test_events_of_words_and_of_a_direction_are_read():
    for value, words in (
        (["<...> good morning <...>", 0.5], ("good morning",)),
        (["yes", 0.5, "", 0.0], ("yes",)),
        (["<...> <...>", 0.5], None),
        (None, None),
    ):
        assert getattr(read_heard(value), "words", None) == words
    found = read_direction([[12, 500000], [0.5, -0.1, 0.9, 0.04], [0.0, 0.0, 0.1265, 0.0, 0.1, 0.2], [0.0] * 6])
    assert found.time == pytest.approx(12.5)
    assert (found.azimuth, found.elevation, found.confidence, found.energy) == (0.5, -0.1, 0.9, 0.04)
    assert found.head_in_torso == (0.0, 0.0, 0.1265, 0.0, 0.1, 0.2)
    for value in (None, [], [[1, 2], [], [0.0] * 6], [[1, 2], [0.1, 0.2, 0.3], [0.0]]):
        assert read_direction(value) is None


HEADER = Header(frame_id="CameraBottom_optical_frame")
STAMP = [12, 500000]
TORSO = [0.05, 0.01, 0.2, 0.0, 0.02, 0.5]
FEET = [0.06, 0.02, 0.5, 0.0, 0.03, 0.6]
LEFT_EYE = [0.01 * number for number in range(6)] + [0.0] * 8
RIGHT_EYE = [-0.01 * number for number in range(6)] + [0.0] * 8
MOUTH = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6] + [0.0] * 10
EXTRA = [3, 0.75, "ada", LEFT_EYE, RIGHT_EYE, [], [], [0.5, 0.6, 0.7, 0.8, 0.9, 1.0], MOUTH]


def shape(seen):
    return seen.alpha, seen.beta, seen.size_x, seen.size_y


def test_faces_with_all_their_points_and_what_is_new_about_them_is_no_face():
    second = [[0, -0.3, 0.0, 0.1, 0.1], [4, 0.0, ""]]
    value = [STAMP, [[[0, 0.1, -0.2, 0.15, 0.18], EXTRA], second, [2, ["ada"]]], TORSO, FEET, 1]
    view, (face, other) = vision.read_faces(value)
    assert (view.time, view.camera, view.in_torso, view.in_robot) == (12.5, 1, tuple(TORSO), tuple(FEET))
    assert shape(face.shape) == (0.1, -0.2, 0.15, 0.18)
    assert (face.number, face.score, face.label) == (3, 0.75, "ada")
    assert face.points["left_eye_earSideLimit"] == (0.04, 0.05)
    assert face.points["right_eye_noseSideLimit"] == (-0.02, -0.03)
    assert face.points["nose_bottomRightLimit"] == (0.9, 1.0)
    assert face.points["mouth_topLimit"] == (0.5, 0.6)
    assert not any("eyebrow" in name for name in face.points)
    assert (other.number, other.label, other.points) == (4, "", {})


def test_landmarks_are_read_and_their_number_may_be_bare():
    marks = [[[1, 0.1, 0.2, 0.05, 0.06, 0.0], [84]], [[1, -0.1, 0.3, 0.07, 0.08, 0.0], 119]]
    seen = vision.read_landmarks([STAMP, marks, TORSO, FEET, "CameraBottom"])
    assert (seen.time, seen.camera, seen.in_robot) == (12.5, 1, tuple(FEET))
    told = [(mark.name, shape(mark)) for mark in seen.detections]
    assert told == [("84", (0.1, 0.2, 0.05, 0.06)), ("119", (-0.1, 0.3, 0.07, 0.08))]
    for told in ([STAMP, marks], [STAMP, marks, [], [], "Other"]):  # of robots that do not tell where their camera is
        older = vision.read_landmarks(told)
        assert (older.camera, older.in_torso, older.detections) == (0, (0.0,) * 6, seen.detections)


def test_nothing_seen_is_none():
    for value in ([], None, [STAMP]):
        assert vision.read_faces(value) is None and MovementReader().read(value) is None
    assert vision.read_landmarks([]) is None
    for empty in ([[]], [[4]], 5):
        assert vision.read_faces([STAMP, empty, TORSO, FEET, 0]) is None
    assert vision.read_landmarks([STAMP, [], TORSO, FEET, "CameraTop"]) is None
    assert MovementReader().read([STAMP, [], TORSO, FEET, 0]) is None


def movement(time, *clusters):
    return [[int(time), round(time % 1 * 1e6)], [list(cluster) for cluster in clusters], TORSO, FEET, 0]


def test_what_moved_and_how_fast_from_one_time_to_the_next():
    reader = MovementReader()
    first = reader.read(movement(5.0, ([0.2, 0.1], [0.25, 0.05, 0.1, 0.1], 0.5), ([-0.3, 0.0], [0, 0, 0.1, 0.1], 0.5)))
    assert first.points == ((0.2, 0.1), (-0.3, 0.0)) and (first.view.time, first.view.camera) == (5.0, 0)
    assert first.centre == (pytest.approx(-0.05), pytest.approx(0.05))
    assert first.velocity == (0.0, 0.0) and first.velocities == ((0.0, 0.0), (0.0, 0.0))
    then = reader.read(movement(5.2, ([-0.3, 0.02], [0, 0, 0.1, 0.1], 0.5), ([0.3, 0.1], [0, 0, 0.1, 0.1], 0.5)))
    assert then.velocities == ((0.0, pytest.approx(0.1)), (pytest.approx(0.5), 0.0))
    assert then.velocity == (pytest.approx(0.25), pytest.approx(0.05))
    for time in (9.0, 2.0):  # over a long time or backwards there is no speed
        assert reader.read(movement(time, ([0.1, 0.0], [0, 0, 0.1, 0.1], 0.5))).velocities == ((0.0, 0.0),)


def test_what_moves_more_counts_more_and_the_layout_of_robots_before_2_0():
    big, small = ([0.4, 0.0], [0, 0, 0.2, 0.2], 0.75), ([0.0, 0.0], [0, 0, 0.1, 0.1], 1.0)
    assert MovementReader().read(movement(5.0, big, small)).centre == (pytest.approx(0.3), 0.0)
    found = MovementReader().read([[[0.1, 0.2], [0.3, 0.4], [[0.1, 0.2], [0.5, 0.6]], [[0.3, 0.4], [0.7, 0.8]]]])
    assert (found.view, found.centre, found.velocity) == (None, (0.1, 0.2), (0.3, 0.4))
    assert found.points[1] == (0.5, 0.6) and found.velocities[1] == (0.7, 0.8)
    message = to_movement(found, HEADER)
    assert (message.gravity_center.x, message.gravity_center.y) == (0.1, 0.2)
    assert (message.mean_velocity.x, message.mean_velocity.y) == (0.3, 0.4)
    assert [(each.x, each.y) for each in message.points_poses] == [(0.1, 0.2), (0.5, 0.6)]
    assert [(each.x, each.y) for each in message.points_speeds] == [(0.3, 0.4), (0.7, 0.8)]


VIEW = DetectionArray(5.0, 1, (0.1, 0.2, 0.3, 0.0, 0.0, math.pi / 2), (0.4, 0.5, 0.6, math.pi, 0.0, 0.0), ())


def test_every_point_of_a_face_has_its_field():
    names = [f"{part}_{point}" for part, points in vision.PARTS for point in points]
    points = {name: (0.01 * place, -0.01 * place) for place, name in enumerate(names)}
    seen = Detection(FACE, "ada", "#3", 0.75, 0.1, -0.2, 0.15, 0.18)
    message = to_face(Face(seen, 3, 0.75, "ada", points), VIEW, HEADER)
    found = {name: (getattr(message, f"{name}_x").data, getattr(message, f"{name}_y").data) for name in names}
    assert found == points
    fields = {name for name in FaceDetected.__slots__ if name.endswith(("_x", "_y"))}
    assert fields == {f"{name}_{axis}" for name in names for axis in "xy"}
    assert (message.face_id.data, message.score_reco.data, message.face_label.data) == (3, 0.75, "ada")
    assert (message.shape_alpha.data, message.shape_sizeY.data, message.camera_id.data) == (0.1, 0.18, 1)
    assert message.header.frame_id == HEADER.frame_id


def test_landmarks_are_in_one_message_with_the_poses_of_the_camera():
    shapes = {"84": (0.1, 0.2, 0.05, 0.06), "119": (-0.1, 0.3, 0.07, 0.08)}
    marks = tuple(Detection(LANDMARK, name, name, 1.0, *angles) for name, angles in shapes.items())
    message = to_landmarks(replace(VIEW, detections=marks), HEADER)
    assert [each.data for each in message.mark_ids] == [84, 119]
    assert [each.data for each in message.shape_beta] == [0.2, 0.3]
    assert [each.data for each in message.shape_sizex] == [0.05, 0.07]
    assert [each.data for each in message.shape_sizey] == [0.06, 0.08]
    local, world = message.camera_local_pose, message.camera_world_pose
    assert (local.position.x, local.position.y, local.position.z) == (0.1, 0.2, 0.3)
    assert (local.orientation.z, local.orientation.w) == (pytest.approx(math.sqrt(0.5)), pytest.approx(math.sqrt(0.5)))
    assert (world.orientation.x, world.orientation.w) == (pytest.approx(1.0), pytest.approx(0.0))
    assert message.camera_name.data == "CameraBottom"
