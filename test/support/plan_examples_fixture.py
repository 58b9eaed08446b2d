"""What the scenarios of the plan examples have in common: the trace that a plan writes is looked at, too."""

import tempfile
from pathlib import Path

from examples_fixture import ExampleTest

from nao_library_modules.process_modules.trace import Trace

STANDING = 0.28
"""m that the torso is over the floor at least."""


class PlanExampleTest(ExampleTest):
    """Runs plans on the simulated robot, and looks at what came of it.

    Attributes:
        servers: That are waited for before the first example: name of the action, and its class.
    """

    servers = {}
    limit = 180

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        for name, kind in cls.servers.items():
            cls.robot.action_client(name, kind, limit=90.0)

    def setUp(self):
        super().setUp()
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

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

    def assert_stands(self):
        self.assertFalse(self.robot.module("ALMotion").moveIsActive())
        self.robot.advance(1.0)
        self.assertGreater(self.robot.true_pose().position.z, STANDING)
