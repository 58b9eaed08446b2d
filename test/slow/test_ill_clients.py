"""Clients of simulator and servers that are stopped, killed, or load files for ever: nothing is kept of them."""

import os
import signal
import subprocess
import sys
import time
from contextlib import closing
from pathlib import Path

import pytest
from waits import PATIENCE

from nao_library_modules.ros.own_stack import OwnMaster

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "soak"))
from nao_soak.ill_clients import IllClients
from nao_soak.levels import Levels

pytestmark = [pytest.mark.long, pytest.mark.timeout(1800)]
# The short form; `make soak` is the long one. s of wall time.
WARM, SECONDS, KILLED_EVERY, SAMPLED_EVERY = 90.0, 120.0, 6.0, 1.0


NODE = Path(__file__).resolve().parents[2] / "nao_library_modules/nodes/nao_lights"
USER = """
import rospy
from actionlib import SimpleActionClient
from nao_library_actions.msg import NaoLedAction, NaoLedGoal
from nao_library_msgs.msg import LedFunction

rospy.init_node("mortal", anonymous=True)
client = SimpleActionClient("NaoLights", NaoLedAction)
client.wait_for_server()
wait = LedFunction(function="setIntensity", lights=["FaceLeds"], i_values=[0.5], time=rospy.Duration.from_sec(0.05))
while True:
    client.send_goal_and_wait(NaoLedGoal([wait, LedFunction(function="getColor", lights=["FaceLeds"])]))
"""


class Server:
    """NaoLights on a ROS master of its own, and a client that sends it goals until it is killed, and another one.

    Attributes:
        killed: How many were.
    """

    def __init__(self, folder, robot_port):
        self.log = folder / "NaoLights.log"
        self._master = OwnMaster(folder / "master.txt")
        uri, folders = self._master.uri, dict.fromkeys(("ROS_HOME", "ROS_LOG_DIR"), str(folder / "ros"))
        self._options = {"env": {**os.environ, **folders, "ROS_MASTER_URI": uri}, "stderr": subprocess.DEVNULL}
        node = [sys.executable, str(NODE), "--pport", str(robot_port), f"__log:={self.log}"]
        self.process = subprocess.Popen(node, stdout=subprocess.DEVNULL, **self._options)
        self.killed, self._user, self._until = 0, None, 0.0

    def look(self, now):
        """Kill the client when its time has come."""
        if now > self._until:
            self._until = now + KILLED_EVERY
            if self._user:
                self._user.kill()
                self._user.wait()
                self.killed += 1
            self._user = subprocess.Popen([sys.executable, "-c", USER], stdout=subprocess.DEVNULL, **self._options)

    def close(self):
        for process in filter(None, (self._user, self.process)):
            process.kill()
            process.wait()
        self._master.stop()


def test_memory_threads_descriptors_and_log_are_level_with_ill_clients(tmp_path):
    log = tmp_path / "nao_sim.log"
    command = [sys.executable, "-m", "nao_sim_bridge", "--port", "0", "--speed", "2", "--record-dir", str(tmp_path)]
    with log.open("wb") as said:
        simulator = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=said, text=True)
    levels = Levels(SAMPLED_EVERY)
    try:
        port = int(simulator.stdout.readline().rpartition(":")[2])
        with IllClients("127.0.0.1", port, KILLED_EVERY) as clients, closing(Server(tmp_path, port)) as server:
            began = time.monotonic()
            while (now := time.monotonic() - began) < WARM + SECONDS:
                server.look(now)
                if now > WARM:
                    levels.add("simulator", simulator.pid, log)
                    levels.add("NaoLights", server.process.pid, server.log)
                time.sleep(SAMPLED_EVERY)
            ended = simulator.poll(), server.process.poll()
    finally:
        simulator.send_signal(signal.SIGTERM)
        simulator.communicate(timeout=PATIENCE)
    print(f"\n{clients.killed} clients of the robot killed, {server.killed} of the server\n{levels.table()}")
    assert ended == (None, None) and clients.died == 0
    assert min(clients.killed, server.killed) >= 0.3 * SECONDS / KILLED_EVERY
    assert len(levels.growth()) == 8 and levels.swollen() == [], log.read_text(errors="replace")[-4000:]
