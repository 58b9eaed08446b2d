"""Goals in which one number is what nobody means: each ends, says what was wrong, and the server works afterwards."""

from __future__ import annotations

import math
import resource
from collections import Counter

import numpy as np
import pytest
from amount import part_of
from boundary import EXAMPLES, long_lists, variants
from camera_topics import Topics
from gaps import LONGEST, gaps_of

from nao_library_actions.msg import (
    NaoAudioInGoal,
    NaoAudioOutGoal,
    NaoBehaviorGoal,
    NaoLedGoal,
    NaoMotionGoal,
    NaoTactileGoal,
    NaoVisionGoal,
)
from nao_library_modules.audio_in.audio_in_server import NaoAudioInput
from nao_library_modules.audio_out.audio_out_server import NaoAudioOutput
from nao_library_modules.behaviors.server import NaoBehavior
from nao_library_modules.lights.lights_server import NaoLights
from nao_library_modules.motion.motion_server import NaoMotion
from nao_library_modules.tactile.tactile_server import NaoTactile
from nao_library_modules.vision import NaoVision

PROMPT = 0.05
"""s of the computer that a refusal may take without time having to pass for it."""
DEADLINE = 0.1
"""s of simulated time after which a goal that goes on is cancelled."""
FIGURES = Counter()
MEMORY = 8 * 1024**3
"""What simulator and servers may have of address space together, bytes."""


@pytest.fixture(scope="module", autouse=True)
def limited():
    before = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, before[1]))
    yield
    resource.setrlimit(resource.RLIMIT_AS, before)


@pytest.fixture
def gaps(robot):
    gaps = gaps_of(robot.server.runner)
    yield gaps
    gaps.close()


@pytest.fixture
def servers(goals_to, robot, tmp_path):
    """Makes the module of a server."""
    folder = str(tmp_path)
    make = {
        "NaoLights": lambda: goals_to(NaoLights, NaoLedGoal),
        "NaoMotion": lambda: goals_to(NaoMotion, NaoMotionGoal, motion_dir=tmp_path),
        "NaoTactile": lambda: goals_to(NaoTactile, NaoTactileGoal),
        "NaoVision": lambda: goals_to(NaoVision, NaoVisionGoal, topics=Topics(), record_dir=folder),
        "nao_audio_in": lambda: goals_to(NaoAudioInput, NaoAudioInGoal, robot_home=str(robot.server.files.folder)),
        "nao_audio_out": lambda: goals_to(NaoAudioOutput, NaoAudioOutGoal),
        "NaoBehavior": lambda: goals_to(NaoBehavior, NaoBehaviorGoal, behavior_dir=tmp_path, clients=lambda name: None),
    }
    return lambda name: make[name]()


def ended(robot, goal):
    if not goal.refused(PROMPT):
        robot.advance(DEADLINE)
    return goal.cancel() if goal.active else goal.finish()


ONE_IN = 5
"""One in so many goals is tried in the short form."""
CASES = [(name, number) for name, examples in EXAMPLES.items() for number in range(len(examples))]


@pytest.mark.parametrize("name, number", CASES, ids=[f"{n}-{i}-{EXAMPLES[n][i].function}" for n, i in CASES])
def test_goals_with_a_number_that_nobody_means_end_and_the_server_works_afterwards(robot, servers, gaps, name, number):
    server, example = servers(name), EXAMPLES[name][number]
    robot.ALMotion.setStiffnesses("Body", 1.0)
    robot.advance(0.5)
    strange = []
    empty = type(example)()
    fields = {field for field in example.__slots__ if getattr(example, field) != getattr(empty, field)} | {"time"}
    for place, value, message in part_of([*variants(example, fields), *long_lists(example)], ONE_IN):
        if "header" in place:
            continue
        goal = ended(robot, server.send(message))
        FIGURES[goal.state] += 1
        field = place.split(".")[0]
        mad = isinstance(value, float) and (math.isnan(value) or abs(value) >= 1e9)
        told = field in goal.text or f"{value:.0f}" in goal.text  # the robot's own refusals name the value
        if goal.state == "aborted" and ("unexpected" in goal.text or (mad and not told)):
            strange.append((place, value, goal.text))
        assert np.isfinite(robot.ALMotion.getAngles("Body", True)).all(), (place, value)
    assert server.play(type(example)(function="ping")).state == "succeeded"
    assert not strange, "\n".join(map(str, strange))
    assert gaps.longest < LONGEST
    print(f"{name} {example.function}: {dict(FIGURES)} so far, longest gap {gaps.longest:.2f} s")
