"""Streams and recordings by themselves: frames and time come from the test."""

from __future__ import annotations

import pytest
from camera_topics import CAMERA, OUT, HandClock, Topics, numbered_image

from nao_library_modules.vision.capture_jobs import Stream, VideoRecording, VideoSpec
from nao_library_modules.vision.video import VisionFiles


@pytest.fixture
def topics():
    return Topics()


@pytest.fixture
def clock():
    return HandClock()


@pytest.fixture
def files(tmp_path):
    return VisionFiles(str(tmp_path))


@pytest.fixture
def started():
    """Starts what it gets; everything is stopped at the end."""
    made = []

    def start(one):
        made.append(one)
        one.start()
        return one

    yield start
    for one in made:
        one.stop(at_once=True)


@pytest.fixture
def stream(topics, clock, started):
    return lambda rate=0.0, out=OUT, width=0, height=0: started(
        Stream("s", CAMERA, rate, topics, clock, out, width, height)
    )


@pytest.fixture
def recording(topics, clock, files, started):
    def make(name="walk.mp4", rate=0.0, **fields):
        spec = VideoSpec(files.folder / name if name else None, "mp4", "h264", **fields)
        return started(VideoRecording("r", CAMERA, rate, topics, clock, files, spec))

    return make


@pytest.fixture
def send(topics, clock):
    """Sends frames at 10 a second, numbered on."""
    numbers = iter(range(256))

    def some(count=1, topic=CAMERA):
        for _ in range(count):
            clock.time += 0.1
            topics.send(topic, numbered_image(next(numbers), clock.time))

    return some
