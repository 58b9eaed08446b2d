"""How soon everything is there that a user starts."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

from nao_library_modules.ros.own_stack import OwnStack

from ..errors import BenchmarkError
from ..row import Figures, Row, at_most
from ..stack import Stack

PROGRAMS = 28
"""As many as the stack starts."""
LIMIT = 300.0
BARE = "import actionlib, numpy, rospy"
CLIENT = """
import rospy
from nao_library_actions.msg import NaoLedAction
from nao_sim_bridge.testing import SimulatedRobot
rospy.init_node("startup_client")
SimulatedRobot().action_client("NaoLights", NaoLedAction)
"""


def bare_start() -> float:
    """Time that as many programs as the stack has take to import what each of them needs, s."""
    began = time.perf_counter()
    for program in [subprocess.Popen([sys.executable, "-c", BARE]) for _ in range(PROGRAMS)]:
        program.wait(LIMIT)
    return time.perf_counter() - began


class Startup(Row):
    """From roslaunch to a goal that a server has taken and that has reached the robot."""

    name = "startup"
    subject = "roslaunch nao_sim.launch, to a goal that reaches the robot"
    against = f"{PROGRAMS} programs that import actionlib, numpy and rospy"
    unit = "s"
    bound = at_most(3.5)

    def measure(self, stack: Stack) -> Figures:
        """Start the bare programs, and then all of ours."""
        bare, began = bare_start(), time.perf_counter()
        with TemporaryDirectory() as folder, OwnStack(Path(folder) / "stack.txt", {}) as own:
            environment = {**os.environ, "ROS_MASTER_URI": own.master_uri, "ROS_LOG_DIR": folder}
            client = subprocess.run([sys.executable, "-c", CLIENT], env=environment, timeout=LIMIT, check=False)
            took = time.perf_counter() - began
        if client.returncode:
            raise BenchmarkError("no goal has reached the robot")
        return Figures(took, bare)
