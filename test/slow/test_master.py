"""A ROS master that dies and comes back, or hangs for a while: all is found again, and what was under way goes on."""

import os
import signal
import subprocess
import sys
import time

import pytest
from listening import listens
from named_port import named_port

from nao_library_modules.processes.own_stack import OwnStack
from nao_library_modules.ros.master_watch import LOOKS, PERIOD

LIMIT = 60.0
STOPPED = 60.0
"""s for which it hangs."""
DOWN, UNDER_WAY = 3.0, 20.0
"""s for which there is none, and for which what is under way goes on longer."""
USER = """
import sys, time
import rospy
import actionlib
from nao_library_actions.msg import NaoBehaviorAction, NaoLedAction, NaoMotionAction, NaoTactileAction
sys.path.insert(0, sys.argv[1])
from goal_functions import behavior, led, motion, tactile

rospy.init_node("user", anonymous=True, disable_signals=True)
began = time.monotonic()

def client(name, action):
    made = actionlib.SimpleActionClient(name, action)
    assert made.wait_for_server(rospy.Duration(60)), name
    return made

def goal(action, function):
    made = action().action_goal.goal
    setattr(made, made.__slots__[0], [function])
    return made

rospy.wait_for_service("nao_sim/reset", 60)
moves, touches = client("NaoMotion", NaoMotionAction), client("NaoTactile", NaoTactileAction)
runs = client("NaoBehavior", NaoBehaviorAction)

def done(client, action, function):
    client.send_goal(goal(action, function))
    assert client.wait_for_result(rospy.Duration(60)), function.function
    assert client.get_state() == 3, (function.function, client.get_goal_status_text())
    return client.get_result()
"""
LONG = """
done(touches, NaoTactileAction, tactile("onTouch", sensors=["chest"], behavior="hello"))
seconds = float(sys.argv[2])
turn = motion("angleInterpolation", names=["HeadYaw"], angles=[0.5], times=[seconds], stiffness=1.0)
moves.send_goal(goal(NaoMotionAction, turn))
wait = f"help: A wait. \\ndo:\\n  - wait: {seconds - 5.0}\\n"
runs.send_goal(goal(NaoBehaviorAction, behavior("runBehavior", text=wait)))
while moves.get_state() != 1 or runs.get_state() != 1:
    time.sleep(0.05)
print("under way", flush=True)
for made in (moves, runs):
    assert made.wait_for_result(rospy.Duration.from_sec(seconds + 60))
    assert made.get_state() == 3, made.get_goal_status_text()
print("went on", flush=True)
"""
NEW = """
for service in ("NaoMotion/describe", "NaoAudioOut/describe", "nao_controller/part_of_nao_driver"):
    rospy.wait_for_service(service, 60)
assert done(touches, NaoTactileAction, tactile("listOnTouch")).memList == ["hello"]
done(client("NaoLights", NaoLedAction), NaoLedAction, led("on", lights=["FaceLeds"]))
assert rospy.get_param("robot_description") and rospy.get_param("nao_walker/cmd_vel_timeout") == 0.5
print("all is back", flush=True)
"""


class Master:
    def __init__(self, folder):
        self.port = named_port()
        self._folder = folder
        self.start()

    def start(self):
        with (self._folder / "master.txt").open("ab") as output:
            command = ["rosmaster", "--core", "-p", str(self.port)]
            self.process = subprocess.Popen(command, stdout=output, stderr=output, stdin=subprocess.DEVNULL)
        deadline = time.monotonic() + LIMIT
        while not listens(self.port):
            assert time.monotonic() < deadline, "the ROS master does not come up"

    def kill(self):
        self.process.kill()
        self.process.wait(LIMIT)


@pytest.fixture
def master(tmp_path, monkeypatch):
    for name in ("ROS_HOME", "ROS_LOG_DIR"):
        monkeypatch.setenv(name, str(tmp_path))
    made = Master(tmp_path)
    monkeypatch.setenv("ROS_MASTER_URI", f"http://127.0.0.1:{made.port}")
    yield made
    made.process.send_signal(signal.SIGCONT)
    made.kill()


@pytest.fixture
def user():
    """Starts a program of a user's; what it says line by line."""
    support = os.path.join(os.path.dirname(__file__), "..", "support")
    started = []

    def start(program, *arguments):
        command = [sys.executable, "-c", USER + program, support, *map(str, arguments)]
        started.append(subprocess.Popen(command, stdout=subprocess.PIPE, text=True))
        return started[-1].stdout

    yield start
    for process in started:
        process.kill()
        process.communicate()


def test_a_master_that_dies_or_hangs_knows_everybody_again(master, user, tmp_path):
    with OwnStack(tmp_path / "stack.txt", {}, master_uri=os.environ["ROS_MASTER_URI"]) as stack:
        stack.wait_for_robot()
        long = user(LONG, DOWN + UNDER_WAY)
        assert long.readline() == "under way\n"
        time.sleep((LOOKS + 1) * PERIOD)  # by then the watch has read what there is
        master.kill()
        time.sleep(DOWN)
        master.start()
        began = time.monotonic()
        assert user(NEW).readline() == "all is back\n"
        print(f"a master that was killed: all is back after {time.monotonic() - began:.1f} s")
        assert long.readline() == "went on\n"

        long = user(LONG, STOPPED + UNDER_WAY)
        assert long.readline() == "under way\n"
        master.process.send_signal(signal.SIGSTOP)
        time.sleep(STOPPED)
        master.process.send_signal(signal.SIGCONT)
        began = time.monotonic()
        assert user(NEW).readline() == "all is back\n"
        print(f"a master that hung for {STOPPED:g} s: all is back after {time.monotonic() - began:.1f} s")
        assert long.readline() == "went on\n"
