"""The command as a program of its own."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

PROGRAM = Path(__file__).parents[4] / "nao_library_modules" / "nodes" / "nao"
PRESSED = "import os, signal\nos.kill(os.getpid(), signal.SIGINT)\nraise SystemExit('went on in spite of Ctrl-C')\n"


def test_ctrl_c_while_the_program_loads_ends_it_quietly(tmp_path):
    # Stands for the first module that takes a moment to load.
    (tmp_path / "click.py").write_text(PRESSED)
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), *sys.path])}
    done = subprocess.run(
        [sys.executable, str(PROGRAM), "status"], env=environment, capture_output=True, text=True, timeout=60
    )
    assert (done.returncode, done.stderr, done.stdout) == (130, "", "")
