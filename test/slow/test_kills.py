"""Nodes that are killed in the middle of what they do: the robot stands, no goal hangs, and all works again."""

import json
import os
import signal
import socket
import subprocess
import sys
from pathlib import Path
from xmlrpc.client import ServerProxy

import pytest
import qi
import rosgraph
from amount import amount
from listening import listens

from nao_library_modules.ros.own_stack import OwnMaster, OwnStack, StackFailed
from nao_sim_bridge.testing import wait_until

pytestmark = pytest.mark.timeout(1800)
SCRIPT = Path(__file__).resolve().parents[1] / "soak/kills.py"
LIMIT = 60.0
OWN_SERVER = """
import sys
from nao_library_modules.lights import NaoLights
from nao_library_modules.node import run_module
sys.exit(run_module(NaoLights, "NaoLights", "A server of one's own in place of the launched one."))
"""
ROOM_MADE = "another node took the name /NaoLights: this one is started again when that one has ended"
KILLS = amount(6, 18)
"""Of the first kinds; `test/soak/kills.py` takes all of them, and with `--kills 100` some again."""


def test_what_a_killed_node_was_doing_ends_and_the_node_comes_back(tmp_path):
    command = [sys.executable, str(SCRIPT), "--kills", str(KILLS), "--output", str(tmp_path)]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    print(run.stdout)
    assert run.stdout, run.stderr[-4000:]
    *records, whole = map(json.loads, run.stdout.splitlines())
    assert whole["kills"] == KILLS == len(records), run.stderr[-4000:]
    # How soon, against limits of this computer's time, is for who runs the script.
    assert [each for each in records if None in (each["still"], each["ended"], each["works"])] == []


def test_what_is_killed_or_makes_room_comes_back_and_a_simulator_that_was_switched_off_does_not(tmp_path):
    folders = dict.fromkeys(("ROS_HOME", "ROS_LOG_DIR"), str(tmp_path))
    arguments = {"driver": "false", "record_dir": str(tmp_path), "sim_time": "true"}
    with OwnStack(tmp_path / "stack.txt", arguments) as stack:
        environment = {**os.environ, **folders, "ROS_MASTER_URI": stack.master_uri}

        def lights_work():
            command = ["nao", "leds", "FaceLeds", "green"]
            return subprocess.run(command, env=environment, capture_output=True, timeout=LIMIT).returncode == 0

        def pid_of(name):
            try:
                return ServerProxy(rosgraph.Master("/test", stack.master_uri).lookupNode(name)).getPid("/test")[2]
            except (rosgraph.MasterError, OSError):
                return 0

        stack.wait_for_robot()
        wait_until(lights_work, LIMIT, "lights")
        node = rosgraph.Master("/test", stack.master_uri).lookupNode("/nao_sim")
        os.kill(ServerProxy(node).getPid("/test")[2], signal.SIGKILL)
        wait_until(lambda: not listens(stack.nao_port), LIMIT, "the end of the simulator")
        wait_until(lights_work, LIMIT, "lights of the simulator that was started again")

        second = OwnStack(tmp_path / "second.txt", {**arguments, "sim_time": "false"}, master_uri=stack.master_uri)
        wait_until(lambda: not second.alive(), LIMIT, "the end of a second launch file")
        assert "runs on this ROS master already" in second.log.read_text()
        wait_until(lights_work, LIMIT, "lights of the first one")
        master = rosgraph.Master("/test", stack.master_uri)
        assert master.getParam("/use_sim_time") is True
        assert master.getParam("/nao_sim/bound_port") == stack.nao_port  # set to 0 by the second launch file

        rooms_made = stack.log.read_text().count(ROOM_MADE)
        command = [sys.executable, "-c", OWN_SERVER, "--pport", str(stack.nao_port)]
        with subprocess.Popen(command, env=environment) as own:
            wait_until(lambda: stack.log.read_text().count(ROOM_MADE) > rooms_made, LIMIT, "a server that makes room")
            wait_until(lambda: pid_of("/NaoLights") == own.pid and lights_work(), LIMIT, "lights of the own server")
            own.send_signal(signal.SIGINT)
        wait_until(lambda: pid_of("/NaoLights") not in (0, own.pid) and lights_work(), LIMIT, "the launched server")

        session = qi.Session()
        session.connect(f"tcp://127.0.0.1:{stack.nao_port}")
        session.service("ALSystem").shutdown()
        wait_until(lambda: "nao_sim is off" in stack.log.read_text(), LIMIT, "the end of the simulator")
        assert not listens(stack.nao_port) and stack.alive()


def test_a_simulator_that_cannot_start_ends_its_launch_file_at_once_with_the_reason(tmp_path):
    with socket.create_server(("127.0.0.1", 0)) as taken, OwnMaster(tmp_path / "master.txt") as master:
        port = {"nao_port": str(taken.getsockname()[1])}
        cases = ({"world": "lob"}, "did you mean 'lab'"), ({"robots": "20"}, "1 to 8"), (port, "listens there")
        for arguments, told in cases:
            given = {"driver": "false", "record_dir": str(tmp_path), **arguments}
            stack = OwnStack(tmp_path / "stack.txt", given, master_uri=master.uri)
            with pytest.raises(StackFailed, match=told):
                stack.wait_for_robot()
            assert stack.alive()  # its nodes have not ended yet
            wait_until(lambda stack=stack: not stack.alive(), LIMIT, "the end of the launch file")
            assert "escalating to" not in stack.log.read_text()
