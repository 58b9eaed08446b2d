"""Times at which a path is solved: found when they are needed, however long the path is."""

import math
import tracemalloc

import numpy as np
import pytest

from nao_sim_bridge.control.whole_body.cartesian_path import SAMPLE_TIME, SampleTimes, SolvedPath

DAY = 86400.0


def test_every_time_is_a_sample_and_steps_between_are_short_and_even():
    times = list(SampleTimes([0.12, 0.12, 0.13, 1.0]))
    assert times == sorted(set(times)) and {0.0, 0.12, 0.13, 1.0} <= set(times)
    assert max(np.diff(times)) <= SAMPLE_TIME + 1e-9
    assert times[:4] == pytest.approx([0.0, 0.04, 0.08, 0.12])
    assert list(SampleTimes([])) == [0.0] and SampleTimes([1.0])[-1] == 1.0
    with pytest.raises(IndexError):
        SampleTimes([1.0])[21]


def test_a_day_takes_no_more_memory_than_a_second_and_any_time_is_found():
    tracemalloc.start()
    times = SampleTimes([1.0, DAY])
    path = SolvedPath(times, np.zeros(26), lambda moment, before: before + 0.01)
    for tick in range(1600):
        path.angles(tick * 0.05)
    assert tracemalloc.get_traced_memory()[1] < 1e6
    tracemalloc.stop()
    assert len(times) == 1 + 20 + math.ceil((DAY - 1.0) / SAMPLE_TIME)
    assert times[-1] == DAY and times[10**6] < times[10**6 + 1]
    assert path.angles(1600 * 0.05)[0] == pytest.approx(16.0, abs=0.02)
