"""The program that times walking must time a robot that walks, next to one that does not."""

from __future__ import annotations

import pybullet
import pytest
from nao_benchmarks.errors import BenchmarkError


@pytest.fixture
def still(program):
    made = program.awake()
    yield made
    made.close()


def test_both_robots_are_timed_equally_often(program):
    times = program.time_ticks(20)
    assert len(times["ours"]) == len(times["reference"]) == 20
    assert min(times["ours"] + times["reference"]) > 0.0


def test_the_walk_takes_less_than_the_physics_and_the_engine_is_left_as_it_was(program):
    step = pybullet.stepSimulation
    times = program.time_controller(50)
    assert 0.0 < sum(times["ours"]) < sum(times["reference"])
    assert pybullet.stepSimulation is step


def test_a_robot_that_stands_is_not_taken_for_one_that_walks(program, still):
    program.check_stands(still)
    with pytest.raises(BenchmarkError, match="does not"):
        program.check_walks(still)


def test_a_robot_that_walks_is_not_taken_for_one_that_stands(program):
    walks = program.walking()
    try:
        program.check_walks(walks)
        with pytest.raises(BenchmarkError, match="stand still does not"):
            program.check_stands(walks)
    finally:
        walks.close()
