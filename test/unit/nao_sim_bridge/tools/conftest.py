"""What all tests of the tools share."""

from __future__ import annotations

import logging

import pytest


@pytest.fixture(autouse=True)
def simulator_log_levels():
    """Tools silence the simulator in a process of their own; that of the tests is to hear its warnings again."""
    loggers = [logging.getLogger(name) for name in ("nao_sim", "nao_sim.motion")]
    levels = [logger.level for logger in loggers]
    yield
    for logger, level in zip(loggers, levels):
        logger.setLevel(level)
