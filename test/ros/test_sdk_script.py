"""A script written for the robot maker's Python SDK runs against the simulator, callbacks and all."""

import os
import subprocess
import sys
import unittest
from pathlib import Path

import rospkg
from waits import PATIENCE

from nao_sim_bridge.testing import SimulatedRobot


class SdkScript(unittest.TestCase):
    def test_the_greeter_runs(self):
        SimulatedRobot()
        script = Path(rospkg.RosPack().get_path("nao_library_tests")) / "scripts" / "greeter.py"
        done = subprocess.run(
            [sys.executable, str(script), "127.0.0.1", os.environ["NAO_PORT"]],
            stdout=subprocess.PIPE,
            timeout=PATIENCE,
            text=True,
        )
        self.assertEqual(done.returncode, 0, done.stdout)
        for line in (
            "fading True True",
            "stopped True",
            "head 0.0 2",
            "refused True",
            "called back True [('FrontTactilTouched', 1.0)]",
        ):
            self.assertIn(line, done.stdout)
