"""The short form of the soak: robot and servers on two machines, strange goals, accidents; all works afterwards."""

import json
import os
import subprocess
import sys
import unittest
from pathlib import Path
from tempfile import TemporaryDirectory

SOAK = Path(__file__).resolve().parents[2] / "soak" / "run.py"


class Soak(unittest.TestCase):
    def test_nobody_dies_no_goal_hangs_and_everything_works_afterwards(self):
        with TemporaryDirectory() as folder:
            command = [sys.executable, str(SOAK), "--minutes", "3", "--speed", "4", "--kills", "1", "--drops", "1"]
            # Too short to tell whether memory is flat: that takes the long form.
            done = subprocess.run(
                [*command, "--no-memory", "--output", folder],
                capture_output=True,
                text=True,
                env={**os.environ, "PYTHONUNBUFFERED": "1"},
                check=False,
            )
            simulator = (Path(folder) / "nao_sim.log").read_text(encoding="utf-8", errors="replace")[-20000:]
            self.assertEqual(done.returncode, 0, f"{done.stdout}\n{done.stderr}\n{simulator}")
            report = json.loads((Path(folder) / "report.json").read_text(encoding="utf-8"))
            said = (Path(folder) / "roslaunch.log").read_text(encoding="utf-8", errors="replace")[-20000:]
        self.assertEqual(len(report["accidents"]), 2)
        for server, ends in report["ends"].items():
            self.assertTrue(ends.get("succeeded") and ends.get("aborted"), f"{server}: {report['ends']}\n{said}")
