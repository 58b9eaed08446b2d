"""What looks through a camera for an extractor: when it looks, at what, how often, and what it survives."""

from __future__ import annotations

import logging
import queue
import threading
from collections import deque

import numpy as np
import pytest

from nao_sim_bridge.services.errors import NaoqiError
from nao_sim_bridge.services.extractor import Subscription
from nao_sim_bridge.services.vision.vision_extractor import VisionExtractor
from nao_sim_bridge.services.vision.watching import Watching
from nao_sim_bridge.sim.cameras.frame import Frame
from nao_sim_bridge.sim.cameras.settings import load_cameras
from nao_sim_bridge.sim.cameras.stream import CameraClosed
from nao_sim_bridge.sim.errors import BadValue, SimulationError

POSE = (0.0, 0.0, 0.1, 0.0, 0.0, 0.0)


class FakeStream:
    """Gives the frames that a test puts into it."""

    def __init__(self, camera, resolution, fps):
        self.camera, self.resolution, self.fps = camera, resolution, fps
        self._frames = deque()
        self._news = threading.Condition()
        self._closed = False

    def take(self, timeout):
        with self._news:
            if not self._news.wait_for(lambda: self._frames or self._closed, timeout):
                raise TimeoutError("nothing is due")
            if self._closed:
                raise CameraClosed("closed")
            frame = self._frames.popleft()
        if isinstance(frame, Exception):
            raise frame
        return frame

    def put(self, frame):
        with self._news:
            self._frames.append(frame)
            self._news.notify()

    def close(self):
        with self._news:
            self._closed = True
            self._news.notify()


class FakeCameras:
    """Opens fake streams and remembers them."""

    def __init__(self):
        self.streams = []
        self.active = 0

    def open(self, name, camera, resolution, color_space, fps, every):
        assert (name, color_space, every) == ("ALTestDetection", 13, True)
        self.streams.append(FakeStream(camera, resolution, fps))
        return self.streams[-1]


class FakeDetector:
    """Finds the number in the first pixel, or fails when that is 255."""

    def __init__(self):
        self.closed = 0

    def detect(self, image, optics, settings):
        number = int(image[0, 0, 0])
        if number == 255:
            raise SimulationError("cannot look at this")
        return [number, settings]

    def close(self):
        self.closed += 1


class Eyes:
    """A watching with fake cameras and a fake detector."""

    def __init__(self, patience, **options):
        self.patience = patience
        self.cameras, self.detector = FakeCameras(), FakeDetector()
        self.results = queue.Queue()
        self.stops = 0
        self.watching = Watching(
            self.cameras,
            "ALTestDetection",
            self.detector,
            lambda frame, found: self.results.put((frame.time, *found)),
            settings=lambda frame: f"seen at {frame.time:g}",
            on_stop=self._stopped,
            **options,
        )

    def _stopped(self):
        self.stops += 1

    @property
    def stream(self):
        return self.cameras.streams[-1]

    def subscribe(self, **periods):
        if not self.watching.looks and not self.watching.paused:
            self.watching.start()
        self.watching.changed({name: Subscription(period, 0.0) for name, period in periods.items()})

    def show(self, number, time, camera=0):
        pixels = np.full((2, 2, 3), number, np.uint8).tobytes()
        self.stream.put(Frame(time, camera, 2, 2, 13, 3, pixels, 0.9, 0.7, POSE, POSE))

    def result(self):
        return self.results.get(timeout=self.patience)


@pytest.fixture
def eyes_of(patience):
    made = []

    def make(**options):
        made.append(Eyes(patience, **options))
        return made[-1]

    yield make
    for eyes in made:
        eyes.watching.stop()


@pytest.fixture
def eyes(eyes_of):
    return eyes_of()


def test_it_looks_from_the_first_subscriber_to_the_last(eyes):
    assert not eyes.watching.looks and eyes.cameras.streams == []
    eyes.subscribe(one=0)
    assert eyes.watching.looks
    eyes.show(7, 1.0)
    assert eyes.result() == (1.0, 7, "seen at 1")
    eyes.watching.stop()
    assert not eyes.watching.looks
    assert (eyes.detector.closed, eyes.stops) == (1, 1)
    eyes.subscribe(two=0)
    assert len(eyes.cameras.streams) == 2


def test_paused_it_looks_at_nothing(eyes):
    eyes.subscribe(one=0)
    eyes.watching.pause(True)
    assert eyes.watching.paused and not eyes.watching.looks and eyes.stops == 1
    eyes.watching.pause(False)
    assert not eyes.watching.paused and eyes.watching.looks
    eyes.show(3, 2.0)
    assert eyes.result()[:2] == (2.0, 3)


def test_paused_before_anybody_subscribes_it_stays_so(eyes):
    eyes.watching.pause(True)
    eyes.watching.start()
    assert not eyes.watching.looks
    eyes.watching.pause(False)
    assert eyes.watching.looks


def test_the_shortest_period_is_kept_between_two_pictures(eyes):
    eyes.subscribe(one=2000, two=1500)
    for tenths in range(0, 41, 5):
        eyes.show(tenths, tenths / 10.0)
    assert [eyes.result()[0] for _ in range(3)] == [0.0, 1.5, 3.0]
    assert eyes.stream.fps == 1  # no rate is lower


@pytest.mark.parametrize("period, fps", [(0, 30), (30, 30), (33, 30), (50, 20), (100, 10), (300, 3), (5000, 1)])
def test_the_camera_runs_as_slowly_as_the_period_allows(eyes, period, fps):
    eyes.subscribe(one=period)
    assert eyes.stream.fps == fps


def test_the_camera_is_as_fast_as_the_quickest_subscriber(eyes):
    eyes.subscribe(one=0, two=0)
    eyes.watching.set_fps(5, "one")
    assert (eyes.watching.fps, eyes.stream.fps) == (30, 30)
    eyes.watching.set_fps(12, "two")
    assert (eyes.watching.fps, eyes.stream.fps) == (12, 12)
    eyes.subscribe(one=0)
    assert (eyes.watching.fps, eyes.stream.fps) == (5, 5)
    eyes.watching.set_fps(20)
    assert (eyes.watching.fps, eyes.stream.fps) == (20, 20)


def test_only_a_subscriber_has_a_rate(eyes):
    with pytest.raises(NaoqiError, match="'one' is not subscribed; subscribed is nobody"):
        eyes.watching.set_fps(5, "one")


def test_camera_and_resolution_change_while_it_looks(eyes):
    eyes.subscribe(one=0)
    assert (eyes.stream.camera, eyes.stream.resolution) == (0, 1)
    eyes.watching.set_camera(1)
    eyes.watching.set_resolution(2)
    assert (eyes.stream.camera, eyes.stream.resolution) == (1, 2)
    eyes.watching.stop()
    eyes.subscribe(one=0)
    assert (eyes.stream.camera, eyes.stream.resolution) == (1, 2)


def test_without_a_camera_of_its_own_it_follows_the_active_one(eyes_of):
    eyes = eyes_of(camera=None)
    eyes.subscribe(one=0)
    assert eyes.stream.camera == eyes.watching.camera == 0
    eyes.cameras.active = 1
    assert eyes.watching.camera == 1
    eyes.show(1, 1.0, camera=0)
    eyes.show(2, 2.0, camera=1)
    assert eyes.result()[:2] == (2.0, 2)
    assert eyes.stream.camera == 1


def test_pictures_that_cannot_be_drawn_or_looked_at_are_told_once_and_it_goes_on(eyes, caplog):
    eyes.subscribe(one=0)
    eyes.stream.put(SimulationError("cannot be drawn"))
    eyes.show(255, 1.0)
    eyes.show(255, 2.0)
    eyes.show(9, 3.0)
    assert eyes.result()[:2] == (3.0, 9)
    errors = [record.getMessage() for record in caplog.records if record.levelno == logging.ERROR]
    assert errors == ["ALTestDetection: cannot be drawn; it goes on, and further failures in a row are not logged"]
    eyes.show(255, 4.0)
    eyes.show(10, 5.0)
    eyes.result()
    assert "cannot look at this" in caplog.text  # after a success it is news again


def test_a_result_that_nobody_wants_any_more_is_dropped(eyes, patience):
    begun, go_on = threading.Event(), threading.Event()
    detect = eyes.detector.detect

    def slow(*arguments):
        begun.set()
        go_on.wait(patience)
        return detect(*arguments)

    eyes.detector.detect = slow
    eyes.subscribe(one=0)
    eyes.show(1, 1.0)
    assert begun.wait(patience)
    stopping = threading.Thread(target=eyes.watching.stop)
    stopping.start()
    while eyes.watching.looks and stopping.is_alive():
        stopping.join(0.001)
    go_on.set()
    stopping.join(patience)
    assert not stopping.is_alive()
    assert eyes.results.empty() and eyes.stops == 1


# --- its methods of NAOqi -------------------------------------------------------------------------------------------


@pytest.fixture
def extractor(eyes):
    return VisionExtractor(eyes.watching, load_cameras("V6"))


def test_settings_are_answered_and_changed(eyes, extractor):
    assert (extractor.getActiveCamera(), extractor.getResolution(), extractor.getFrameRate()) == (0, 1, 30)
    eyes.subscribe(one=0)
    assert extractor.setActiveCamera(1) and extractor.setResolution(0)
    assert extractor.setFrameRate(9) and extractor.setFrameRate("one", 4)
    assert (extractor.getActiveCamera(), extractor.getResolution(), extractor.getFrameRate()) == (1, 0, 4)
    assert (eyes.stream.camera, eyes.stream.resolution, eyes.stream.fps) == (1, 0, 4)


def test_pause_is_answered(eyes, extractor):
    assert (extractor.isPaused(), extractor.isProcessing()) == (False, False)
    eyes.subscribe(one=0)
    assert extractor.isProcessing()
    extractor.setParameter("pause", True)
    assert (extractor.isPaused(), extractor.isProcessing()) == (True, False)


@pytest.mark.parametrize(
    "method, arguments, problem",
    [
        ("setActiveCamera", (2,), "camera is 2, allowed is one of 0"),
        ("setResolution", (99,), "resolution is 99, allowed is one of"),
        ("setFrameRate", (0,), "framerate is 0, allowed is 1 to 30"),
        ("setFrameRate", (31,), "framerate is 31, allowed is 1 to 30"),
        ("setFrameRate", (True,), "framerate is True"),
        ("setParameter", ("resolution", 99), "resolution is 99"),
        ("setParameter", ("size", 1), "unknown parameter 'size'; there are pause, resolution"),
    ],
)
def test_wrong_settings_are_refused_and_change_nothing(eyes, extractor, method, arguments, problem):
    with pytest.raises((BadValue, NaoqiError), match=problem):
        getattr(extractor, method)(*arguments)
    assert (extractor.getActiveCamera(), extractor.getResolution(), extractor.getFrameRate()) == (0, 1, 30)
