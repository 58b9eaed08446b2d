"""Tests of the Gymnasium environments, which test_library.py runs where there is Gymnasium."""

from __future__ import annotations

import warnings

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import nao_sim_bridge.envs
from nao_sim_bridge.base.errors import BadValue, SimulationError
from nao_sim_bridge.envs.walk import NaoWalkEnv


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


@pytest.mark.parametrize(
    "options, told",
    [
        ({"friktion": 1.0}, "'friktion': did you mean 'friction'.*allowed: world"),
        ({"posture": "Sit"}, "'posture'"),
        ({"render_mode": "ansi"}, "render_mode"),
        ({"drive": "velocity"}, "drive"),
        ({"randomization": {"pushh": 1.0}}, "'pushh': did you mean 'push'"),
        ({"randomization": {"push": -1.0}}, "randomization: push is -1.0"),
        ({"randomization": {"friction": 1.5}}, "randomization: friction is 1.5"),
        ({"randomization": {"payload": np.nan}}, "randomization: payload is nan"),
    ],
)
def test_an_environment_that_cannot_be_is_refused_when_it_is_made(options, told):
    with pytest.raises(SimulationError, match=told):
        NaoWalkEnv(**options)


@pytest.mark.parametrize("name", ["NaoWalk", "NaoFollowBall"])
def test_options_of_a_reset_and_actions_that_an_environment_does_not_have_are_refused(name):
    env = gymnasium.make(f"{name}-v0").unwrapped
    with pytest.raises(SimulationError, match="comand"):
        env.reset(options={"comand": (0.1, 0.0, 0.0)})
    env.reset(seed=1)
    count = env.action_space.shape[0]
    for wrong in (0.1, np.zeros(count - 1), np.full(count, np.nan)):
        with pytest.raises(SimulationError, match="action is"):
            env.step(wrong)
