"""Tests of the Gymnasium environments, which test_library.py runs where there is Gymnasium."""

from __future__ import annotations

import warnings

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import nao_sim_bridge.envs
from nao_sim_bridge.base.errors import BadValue


@pytest.mark.parametrize("name", nao_sim_bridge.envs.STEPS)
def test_environments_keep_what_gymnasium_asks_for(name):
    warnings.simplefilter("error")
    check_env(gymnasium.make(f"{name}-v0").unwrapped, skip_render_check=True)


def episode(env, seed):
    env.reset(seed=seed)
    for _ in range(40):
        seen = env.step(0.4 * np.ones(env.action_space.shape))[0]
    return seen.tolist()


def test_friction_of_an_episode_is_not_that_of_the_next():
    plain = gymnasium.make("NaoStand-v0", randomization={"push": 3.0}).unwrapped
    once = episode(plain, 5)
    plain.sim.robot.scale_friction(0.2)
    for _ in range(2):
        assert episode(plain, 5) == once
    slippery = gymnasium.make("NaoStand-v0", randomization={"push": 3.0, "friction": 0.9}).unwrapped
    assert episode(slippery, 5) != once
    slippery.randomization = plain.randomization
    assert episode(slippery, 5) == once


@pytest.mark.parametrize(
    "name, word, wanted", [("NaoWalk", "command", (0.1, 0.0, 0.2)), ("NaoReach", "point", (0.1, -0.1, 0.1))]
)
def test_an_episode_is_about_what_it_is_told(name, word, wanted):
    env = gymnasium.make(f"{name}-v0")
    env.reset(seed=1, options={word: wanted})
    assert getattr(env.unwrapped, f"_{word}").tolist() == list(wanted)
    env.reset()
    assert getattr(env.unwrapped, f"_{word}").tolist() != list(wanted)
    with pytest.raises(BadValue, match=word):
        env.reset(options={word: wanted[:2]})
