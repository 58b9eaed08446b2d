"""Videos: every frame at its time, sizes that change, files that end too soon. Read back with PyAV and OpenCV."""

from __future__ import annotations

import av
import numpy as np
import pytest
from camera_topics import number_of, numbered

from nao_library_modules.core.files import WholeFile
from nao_library_modules.vision.video import VideoFile, codec_name, known_codecs

UNEVEN = [100.0, 100.033, 100.066, 100.5, 100.533, 102.0, 102.1, 102.2]
EVERY = [(kind, codec) for kind in ("mp4", "avi") for codec in known_codecs(kind)]


def grey(level, size):
    return np.full((size[1], size[0], 3), level, np.uint8)


@pytest.fixture
def path(tmp_path):
    return tmp_path / "video.mp4"


def write(path, stamps, kind="mp4", codec="h264", size=(64, 48)):
    video = VideoFile(WholeFile(path), kind, codec, *size)
    for number, stamp in enumerate(stamps):
        video.write(numbered(number) if size == (64, 48) else grey(9, size), stamp)
    video.close()
    return video


def read(path):
    """Times in s and numbers of the frames, and the length of the whole in s."""
    with av.open(str(path)) as container:
        frames = [(float(f.pts * f.time_base), f.to_ndarray(format="bgr24")) for f in container.decode(video=0)]
        return [time for time, _ in frames], [number_of(p) for _, p in frames], (container.duration or 0) / 1e6


@pytest.mark.parametrize("kind, codec", EVERY)
def test_every_frame_stands_at_its_time(path, kind, codec):
    video = write(path, UNEVEN, kind, codec)
    times, numbers, length = read(path)
    assert numbers == list(range(len(UNEVEN)))
    slack = {"mp4": 1e-4, "avi": 0.5 / 120 + 1e-4}[kind]  # an AVI has a grid of 1/120 s
    assert times == pytest.approx([stamp - UNEVEN[0] for stamp in UNEVEN], abs=slack)
    assert video.duration == pytest.approx(2.3)
    assert length == pytest.approx(2.3, abs=0.11 if kind == "avi" else 0.01)  # where the last frame lasts one step
    assert (video.frames, video.dropped, video.began) == (len(UNEVEN), 0, UNEVEN[0])


def test_frames_that_come_twice_are_left_out_and_counted(path):
    video = write(path, [1.0, 1.1, 1.1, 1.05, 1.2])
    assert (video.frames, video.dropped, read(path)[1]) == (3, 2, [0, 1, 4])


def test_a_camera_that_changes_its_size_is_made_to_fit(path):
    video = VideoFile(WholeFile(path), "mp4", "h264", 64, 48)
    for number, size in enumerate([(64, 48), (128, 96), (32, 24), (64, 64)]):
        video.write(grey(50 + 50 * number, size), number / 10.0)
    video.close()
    with av.open(str(path)) as container:
        pictures = [f.to_ndarray(format="bgr24") for f in container.decode(video=0)]
    assert [picture.shape for picture in pictures] == [(48, 64, 3)] * 4
    assert [picture[:, 16:48].mean() for picture in pictures] == pytest.approx([50, 100, 150, 200], abs=6)
    assert pictures[3][:, :6].mean() == pytest.approx(0, abs=6)  # black beside what is higher than wide


def test_codecs_have_several_names():
    assert {("mp4", "h264"), ("mp4", "mpeg4"), ("avi", "mjpeg"), ("avi", "mpeg4"), ("avi", "ffv1")} <= set(EVERY)
    named = [codec_name(name, "mp4") for name in ("", "H264", "X264", "XVID", "mp4v", "nope")]
    assert named == ["h264", "h264", "h264", "mpeg4", "mpeg4", "nope"]
    assert codec_name("", "avi") == codec_name("MJPG", "avi") == "mjpeg"
