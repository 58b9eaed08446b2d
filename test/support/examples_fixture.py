"""What the scenarios of the examples have in common: an example is started as users start it."""

import subprocess
import sys
import unittest
from pathlib import Path

import rospkg

from nao_sim_bridge.testing import SimulatedRobot

EXAMPLES = Path(rospkg.RosPack().get_path("nao_library_modules")) / "examples"
sys.path.append(str(EXAMPLES))
SENSOR = "Device/SubDeviceList/{}/Position/Sensor/Value"


def start(name, *arguments):
    """An example that runs; what it prints goes into a pipe."""
    command = [sys.executable, str(EXAMPLES / name), *arguments]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


class ExampleTest(unittest.TestCase):
    """Runs examples on the simulated robot, which begins each test anew.

    Attributes:
        limit: s that an example may take.
    """

    limit = 150

    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()

    def setUp(self):
        self.robot.reset()

    def run_example(self, name, *arguments, status=0):
        """What an example printed; it ends with this status."""
        example = start(name, *arguments)
        try:
            output, _ = example.communicate(timeout=self.limit)
        except subprocess.TimeoutExpired:
            example.kill()
            self.fail(f"{name} did not end within {self.limit} s: {example.communicate()[0]}")
        self.assertEqual(example.returncode, status, output)
        return output

    def angle(self, joint):
        return self.robot.value(SENSOR.format(joint))
