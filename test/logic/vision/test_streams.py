"""Streams: what goes through, in which size, rate and encoding."""

from __future__ import annotations

import pytest
from camera_topics import CAMERA, OUT, compressed, image, number_of, numbered, numbered_image, numbers_of, wait_for
from sensor_msgs.msg import CameraInfo, CompressedImage, Image

from nao_library_modules.vision.capture_jobs import info_topic
from nao_library_modules.vision.pictures import encoded, picture_of


def test_frames_pass_a_stream_as_they_are(stream, topics, send):
    one = stream()
    send(3)
    one.stop()
    sent = topics.publishers[OUT].messages
    assert topics.publishers[OUT].kind is Image and topics.publishers[OUT].closed
    assert numbers_of(sent) == [0, 1, 2]
    assert [message.header.stamp.to_sec() for message in sent] == pytest.approx([50.1, 50.2, 50.3])
    assert sent[0].header.frame_id == "CameraTop_optical_frame"


def test_a_stream_has_another_size_and_rate(stream, topics, send):
    one = stream(rate=5.0, height=24)
    send(10)
    one.stop()
    sent = topics.publishers[OUT].messages
    assert numbers_of(sent) == [0, 2, 4, 6, 8]
    assert {(m.width, m.height, m.step, len(m.data), m.encoding) for m in sent} == {(32, 24, 96, 96 * 24, "bgr8")}
    report = one.report()
    assert (report.frames, report.dropped, report.width, report.height) == (5, 0, 32, 24)


@pytest.mark.parametrize("encoding, pixel", [("mono8", (70,)), ("mono16", (70, 1))])
def test_grey_stays_grey(stream, topics, clock, encoding, pixel):
    one = stream(width=32)
    topics.send(CAMERA, image(clock.time, pixel, encoding=encoding))
    one.stop()
    (message,) = topics.publishers[OUT].messages
    assert (message.encoding, message.width, bytes(message.data)) == (encoding, 32, bytes(pixel) * 32 * 24)


def test_a_stream_compresses_and_decompresses(stream, topics, clock):
    one = stream(out="/out/image_raw/compressed")
    topics.send(CAMERA, numbered_image(77, clock.time))
    topics.send(CAMERA, compressed(clock.time, encoded(numbered(78), "png"), "png"))
    one.stop()
    publisher = topics.publishers["/out/image_raw/compressed"]
    first, second = publisher.messages
    assert publisher.kind is CompressedImage
    assert first.format == "bgr8; jpeg compressed bgr8" and number_of(picture_of(first)) == 77
    assert second.format == "png" and number_of(picture_of(second)) == 78
    two = stream()
    topics.send(CAMERA, compressed(clock.time, encoded(numbered(78), "png"), "png"))
    two.stop()
    (message,) = topics.publishers[OUT].messages
    assert (message.encoding, number_of(picture_of(message))) == ("bgr8", 78)


def test_a_streams_camera_info_is_in_its_size(stream, topics, clock):
    one = stream(width=32)
    topics.send(CAMERA, image(clock.time))  # nothing is known of the camera yet
    wait_for(lambda: one.report().frames == 1)
    calibration = CameraInfo(width=64, height=48, distortion_model="plumb_bob", D=[0.1] * 5)
    calibration.K = [60.0, 0.0, 32.0, 0.0, 62.0, 24.0, 0.0, 0.0, 1.0]
    calibration.P = [60.0, 0.0, 32.0, 8.0, 0.0, 62.0, 24.0, 0.0, 0.0, 0.0, 1.0, 0.0]
    calibration.roi.width, calibration.roi.x_offset = 20, 10
    topics.send("/camera/camera_info", calibration)
    topics.send(CAMERA, image(clock.time))
    one.stop()
    (info,) = topics.publishers["/out/camera_info"].messages
    assert (info.width, info.height, info.distortion_model, list(info.D)) == (32, 24, "plumb_bob", [0.1] * 5)
    assert info.K == [30.0, 0.0, 16.0, 0.0, 31.0, 12.0, 0.0, 0.0, 1.0]
    assert info.P == [30.0, 0.0, 16.0, 4.0, 0.0, 31.0, 12.0, 0.0, 0.0, 0.0, 1.0, 0.0]
    assert (info.roi.width, info.roi.x_offset) == (10, 5)
    assert info.header == topics.publishers[OUT].messages[1].header
    assert topics.count("/camera/camera_info") == 0 and topics.publishers["/out/camera_info"].closed


def test_camera_info_is_beside_the_pictures():
    for topic, beside in (
        ("/a/image_raw", "/a/camera_info"), ("/a/image_raw/compressed", "/a/camera_info"),
        ("/image", "/camera_info"), ("/relay", ""), ("/a/compressed", ""),
    ):  # fmt: skip
        assert info_topic(topic) == beside
