"""What a user types first: roslaunch brings all servers up within seconds, and every program explains itself."""

import os
import signal
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from concurrent.futures import ThreadPoolExecutor
from importlib.util import cache_from_source
from pathlib import Path

import rospkg
from waits import PATIENCE, hold

import nao_library_actions
import nao_library_msgs
from nao_library_modules.ros.own_stack import OwnMaster

CLIENT = """
import rospy
from nao_library_actions.msg import NaoLedAction
from nao_sim_bridge.testing import SimulatedRobot
rospy.init_node("startup_client")
SimulatedRobot().action_client("NaoLights", NaoLedAction)
"""
HANGING = """
import threading
from nao_library_modules.ros.node import run_module
def module(*_, **__):
    print("being made", flush=True)
    threading.Event().wait()
run_module(module, "hanging", "", [])
"""


def test_all_servers_get_ready(tmp_path):
    folders = dict.fromkeys(("ROS_HOME", "ROS_LOG_DIR"), str(tmp_path))
    with OwnMaster(tmp_path / "master.txt") as master:
        environment = {**os.environ, **folders, "ROS_MASTER_URI": master.uri}
        launch = subprocess.Popen(
            ["roslaunch", "nao_library", "nao_sim.launch", "nao_port:=0"], env=environment, stdout=subprocess.DEVNULL
        )
        try:
            # The client ends when every server has taken a goal that reached the robot.
            client = subprocess.run([sys.executable, "-c", CLIENT], env=environment, timeout=300.0)
        finally:
            launch.send_signal(signal.SIGINT)
            launch.wait(60.0)
    assert client.returncode == 0


def test_a_node_whose_module_is_still_being_made_ends_when_it_is_told_to_also_where_the_master_hangs(tmp_path):
    with OwnMaster(tmp_path / "master.txt") as master:
        environment = {**os.environ, "ROS_MASTER_URI": master.uri, "ROS_LOG_DIR": str(tmp_path)}
        node = subprocess.Popen([sys.executable, "-c", HANGING], env=environment, stdout=subprocess.PIPE, text=True)
        try:
            assert node.stdout.readline() == "being made\n"
            hold(master.pid)
            node.send_signal(signal.SIGINT)
            node.wait(60.0)
        finally:
            node.kill()
            os.kill(master.pid, signal.SIGCONT)
            node.communicate()


def test_no_program_compiles_what_is_compiled():
    assert not sys.dont_write_bytecode
    for package in (nao_library_actions, nao_library_msgs):
        files = sorted(Path(package.__file__).parent.glob("msg/_*.py"))
        assert files and all(Path(cache_from_source(str(file))).exists() for file in files)


def test_every_program_explains_itself():
    def run(program):  # not by rosrun, which takes longer to find it than it takes itself
        return subprocess.run([str(program), "--help"], capture_output=True, text=True, timeout=PATIENCE)

    folders = [Path(rospkg.RosPack().get_path(name)) for name in ("nao_sim_bridge", "nao_library_modules")]
    programs = [program for folder in folders for program in sorted((folder / "nodes").iterdir())]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for program, done in zip(programs, pool.map(run, programs)):
            assert done.returncode == 0 and "usage" in done.stdout.lower(), (program, done.stderr)


def test_every_launch_argument_is_documented():
    files = sorted((Path(rospkg.RosPack().get_path("nao_library")) / "launch").glob("*.launch"))
    assert files
    for file in files:
        for argument in ElementTree.parse(file).getroot().findall("arg"):
            constant = "value" in argument.attrib  # it cannot be given
            assert constant or argument.get("doc"), (file.name, argument.get("name"))
