"""What the scenarios of the plan examples have in common: an example is started as users start it."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import rospkg

from nao_library_modules.process_modules.trace import Trace
from nao_sim_bridge.testing import SimulatedRobot

EXAMPLES = Path(rospkg.RosPack().get_path("nao_library_modules")) / "examples"
SENSOR = "Device/SubDeviceList/{}/Position/Sensor/Value"
STANDING = 0.28
"""m that the torso is over the floor at least."""


def start(name, *arguments):
    """An example that runs; what it prints goes into a pipe."""
    command = [sys.executable, str(EXAMPLES / name), *arguments]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


class PlanExampleTest(unittest.TestCase):
    """Runs examples on the simulated robot, and looks at what came of it.

    Attributes:
        servers: That are waited for before the first example: name of the action, and its class.
    """

    servers = {}

    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        for name, kind in cls.servers.items():
            cls.robot.action_client(name, kind, limit=90.0)

    def setUp(self):
        self.robot.reset()
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_example(self, name, *arguments, status=0, limit=180):
        """What an example printed; it ends with this status."""
        example = start(name, *arguments)
        try:
            output, _ = example.communicate(timeout=limit)
        except subprocess.TimeoutExpired:
            example.kill()
            self.fail(f"{name} did not end within {limit} s: {example.communicate()[0]}")
        self.assertEqual(example.returncode, status, output)
        return output

    def run_plan(self, name, *arguments, status=0):
        """What a plan printed, and its trace: every task of it is over, nothing took negative time."""
        file = self.folder / "trace.json"
        output = self.run_example(name, *arguments, "--trace", str(file), status=status)
        trace = Trace.from_json(file.read_text(encoding="utf-8"))
        for record in trace.records:
            self.assertIn(record.state, ("succeeded", "failed", "evaporated"), record)
            if record.began is not None:
                self.assertLessEqual(record.created, record.began, record)
                self.assertLessEqual(record.began, record.ended, record)
        self.assertEqual(trace.records[0].state, "failed" if status else "succeeded", output)
        return output, trace

    def angle(self, joint):
        return self.robot.value(SENSOR.format(joint))

    def assert_stands(self):
        self.assertFalse(self.robot.module("ALMotion").moveIsActive())
        self.robot.advance(1.0)
        self.assertGreater(self.robot.true_pose().position.z, STANDING)
