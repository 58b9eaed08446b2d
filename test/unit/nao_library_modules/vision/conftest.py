"""The module for vision on stand-ins, and streams and recordings by themselves."""

from __future__ import annotations

from contextlib import contextmanager

import pytest
from fake_vision import FakeTopics, FakeVideoDevice, numbered_image
from vision_thread_tools import CAMERA, OUT, HandClock


@pytest.fixture
def topics():
    return FakeTopics()


@pytest.fixture
def device(robot):
    device = FakeVideoDevice()
    robot.add("ALVideoDevice", device)
    return device


@pytest.fixture
def vision(robot, edge, topics, device, tmp_path):
    from nao_library_modules.vision import NaoVision

    # No goal asks the extractors here.
    robot.connection.state = "connecting"
    vision = NaoVision("10.0.0.7", 9559, robot=robot, edge=edge, topics=topics, record_dir=str(tmp_path / "files"))
    yield vision
    vision.threads.close()


@pytest.fixture
def play(vision):
    from nao_library_actions.msg import NaoVisionGoal

    return lambda *functions: vision.server.play(NaoVisionGoal(list(functions)))


@pytest.fixture
def clock():
    return HandClock()


@pytest.fixture
def files(tmp_path):
    from nao_library_modules.vision_files import VisionFiles

    return VisionFiles(str(tmp_path))


@contextmanager
def all_stopped():
    """Gives a function that starts what it gets; everything that it got is stopped at the end."""
    made = []

    def started(one):
        made.append(one)
        one.start()
        return one

    yield started
    for one in made:
        one.stop(at_once=True)


@pytest.fixture
def stream(topics, clock):
    from nao_library_modules.vision_stream import Stream

    with all_stopped() as started:
        yield lambda rate=0.0, out=OUT, width=0, height=0: started(
            Stream("s", CAMERA, rate, topics, clock, out, width, height)
        )


@pytest.fixture
def recording(topics, clock, files):
    from nao_library_modules.vision_recorder import Recording, VideoWish

    with all_stopped() as started:

        def make(name="walk.mp4", rate=0.0, **fields):
            wish = VideoWish(files.folder / name if name else None, "mp4", "h264", **fields)
            return started(Recording("r", CAMERA, rate, topics, clock, files, wish))

        yield make


@pytest.fixture
def send(topics, clock):
    """Sends frames at 10 a second, numbered on."""
    numbers = iter(range(256))

    def some(count=1, topic=CAMERA):
        for _ in range(count):
            clock.time += 0.1
            topics.send(topic, numbered_image(next(numbers), clock.time))

    return some
