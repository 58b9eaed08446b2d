"""The simulator of the soak when it ends by itself."""

from __future__ import annotations

import pytest
from nao_soak.processes import NotReady, Simulator

LIMIT = 10.0


class OneMachine:
    """A machine on which every program ends at once."""

    def on_robot(self, command):
        return ["true"]


def test_a_simulator_that_has_ended_by_itself_is_told_and_can_be_killed(tmp_path):
    with pytest.raises(NotReady, match="ended by itself"), Simulator(OneMachine(), tmp_path, 1.0, 1) as simulator:
        simulator._process.wait(LIMIT)
        assert simulator.pid
    assert simulator.lives == 1


def test_a_simulator_can_be_killed_twice(tmp_path):
    simulator = Simulator(OneMachine(), tmp_path, 1.0, 1)
    simulator.start()
    simulator.kill()
    simulator.kill()
    with pytest.raises(NotReady):
        assert simulator.pid
