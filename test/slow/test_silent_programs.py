"""Programs of others, by the SDK and by plain libqi, with a simulator that answers nothing for more than 10 s."""

import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from waits import hold

pytestmark = pytest.mark.timeout(300)
PROGRAM = Path(__file__).resolve().parents[1] / "scripts/patient_program.py"
SILENCE = 11.0
"""s: with a patience of 10 s each of them lost all that it had under way."""
ANSWERS = {"question: Nao", "new connection: Nao", "new module of the robot: True", "picture: 320"}
CALLS = {"blocking call", "posted call", "event", "new module of the program"}
KINDS = "naoqi", "qi"


@pytest.fixture
def simulator(tmp_path):
    command = [sys.executable, "-m", "nao_sim_bridge", "--port", "0", "--record-dir", str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as simulator:
        yield simulator
        simulator.kill()


def test_every_kind_of_call_goes_on_and_events_come(simulator):
    port = next(found[1] for found in (re.search(r"listens on .*:(\d+)", line) for line in simulator.stdout) if found)
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}
    programs = {kind: subprocess.Popen([sys.executable, str(PROGRAM), kind, port], **pipes) for kind in KINDS}
    try:
        for program in programs.values():
            assert "ready\n" in iter(program.stdout.readline, "")
        hold(simulator.pid)
        for program in programs.values():
            print("silent", file=program.stdin, flush=True)
        time.sleep(SILENCE)
        simulator.send_signal(signal.SIGCONT)
        for kind, program in programs.items():
            said = set(iter(lambda program=program: program.stdout.readline().rstrip("\n"), "over"))
            assert not [line for line in said if "FAILED" in line]
            assert said >= ANSWERS and {line.split(":")[0] for line in said} >= CALLS
            assert said >= {f"{kind}/Before came: 1", f"{kind}/Before/signal came: 1", f"{kind}/During came: 2"}
    finally:
        for program in programs.values():
            program.kill()
            program.communicate()
