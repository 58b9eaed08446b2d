"""Stacks that start side by side on a busy computer whose ports come and go: `test/soak/starts.py` in short."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from amount import amount

pytestmark = pytest.mark.timeout(1200)
SCRIPT = Path(__file__).resolve().parents[1] / "soak/starts.py"
STARTS = amount(1, 3)


def test_all_stacks_come_up(tmp_path):
    command = [sys.executable, str(SCRIPT), "--starts", str(STARTS), "--output", str(tmp_path)]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    print(run.stdout)
    assert run.returncode == 0, run.stdout + run.stderr[-4000:]
    assert json.loads(run.stdout.splitlines()[-1])["up"] == 2 * STARTS
