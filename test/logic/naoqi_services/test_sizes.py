"""How much clients may leave in the simulated robot."""

from __future__ import annotations

from unittest.mock import Mock

import pytest

from nao_sim_bridge.base.errors import BadValue, NotAllowed
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.behaviors.installed import InstalledBehaviors
from nao_sim_bridge.behaviors.steps import Behavior, Wait
from nao_sim_bridge.naoqi.behaviors.frame_manager import ALFrameManager
from nao_sim_bridge.server.film_control import FilmControl
from nao_sim_bridge.speech.animations import load_animations

SIZES = load_sizes()
TIMELINE = '<Timeline enable="1"/>'


def test_behaviours_of_numbers_are_bounded():
    frames = ALFrameManager(Mock(names=[]), Mock(), Mock())
    made = [frames.createTimeline(TIMELINE) for _ in range(SIZES.behaviors.made)]
    with pytest.raises(NotAllowed, match="there are 100 behaviors already: deleteBehavior or cleanBehaviors first"):
        frames.createTimeline(TIMELINE)
    frames.deleteBehavior(made[0])
    assert frames.createTimeline(TIMELINE) not in made


def test_installed_behaviours_are_bounded_and_one_that_is_there_can_be_replaced():
    installed = InstalledBehaviors(load_animations())
    installed.install([Behavior(f"mine/{number}", Wait(1.0)) for number in range(SIZES.behaviors.installed)])
    with pytest.raises(NotAllowed, match="1000 behaviors are installed at most"):
        installed.install([Behavior("mine/another", Wait(1.0))])
    assert installed.install([Behavior("mine/0", Wait(2.0))]) == ([], ["mine/0"])


def test_captions_of_films_are_bounded():
    film = FilmControl(*[Mock()] * 3)
    with pytest.raises(BadValue, match="caption is 'x+... of 201 characters', allowed is 200 characters at most"):
        film.caption("x" * 201)
    with pytest.raises(NotAllowed, match="nothing is being filmed"):
        film.caption("x" * 200)
