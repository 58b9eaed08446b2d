"""A simulator that scenarios about lost robots start and kill."""

import os
import signal
import subprocess
import sys

from naoqi.limits import START_PATIENCE

LIMIT = START_PATIENCE + 30.0
"""s of a wait; a goal to a robot that has never been there waits for it first."""
PORT = int(os.environ.get("NAO_PORT", "9559"))


class MortalSimulator:
    """To be mixed into a TestCase; `kill` belongs into its clean-up.

    Attributes:
        simulator: The process; None while there is none.
    """

    simulator = None

    def start(self):
        """Start a simulator; it may take a while until it answers."""
        self.simulator = subprocess.Popen([sys.executable, "-m", "nao_sim_bridge", "--port", str(PORT)])

    def kill(self):
        """Kill it if there is one, also if it was stopped."""
        if self.simulator is not None:
            self.simulator.send_signal(signal.SIGCONT)
            self.simulator.kill()
            self.simulator.wait()
            self.simulator = None
