"""The end of a node that comes at any moment, also while its module is being made."""

from __future__ import annotations

import pytest
from recorded_node import RecordedNode

from nao_library_modules.core.goal_checks import KnownRobot
from nao_library_modules.core.server_types import ACTIONS, server_type
from nao_library_modules.nao_basic import NaoBasic


@pytest.mark.parametrize("name", ACTIONS)
def test_a_node_may_be_ended_at_any_line_of_the_constructor_of_its_module(name):
    node, steps = RecordedNode(), []

    class Ended(server_type(name).module):
        def __setattr__(self, attribute, value):
            super().__setattr__(attribute, value)
            if node.shutdown_actions:
                steps.append(len(self.shutdown_steps()))

    Ended("127.0.0.1", 9559, robot=KnownRobot(), node=node)
    assert steps and steps == sorted(steps)


def test_a_module_of_ones_own_that_cannot_tell_its_steps_ends_the_others(caplog):
    class Own(NaoBasic):
        def shutdown_steps(self):
            return [*super().shutdown_steps(), self.camera.close]  # which its constructor was about to make

    module = Own("127.0.0.1", 9559, robot=KnownRobot(), node=RecordedNode())
    module.shut_down()
    assert module.interrupt.is_set()
    assert "Own.shutdown_steps failed" in caplog.text
