"""The program that times motion must move every joint of one robot and none of the other."""

from __future__ import annotations

import pytest
from nao_benchmarks.errors import BenchmarkError


@pytest.fixture
def robots(program):
    both = program.awake(), program.awake()
    yield both
    for each in both:
        each.close()


def test_a_robot_that_moves_passes_the_check_and_one_that_stands_still_does_not(program, robots):
    moving, still = robots
    program.keep_moving(moving)
    moving.run(0.5)
    still.run(0.5)
    program.check_moves(moving, still)
    with pytest.raises(BenchmarkError, match="not every joint"):
        program.check_moves(still, still)
    with pytest.raises(BenchmarkError, match="should stand still"):
        program.check_moves(moving, moving)
