"""What looks through a camera for an extractor; settings of the detectors, and cones through what they see."""

from __future__ import annotations

import logging
import queue
import threading
from types import SimpleNamespace

import numpy as np
import pytest
from plain_cameras import Head

from nao_sim_bridge.paths import config_file
from nao_sim_bridge.services.errors import NaoqiError
from nao_sim_bridge.services.extractor import Subscription
from nao_sim_bridge.services.memory_store import MemoryStore
from nao_sim_bridge.services.vision.face_detection_learning import MOST_WAITING, FaceLearner
from nao_sim_bridge.services.vision.sight import Sight
from nao_sim_bridge.services.vision.vision_extractor import VisionExtractor
from nao_sim_bridge.services.vision.watching import Watching
from nao_sim_bridge.sim.config import read_json
from nao_sim_bridge.sim.errors import BadValue, ConfigError, SimulationError
from nao_sim_bridge.sim.render import RenderError
from nao_sim_bridge.sim.vision.cone import fit_cone
from nao_sim_bridge.sim.vision.settings import FILE, load_vision, parse_vision

PATIENCE = 15.0


class Eyes(Head):
    """Cameras whose pictures are as bright as the second is late, and a watching with a detector of that brightness."""

    def __init__(self, **options):
        super().__init__()
        self.manual()
        self.pictures.paint = lambda time, shape: np.full(shape, round(20 * time), np.uint8)
        self.results, self.closed, self.stops, self.fails = queue.Queue(), 0, 0, False
        settings = lambda frame: f"seen at {frame.time:.2f}"  # noqa: E731
        found = lambda frame, seen: self.results.put((frame.time, frame.camera, *seen))  # noqa: E731
        self.watching = Watching(self.cameras, "ALTest", self, found, settings, self.stopped, **options)

    def detect(self, image, optics, settings):
        if self.fails:
            raise SimulationError("cannot look at this")
        return [round(float(image.mean())), settings]

    def close(self):
        self.closed += 1

    def stopped(self):
        self.stops += 1

    def end(self):
        self.watching.stop()
        super().close()

    @property
    def stream(self):
        return self.cameras.streams[-1]

    def subscribe(self, **periods):
        self.watching.start()
        self.watching.changed({name: Subscription(period, 0.0) for name, period in periods.items()})

    def seen(self):
        """(time, brightness) of the pictures that were looked at."""
        return [(round(r[0], 3), r[2]) for r in (self.results.get_nowait() for _ in range(self.results.qsize()))]


@pytest.fixture
def eyes_of():
    made = []

    def make(**options):
        made.append(Eyes(**options))
        return made[-1]

    yield make
    for eyes in made:
        eyes.end()


@pytest.fixture
def eyes(eyes_of):
    return eyes_of()


def test_it_looks_from_the_first_subscriber_to_the_last_unless_paused(eyes):
    assert not eyes.watching.looks and eyes.cameras.streams == ()
    eyes.subscribe(one=1000)
    assert eyes.watching.looks
    eyes.advance(2.0)
    assert eyes.results.get(timeout=PATIENCE) == (pytest.approx(1 / 120), 0, 0, "seen at 0.01")
    assert eyes.results.get(timeout=PATIENCE)[0] == pytest.approx(1.0, abs=0.02)
    eyes.watching.pause(True)
    assert eyes.watching.paused and not eyes.watching.looks and (eyes.closed, eyes.stops) == (1, 1)
    eyes.watching.pause(False)
    assert not eyes.watching.paused and eyes.watching.looks
    eyes.watching.stop()
    assert not eyes.watching.looks and eyes.cameras.streams == () and (eyes.closed, eyes.stops) == (2, 2)
    eyes.watching.pause(True)
    eyes.watching.start()
    assert not eyes.watching.looks, "paused before anybody subscribed"
    eyes.watching.pause(False)
    assert eyes.watching.looks


def test_the_shortest_period_is_kept_between_two_pictures(eyes):
    eyes.subscribe(one=2000, two=1500)
    assert eyes.stream.fps == 1  # no rate is lower
    eyes.advance(5.0)
    assert eyes.seen() == [(0.008, 0), (2.008, 40), (4.008, 80)]


@pytest.mark.parametrize("period, fps", [(0, 30), (30, 30), (33, 30), (50, 20), (100, 10), (300, 3), (5000, 1)])
def test_the_camera_runs_as_slowly_as_the_period_allows(eyes, period, fps):
    eyes.subscribe(one=period)
    assert eyes.stream.fps == fps


def test_camera_resolution_and_rate_are_answered_and_change_while_it_looks(eyes):
    extractor = VisionExtractor(eyes.watching, eyes.cameras.tables)
    answers = lambda: (extractor.getActiveCamera(), extractor.getResolution(), extractor.getFrameRate())  # noqa: E731
    assert answers() == (0, 1, 30) and (extractor.isPaused(), extractor.isProcessing()) == (False, False)
    with pytest.raises(NaoqiError, match="'one' is not subscribed; subscribed is nobody"):
        extractor.setFrameRate("one", 4)
    for method, arguments, problem in [
        ("setActiveCamera", (2,), "camera is 2, allowed is one of 0"),
        ("setResolution", (99,), "resolution is 99, allowed is one of"),
        ("setFrameRate", (0,), "framerate is 0, allowed is 1 to 30"),
        ("setFrameRate", (31,), "framerate is 31, allowed is 1 to 30"),
        ("setFrameRate", (True,), "framerate is True"),
        ("setParameter", ("resolution", 99), "resolution is 99"),
        ("setParameter", ("size", 1), "unknown parameter 'size'; there are pause, resolution"),
    ]:
        with pytest.raises((BadValue, NaoqiError), match=problem):
            getattr(extractor, method)(*arguments)
    assert answers() == (0, 1, 30)
    eyes.subscribe(one=0, two=0)
    assert extractor.setFrameRate("one", 5) and (extractor.getFrameRate(), eyes.stream.fps) == (30, 30)
    assert extractor.setFrameRate("two", 12) and (extractor.getFrameRate(), eyes.stream.fps) == (12, 12)
    eyes.subscribe(one=0)
    assert (extractor.getFrameRate(), eyes.stream.fps) == (5, 5)
    assert extractor.setFrameRate(20) and extractor.setActiveCamera(1) and extractor.setResolution(0)
    assert answers() == (1, 0, 20) == (eyes.stream.camera, eyes.stream.resolution, eyes.stream.fps)
    extractor.setParameter("pause", True)
    assert (extractor.isPaused(), extractor.isProcessing()) == (True, False)
    extractor.setParameter("pause", False)
    assert (eyes.stream.camera, eyes.stream.resolution, eyes.stream.fps) == (1, 0, 20)


def test_without_a_camera_of_its_own_it_follows_the_active_one(eyes_of):
    eyes = eyes_of(camera=None)
    eyes.subscribe(one=100)
    eyes.advance(0.05)
    assert eyes.stream.camera == eyes.watching.camera == 0
    eyes.cameras.active = 1
    assert eyes.watching.camera == 1
    eyes.advance(0.4)
    cameras = [result[1] for result in (eyes.results.get_nowait() for _ in range(eyes.results.qsize()))]
    assert cameras[0] == 0 and set(cameras[1:]) == {1} and eyes.stream.camera == 1


def test_pictures_that_cannot_be_drawn_or_looked_at_are_told_once_and_it_goes_on(eyes, caplog):
    eyes.subscribe(one=100)
    errors = lambda: [r.getMessage() for r in caplog.records if r.levelno == logging.ERROR]  # noqa: E731
    once = "ALTest: {}; it goes on, and further failures in a row are not logged"
    eyes.pictures.error = RenderError("cannot be drawn")
    eyes.advance(0.15)
    eyes.pictures.error, eyes.fails = None, True
    eyes.advance(0.2)
    assert errors() == [once.format("cannot be drawn")]
    eyes.fails = False
    eyes.advance(0.1)
    assert eyes.results.get(timeout=PATIENCE)
    eyes.fails = True
    eyes.advance(0.2)
    assert errors()[1:] == [once.format("cannot look at this")], "after a success it is news again"


def test_a_result_that_nobody_wants_any_more_is_dropped(eyes):
    begun, go_on = threading.Event(), threading.Event()
    eyes.detect = lambda *_: (begun.set(), go_on.wait(PATIENCE))
    eyes.subscribe(one=0)
    eyes.run()
    assert begun.wait(PATIENCE)
    stopping = threading.Thread(target=eyes.watching.stop)
    stopping.start()
    while eyes.watching.looks and stopping.is_alive():
        stopping.join(0.001)
    go_on.set()
    stopping.join(PATIENCE)
    assert eyes.results.empty() and eyes.stops == 1


@pytest.mark.parametrize("tell_end, told", [(True, [["a"], ["b"], [], ["c"]]), (False, [["a"], ["b"], ["c"]])])
def test_what_is_seen_is_told_each_time_and_its_end_once_or_not_at_all(tell_end, told):
    memory, heard = MemoryStore(lambda: 0.0), []
    sight = Sight(memory, "Seen", tell_end)
    memory.listen("Seen", heard.append)
    assert memory.get("Seen") == []
    sight.nothing()
    sight.show(["a"])
    sight.show(["b"])
    assert memory.get("Seen") == ["b"]
    sight.nothing()
    sight.nothing()
    assert memory.get("Seen") == []
    sight.show(["c"])
    assert heard == told


def test_calls_that_learn_a_face_are_counted_and_end_with_the_cameras():
    head = Head()
    learner = FaceLearner(head.cameras, SimpleNamespace(close=lambda: None), lambda: 0)
    tasks = [learner.look(lambda _: True) for _ in range(MOST_WAITING)]
    with pytest.raises(BadValue, match=f"calls that learn a face is {MOST_WAITING + 1}, allowed is at most"):
        learner.look(lambda _: True)
    head.close()
    for thread in threading.enumerate():
        if thread.name == "learn a face":
            thread.join(PATIENCE)
    for task in (*tasks, learner.look(lambda _: True)):  # there is room again
        with pytest.raises(RuntimeError, match="the cameras were closed"):
            task.result(PATIENCE)


@pytest.mark.parametrize(
    "spoil, problem",
    [
        (lambda c: c.pop("ball"), "missing 'ball'"),
        (lambda c: c.update(bal={}), "unknown key 'bal', did you mean 'ball'"),
        (lambda c: c["landmarks"].pop("lead"), f"{FILE} landmarks: missing 'lead'"),
        (lambda c: c["ball"].update(rednes=1), f"{FILE} ball: unknown key 'rednes', did you mean 'redness'"),
    ],
)
def test_settings_that_are_wrong_are_refused(spoil, problem):
    content = read_json(config_file(FILE))
    assert parse_vision(content) == load_vision()
    spoil(content)
    with pytest.raises(ConfigError, match=problem):
        parse_vision(content)


TURNS = np.linspace(0.0, 2.0 * np.pi, 60, endpoint=False)


def rim(axis, angle, turns):
    """Directions at `angle` around an axis."""
    axis = np.array(axis) / np.linalg.norm(axis)
    left = np.cross((0.0, 0.0, 1.0), axis)
    left /= np.linalg.norm(left)
    around = np.cos(turns)[:, None] * left + np.sin(turns)[:, None] * np.cross(axis, left)
    return np.cos(angle)[..., None] * axis + np.sin(angle)[..., None] * around


@pytest.mark.parametrize("axis", [(1.0, 0.0, 0.0), (1.0, 0.5, 0.0), (1.0, -0.4, 0.35)])
def test_a_rim_or_a_third_of_it_gives_its_cone_and_the_residual_how_far_it_is_off(axis):
    for angle, turns in ((0.01, TURNS), (0.35, TURNS), (0.15, np.linspace(1.0, 3.1, 25))):
        cone = fit_cone(rim(axis, np.array(angle), turns))
        assert cone.angle == pytest.approx(angle, rel=1e-4)
        assert (cone.alpha, cone.beta) == pytest.approx((np.arctan(axis[1]), -np.arctan(axis[2])), abs=1e-4)
        assert cone.residual < 1e-6
    cone = fit_cone(rim(axis, 0.1 + 0.004 * np.where(np.arange(60) % 2 == 0, 1.0, -1.0), TURNS))
    assert (cone.angle, cone.residual) == (pytest.approx(0.1, abs=1e-4), pytest.approx(0.004, rel=0.01))
    assert fit_cone(rim(axis, np.array(0.1), TURNS[:4])) is None and fit_cone(np.tile(axis, (9, 1))) is None
