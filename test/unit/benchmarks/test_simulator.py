from __future__ import annotations

import os
import re
import sys

import pytest
from nao_benchmarks.errors import BenchmarkError
from nao_benchmarks.simulator import READY, Simulator
from nao_benchmarks.stack import free_port


@pytest.mark.parametrize(
    "line",
    [
        "[nao_sim] INFO simulated NAO listens on 127.0.0.1:41234",
        "[INFO] [17.5]: simulated NAO ready on port 41234, world empty, speed 1",
    ],
)
def test_the_port_is_read_from_the_log_with_and_without_ros(line):
    assert re.search(READY, line)[1] == "41234"


def test_a_simulator_that_nobody_can_talk_to_is_ended():
    text = f"import signal; print('ready on port {free_port()}', flush=True); signal.pause()"
    started = []

    class Watched(Simulator):
        def __init__(self, program):
            started.append(program)
            super().__init__(program)

    with pytest.raises(RuntimeError, match="[Cc]onnect"):
        Watched.started("simulator", [sys.executable, "-c", text])
    with pytest.raises(ProcessLookupError):
        os.kill(started[0].pid, 0)


def test_a_simulator_that_does_not_start_says_why():
    with pytest.raises(BenchmarkError, match=r"simulator ended early(?s:.*)no such world"):
        Simulator.started("simulator", [sys.executable, "-c", "import sys; sys.exit('no such world')"])
