"""A simulator that cases about lost robots start and kill: one for all cases of a program."""

import os
import signal
import subprocess
import sys
import unittest
from typing import ClassVar

from naoqi.limits import START_PATIENCE

LIMIT = START_PATIENCE + 30.0
"""s of a wait; a goal to a robot that has never been there waits for it first."""
PORT = int(os.environ.get("NAO_PORT", "9559"))


class MortalSimulator:
    """Starts and kills the simulator.

    Attributes:
        simulator: The process; None while there is none.
    """

    simulator: ClassVar = None

    @classmethod
    def start(cls):
        """Start a simulator; it may take a while until it answers."""
        MortalSimulator.simulator = subprocess.Popen([sys.executable, "-m", "nao_sim_bridge", "--port", str(PORT)])

    @classmethod
    def kill(cls):
        """Kill it if there is one, also if it was stopped."""
        if cls.simulator is not None:
            cls.simulator.kill()
            cls.simulator.wait()
            MortalSimulator.simulator = None


class LostRobotCase(MortalSimulator, unittest.TestCase):
    """A case that finds a simulator, which may still be starting, and leaves one behind."""

    def setUp(self):
        if self.simulator is None:
            self.start()
        self.simulator.send_signal(signal.SIGCONT)  # where a case before failed

    def kept(self, subscriber):
        """A subscriber, or whatever else has `unregister`, until the end of the case."""
        self.addCleanup(subscriber.unregister)
        return subscriber
