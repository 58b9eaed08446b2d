"""What looks through a camera for an extractor, and cones through what is seen."""

from __future__ import annotations

import numpy as np
import pytest
from plain_cameras import Head

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.memory.extractor import Subscription
from nao_sim_bridge.naoqi.vision.vision_extractor import VisionExtractor
from nao_sim_bridge.naoqi.vision.watching import Watching
from nao_sim_bridge.vision.ball import fit_cone


class Eyes(Head):
    """Cameras, and a watching that sees nothing."""

    def __init__(self):
        super().__init__()
        self.watching = Watching(self.cameras, "ALTest", self, lambda *_: None, lambda _: None, lambda: None)

    def detect(self, image, optics, settings):
        return []

    def close(self):
        """The detector is closed; the cameras go on."""

    @property
    def stream(self):
        return self.cameras.streams[-1]

    def subscribe(self, **periods):
        self.watching.start()
        self.watching.changed({name: Subscription(period, 0.0) for name, period in periods.items()})


@pytest.fixture
def eyes():
    made = Eyes()
    yield made
    made.watching.stop()
    Head.close(made)


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
    for rate in (0, 31):
        with pytest.raises(BadValue, match=f"framerate is {rate}, allowed is 1 to 30"):
            extractor.setFrameRate(rate)
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
