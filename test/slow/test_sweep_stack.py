"""`nao sweep` with a stack of its own: who is pushed over is counted, and it goes on where it was ended."""

from __future__ import annotations

import csv
import os
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def test_falls_are_counted_and_what_is_in_the_file_is_not_run_again(tmp_path):
    file, passing = tmp_path / "falls.csv", tmp_path / "passing"
    passing.mkdir()
    environment = {**os.environ, "ROS_HOME": str(tmp_path), "ROS_LOG_DIR": str(tmp_path), "TMPDIR": str(passing)}

    def sweep(seeds):
        line = [ROOT / "scripts/bin/nao", "sweep", "nod", "--seeds", seeds, "--push", "0,30", "--workers", "0"]
        told = subprocess.run([*line, "--output", file], env=environment, capture_output=True, text=True)
        assert told.returncode == 0, told.stderr
        with file.open(newline="") as lines:
            return told.stdout.splitlines(), list(csv.DictReader(lines))

    _, first = sweep("1")
    assert [(row["push"], row["fell"], row["error"]) for row in first] == [("0.0", "False", ""), ("30.0", "True", "")]
    told, rows = sweep("2")
    assert rows[:2] == first and len(rows) == 4
    assert [line.split()[:4] for line in told] == [
        ["push", "runs", "fell", "rate"],
        ["0.0", "2", "0", "0"],
        ["30.0", "2", "2", "1"],
    ]
    assert float(rows[0]["duration"]) > 1.0 > float(rows[0]["lean"]) and float(rows[1]["lean"]) > 1.0
    assert not list(passing.glob("nao_sweep_*"))
