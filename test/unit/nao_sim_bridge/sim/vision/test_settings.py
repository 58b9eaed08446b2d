"""Settings of the detectors are read strictly."""

from __future__ import annotations

import copy

import pytest

from nao_sim_bridge.paths import config_file
from nao_sim_bridge.sim.config import read_json
from nao_sim_bridge.sim.errors import ConfigError
from nao_sim_bridge.sim.vision.settings import FILE, load_vision, parse_vision


@pytest.fixture
def content():
    return copy.deepcopy(read_json(config_file(FILE)))


def test_the_file_of_the_package_is_complete():
    settings = load_vision()
    low, high = settings.ball.redness
    assert 0.0 < low < high < 1.0
    assert settings.ball.least_radius < settings.ball.most_radius
    assert settings.landmarks.levels[0] < settings.landmarks.levels[1]


@pytest.mark.parametrize(
    "spoil, problem",
    [
        (lambda c: c.pop("ball"), "missing 'ball'"),
        (lambda c: c.update(bal={}), "unknown key 'bal', did you mean 'ball'"),
        (lambda c: c["landmarks"].pop("lead"), f"{FILE} landmarks: missing 'lead'"),
        (lambda c: c["ball"].update(rednes=1), f"{FILE} ball: unknown key 'rednes', did you mean 'redness'"),
    ],
)
def test_a_file_that_is_wrong_is_refused(content, spoil, problem):
    spoil(content)
    with pytest.raises(ConfigError, match=problem):
        parse_vision(content)
